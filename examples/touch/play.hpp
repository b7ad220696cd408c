// SPDX-License-Identifier: MIT
#pragma once

/// @file One scene played: felt on the device, its shape drawn beside the servo loop, and all of it written
/// down.

#include <palpate/calibrate/response_map.hpp>
#include <palpate/geometry/mesh_surface.hpp>
#include <palpate/geometry/sampled_surface.hpp>

#include "povray.hpp"
#include "session.hpp"

namespace touch {

inline constexpr std::size_t display_vertices = 5000;  ///< of exact surfaces
inline constexpr std::size_t most_frames = 36;

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

/// What the hand feels of the body that a response field describes: its force under the tool's contact area,
/// fitted down to two radii.
template <class Body>
[[nodiscard]] palpate::DuffingMap<S> field_force(const palpate::ResponseField& field, const Body& body,
                                                 const Tool& tool) {
  const S radius = std::sqrt(tool.contact_area / std::numbers::pi_v<S>);
  auto fitted =
      palpate::response_map(field, body,
                            palpate::ResponseMapParams<S>{
                                .radius = radius, .depth = 2 * radius, .spacing = field.mesh().length / 2});
  const auto law = fitted.map.at(body.raycast(V(0, 1, 0), -V::UnitY()).position).params();
  std::printf("force          of the field: c1 %.0f N/m, c3 %.2g N/m^3 on top, fits within %.1f %%\n", law.c1,
              law.c3, 100 * fitted.worst_rms);
  return std::move(fitted.map);
}

/// One line per region and tick in contact. Without a shape w is 1.
template <class Device>
void write_contacts(const std::string& file, const Device& device, const Shape* shape) {
  std::ofstream csv(file);
  csv << "t_s,region,tool_x_m,F_x_N,F_y_N,F_z_N,force_N,D_m,area_m2,w,modified_D_m\n";
  for (std::size_t i = 0; i < device.recorded(); ++i) {
    const auto& r = device.recording()[i];
    for (std::size_t j = 0; j < r.result.contacts.size(); ++j) {
      const palpate::ContactState<S>& c = r.result.contacts[j];
      const S w = shape != nullptr ? shape->factor(c) : 1, D = c.displacement.norm();
      csv << r.t << ',' << c.id << ',' << r.result.pose.to_tool(c.centre).x() << ',' << c.force.x() << ','
          << c.force.y() << ',' << c.force.z() << ',' << c.force.norm() << ',' << D << ',' << c.area << ','
          << w << ',' << w * D << '\n';
    }
  }
  std::printf("wrote          %s\n", file.c_str());
}

/// The largest change of the force from one tick to the next, and that at the ticks in which a region
/// appears.
template <class Device>
void print_steps(const Device& device) {
  double largest = 0, landing = 0;
  for (std::size_t i = 1; i < device.recorded(); ++i) {
    const Felt& before = device.recording()[i - 1].result;
    const Felt& now = device.recording()[i].result;
    const double step = (now.wrench.force - before.wrench.force).norm();
    largest = (std::max)(largest, step);
    if (now.regions > before.regions) landing = (std::max)(landing, step);
  }
  std::printf("force step     %.4f N in a tick at most; %.4f N where a region appears\n", largest, landing);
}

/// Plays the scene as options.shape and options.stepped say; results go into options.out.
template <class Body, class Coupling>
int play(Options options, const Scene<Body, Coupling>& scene) {
  options.tool = scene.tool;
  std::filesystem::create_directories(options.out);
  std::filesystem::remove_all(options.out + "/frames");  // those of an earlier run
  const Tool tool = make_tool(options);
  const Script script = scene.script(options, scene.body, tool);
  const auto& object = felt_object(scene.body);
  std::optional<Shape> shape;
  if (options.shape != "none") shape.emplace(make_shape(options.shape, scene.body, scene.display));
  std::optional<palpate::SweptPose<S>> sweep;
  if (options.sweep > 0) sweep.emplace(options.sweep);

  // Frames from first contact on, at even distances of the updates.
  constexpr double begin = 1.0;
  const auto stride =
      static_cast<std::size_t>(std::ceil((script.seconds - begin) * update_rate / most_frames));
  std::size_t updates = 0;
  std::vector<Frame> frames;
  const auto update = [&](const auto& record) {
    if (!shape) return;
    shape->update(record.result);
    if (record.t >= begin && updates++ % stride == 0) frames.push_back(shape->frame(record.t, record.result));
  };
  const V top = scene.body.raycast(V(0, 1, 0), -V::UnitY()).position;
  const auto finish = [&](const auto& device) {
    print_steps(device);
    write_contacts(options.out + "/contacts.csv", device, shape ? &*shape : nullptr);
    if (!shape) return;
    std::printf("shape          %s, %zu vertices, %zu updates that moved something, %.0f us each\n",
                options.shape.c_str(), shape->rest().vertices.size(), shape->updates(),
                1e6 * shape->mean_time());
    write_series(options.out, "shape", shape->rest(), frames);
    Pictures(options.out + "/frames", scene.view, shape->rest(), tool).write(scene.title, frames);
    std::printf("wrote          %s/shape.pvd, %zu frames\n", options.out.c_str(), frames.size());
  };

  using Object = std::remove_cvref_t<decltype(object)>;
  const auto felt_with = [&](const auto& force) {
    using Force = std::remove_cvref_t<decltype(force)>;
    if constexpr (std::same_as<Body, palpate::MeshSurface<S>>) {
      if (options.deformed) {
        if (!shape) refuse("--detect deformed needs a shape");
        using Now = palpate::DeformedSurface<Object>;
        Feel<Contact<Now, Coupling, Force>, FollowShape> feel{
            make_contact(Now(object, palpate::TriangleMesh<S>(scene.display)), tool, force, scene.coupling),
            sweep,
            palpate::EnergyLimit<S>(
                {.centre_of_mass = tool.centre_of_mass, .contact_area = tool.contact_area}),
            FollowShape(*shape)};
        return perform(options, feel, tool, script, top, scene.title, update, [&](const auto& device) {
          std::printf("detection      on the deformed shape, bulges up to %.3f mm\n",
                      1e3 * feel.follow.highest);
          finish(device);
        });
      }
    }
    if (options.deformed) refuse("--detect deformed is for mesh files");
    Feel<Contact<Object, Coupling, Force>> feel{
        make_contact(object, tool, force, scene.coupling), sweep, {}, {}};
    return perform(options, feel, tool, script, top, scene.title, update, finish);
  };
  if (!shape || !shape->field) return felt_with(scene.force);
  const auto fitted = field_force(*shape->field, scene.body, tool);
  return felt_with(fitted);
}

}  // namespace touch
