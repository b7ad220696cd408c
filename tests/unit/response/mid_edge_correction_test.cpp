// SPDX-License-Identifier: MIT
#include <palpate/response/response_contact.hpp>
#include <palpate/response/setup/make_element_mesh.hpp>
#include <palpate/response/setup/mid_edge_fit.hpp>
#include <palpate/response/setup/quadrature.hpp>

#include "support/check.hpp"
#include "support/response_meshes.hpp"

namespace {
using namespace palpate;
using V = Vec3<double>;

ElementMesh cube() {
  MeshData<double> mesh = test::box_mesh(V(0.1, 0.1, 0.1), 10);
  std::vector<std::uint8_t> fixed;
  for (const auto& t : mesh.triangles)
    fixed.push_back(mesh.vertices[t[0]].y() + mesh.vertices[t[1]].y() + mesh.vertices[t[2]].y() < 1e-9);
  return make_element_mesh(SmoothSurface(mesh), fixed, {.vertices = 300});
}
detail::DrawnContact contact_at(const V& position) {
  detail::DrawnContact contact{};
  detail::NearField& near = contact.near;
  near.x = position.cast<float>();
  near.m = Vec3<float>(0, -1, 0);
  near.along = near.couple = near.slope = near.push = Vec3<float>::Zero();
  near.shear.setZero();
  near.a = 0.005f;
  return contact;
}
std::array<detail::DrawnContact, 1> list(const detail::DrawnContact& contact) { return {contact}; }
// A quadratic field at the mesh's vertices.
V u(const V& x) { return V(x.x() * x.x() + x.z(), 2 * x.x() * x.z(), 0.1 - x.z() * x.z()); }
}  // namespace

TEST_CASE("a quadratic field is drawn exactly on a face, near a contact; far from it, as ever") {
  const ElementMesh mesh = cube();
  const MidEdgeTable table(mesh, detail::MidEdgeFit(mesh));
  const std::size_t n = ResponseField::padded(mesh.vertices.size());
  std::vector<float> field(3 * n, 0.f);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    for (std::size_t i = 0; i < 3; ++i) field[i * n + v] = float(u(mesh.vertices[v])[Eigen::Index(i)]);
  const std::vector<float> none(3 * n, 0.f);  // a contact without a force
  detail::MidEdgeCorrection<1> bent(table, n);
  const float reach = 0.06f;
  std::size_t checked = 0;
  for (const V& position :
       {V(0.03, 0.1, 0.03), V(0.07, 0.1, 0.06)}) {  // the second: nothing is left of the first
    bent.read(field.data(), none.data(), n, list(contact_at(position)), reach);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& c = mesh.triangles[t];
      const V &p = mesh.vertices[c[0]], &q = mesh.vertices[c[1]], &r = mesh.vertices[c[2]];
      const V middle = (p + q + r) / 3;
      const double away = (middle - position).norm();
      detail::MidEdgeCorrection<1>::OfTriangle of_triangle{};
      const bool any = bent.find(t, of_triangle);
      if (away > reach + 0.005 + 0.02) CHECK(!any);
      if (away > 0.6 * reach || std::min({p.y(), q.y(), r.y()}) < 0.1 - 1e-9) continue;
      REQUIRE(any);
      const detail::Simd4 third = detail::Simd4(1.f / 3);
      const detail::SimdVec3<detail::Simd4> more = of_triangle(third, third);
      const V drawn = (u(p) + u(q) + u(r)) / 3 + V(more.x[0], more.y[0], more.z[0]),
              linear = (u(p) + u(q) + u(r)) / 3;
      // The penalty on second derivatives (mid_edge_fit.hpp) makes them too small where neighbours lie to one
      // side, next to an edge of the cube: 8 % met.
      CHECK((drawn - u(middle)).norm() < 0.1 * (linear - u(middle)).norm());
      ++checked;
    }
  }
  CHECK(checked > 40);
}

TEST_CASE(
    "far from a contact a quadratic field is drawn linearly, right in the mean; near it, vertices stay") {
  const ElementMesh mesh = cube();
  const MidEdgeTable table(mesh, detail::MidEdgeFit(mesh));
  const auto bulge = [](const V& x) {
    return V(x.x() * x.x() + x.z(), x.squaredNorm(), 0.1 - x.z() * x.z());
  };
  const std::size_t n = ResponseField::padded(mesh.vertices.size());
  std::vector<float> position(3 * n, 0.f), field(4 * n, 0.f);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    for (std::size_t i = 0; i < 3; ++i) {
      position[i * n + v] = float(mesh.vertices[v][Eigen::Index(i)]);
      field[4 * v + i] = float(bulge(mesh.vertices[v])[Eigen::Index(i)]);
    }
  const std::array<const float*, 3> vertices{position.data(), &position[n], &position[2 * n]};
  const detail::MidEdgeCorrection<1> bent(table, n);
  std::vector<float> corrected(field.size(), 0.f);

  bent.correct_vertices(vertices, field.data(), list(contact_at(V(1, 1, 1))), 0.06f, 1e3f, corrected.data());
  V sum = V::Zero(), linear_sum = V::Zero(), square = V::Zero(), linear_square = V::Zero();
  std::size_t checked = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& c = mesh.triangles[t];
    const std::array<V, 3> x{mesh.vertices[c[0]], mesh.vertices[c[1]], mesh.vertices[c[2]]};
    const auto inside = [](const V& p) {
      return p.y() > 0.1 - 1e-9 && std::min({p.x(), p.z(), 0.1 - p.x(), 0.1 - p.z()}) > 1e-6;
    };
    if (!std::all_of(x.begin(), x.end(), inside)) continue;
    ++checked;
    const double area = (x[1] - x[0]).cross(x[2] - x[0]).norm();
    for (const TrianglePoint& q : radon_rule()) {
      const auto error_of = [&](const std::vector<float>& at) -> V {
        V u = -bulge(q.weight[0] * x[0] + q.weight[1] * x[1] + q.weight[2] * x[2]);
        for (std::size_t k = 0; k < 3; ++k)
          for (std::size_t i = 0; i < 3; ++i)
            u[Eigen::Index(i)] += q.weight[Eigen::Index(k)] * double(at[4 * c[k] + i]);
        return u;
      };
      const V e = error_of(corrected), linear = error_of(field);
      sum += q.share * area * e, linear_sum += q.share * area * linear;
      square += q.share * area * e.cwiseAbs2(), linear_square += q.share * area * linear.cwiseAbs2();
    }
  }
  CHECK(checked > 20);
  for (int i = 0; i < 3; ++i) {
    CHECK(std::abs(sum[i]) < 0.1 * std::abs(linear_sum[i]));
    CHECK(std::sqrt(square[i] / linear_square[i]) < (i == 1 ? 0.3 : 0.45));  // equal triangles: 0.25, 0.41
  }
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    if (mesh.fixed_vertex[v]) CHECK(corrected[4 * v + 1] == field[4 * v + 1]);

  bent.correct_vertices(vertices, field.data(), list(contact_at(V(0.05, 0.1, 0.05))), 1.f, 1e3f,
                        corrected.data());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    for (std::size_t i = 0; i < 3; ++i) CHECK(corrected[4 * v + i] == field[4 * v + i]);

  // Never by more than half of what is allowed, and by nothing where nothing is.
  std::vector<float> wild(field.size());
  for (std::size_t i = 0; i < wild.size(); ++i) wild[i] = i % 7 == 0 ? 100.f : -100.f;
  for (const float most : {0.02f, 0.f}) {
    bent.correct_vertices(vertices, wild.data(), list(contact_at(V(1, 1, 1))), 0.06f, most, corrected.data());
    for (std::size_t i = 0; i < 4 * mesh.vertices.size(); ++i)
      CHECK(std::abs(corrected[i] - wild[i]) <= 0.5f * most + 1e-4f);  // rounding of 100 in float
  }
}

TEST_CASE("near fields are drawn by their values at the middles of edges, a contact's own and all of them") {
  const ElementMesh mesh = cube();
  const MidEdgeTable table(mesh, detail::MidEdgeFit(mesh));
  const std::size_t n = ResponseField::padded(mesh.vertices.size());
  std::array<detail::DrawnContact, 2> contact{contact_at(V(0.03, 0.1, 0.03)), contact_at(V(0.07, 0.1, 0.06))};
  contact[0].near.normal = 1, contact[1].near.normal = 0.5f;
  const auto near = [&contact](std::size_t c, const V& x) {
    const auto at = [&x](int axis) { return detail::Simd4(float(x[axis])); };
    const detail::SimdVec3<detail::Simd4> u =
        contact[c].near(detail::SimdVec3<detail::Simd4>{at(0), at(1), at(2)});
    return V(u.x[0], u.y[0], u.z[0]);
  };
  std::vector<float> total(3 * n, 0.f), own(2 * 3 * n, 0.f);  // nothing but near fields
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    for (std::size_t c = 0; c < 2; ++c)
      for (std::size_t i = 0; i < 3; ++i) {
        own[(3 * c + i) * n + v] = float(near(c, mesh.vertices[v])[Eigen::Index(i)]);
        total[i * n + v] += own[(3 * c + i) * n + v];
      }
  detail::MidEdgeCorrection<2> bent(table, n);
  bent.read(total.data(), own.data(), n, contact, 0.06f);
  std::size_t checked = 0;
  double linear_error = 0, bent_error = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& k = mesh.triangles[t];
    const V &p = mesh.vertices[k[0]], &q = mesh.vertices[k[1]], &r = mesh.vertices[k[2]];
    if (std::min({p.y(), q.y(), r.y()}) < 0.1 - 1e-9) continue;
    detail::MidEdgeCorrection<2>::OfTriangle all{}, part{};
    V apart = V::Zero();
    const detail::Simd4 third = detail::Simd4(1.f / 3), half = detail::Simd4(0.5f);
    const auto value = [](const detail::SimdVec3<detail::Simd4>& u) { return V(u.x[0], u.y[0], u.z[0]); };
    for (std::size_t c = 0; c < 2; ++c) {
      const V middle = (p + q + r) / 3;
      const double away = (middle - contact[c].near.x.cast<double>()).norm();
      if (!bent.find_near(c, t, part)) {
        CHECK(away > 0.045);
        continue;
      }
      apart += value(part(third, third));
      if (away < 0.02 || away > 0.045 - 0.01) continue;  // next to the patch nothing of second degree will do
      // At the middle of an edge it is the field itself, to ten roundings in float; one is met.
      CHECK((0.5 * (near(c, q) + near(c, r)) + value(part(half, half)) - near(c, 0.5 * (q + r))).norm() <
            1e-6 * near(c, q).norm());
      const V linear = (near(c, p) + near(c, q) + near(c, r)) / 3;
      linear_error += (linear - near(c, middle)).norm();
      bent_error += (linear + value(part(third, third)) - near(c, middle)).norm();
      ++checked;
    }
    // Nothing else bends. Fields of 50 in float, four times the sum of some 25 differences of theirs: 7e-6
    // met.
    if (bent.find(t, all)) CHECK((value(all(third, third)) - apart).norm() < 1e-4);
  }
  CHECK(checked > 40);
  CHECK(bent_error < 0.5 * linear_error);  // what is left is of third degree: less by length over distance

  // What has been drawn before does not count: the same bits.
  const auto drawn = [&bent, &mesh] {
    std::vector<float> out;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      detail::MidEdgeCorrection<2>::OfTriangle of_triangle{};
      if (bent.find(t, of_triangle))
        for (const detail::Simd4& edge : of_triangle.edge) out.insert(out.end(), {edge[0], edge[1], edge[2]});
    }
    return out;
  };
  const std::vector<float> first = drawn();
  for (double x = 0.01; x < 0.1; x += 0.007)
    bent.read(total.data(), own.data(), n, std::array{contact_at(V(x, 0.1, x)), contact_at(V(0.1, x, 0.05))},
              0.06f);
  CHECK(drawn() != first);
  bent.read(total.data(), own.data(), n, contact, 0.06f);
  CHECK(drawn() == first);
}
