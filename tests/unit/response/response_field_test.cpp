// SPDX-License-Identifier: MIT
#include <palpate/response/response_contact.hpp>
#include <palpate/response/save.hpp>
#include <palpate/response/setup/load_positions.hpp>

#include "support/check.hpp"
#include "support/joined.hpp"
#include "support/no_heap.hpp"
#include "support/response_bodies.hpp"
#include "support/response_fields.hpp"
#include "support/response_meshes.hpp"

#include <algorithm>

namespace {
using namespace palpate;
using V = Vec3<double>;

const V cube(0.1, 0.1, 0.1);
}  // namespace

TEST_CASE("large block: flat punch and Hertz tend to the half-space, nu = 0, 0.3, 1/2") {
  for (double nu : {0.0, 0.3, 0.5}) {
    const ResponseField field = test::block_field(cube, 1e6, nu, 120);
    ResponseTick<1> tick(field, {.second_order = false});
    const double a = 1e-3, mu = 1e6 / (2 * (1 + nu)), d = 1e-5;
    const ResponseContact<double> punch{
        .position = V(0.004, 0.1, 0.003), .normal = V::UnitY(), .radius = a, .displacement = V(0, -d, 0)};
    V F;
    tick.solve(&punch, 1, &F);
    const double half_space =
        nu < 0.5 ? 4 * mu * a * std::log(3 - 4 * nu) / (1 - 2 * nu) * d : 8 * mu * a * d;
    CHECK_RELATIVE(-F.y(), half_space, 0.05);  // the finite block: about a / size, 1-3 %
    CHECK(std::abs(F.x()) < 0.03 * std::abs(F.y()));
    const auto ball = tick.solve(SphereContact<double>{
        .position = punch.position, .normal = V::UnitY(), .radius = 0.005, .depth = 1e-5});
    CHECK_RELATIVE(ball.force, 4.0 / 3 * 1e6 / (1 - nu * nu) * std::sqrt(0.005) * std::pow(1e-5, 1.5),
                   0.03);  // ditto, a = 0.2 mm
  }
}

TEST_CASE("field: patch moves by d, fixed vertices rest, reciprocity, forces of two contacts, refinement") {
  const ResponseField field = test::ellipsoid_field(0.5, 140);
  ResponseTick<2> tick(field);
  const V n2 = V(0.03 / 0.0036, 0.034641016151377546 / 0.0016, 0).normalized();
  const ResponseContact<double> two[2] = {
      {.position = V(-0.02, 0.037712361663282534, 0),
       .normal = V(-0.02 / 0.0036, 0.037712361663282534 / 0.0016, 0).normalized(),
       .radius = 0.005,
       .displacement = V(0, -0.001, 0)},
      {.position = V(0.03, 0.034641016151377546, 0),
       .normal = n2,
       .radius = 0.005,
       .displacement = -0.002 * n2}};
  const std::vector<V> points = {two[0].position, two[1].position, V(0, -0.04, 0), V(0.06, 0, 0)};
  const ResponseDisplay display = ResponseDisplay(field, points);
  V F[2], again[2];
  std::vector<float> u(4 * points.size(), 7.f), v(4 * points.size());
  tick.solve(two, 2, F);
  tick.displace(display, u.data(), 4);
  tick.solve(two, 2, again);
  tick.displace(display, v.data(), 4);
  CHECK((F[0] == again[0] && F[1] == again[1]));  // same bits
  CHECK(u[0] == v[0]);
  CHECK(u[3] == 7.f);  // the stride's gap is the caller's
  CHECK_ABSOLUTE(u[1], -0.001, 1e-9);
  CHECK_ABSOLUTE(u[4], -0.002 * n2.x(), 1e-9);
  CHECK((u[8] == 0.f && u[9] == 0.f && u[10] == 0.f));
  // Reciprocity of the influence functions, before the system is made symmetric: discretisation error of 140
  // vertices, 6 %.
  const auto block = [&](std::size_t i, std::size_t j) {
    Mat3<double> w;
    for (std::size_t l = 0; l < 3; ++l) w.col(Eigen::Index(l)) = field.at(i, j, l);
    return w;
  };
  const auto rests = [&](std::size_t k) {
    const LoadNode& node = field.load_mesh().nodes().at(k);
    bool any = false;
    for (std::size_t c = 0; c < 3; ++c)
      any = any || (node.part[Eigen::Index(c)] > 0 &&
                    field.mesh().fixed_vertex[field.mesh().triangles[node.triangle][c]]);
    return any;
  };
  double difference = 0, norm = 0;
  for (std::size_t i = 0; i < field.load_mesh().nodes().size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      if (rests(i) || rests(j)) continue;
      difference += (block(i, j) - block(j, i).transpose()).squaredNorm();
      norm += block(i, j).squaredNorm();
    }
  MESSAGE("reciprocity of w: ", std::sqrt(difference / norm));
  CHECK(std::sqrt(difference / norm) < 0.08);
  // Refinement: 140 and 200 vertices differ by little.
  const ResponseField fine = test::ellipsoid_field(0.5, 200);
  ResponseTick<2> finer(fine);
  finer.solve(two, 2, again);
  CHECK_RELATIVE(F[0].norm(), again[0].norm(), 0.02);
  CHECK_RELATIVE(F[1].norm(), again[1].norm(), 0.02);
}

TEST_CASE("near field of second order: the patch moves as one, no jump at its edge or below its axis") {
  const ResponseField field =
      test::ellipsoid_field(0.5, 60);  // nu = 1/2: the disc's own field is uniform within
  detail::ContactSystem<1> contacts[2] = {{field, {}}, {field, {.second_order = false}}};
  const double a = 0.005;
  for (auto& system : contacts) {
    system.place(0, {.x = V(0.004, 0.0399, 0),
                     .m = -V::UnitY(),
                     .d = V(0.0015, -0.004, 0),
                     .rotation = V::Zero(),
                     .a = a});
    system.solve(1);
  }
  const detail::Indenter& c = contacts[0].placed(0).tool;
  const detail::NearField both[2] = {contacts[0].drawn(0).near, contacts[1].drawn(0).near};
  // What second order adds: to first order the near field undoes the slopes of w.
  const auto at = [&](double along, double down) {
    const V x = c.x + a * along * V(0.8, 0, 0.6) + a * down * c.m;
    const auto all_four = [](double value) { return detail::Simd4(static_cast<float>(value)); };
    V u = V::Zero();
    for (int order = 0; order < 2; ++order) {
      const detail::SimdVec3<detail::Simd4> part =
          both[order](detail::SimdVec3<detail::Simd4>{all_four(x.x()), all_four(x.y()), all_four(x.z())});
      u += (order == 0 ? 1 : -1) * V(double(part.x[0]), double(part.y[0]), double(part.z[0]));
    }
    return u;
  };
  for (double s : {0.3, 0.7, 0.999})
    CHECK((at(s, 0) - at(0, 0)).norm() < 1e-4 * c.d.norm());  // float, the disc's arctangent: 1e-5
  // Beyond the edge as sqrt(s - 1): 2e-3 of d. When the terms of second order began there: half of d.
  for (double down : {0.0, 0.3, -0.3}) {
    const double rim = std::sqrt(1 - down * down);
    CHECK((at(rim * (1 + 1e-5), down) - at(rim * (1 - 1e-5), down)).norm() < 0.01 * c.d.norm());
  }
  CHECK((at(1e-4, 1.5) - at(-1e-4, 1.5)).norm() < 1e-3 * c.d.norm());
}

TEST_CASE(
    "positions of loads: on the body, and no triangle between them folds over, where parts of the surface "
    "have "
    "reflex corners") {
  const test::ResponseBody bowl = test::response_bodies()[6];
  std::vector<std::uint8_t> fixed;
  const auto& v = bowl.mesh.vertices;
  for (const auto& t : bowl.mesh.triangles)
    fixed.push_back((v[t[0]].y() + v[t[1]].y() + v[t[2]].y()) / 3 < bowl.fixed_below);
  const ElementMesh solve = make_element_mesh(SmoothSurface(bowl.mesh), fixed, {.vertices = 200});
  const TriangleBvh<double> body(bowl.mesh);
  const LoadMesh touch = detail::LoadPositions(solve).load_mesh();
  for (const auto& node : touch.nodes()) CHECK(std::sqrt(body.closest(node.source).distance2) < 1e-9);
  for (const auto& t : touch.triangles()) {
    const auto &p = touch.nodes()[t[0]], &q = touch.nodes()[t[1]], &r = touch.nodes()[t[2]];
    CHECK((q.source - p.source).cross(r.source - p.source).dot(p.normal + q.normal + r.normal) > 0);
  }
}

TEST_CASE("reciprocity of unit forces on a body with a thin, curved rim, held at one side") {
  const ResponseField field(test::ellipsoid_mesh(V(0.04, 0.008, 0.03), 16),
                            [](const V& x) { return x.x() < -0.02; },
                            {.E = 1e5, .nu = 0.49, .mesh = {.vertices = 300}});
  const LoadMesh& mesh = field.load_mesh();
  std::vector<double> missed;
  for (std::size_t k = 0; k < mesh.solved(); ++k)
    for (std::size_t l = 0; l < k; ++l) {
      if ((mesh.nodes()[k].source - mesh.nodes()[l].source).norm() > 3 * mesh.nodes()[k].size) continue;
      Mat3<double> kl, lk;
      for (std::size_t c = 0; c < 3; ++c) {
        kl.col(Eigen::Index(c)) = field.at(k, l, c);
        lk.col(Eigen::Index(c)) = field.at(l, k, c);
      }
      missed.push_back((kl - lk.transpose()).norm() / (kl.norm() + lk.norm()));
    }
  std::sort(missed.begin(), missed.end());
  const double half = missed[missed.size() / 2], most = missed[missed.size() * 3 / 4];
  MESSAGE("off by ", half, " in half of the pairs, by ", most, " in three quarters");
  // 0.013 and 0.032; 0.12 and 0.27 where loads of the vertices have not the strength that the body feels.
  CHECK(half < 0.03);
  CHECK(most < 0.06);
}

TEST_CASE("bad input: reported at set-up, zero in a tick") {
  const MeshData<double> mesh = test::box_mesh(V(1, 1, 1), 3);
  const auto base = [](const V& p) { return p.y() <= 1e-6; };
  CHECK_THROWS_AS(ResponseField(mesh, base, {.E = -1}), SetupError);
  CHECK_THROWS_AS(ResponseField(mesh, base, {.E = 1, .nu = 0.6}), SetupError);
  CHECK_THROWS_AS(ResponseField(mesh, [](const V&) { return false; }, {.E = 1}), SetupError);
  CHECK_THROWS_AS(ResponseField(mesh, [](const V&) { return true; }, {.E = 1}), SetupError);
  MeshData<double> two = mesh;  // a second box, fixed nowhere
  test::append<double>(two, mesh, V(0, 3, 0));
  CHECK_THROWS_AS(ResponseField(two, base, {.E = 1}), SetupError);
  CHECK_THROWS_AS(ResponseField(mesh, std::vector<std::uint32_t>{999}, {.E = 1}), SetupError);
  const ResponseField field(mesh, base, {.E = 1, .mesh = {.vertices = 40}, .threads = 1});
  ResponseTick<1> tick(field);
  const double bad = std::numeric_limits<double>::quiet_NaN();
  for (const auto& contact : {ResponseContact<double>{.position = V(bad, 0, 0), .radius = 0.1},
                              ResponseContact<double>{.radius = -1},
                              ResponseContact<double>{.normal = V(0, 0, 9), .radius = 0.1}}) {
    V F(1, 1, 1);
    tick.solve(&contact, 1, &F);
    CHECK(F == V::Zero());
    float u[3] = {1, 1, 1};
    tick.displace(ResponseDisplay(field, std::vector<V>{V(0.5, 1, 0.5)}), u, 3);
    CHECK((u[0] == 0.f && u[1] == 0.f && u[2] == 0.f));
  }
}

TEST_CASE("tick: no heap, no memory of what was before, coinciding contacts, surplus") {
  const ResponseField field = test::ellipsoid_field(0.3, 60);
  const V n = V::UnitY();
  const ResponseContact<double> one{
      .position = V(0, 0.04, 0), .normal = n, .radius = 0.004, .displacement = V(0.0005, -0.002, 0)};
  const ResponseContact<double> far{
      .position = V(0.06, 0, 0), .normal = V::UnitX(), .radius = 0.02, .displacement = V(-0.002, 0, 0)};
  const std::vector<V> points = {V(0.01, 0.039, 0.001), V(-0.05, 0.01, 0.01)};
  const ResponseDisplay display(field, points);
  ResponseTick<3> tick(field), fresh(field);
  V F[4], again[3];
  double u[6], v[6];
  fresh.solve(&one, 1, F);
  fresh.displace(display, u, 3);
  const test::HeapCount heap;
  const ResponseContact<double> both[2] = {far, one};
  tick.solve(both, 2, again);
  tick.displace(display, v, 3);
  tick.solve(&one, 1, again);
  tick.displace(display, v, 3);
  CHECK(heap.allocations() == 0);
  CHECK(again[0] == F[0]);
  for (int i = 0; i < 6; ++i) CHECK(v[i] == u[i]);
  // The same patch two and three times: the system stays definite, and together they push about as hard as
  // one.
  const ResponseContact<double> same[4] = {one, one, one, one};
  for (const std::size_t count : {2u, 3u}) {
    CHECK(fresh.solve(same, count, again) == Status::contact);
    V sum = V::Zero();
    for (std::size_t c = 0; c < count; ++c) sum += again[c];
    CHECK(is_finite(sum));
    // Discs that know of each other by second moments only: 2 / (1 + 0.71), 3 / (1 + 2 * 0.71) of one; second
    // order counts for each of them.
    CHECK(sum.norm() > 0.8 * F[0].norm());
    CHECK(sum.norm() < 1.5 * F[0].norm());
  }
  CHECK(has(fresh.solve(same, 4, F), Status::region_overflow));
  CHECK(F[3] == V::Zero());
}

TEST_CASE("saved and loaded: the same bits; bytes that are not a saved field are refused by name") {
  const ResponseField field = test::block_field(cube, 1e6, 0.4, 40);
  const std::vector<std::byte> bytes = save_response_field(field);
  const ResponseField loaded = load_response_field(bytes);
  CHECK(save_response_field(loaded) == bytes);
  const ResponseContact<double> one{.position = V(0.01, 0.1, 0.02),
                                    .normal = V::UnitY(),
                                    .radius = 0.01,
                                    .displacement = V(0.0005, -0.002, 0)};
  V F, again;
  ResponseTick<1>(field).solve(&one, 1, &F);
  ResponseTick<1>(loaded).solve(&one, 1, &again);
  CHECK(F == again);
  const auto refused = [](std::vector<std::byte> changed, const char* why) {
    try {
      (void)load_response_field(changed);
    } catch (const SetupError& e) {
      return std::string_view(e.what()).find(why) != std::string_view::npos;
    }
    return false;
  };
  CHECK(refused({}, "at least 32"));
  CHECK(refused(std::vector<std::byte>(100), "not a saved response field"));
  CHECK(refused({bytes.begin(), bytes.end() - 1}, "cut short"));
  auto changed = bytes;
  changed.push_back(std::byte{0});
  CHECK(refused(changed, "too long"));
  changed = bytes;
  changed[8] = std::byte{99};
  CHECK(refused(changed, "version"));
  for (std::size_t at : {std::size_t{40}, bytes.size() / 2, bytes.size() - 1}) {  // one bit anywhere
    changed = bytes;
    changed[at] ^= std::byte{4};
    CHECK(refused(changed, "checksum"));
  }
  // A list's length changed with the checksum made right: still refused, nothing is read past the end.
  const auto sign = [&] {
    const std::uint64_t sum = detail::checksum(std::span<const std::byte>(changed).subspan(32));
    std::memcpy(changed.data() + 24, &sum, 8);
  };
  changed = bytes;
  changed[32 + 24 + 6] = std::byte{1};
  sign();
  CHECK(refused(changed, "lengths"));
  for (const double length : {0.0, -1.0, 1e-300, 1e6, 1e300, HUGE_VAL, std::nan("")}) {  // after E and nu
    changed = bytes;
    std::memcpy(changed.data() + 32 + 16, &length, 8);
    sign();
    CHECK(refused(changed, "length is out of range"));
  }
  // Numbers of nodes and tables, likewise: the lists are as long as they say, one after the other.
  constexpr std::size_t node = 8 * sizeof(double) + 6 * 4;
  const std::size_t item[] = {8,
                              12,
                              1,
                              1,
                              node,
                              12,
                              4,
                              sizeof(LoadMesh::Share),
                              sizeof(PatchTable::Own),
                              sizeof(PatchTable::Second),
                              sizeof(PatchTable::Moments)};
  std::size_t at = 32 + 24;
  for (const std::size_t size : item) {
    std::uint64_t count = 0;
    std::memcpy(&count, bytes.data() + at, 8);
    REQUIRE(count > 0);
    if (size == node) {
      for (const double x : {1e20, HUGE_VAL}) {
        changed = bytes;
        std::memcpy(changed.data() + at + 8, &x, 8);  // a normal
        sign();
        CHECK(refused(changed, "not a triangle's"));
      }
      for (const int length : {48, 56})  // size and spacing: squares of them are divided by
        for (const double x : {0.0, 5e-324, 1e-20, 1e20, HUGE_VAL}) {
          changed = bytes;
          std::memcpy(changed.data() + at + 8 + length, &x, 8);
          sign();
          CHECK(refused(changed, "not a triangle's"));
        }
    } else if (size == sizeof(PatchTable::Own) || size == sizeof(PatchTable::Second) ||
               size == sizeof(PatchTable::Moments)) {
      for (const float x : {1e38f, HUGE_VALF, std::nanf("")}) {
        for (const std::size_t within : {std::size_t{0}, size - 4}) {  // of moments the first and sagittas
          changed = bytes;
          std::memcpy(changed.data() + at + 8 + within, &x, 4);
          sign();
          CHECK(refused(changed, "a table is not finite"));
        }
      }
    }
    at += 8 + static_cast<std::size_t>(count) * size;
  }
  // The influence functions come last. Numbers that no body has would leave float's range in a tick's sums.
  for (const float c : {0x1p64f, -0x1p64f, 3e38f, HUGE_VALF, std::nanf("")}) {
    changed = bytes;
    std::memcpy(changed.data() + bytes.size() - 4, &c, 4);
    sign();
    CHECK(refused(changed, "influence function"));
  }
  constexpr float largest = 0x1.fffffep63f;
  std::memcpy(changed.data() + bytes.size() - 4, &largest, 4);
  sign();
  CHECK_FALSE(refused(changed, "influence function"));
}
