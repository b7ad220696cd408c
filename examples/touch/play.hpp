// SPDX-License-Identifier: MIT
#pragma once

/// @file One scene played: felt on the device, its shape drawn beside the servo loop, and all of it written
/// down. Templates hold only what needs the object's type.

#include <palpate/geometry/mesh_surface.hpp>
#include <palpate/geometry/sampled_surface.hpp>
#include <palpate/law/map/duffing_map.hpp>

#include <filesystem>
#include <functional>
#include <optional>

#include "povray.hpp"
#include "session.hpp"

namespace touch {

inline constexpr std::size_t display_vertices = 5000;  ///< of exact surfaces

/// Object, tool, script and parameters.
template <class Body, class Coupling = palpate::IndependentRegions>
struct Scene {
  std::string title;
  Body body;
  palpate::MeshData<S> display;  ///< the mesh that is drawn
  std::string tool;
  palpate::DuffingForce<S> force;
  Coupling coupling;
  View view;
  Script (*script)(const Options&, const Body&, const Tool&);
};

/// The object as the solver asks it: an exact surface itself, a mesh through samples a hundredth of its size
/// apart, which are ten times faster.
template <class Body>
[[nodiscard]] const Body& felt_object(const Body& body) {
  return body;
}
[[nodiscard]] inline palpate::SampledSurface<palpate::MeshSurface<S>> felt_object(
    const palpate::MeshSurface<S>& body) {
  return {body, {.spacing = 0.01 * (body.upper() - body.lower()).norm()}};
}

/// A body as set-up asks it, its type forgotten.
struct AnyBody {
  using Scalar = S;

  template <class Body>
  explicit AnyBody(const Body& body)
      : nearest([&body](const V& x) { return body.closest(x); }),
        low(body.lower()),
        high(body.upper()),
        inwards(body.reach()) {}

  [[nodiscard]] palpate::SurfacePoint<S> closest(const V& x) const noexcept { return nearest(x); }
  [[nodiscard]] V lower() const noexcept { return low; }
  [[nodiscard]] V upper() const noexcept { return high; }
  [[nodiscard]] S reach() const noexcept { return inwards; }

  std::function<palpate::SurfacePoint<S>(const V&)> nearest;
  V low, high;
  S inwards;
};

/// What the hand feels of the body that a response field describes: its force under the tool's contact area,
/// fitted down to two radii. `top`: the point whose law is printed [m].
[[nodiscard]] palpate::DuffingMap<S> field_force(const palpate::ResponseField& field, const AnyBody& body,
                                                 const Tool& tool, const V& top);

/// A scene without its object.
struct Stage {
  const Options& options;
  const Tool& tool;
  const Script& script;
  std::string title;
  View view;
  V top;  ///< the device's origin [m]
  std::optional<Shape>& shape;
};

/// Runs the script and writes results into options.out; `report` prints what the object has to say first.
int play(const Stage& stage, Feel& feel, const std::function<void()>& report = {});

/// Empties the folder of the results' frames, and makes it if need be.
void prepare_folder(const std::string& out);

/// Plays the scene as options.shape and options.stepped say; results go into options.out.
template <class Body, class Coupling>
int play(Options options, const Scene<Body, Coupling>& scene) {
  options.tool = scene.tool;
  prepare_folder(options.out);
  const Tool tool = make_tool(options);
  const Script script = scene.script(options, scene.body, tool);
  const auto& object = felt_object(scene.body);
  std::optional<Shape> shape;
  if (options.shape != "none") shape.emplace(make_shape(options.shape, scene.body, scene.display));
  std::optional<palpate::SweptPose<S>> sweep;
  if (options.sweep > 0) sweep.emplace(options.sweep);
  const V top = scene.body.raycast(V(0, 1, 0), -V::UnitY()).position;
  const Stage stage{options, tool, script, scene.title, scene.view, top, shape};

  using Object = std::remove_cvref_t<decltype(object)>;
  const auto felt_with = [&](const auto& force) {
    using Force = std::remove_cvref_t<decltype(force)>;
    if constexpr (std::same_as<Body, palpate::MeshSurface<S>>) {
      if (options.deformed) {
        if (!shape) refuse("--detect deformed needs a shape");
        using Now = palpate::DeformedSurface<Object>;
        SolverFeel<Contact<Now, Coupling, Force>, FollowShape> feel(
            make_contact(Now(object, palpate::TriangleMesh<S>(scene.display)), tool, force, scene.coupling),
            sweep,
            palpate::EnergyLimit<S>(
                {.centre_of_mass = tool.centre_of_mass, .contact_area = tool.contact_area}),
            FollowShape(*shape));
        return play(stage, feel, [&] {
          std::printf("detection      on the deformed shape, bulges up to %.3f mm\n",
                      1e3 * feel.follow.highest);
        });
      }
    }
    if (options.deformed) refuse("--detect deformed is for mesh files");
    SolverFeel<Contact<Object, Coupling, Force>> feel(make_contact(object, tool, force, scene.coupling),
                                                      sweep);
    return play(stage, feel);
  };
  if (!shape || !shape->field) return felt_with(scene.force);
  return felt_with(field_force(*shape->field, AnyBody(scene.body), tool, top));
}

// Compiled in surfaces.cpp; the scenes use them too.
extern template int play(Options, const Scene<palpate::Box<S>>&);
extern template int play(Options, const Scene<palpate::Ellipsoid<S>>&);

/// An object of the command line. `shape`: the model that suits the body, where options name none.
template <class Body>
int run(Options options, const Body& body, palpate::MeshData<S> display, const char* shape) {
  if (options.shape.empty()) options.shape = shape;
  return play(options,
              Scene<Body>{.title = "object " + std::filesystem::path(options.object).stem().string() +
                                   ", tool " + options.tool + ", script " + options.script,
                          .body = body,
                          .display = std::move(display),
                          .tool = options.tool,
                          .force = paper_force,
                          .coupling = {},
                          .view = view_of(body),
                          .script = [](const Options& o, const Body& b, const Tool& tool) {
                            return make_script(o, b, tool.mesh);
                          }});
}

}  // namespace touch
