// SPDX-License-Identifier: MIT
#include "support/check.hpp"
#include "support/no_heap.hpp"
#include "support/response_meshes.hpp"

#include <palpate/elasticity/half_space.hpp>

#include "reference/response_truth.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>

#include <random>
#include <string>

using namespace palpate;
using V = Vec3<double>;

namespace {

const V axes(0.06, 0.04, 0.04);
constexpr auto cap = [](const auto& p) { return p.y() <= -0.036; };

template <class S>
ContactState<S> pressed(const Vec3<S>& position, const Vec3<S>& normal, const Vec3<S>& displacement,
                        S radius) {
  ContactState<S> c{};
  c.points = 1;
  c.normal = normal;
  c.displacement = displacement;
  c.centre = position + displacement;
  c.force = c.friction = Vec3<S>::Zero();
  c.area = S(3.14159265358979L) * radius * radius;
  return c;
}

struct Drawn {
  MeshData<double> mesh;
  HalfSpaceDeformation<double> model;
  std::vector<V> position, normal;

  template <class Fixed>
  Drawn(const MeshData<double>& m, const Fixed& fixed, double nu = 0.49)
      : mesh(m),
        model(mesh, fixed, {.nu = nu}),
        position(mesh.vertices.size()),
        normal(mesh.vertices.size()) {
    model.write_rest(buffer());
  }
  VertexBuffer<double> buffer() {
    return {.positions = position[0].data(),
            .position_stride = sizeof(V),
            .normals = normal[0].data(),
            .normal_stride = sizeof(V)};
  }
  Moved<double> write(const std::vector<ContactState<double>>& contacts) {
    return model.write(std::span(contacts), buffer());
  }
  V u(std::size_t v) const { return position[v] - mesh.vertices[v]; }
  double most() const {
    double most = 0;
    for (std::size_t v = 0; v < position.size(); ++v) most = (std::max)(most, u(v).norm());
    return most;
  }
};

Drawn egg() { return Drawn(test::ellipsoid_mesh(axes, 14), cap); }
const ContactState<double> top = pressed<double>(V(0, 0.04, 0), V::UnitY(), V(0, -0.002, 0), 0.005);

}  // namespace

TEST_CASE_TEMPLATE(
    "half-spaces: the fixed region stays, the contact moves by D, the same contacts move nothing", S, float,
    double) {
  const MeshData<double> wide = test::ellipsoid_mesh(axes, 14);
  MeshData<S> mesh;
  for (const V& v : wide.vertices) mesh.vertices.push_back(v.cast<S>());
  mesh.triangles = wide.triangles;
  HalfSpaceDeformation<S> model(mesh, cap, {.nu = S(0.49)});
  std::vector<float> out(6 * mesh.vertices.size());  // interleaved
  const VertexBuffer<float> buffer{
      .positions = out.data(), .position_stride = 24, .normals = out.data() + 3, .normal_stride = 24};
  model.write_rest(buffer);
  const std::vector<ContactState<S>> contacts{
      pressed<S>(Vec3<S>(0, S(0.04), 0), Vec3<S>::UnitY(), Vec3<S>(0, S(-0.002), 0), S(0.005))};
  const test::HeapCount heap;
  const Moved<S> moved = model.write(std::span(contacts), buffer);
  CHECK(heap.allocations() == 0);
  CHECK(moved.vertices == mesh.vertices.size());
  Vec3<float> lower = Vec3<float>::Constant(1), upper = -lower;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vec3<float> now(out[6 * v], out[6 * v + 1], out[6 * v + 2]);
    lower = lower.cwiseMin(now), upper = upper.cwiseMax(now);
  }
  CHECK(moved.lower == lower.cast<S>());
  CHECK(moved.upper == upper.cast<S>());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vec3<float> now(out[6 * v], out[6 * v + 1], out[6 * v + 2]),
        rest = mesh.vertices[v].template cast<float>();
    const Vec3<S> u = (now - rest).template cast<S>();
    if (cap(mesh.vertices[v])) CHECK(now == rest);
    const Vec3<float> n(out[6 * v + 3], out[6 * v + 4], out[6 * v + 5]);
    CHECK(std::abs(n.norm() - 1) < 1e-5f);
    // The vertex at the top: the flat punch's own field, on a curved surface, within a twentieth.
    if (mesh.vertices[v].y() > S(0.03999)) CHECK((u - contacts[0].displacement).norm() < S(1e-4));
  }
  CHECK(model.write(std::span(contacts), buffer).vertices == 0);
  const std::vector<float> drawn = out;
  model.write_rest(buffer);
  CHECK(model.write(std::span(contacts), buffer).vertices == mesh.vertices.size());
  CHECK(out == drawn);
  const std::vector<ContactState<S>> none;
  CHECK(model.write(std::span(none), buffer).vertices == mesh.vertices.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    CHECK(Vec3<float>(out[6 * v], out[6 * v + 1], out[6 * v + 2]) == mesh.vertices[v].template cast<float>());
  CHECK(model.write(std::span(none), buffer).vertices == 0);
}

// The force is solved for with fields in double, vertices are moved by profiles in float.
TEST_CASE("half-spaces: what is drawn is contact, base and rigid motion of the force that was solved for") {
  for (const double nu : {0.0, 0.3, 0.49}) {
    Drawn body(test::ellipsoid_mesh(axes, 14), cap, nu);
    const V out = V(1, 0.3, 0.2).normalized(), x = out.cwiseProduct(axes);  // a push from the side
    const V m = -V(out.cwiseQuotient(axes)).normalized();
    constexpr double a = 0.005, scale = 1 / (4 * 3.14159265358979323846);
    body.write({pressed<double>(x, V(-m), V(0.002 * m + V(0, 0, 0.001)), a)});
    const V f = body.model.forces()[0];
    const auto contact = [&](const V& p) {
      const V r = p - x;
      return V(scale * flat_punch_load(r, m, edge_depth(r, m, a), a, f, nu));
    };
    const detail::FixedBase base(body.mesh, cap, nu, "");
    const detail::Screw load = base.reaction(x, f);
    const detail::Screw motion =
        -(base.fit([&](const V& y) { return contact(V(base.middle() + y)); }) + base.fit(load));
    double worst = 0;
    for (std::size_t v = 0; v < body.mesh.vertices.size(); ++v) {
      if (cap(body.mesh.vertices[v])) continue;
      const V y = body.mesh.vertices[v] - base.middle();
      const V u = contact(body.mesh.vertices[v]) + base.field(y, load) + detail::rigid_motion(motion, y);
      worst = (std::max)(worst, (body.u(v) - u).norm());
    }
    CHECK(worst < 2e-8);  // positions are kept in float: 4e-9 m at 0.06 m, and a sum of three
    CHECK(body.most() > 1e-3);
  }
}

TEST_CASE("half-spaces: linear in D, and lengths scale") {
  Drawn one = egg(), two = egg();
  MeshData<double> large = one.mesh;
  for (V& v : large.vertices) v *= 10;
  Drawn ten(large, [](const V& p) { return p.y() <= -0.36; });
  one.write({top});
  ContactState<double> deeper = pressed<double>(V(0, 0.04, 0), V::UnitY(), V(0, -0.004, 0), 0.005);
  two.write({deeper});
  ten.write({pressed<double>(V(0, 0.4, 0), V::UnitY(), V(0, -0.02, 0), 0.05)});
  CHECK_RELATIVE(two.model.forces()[0].norm(), 2 * one.model.forces()[0].norm(), 1e-12L);
  CHECK_RELATIVE(ten.model.forces()[0].norm(), 100 * one.model.forces()[0].norm(),
                 1e-9L);  // mesh positions in float
  for (std::size_t v = 0; v < one.position.size(); ++v) {
    // Places are kept in float: 4e-9 m at 0.06 m, and ten times that.
    CHECK((two.u(v) - 2 * one.u(v)).norm() < 4e-8);
    CHECK((ten.u(v) - 10 * one.u(v)).norm() < 4e-7);
  }
}

TEST_CASE("half-spaces: turned body and contact, turned field") {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, V(1, 2, -1).normalized()).toRotationMatrix();
  Drawn one = egg();
  MeshData<double> turned = one.mesh;
  for (V& v : turned.vertices) v = turn * v;
  Drawn other(turned, [&](const V& p) { return (turn.transpose() * p).y() <= -0.036 + 1e-12; });
  const V position(0.03, 0.04 * std::sqrt(0.75), 0),
      n = V(position.x() / 0.0036, position.y() / 0.0016, 0).normalized(), D = -0.002 * n + V(0, 0, 0.001);
  one.write({pressed<double>(position, n, D, 0.004)});
  other.write({pressed<double>(turn * position, turn * n, turn * D, 0.004)});
  CHECK((other.model.forces()[0] - turn * one.model.forces()[0]).norm() <
        1e-6 * one.model.forces()[0].norm());
  for (std::size_t v = 0; v < one.position.size(); ++v)
    CHECK((other.u(v) - turn * one.u(v)).norm() < 4e-8);  // floats
}

TEST_CASE("half-spaces: a contact that appears without force changes nothing, and none pulls") {
  Drawn alone = egg(), both = egg();
  const V position(0.03, 0.04 * std::sqrt(0.75), 0),
      n = V(position.x() / 0.0036, position.y() / 0.0016, 0).normalized();
  alone.write({top});
  both.write({top, pressed<double>(position, n, V::Zero(), 0.002)});
  CHECK(both.model.forces()[1].norm() == 0);
  for (std::size_t v = 0; v < alone.position.size(); ++v) CHECK(both.position[v] == alone.position[v]);
  // Two that press: each gets its D, so each takes some of the other's work.
  both.write({top, pressed<double>(position, n, V(-0.002 * n), 0.005)});
  CHECK(both.model.forces()[0].dot(V(0, -1, 0)) > 0);
  CHECK(both.model.forces()[1].dot(-n) > 0);
  CHECK(both.model.forces()[0].norm() < alone.model.forces()[0].norm());
}

TEST_CASE(
    "half-spaces against nonlinear finite elements: within 20 % of the displacement, without any set-up "
    "solve") {
  // Model error, not code error: what this rung is good for. The skeleton's is above 100 % here.
  Drawn drawn(test::ellipsoid_mesh(axes, 40), cap);
  drawn.write({pressed<double>(V(0, 0.04, 0), V::UnitY(), V(0, -0.004, 0), 0.005)});
  double error = 0, norm = 0;
  for (const test::TruthVertex& t : test::truth_ellipsoid) {
    const V x(t.x[0], t.x[1], t.x[2]), exact(t.u[0], t.u[1], t.u[2]);
    if ((x - V(0, 0.04, 0)).norm() < 0.006) continue;  // too steep there to ask the nearest vertex
    std::size_t nearest = 0;
    for (std::size_t v = 1; v < drawn.mesh.vertices.size(); ++v)
      if ((drawn.mesh.vertices[v] - x).norm() < (drawn.mesh.vertices[nearest] - x).norm()) nearest = v;
    error += t.area * (drawn.u(nearest) - exact).squaredNorm();
    norm += t.area * exact.squaredNorm();
  }
  CHECK(std::sqrt(error / norm) < 0.2);
  const double mu = 1.5e6 / 2 / 1.49;
  CHECK_RELATIVE(mu * drawn.model.forces()[0].norm(), test::truth_ellipsoid_force, 0.1);
}

TEST_CASE("half-spaces: the field is continuous while a contact wanders") {
  constexpr std::uint64_t seed = 20261121;
  MESSAGE("seed ", seed);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Drawn drawn = egg();
  std::vector<V> before = drawn.position;
  V direction = V::UnitY(), speed = V(normal(random), normal(random), normal(random));
  double largest = 0;
  for (int i = 0; i < 400; ++i) {
    speed = 0.95 * speed + 0.3 * V(normal(random), normal(random), normal(random));
    direction = (direction + 2e-3 * speed).normalized();
    if (direction.y() < -0.5)
      direction.y() = -direction.y(), direction.normalize(), speed.y() = std::abs(speed.y());
    const V position = direction / direction.cwiseQuotient(axes).norm(),
            n = position.cwiseQuotient(axes.cwiseAbs2()).normalized();
    drawn.write({pressed<double>(position, n, V(-0.002 * n), 0.004 + 0.001 * std::sin(0.05 * i))});
    double change = 0;
    for (std::size_t v = 0; v < before.size(); ++v)
      change = (std::max)(change, (drawn.position[v] - before[v]).norm());
    if (i > 0 && direction.y() > -0.45) largest = (std::max)(largest, change / 0.002);
    before = drawn.position;
  }
  // A step is at most about 0.3 mm, a tenth of the radius; the field of a disc changes by D over a radius,
  // most at its rim.
  CHECK(largest < 0.35);
  CHECK(largest > 0.001);
}

TEST_CASE("half-spaces: bad input") {
  const MeshData<double> mesh = test::ellipsoid_mesh(axes, 6);
  const auto refusal = [&](auto&& make) -> std::string {
    try {
      make();
    } catch (const SetupError& error) {
      return error.what();
    }
    return "accepted";
  };
  CHECK(refusal([&] { HalfSpaceDeformation<double>(mesh, cap, {.nu = 0.6}); }) ==
        "HalfSpaceDeformation: nu must be in [0, 1/2], got 0.6");
  CHECK(refusal([&] { HalfSpaceDeformation<double>(mesh, cap, {.smallest_radius = 0}); }) ==
        "HalfSpaceDeformation: smallest_radius [m] must be > 0, got 0");
  CHECK(refusal([&] { HalfSpaceDeformation<double>(mesh, [](const V&) { return false; }); }) ==
        "HalfSpaceDeformation: the fixed region must hold at least one triangle");
  CHECK(refusal([&] { HalfSpaceDeformation<double>(MeshData<double>{}, cap); }) ==
        "HalfSpaceDeformation: needs a mesh with triangles");
  CHECK(refusal([&] {
          HalfSpaceDeformation<double>(MeshData<double>{.vertices = mesh.vertices, .triangles = {}}, cap);
        }) == "HalfSpaceDeformation: needs a mesh with triangles");
  MeshData<double> broken = mesh;
  broken.vertices[3].x() = std::numeric_limits<double>::quiet_NaN();
  CHECK(refusal([&] { HalfSpaceDeformation<double>(broken, cap); }) ==
        "HalfSpaceDeformation: position must be finite, at mesh vertex 3");

  Drawn drawn = egg();
  ContactState<double> bad = top;
  bad.displacement.x() = std::numeric_limits<double>::quiet_NaN();
  CHECK(drawn.write({bad}).vertices == 0);
  CHECK(has(drawn.write({top, top, top, top, top}).status, Status::region_overflow));
  CHECK(std::isfinite(drawn.most()));
}
