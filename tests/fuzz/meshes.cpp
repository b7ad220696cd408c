// SPDX-License-Identifier: MIT

/// @file Triangle meshes from bytes: a good one that was edited, or any at all. inspect() names a defect, or
/// the mesh is closed by an independent check and everything that is made of it answers with finite numbers.

#include "bytes.hpp"

#include <palpate/detection/tool_points.hpp>
#include <palpate/geometry/box.hpp>
#include <palpate/geometry/mesh_extremal_points.hpp>
#include <palpate/geometry/mesh_surface.hpp>
#include <palpate/geometry/sphere.hpp>

#include <support/meshes.hpp>

namespace {
using namespace palpate;
using fuzz::Bytes;
using fuzz::require;

template <Real S>
MeshData<S> from_bytes(Bytes& in) {
  MeshData<S> mesh;
  const std::uint8_t kind = in.byte();
  switch (kind % 4) {
    case 0:
      mesh = Box<S>({.half = Vec3<S>(S(0.03), S(0.02), S(0.01))}).mesh(8);
      break;
    case 1:
      mesh = Sphere<S>({}).mesh(26);
      break;
    case 2:
      mesh = test::torus<S>(S(0.03), S(0.01), 4, 4);
      break;
    default:
      for (int v = in.byte() % 16; v > 0; --v) mesh.vertices.push_back(in.units<S>());
      for (int t = in.byte() % 32; t > 0; --t)
        mesh.triangles.push_back({in.byte() % 16u, in.byte() % 16u, in.byte() % 16u});
  }
  if (mesh.vertices.empty() || mesh.triangles.empty()) return mesh;
  if (kind & 64) {
    const S scale = in.between<S>(S(1e-4), S(1e6));  // 1e-6 m and up, as all bodies
    for (Vec3<S>& v : mesh.vertices) v *= scale;
  }
  while (!in.empty()) {
    Vec3<S>& v = mesh.vertices[in.byte() % mesh.vertices.size()];
    auto& t = mesh.triangles[in.byte() % mesh.triangles.size()];
    switch (in.byte() % 12) {
      case 0:
        v[in.byte() % 3] = in.number<S>();
        break;
      case 1:
        std::swap(t[0], t[1]);
        break;
      case 2:
        t[in.byte() % 3] = in.raw<std::uint8_t>();
        break;
      case 3:
        t[in.byte() % 3] = in.raw<std::uint32_t>();
        break;
      case 4:
        mesh.triangles.push_back(t);
        break;
      case 5:
        t = mesh.triangles.back();
        mesh.triangles.pop_back();
        if (mesh.triangles.empty()) return mesh;
        break;
      case 6:
        v = mesh.vertices[in.byte() % mesh.vertices.size()];
        break;
      case 7:  // split a triangle at a point of it, or off it
      {
        const auto old = t;
        const auto middle = static_cast<std::uint32_t>(mesh.vertices.size());
        for (const std::uint32_t i : old)
          if (i >= middle) return mesh;
        const S a = in.unit<S>(), b = in.unit<S>();
        mesh.vertices.push_back(mesh.vertices[old[0]] + a * (mesh.vertices[old[1]] - mesh.vertices[old[0]]) +
                                b * (mesh.vertices[old[2]] - mesh.vertices[old[0]]));
        t[2] = middle;
        mesh.triangles.push_back({old[1], old[2], middle});
        mesh.triangles.push_back({old[2], old[0], middle});
        break;
      }
      case 8:
        v += in.units<S>() * S(1e-3);
        break;
      case 9:
        v[in.byte() % 3] *= S(-1);
        break;
      case 10: {  // another closed part
        const MeshData<S> other =
            Box<S>({.half = Vec3<S>::Constant(S(0.01)), .centre = in.units<S>() * S(0.1)}).mesh(8);
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        for (const auto& p : other.vertices) mesh.vertices.push_back(p);
        for (const auto& u : other.triangles)
          mesh.triangles.push_back({u[0] + first, u[1] + first, u[2] + first});
        break;
      }
      default: {  // thin
        const int axis = in.byte() % 3;
        const S factor = in.between<S>(S(1e-12), S(1));
        for (Vec3<S>& u : mesh.vertices) u[axis] *= factor;
      }
    }
    if (mesh.vertices.size() > 200) break;
  }
  return mesh;
}

template <Real S>
void one(Bytes& in) {
  const MeshData<S> data = from_bytes<S>(in);
  const MeshReport report = inspect(data);
  for (std::size_t d = 0; d < mesh_defect_count; ++d) {
    const MeshMessage message = describe(report, static_cast<MeshDefect>(d));
    require(std::memchr(message.text, 0, sizeof message.text) != nullptr, "a message ends");
    require((message.text[0] != 0) == (report.defects[d].count > 0), "a defect has a message");
  }
  if (!report.valid()) {
    try {
      const TriangleMesh<S> mesh(data);
      require(false, "a mesh with a defect is refused");
    } catch (const SetupError&) {
    }
    return;
  }
  require(test::is_sound(data), "what has no defect is closed, oriented and holds volume");
  const TriangleMesh<S> mesh(data);
  require(
      mesh.volume() > S(0) && mesh.area() > S(0) && is_finite(mesh.volume()) && is_finite(mesh.centroid()),
      "volume and area are positive");
  for (const auto& n : mesh.vertex_normals()) require(std::abs(n.norm() - S(1)) < S(1e-4), "unit normals");
  const MeshSurface<S> body(mesh);
  const S size = (mesh.upper() - mesh.lower()).norm(),
          far = mesh.upper().cwiseAbs().maxCoeff() + mesh.lower().cwiseAbs().maxCoeff();
  std::uint32_t seed = 1;
  for (const auto& v : data.vertices) {
    seed = seed * 1664525u + 1013904223u;
    const Vec3<S> x = seed & 1024 ? v : Vec3<S>(v + size * S(1e-2) * (mesh.centroid() - v).normalized());
    const auto at = body.closest(x);
    require(is_finite(at.position) && std::abs(at.normal.norm() - S(1)) < S(1e-4),
            "a closest point is finite");
    require(std::abs((x - at.position).norm() - std::abs(at.distance)) <= S(1e-4) * (size + far), "distance");
    const auto slow = static_cast<S>(std::fabs(test::brute_force_distance(data, x)));
    require(std::abs(std::abs(at.distance) - slow) <= S(1e-4) * (size + far), "no triangle is nearer");
    const auto inside = body.penetration(x);
    require(is_finite(inside.depth) && is_finite(inside.gradient) && inside.gradient.norm() < S(1.01),
            "a depth is finite");
    (void)body.raycast(x, Vec3<S>(S(0.3), S(-0.5), S(0.8)));
    (void)body.separated(x, size);
  }
  const auto points = extremal_points(mesh);
  require(points.size() <= 16, "extremal points are few");
  for (const auto& p : points)
    require(is_finite(p.position) && std::abs(p.normal.norm() - S(1)) < S(1e-4),
            "an extremal point is finite");
  const ToolPoints<S> tool(mesh, {.contact_area = mesh.area()});
  require(tool.size() == data.vertices.size(), "a tool's points are the mesh's");
  if (mesh.area() < S(1e6) * size * size) {
    try {
      const ToolPoints<S> even(mesh, {.contact_area = mesh.area()}, size / S(8));
      S area = S(0);
      for (const S a : even.areas()) area += a;
      require(std::abs(area - mesh.area()) <= S(1e-3) * mesh.area(), "even points have the mesh's area");
    } catch (const SetupError&) {
    }
  }
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes in(data, size);
  if (in.byte() % 2)
    one<float>(in);
  else
    one<double>(in);
  return 0;
}
