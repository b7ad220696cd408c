// SPDX-License-Identifier: MIT

#include "body.hpp"

#include <palpate/geometry/mesh_extremal_points.hpp>
#include <palpate/geometry/mesh_surface.hpp>

#include <filesystem>

#include "heart.hpp"

namespace touch {

using namespace palpate;

namespace {

constexpr std::size_t display_vertices = 5000;  // of exact surfaces

template <class Surface>
class Model final : public Body::Interface {
 public:
  explicit Model(const Surface& surface) : surface_(surface) {}
  SurfacePoint<S> closest(const V& x) const noexcept override { return surface_.closest(x); }
  RayHit<S> raycast(const V& from, const V& along) const noexcept override {
    return surface_.raycast(from, along);
  }
  V shading_normal(const V& x) const override {
    using palpate::shading_normal;
    return shading_normal(surface_, x);
  }
  std::vector<ExtremalPoint<S>> extremal_points() const override {
    using palpate::extremal_points;
    return extremal_points(surface_);
  }

 private:
  Surface surface_;
};

TriangleMesh<S> file_mesh(const Options& options) {
  MeshData<S> mesh = read_mesh(options.file(options.object));
  V low = mesh.vertices.front(), high = low;
  for (const V& v : mesh.vertices) low = low.cwiseMin(v), high = high.cwiseMax(v);
  for (V& v : mesh.vertices) v -= (low + high) / 2;
  const V size = 1e3 * (high - low);
  std::printf("%s: %zu vertices, %zu triangles, %.0f x %.0f x %.0f mm\n", options.object.c_str(),
              mesh.vertices.size(), mesh.triangles.size(), size.x(), size.y(), size.z());
  if (!(size.maxCoeff() > 10 && size.maxCoeff() < 1000))
    std::printf("note           the tools are 3 to 60 mm wide: is --scale right?\n");
  return TriangleMesh<S>(mesh);
}

}  // namespace

template <class Surface>
Body Body::of(std::string title, const Surface& surface, MeshData<S> display) {
  Body body;
  body.title = std::move(title);
  body.display = std::move(display);
  body.it_ = std::make_shared<Model<Surface>>(surface);
  body.lower_ = surface.lower(), body.upper_ = surface.upper();
  body.reach_ = surface.reach(), body.volume_ = surface.volume();
  return body;
}

Body make_body(const Options& options) {
  const std::string& name = options.object;
  const auto exact = [&](const auto& surface) {
    return Body::of(name, surface, surface.mesh(display_vertices));
  };
  if (name == "ellipsoid") return exact(Ellipsoid<S>({.axes = V(0.06, 0.04, 0.04)}));
  if (name == "sphere") return exact(Sphere<S>({.radius = 0.05}));
  if (name == "box") return exact(Box<S>({.half = V(0.05, 0.04, 0.05)}));
  if (name == "cube") return exact(Box<S>({.half = V(0.05, 0.05, 0.05)}));
  if (name == "cylinder") return exact(Cylinder<S>({.radius = 0.05, .half_height = 0.04}));
  if (name == "superellipsoid") return exact(Superellipsoid<S>({.axes = V(0.06, 0.04, 0.05)}));
  if (name == "heart") return exact(Heart({}));
  if (!is_mesh_file(name)) refuse("unknown object " + name);
  const TriangleMesh<S> mesh = file_mesh(options);
  Body body = Body::of(std::filesystem::path(name).stem().string(), MeshSurface<S>(mesh), mesh.data());
  body.is_file = true;
  return body;
}

}  // namespace touch
