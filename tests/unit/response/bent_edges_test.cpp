// SPDX-License-Identifier: MIT
#include <palpate/response/response_contact.hpp>

#include "support/check.hpp"
#include "support/response_meshes.hpp"

namespace {
using namespace palpate;
using V = Vec3<double>;

SolveMesh cube() {
  MeshData<double> mesh = test::box_mesh(V(0.1, 0.1, 0.1), 10);
  std::vector<std::uint8_t> fixed;
  for (const auto& t : mesh.triangles)
    fixed.push_back(mesh.vertices[t[0]].y() + mesh.vertices[t[1]].y() + mesh.vertices[t[2]].y() < 1e-9);
  return make_solve_mesh(SmoothSurface(mesh), fixed, {.vertices = 300});
}
struct Near {
  Vec3<float> place;
  float a = 0.005f;
};
// A quadratic field at the mesh's vertices.
V u(const V& x) { return V(x.x() * x.x() + x.z(), 2 * x.x() * x.z(), 0.1 - x.z() * x.z()); }
}  // namespace

TEST_CASE("a quadratic field is drawn exactly on a face, near a contact; far from it, as ever") {
  const SolveMesh mesh = cube();
  const BendTable table(mesh, detail::EdgeBend(mesh));
  const std::size_t n = ResponseField::padded(mesh.vertices.size());
  std::vector<float> field(3 * n, 0.f);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    for (std::size_t i = 0; i < 3; ++i) field[i * n + v] = float(u(mesh.vertices[v])[Eigen::Index(i)]);
  detail::BentEdges bent(table, n);
  const float reach = 0.06f;
  std::size_t checked = 0;
  for (const V& place :
       {V(0.03, 0.1, 0.03), V(0.07, 0.1, 0.06)}) {  // the second: nothing is left of the first
    const std::array<Near, 1> contact{{place.cast<float>(), 0.005f}};
    bent.read(field.data(), n);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& c = mesh.triangles[t];
      const V &p = mesh.vertices[c[0]], &q = mesh.vertices[c[1]], &r = mesh.vertices[c[2]];
      const V middle = (p + q + r) / 3;
      const double away = (middle - place).norm();
      detail::BentEdges::OfTriangle bend;
      const bool any = bent.find(t, contact, 1, reach, bend);
      if (away > reach + 0.005 + 0.02) CHECK(!any);
      if (away > 0.6 * reach || std::min({p.y(), q.y(), r.y()}) < 0.1 - 1e-9) continue;
      REQUIRE(any);
      const detail::Lane third = detail::four(1.f / 3);
      const detail::Lane3 more = bend(third, third);
      const V drawn = (u(p) + u(q) + u(r)) / 3 + V(more.x[0], more.y[0], more.z[0]),
              linear = (u(p) + u(q) + u(r)) / 3;
      // The penalty on second derivatives (edge_bend.hpp) makes them too small where neighbours lie to one side, next to an edge of
      // the cube: 8 % met.
      CHECK((drawn - u(middle)).norm() < 0.1 * (linear - u(middle)).norm());
      ++checked;
    }
  }
  CHECK(checked > 40);
}
