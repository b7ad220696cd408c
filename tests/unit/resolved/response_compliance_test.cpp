// SPDX-License-Identifier: MIT
// Contact resolved at the tool's points on a body with a response field, against nonlinear finite elements.
#include <palpate/geometry/box.hpp>
#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/geometry/sphere.hpp>
#include <palpate/law/friction/coulomb.hpp>
#include <palpate/resolved/contact_samples.hpp>
#include <palpate/resolved/response_compliance.hpp>
#include <palpate/solver/contact_solver.hpp>

#include <doctest/doctest.h>

#include <support/check.hpp>
#include <support/no_heap.hpp>
#include <support/paths.hpp>
#include <support/response_fields.hpp>

#include <random>

using namespace palpate;
using namespace palpate::test;

namespace {

using V = Vec3<double>;
using Elastic = ElasticContact<double, ResponseCompliance>;
constexpr double R = 0.015;

const auto& field() {
  static const auto made = std::make_shared<const ResponseField>(ellipsoid_field(0.49, 400));
  return made;
}
template <FrictionLaw F = Frictionless<double>>
auto solver_of(double spacing, F friction = {}) {
  return ContactSolver<Ellipsoid<double>, Elastic, F, ContactPoints<256>>(
      {.object = Ellipsoid<double>({.axes = V(0.06, 0.04, 0.04)}),
       .tool = ToolPoints<double>(
           contact_samples(TriangleMesh<double>(Sphere<double>({.radius = R}).mesh(2000)), spacing),
           {.contact_area = 1e-4}),
       .force = Elastic({.compliance = ResponseCompliance(field())}),
       .friction = friction});
}
Pose<double> at(const V& x) {
  Pose<double> X;
  X.translation = x;
  return X;
}

}  // namespace

TEST_CASE(
    "a ball as a mesh on an ellipsoid: nonlinear finite elements' force within 2.5 %, 2 % rms, to 8 mm") {
  // Force [N] of a frictionless ball of 15 mm on rubber of 1.5 MPa, nu 0.49, computed with 10-node
  // tetrahedra; two meshes differ by 0.3 to 1 %. By depth [mm]. Measured: 0.4 to 1.5 %, of linear elasticity
  // 4 %.
  struct Row {
    double depth, force;
  };
  auto solver = solver_of(0.002);
  double sum = 0, d = 0;
  for (const Row& row : {Row{1, 8.313}, Row{2, 22.694}, Row{4, 61.142}, Row{8, 161.97}}) {
    TickResult<double> result{};
    while (d < row.depth - 1e-9) result = solver.tick(at(V(0, 0.04 + R - 1e-3 * (d += 0.05), 0)));
    const double error = result.wrench.force.y() / row.force - 1;
    CAPTURE(row.depth);
    CAPTURE(error);

    CHECK(std::abs(error) <= 0.025);
    sum += error * error;
  }
  CHECK(std::sqrt(sum / 4) <= 0.02);
}

TEST_CASE("without friction a closed path gives no energy: pressed, rolled over the body, lifted") {
  auto solver = solver_of(0.002);
  const HeapCount heap;
  double work = 0, spent = 0;
  V before = V::Zero(), x_before(0, 0.06, 0);
  constexpr int ticks = 2000;
  for (int i = 0; i <= ticks; ++i) {
    const double t = 2 * std::numbers::pi * i / ticks;
    // Down at one position, up at another, back through the air.
    const V x(0.012 * std::sin(t), 0.04 + R - 0.0015 + 0.003 * std::sin(t + 0.8) + 0.001,
              0.006 * std::cos(t));
    const auto result = solver.tick(at(x));
    CHECK(!has(result.status, Status::non_finite_result));
    const V force = result.wrench.force;
    if (i > 0) {
      const double w = 0.5 * (force + before).dot(x - x_before);
      work += w;
      spent += std::abs(w);
    }
    before = force;
    x_before = x;
  }
  const std::size_t allocations = heap.allocations();
  CHECK(allocations == 0);
  CHECK(spent > 1e-4);
  // Measured: 6.7e-4; 9.5e-4 were the gradient by the directions of pressing left out.
  CHECK(std::abs(work) <= 1e-3 * spent);
}

TEST_CASE("a frictionless ball feels no torque about its centre, wherever it presses") {
  // The arm, of the torque over the force. Measured: 0.045 mm, by the mesh's points; 0.054 mm were the
  // gradient by the directions of pressing left out.
  auto solver = solver_of(0.0012);
  const Ellipsoid<double> body({.axes = V(0.06, 0.04, 0.04)});
  double arm = 0;
  for (const double angle : {0.3, 0.6, 0.9, 1.1}) {
    const auto top = body.closest(V(0.06 * std::sin(angle), 0.04 * std::cos(angle), 0));
    solver.reset();
    for (double d = 5e-5; d <= 3e-3; d += 5e-5) {
      const auto felt = solver.tick(at(top.position + (R - d) * top.normal)).wrench;
      if (d > 1.5e-3) arm = (std::max)(arm, felt.torque.norm() / felt.force.norm());
    }
  }
  CHECK(arm <= 6e-5);
}

TEST_CASE("more points than the topology holds are said on a response field, too") {
  ContactSolver<Ellipsoid<double>, Elastic, Frictionless<double>, ContactPoints<8>> solver(
      {.object = Ellipsoid<double>({.axes = V(0.06, 0.04, 0.04)}),
       .tool = solver_of(0.002).tool(),
       .force = Elastic({.compliance = ResponseCompliance(field())})});
  CHECK_FALSE(has(solver.tick(at(V(0, 0.04 + R - 1e-4, 0))).status, Status::point_overflow));
  const auto result = solver.tick(at(V(0, 0.04 + R - 2e-3, 0)));
  CHECK(has(result.status, Status::point_overflow));
  CHECK(has(result.status, Status::contact));
}

TEST_CASE("a plate over most of a block's face has a regular part everywhere, of more nodes than 128") {
  const auto block = std::make_shared<const ResponseField>(block_field(V(0.06, 0.016, 0.06), 1e6, 0.45, 300));
  const ToolPoints<double> plate(
      contact_samples(TriangleMesh<double>(Box<double>({.half = V(0.026, 0.004, 0.026)}).mesh(2000)), 0.0052),
      {.contact_area = 1e-4});
  const auto press = [&]<std::size_t N>(std::integral_constant<std::size_t, N>) {
    ContactSolver<Box<double>, Elastic, Frictionless<double>, ContactPoints<N>> solver(
        {.object = Box<double>({.half = V(0.03, 0.008, 0.03), .centre = V(0, 0.008, 0)}),
         .tool = plate,
         .force = Elastic({.compliance = ResponseCompliance(block)})});
    for (double d = 2e-5; d < 5e-4; d += 2e-5) (void)solver.tick(at(V(0, 0.02 - d, 0)));
    return solver.tick(at(V(0, 0.02 - 5e-4, 0)));
  };
  const auto whole = press(std::integral_constant<std::size_t, 256>());
  CHECK_FALSE(has(whole.status, Status::point_overflow));
  const double force = whole.wrench.force.norm();
  CHECK(whole.wrench.torque.norm() <= 2e-3 * force * 0.026);  // measured: 1.2e-3, by the field's mesh
  const auto more_room = press(std::integral_constant<std::size_t, 512>());
  CHECK((more_room.wrench.force - whole.wrench.force).norm() <= 1e-5 * force);  // rounding of float
  // What has no room is said: the same points, all of them in both, have 30 % less force on 128 nodes.
  const auto cut = press(std::integral_constant<std::size_t, 128>());
  CHECK(has(cut.status, Status::point_overflow));
}

TEST_CASE("a field that is missing is refused") { CHECK_THROWS_AS(ResponseCompliance(nullptr), SetupError); }

TEST_CASE("points in the prisms over a load mesh are where LoadMesh::locate() has them") {
  const LoadMesh& mesh = field()->load_mesh();
  const detail::LoadPrisms prisms(mesh);
  using W = detail::LoadPrisms::V;
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  int elsewhere = 0;
  for (int k = 0; k < 500; ++k) {
    // One by one, for the same points with any compiler: for 2 of 500 others two steps of Newton's method do
    // not do, and locate() is asked.
    const double dz = uniform(random), dy = uniform(random), dx = uniform(random);
    const V direction = V(dx, dy, dz).normalized(),
            x = (1 + 0.1 * uniform(random)) * direction.cwiseProduct(V(0.06, 0.04, 0.04));
    const LoadPosition exact = mesh.locate(x, mesh.locate(x).triangle);
    std::array<std::uint32_t, W::size()> triangle{};  // the first one may, by chance, be the right one
    triangle[0] = exact.triangle;
    const auto at = prisms.locate(detail::each((x - prisms.centre()).cast<float>()), triangle);
    REQUIRE(at.found[0] > 0);
    CHECK_ABSOLUTE(at.q[0], exact.weight.y(), 1e-5);  // the least weight that counts as inside
    CHECK_ABSOLUTE(at.r[0], exact.weight.z(), 1e-5);
    double size = 0;
    for (std::size_t c = 0; c < 3; ++c)
      size += exact.weight[Eigen::Index(c)] * mesh.nodes()[exact.node[c]].size;
    const double far2 = exact.distance2 / (size * size);
    // Positions in float are rounded by 1e-6 of an edge, so far2 by 2e-6 of its root: a third of this.
    CHECK_ABSOLUTE(at.far2[0], far2, 1e-4 * (far2 + 1e-3));
    if (exact.triangle != 0) elsewhere += at.found[1] == 0;
  }
  CHECK(elsewhere > 480);  // all but those beside the first triangle
}
