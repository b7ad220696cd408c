// SPDX-License-Identifier: MIT
#include "contract/interpolation.hpp"
#include "support/no_heap.hpp"

#include <palpate/elasticity/none.hpp>
#include <palpate/luo_xiao/displacement_field.hpp>
#include <palpate/luo_xiao/interpolation/linear.hpp>
#include <palpate/luo_xiao/interpolation/phong.hpp>
#include <palpate/luo_xiao/interpolation/smooth.hpp>

#include <doctest/doctest.h>

using namespace palpate;
using palpate::test::ulps;

namespace {

const Box<double> box({.half = {0.02, 0.02, 0.02}});
const Ellipsoid<double> ellipsoid({.axes = {0.03, 0.02, 0.02}});

ContactDisplacement<double> pressed(const Vec3<double>& position, double depth) {
  return {.position = position, .normal = Vec3<double>::UnitY(), .displacement = Vec3<double>(0, -depth, 0)};
}

template <class I, class N = NoNeighbourhood<double>, class Body>
DisplacementField<I, N> make_field(const Body& body, const MeshData<double>& mesh, N neighbourhood = {},
                                   std::size_t contacts = 4) {
  return DisplacementField<I, N>(I(make_partition(body, mesh)), neighbourhood, mesh, {.contacts = contacts});
}

template <Real T>
struct Buffer {
  std::vector<T> positions, normals;
  VertexBuffer<T> view;
  explicit Buffer(std::size_t vertices, T fill = T(0))
      : positions(3 * vertices, fill), normals(3 * vertices, fill) {
    view = {.positions = positions.data(), .normals = normals.data()};
  }
  [[nodiscard]] Vec3<T> position(std::size_t i) const {
    return Vec3<T>(positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]);
  }
  [[nodiscard]] Vec3<T> normal(std::size_t i) const {
    return Vec3<T>(normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]);
  }
};

using Contacts = std::vector<ContactDisplacement<double>>;
using Corners = std::vector<Vec3<double>>;

}  // namespace

TEST_CASE("rest shape: the mesh to the bit, and unit normals that point outward") {
  const auto mesh = ellipsoid.mesh(300);
  auto field = make_field<LinearInterpolation<double>>(ellipsoid, mesh);
  Buffer<double> out(mesh.vertices.size());
  field.write_rest(out.view);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    CHECK(out.position(i) == mesh.vertices[i]);
    CHECK_ABSOLUTE(out.normal(i).norm(), 1, ulps<float>(4));  // normals are worked out in float
    CHECK(out.normal(i).dot(ellipsoid.closest(mesh.vertices[i]).normal) > 0.98);
  }
}

TEST_CASE("nothing moved: nothing written, not even read; without contacts too") {
  const auto mesh = ellipsoid.mesh(300);
  auto field = make_field<PhongInterpolation<double>>(ellipsoid, mesh);
  Buffer<double> out(mesh.vertices.size());
  field.write_rest(out.view);
  const Corners corners(6, Vec3<double>(1e-4, 0, 0));
  const Contacts contacts{pressed({0.001, 0.02, 0.001}, 1e-3)};
  CHECK(field.write(contacts, corners, out.view).vertices == mesh.vertices.size());
  std::fill(out.positions.begin(), out.positions.end(), 7.0);
  std::fill(out.normals.begin(), out.normals.end(), 7.0);
  const auto moved = field.write(contacts, corners, out.view);
  CHECK(moved.vertices == 0);
  CHECK(moved.lower.isZero(0.0));
  CHECK(moved.upper.isZero(0.0));
  for (const double value : out.positions) CHECK(value == 7.0);
  for (const double value : out.normals) CHECK(value == 7.0);

  auto fresh = make_field<PhongInterpolation<double>>(ellipsoid, mesh);
  CHECK(fresh.write(Contacts{}, Corners{}, out.view).vertices == 0);
  CHECK(
      fresh.write(Contacts{pressed({0, 0.02, 0}, 0)}, Corners(6, Vec3<double>::Zero()), out.view).vertices ==
      0);
}

TEST_CASE(
    "only what moved is written: the split face of a box, its neighbours' normals, and the box around it") {
  const auto mesh = box.mesh(600);
  auto field = make_field<LinearInterpolation<double>>(box, mesh);
  const auto& part = field.partition();
  Buffer<double> out(mesh.vertices.size(), 7.0);
  const Vec3<double> position(0.002, 0.02, 0.001);
  const auto moved =
      field.write(Contacts{pressed(position, 1e-3)}, Corners(8, Vec3<double>::Zero()), out.view);
  const auto& face = part.faces()[part.locate(position).face];
  CHECK(moved.vertices == face.count);
  Vec3<double> low = Vec3<double>::Constant(1), high = -low;
  std::size_t normals = 0;
  for (std::size_t slot = 0; slot < part.size(); ++slot) {
    const std::size_t i = part.order()[slot];
    const bool inside = slot >= face.first && slot < face.first + face.count;
    CHECK((out.position(i) == Vec3<double>::Constant(7)) == !inside);
    normals += out.normal(i) == Vec3<double>::Constant(7) ? 0 : 1;
    if (!inside) continue;
    low = low.cwiseMin(out.position(i)), high = high.cwiseMax(out.position(i));
  }
  CHECK(moved.lower == low);
  CHECK(moved.upper == high);
  CHECK(normals > face.count);
  CHECK(normals < 2 * face.count);
  // The contact gone: the same face returns to rest, exactly.
  CHECK(field.write(Contacts{}, Corners{}, out.view).vertices == face.count);
  for (std::size_t slot = face.first; slot < face.first + face.count; ++slot)
    CHECK(out.position(part.order()[slot]) == mesh.vertices[part.order()[slot]]);
}

TEST_CASE("tick after tick the buffer equals one written from rest, positions and normals") {
  const auto mesh = box.mesh(300);
  auto field = make_field<LinearInterpolation<double>>(box, mesh);
  Buffer<double> out(mesh.vertices.size());
  field.write_rest(out.view);
  for (int tick = 0; tick < 60; ++tick) {
    const double t = 0.1 * tick;
    Contacts contacts{
        pressed(box.closest(Vec3<double>(0.03 * std::cos(t), 0.021, 0.03 * std::sin(t))).position, 1e-3)};
    if (tick % 20 > 10) contacts.push_back(pressed({0, 0.02, 0}, 5e-4));
    if (tick % 20 == 19) contacts.clear();
    const Corners corners(8 * contacts.size(),
                          tick % 3 == 0 ? Vec3<double>(1e-4, 0, 0) : Vec3<double>::Zero());
    field.write(contacts, corners, out.view);
    auto fresh = make_field<LinearInterpolation<double>>(box, mesh);
    Buffer<double> whole(mesh.vertices.size());
    fresh.write_rest(whole.view);
    fresh.write(contacts, corners, whole.view);
    CHECK(out.positions == whole.positions);
    CHECK(out.normals == whole.normals);
  }
}

TEST_CASE("a buffer filled with the rest shape after one face moved has all of its normals") {
  const auto mesh = box.mesh(300);
  auto field = make_field<LinearInterpolation<double>>(box, mesh);
  Buffer<double> out(mesh.vertices.size()), other(mesh.vertices.size());
  field.write_rest(out.view);
  const std::vector<double> rest = out.normals;
  field.write(Contacts{pressed({0.002, 0.02, 0.001}, 1e-3)}, Corners(8, Vec3<double>::Zero()), out.view);
  field.write_rest(other.view);
  CHECK(other.normals == rest);
}

TEST_CASE("normals are area-weighted over the displaced triangles") {
  const auto mesh = ellipsoid.mesh(300);
  auto field = make_field<PhongInterpolation<double>>(ellipsoid, mesh);
  Buffer<double> out(mesh.vertices.size());
  field.write_rest(out.view);
  field.write(Contacts{pressed({0.003, 0.0199, 0.002}, 3e-3)}, Corners(6, Vec3<double>(3e-4, -2e-4, 1e-4)),
              out.view);
  std::vector<Vec3<double>> sum(mesh.vertices.size(), Vec3<double>::Zero());
  for (const auto& t : mesh.triangles) {
    const Vec3<double> area =
        (out.position(t[1]) - out.position(t[0])).cross(out.position(t[2]) - out.position(t[0]));
    for (const std::uint32_t v : t) sum[v] += area;
  }
  // Worked out in float, edges of 3 mm between positions of 30 mm: 10 ulp, times a few.
  for (std::size_t i = 0; i < sum.size(); ++i)
    CHECK((out.normal(i) - sum[i].normalized()).norm() <= ulps<float>(40));
}

TEST_CASE("strides and float buffers: the same numbers at their positions, nothing between them touched") {
  const auto mesh = ellipsoid.mesh(200);
  const std::size_t n = mesh.vertices.size();
  const Contacts contacts{pressed({0.003, 0.0199, 0.002}, 3e-3)};
  const Corners corners(6, Vec3<double>(3e-4, -2e-4, 1e-4));
  auto plain_field = make_field<PhongInterpolation<double>>(ellipsoid, mesh);
  Buffer<double> plain(n);
  plain_field.write_rest(plain.view);
  plain_field.write(contacts, corners, plain.view);
  // 37 bytes per vertex: a byte, position, normal, the rest; no float is aligned.
  constexpr std::size_t stride = 37;
  std::vector<unsigned char> bytes(n * stride, 0xab);
  VertexBuffer<float> view{.positions = reinterpret_cast<float*>(bytes.data() + 1),
                           .position_stride = stride,
                           .normals = reinterpret_cast<float*>(bytes.data() + 13),
                           .normal_stride = stride};
  auto field = make_field<PhongInterpolation<double>>(ellipsoid, mesh);
  field.write_rest(view);
  field.write(contacts, corners, view);
  for (std::size_t i = 0; i < n; ++i) {
    float value[6];
    std::memcpy(value, &bytes[i * stride + 1], sizeof value);
    for (std::size_t k = 0; k < 3; ++k) {
      CHECK(value[k] == static_cast<float>(plain.positions[3 * i + k]));
      CHECK(value[3 + k] == static_cast<float>(plain.normals[3 * i + k]));
    }
    for (std::size_t k = 0; k < stride; ++k) {
      if (k < 1 || k >= 25) CHECK(bytes[i * stride + k] == 0xab);
    }
  }
}

TEST_CASE("several contacts: their fields add up; one that appears with zero displacement changes nothing") {
  const auto mesh = ellipsoid.mesh(300);
  const Contacts a{pressed({0.01, 0.0188, 0}, 1e-3)}, b{pressed({-0.01, 0.0188, 0.001}, 2e-3)};
  const Corners u(6, Vec3<double>(1e-4, 2e-4, 0)), v(6, Vec3<double>(0, 1e-4, 3e-4)),
      none(6, Vec3<double>::Zero());
  const auto displaced = [&](const Contacts& contacts, const Corners& corners) {
    auto field = make_field<PhongInterpolation<double>>(ellipsoid, mesh);
    Buffer<double> out(mesh.vertices.size());
    field.write_rest(out.view);
    field.write(contacts, corners, out.view);
    return out.positions;
  };
  const auto join = [](auto x, const auto& y) {
    x.insert(x.end(), y.begin(), y.end());
    return x;
  };
  const auto only_a = displaced(a, u), only_b = displaced(b, v), both = displaced(join(a, b), join(u, v));
  for (std::size_t i = 0; i < both.size(); ++i)
    CHECK_ABSOLUTE(both[i], only_a[i] + only_b[i] - mesh.vertices[i / 3][static_cast<int>(i % 3)],
                   ulps<double>(4) * 0.03);
  CHECK(displaced(join(a, Contacts{pressed({-0.01, 0.0188, 0}, 0)}), join(u, none)) == only_a);
}

TEST_CASE(
    "more contacts than set up: the surplus is left out and reported; wrong lists: nothing is written") {
  const auto mesh = ellipsoid.mesh(100);
  auto field = make_field<LinearInterpolation<double>>(ellipsoid, mesh, NoNeighbourhood<double>{}, 1);
  Buffer<double> out(mesh.vertices.size());
  field.write_rest(out.view);
  const Contacts two{pressed({0, 0.02, 0}, 1e-3), pressed({0.01, 0.0188, 0}, 1e-3)};
  const auto moved = field.write(two, Corners(12, Vec3<double>::Zero()), out.view);
  CHECK(has(moved.status, Status::region_overflow));
  CHECK(moved.vertices > 0);
  CHECK(field.write(two, Corners(11, Vec3<double>::Zero()), out.view).vertices == 0);
  CHECK(field.write(Contacts{}, Corners{}, VertexBuffer<double>{}).vertices == 0);
}

TEST_CASE("input that is not finite or absurd: that contact is not drawn, and no coordinate is spoilt") {
  const auto mesh = ellipsoid.mesh(100);
  auto field = make_field<PhongInterpolation<double>, AreaNeighbourhood<double>>(
      ellipsoid, mesh, AreaNeighbourhood<double>({}));
  Buffer<float> out(mesh.vertices.size());
  field.write_rest(out.view);
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e200}) {
    for (int entry = 0; entry < 6; ++entry) {
      Contacts contacts{pressed({0, 0.02, 0}, 1e-3)};
      Corners corners(6, Vec3<double>(1e-4, 0, 0));
      contacts[0].area = 1e-5;
      if (entry == 0) contacts[0].position.x() = bad;
      if (entry == 1) contacts[0].displacement.y() = bad;
      if (entry == 2) contacts[0].area = bad;
      if (entry == 3) contacts[0].normal.z() = bad;
      if (entry == 4) corners[5].z() = bad;
      if (entry == 5) contacts[0].depth = bad;
      field.write(contacts, corners, out.view);
      for (const float value : out.positions) CHECK(std::fabs(value) < 0.1f);
      for (const float value : out.normals) CHECK(std::fabs(value) <= 1.001f);
    }
  }
}

namespace {

/// A square of 40 mm with its contact near the middle, and points at 0 to 10 mm from it along x.
struct Profile {
  static constexpr int steps = 600;
  static constexpr double step = 0.01 / steps;
  static inline const Vec3<double> p{0.001, 0.02, 0.002};

  template <class I, class N>
  static std::vector<Vec3<double>> of(const N& neighbourhood, double D, double area) {
    auto mesh = box.mesh(100);
    const std::size_t first = mesh.vertices.size();
    for (int i = 0; i <= steps; ++i) mesh.vertices.push_back(p + Vec3<double>(step * i, 0, 0));
    mesh.triangles.clear();  // no edges that a were widened by
    DisplacementField<I, N> field(I(make_partition(box, mesh)), neighbourhood, mesh, {.normals = false});
    Buffer<double> out(mesh.vertices.size());
    field.write_rest(out.view);
    Contacts contacts{pressed(p, D)};
    contacts[0].area = area;
    field.write(contacts, Corners(8, Vec3<double>::Zero()), out.view);
    std::vector<Vec3<double>> u;
    for (std::size_t i = first; i < mesh.vertices.size(); ++i)
      u.push_back(out.position(i) - mesh.vertices[i]);
    return u;
  }
  /// The largest change of slope of |u| - |g| from one step to the next.
  static double kink(const std::vector<Vec3<double>>& u, const std::vector<Vec3<double>>& g) {
    double most = 0, last = 0;
    for (std::size_t i = 1; i < u.size(); ++i) {
      const double slope = ((u[i].norm() - g[i].norm()) - (u[i - 1].norm() - g[i - 1].norm())) / step;
      if (i > 1) most = std::max(most, std::fabs(slope - last));
      last = slope;
    }
    return most;
  }
};
constexpr double noise = 1e-17;  // of 0.02 + 0.001 - 0.02

}  // namespace

TEST_CASE_TEMPLATE("the tool's face: D within a, the field of w D beyond R, falling between without a kink",
                   I, LinearInterpolation<double>, SmoothInterpolation<double>) {
  const double D = 1e-3, R = 6e-3, area = 1e-5, w = 1 / (1 + std::log(10.0)),
               a = std::sqrt(area / 3.14159265358979323846);
  const auto u = Profile::of<I>(AreaNeighbourhood<double>({.reference_area = 1e-6, .radius = R}), D, area),
             around = Profile::of<I>(NoNeighbourhood<double>{}, w * D, area);
  for (std::size_t i = 0; i < u.size(); ++i) {
    const double r = Profile::step * static_cast<double>(i);
    if (r < a) CHECK((u[i] - Vec3<double>(0, -D, 0)).norm() <= noise);
    if (r > R * (1 + 1e-9)) CHECK(u[i] == around[i]);
    if (i > 0 && r < R) CHECK(u[i].norm() <= u[i - 1].norm() + noise);
  }
  // b = 1 - f(t), f = t^3 (10 - 15 t + 6 t^2): |f'| <= 15/8, |f''| <= 10/sqrt(3); t = (r^2 - a^2)/(R^2 -
  // a^2). D - g changes slowly: half as much again for its part.
  const double per_square = 1 / (R * R - a * a), steepest = 2 * R * per_square,
               curved = 10 / std::sqrt(3.0) * steepest * steepest + 15.0 / 8 * 2 * per_square;
  CHECK(Profile::kink(u, around) <= 1.5 * curved * D * Profile::step);
}

TEST_CASE_TEMPLATE("the printed form: w D at the contact, the field of D beyond R, no kink at R", I,
                   LinearInterpolation<double>, SmoothInterpolation<double>) {
  const double D = 1e-3, R = 6e-3, area = 1e-5, w = 1 / (1 + std::log(10.0));
  const auto u =
      Profile::of<I>(Printed<AreaNeighbourhood<double>>({.reference_area = 1e-6, .radius = R}), D, area);
  const auto around = Profile::of<I>(NoNeighbourhood<double>{}, D, area);
  CHECK((u[0] - Vec3<double>(0, -w * D, 0)).norm() <= noise);
  for (std::size_t i = 0; i < u.size(); ++i) {
    const double r = Profile::step * static_cast<double>(i), s = std::min(r / R, 1.0),
                 b = (1 - s * s) * (1 - s * s);
    if (r > R * (1 + 1e-9)) CHECK(u[i] == around[i]);
    CHECK((u[i] - (1 - (1 - w) * b) * around[i]).norm() <= noise);
  }
  // |b''| <= 8 / R^2; half as much again for the field's own slope.
  CHECK(Profile::kink(u, around) <= 1.5 * 8 * D / (R * R) * Profile::step);
}

TEST_CASE("a point contact is not touched; corners move no more than w D a/l") {
  const auto mesh = box.mesh(300);
  const Contacts point{pressed({0.001, 0.02, 0.002}, 1e-3)};
  const auto write = [&](auto neighbourhood, const Contacts& contacts, const Corners& corners) {
    auto field = make_field<LinearInterpolation<double>>(box, mesh, neighbourhood);
    Buffer<double> out(mesh.vertices.size());
    field.write_rest(out.view);
    field.write(contacts, corners, out.view);
    return out.positions;
  };
  const AreaNeighbourhood<double> local({.reference_area = 1e-6});
  const Corners none(8, Vec3<double>::Zero());
  CHECK(write(local, point, none) == write(NoNeighbourhood<double>{}, point, none));
  // Every corner at its bound, in its own direction: a point is as wide as it is deep.
  Corners large(8, Vec3<double>(3e-3, -4e-3, 0)), bound = large;
  const auto points = extremal_points(box);
  for (std::size_t i = 0; i < bound.size(); ++i)
    bound[i] *= 1e-3 * (1e-3 / (points[i].position - point[0].position).norm()) / 5e-3;
  const auto drawn = write(local, point, large), expected = write(NoNeighbourhood<double>{}, point, bound);
  for (std::size_t i = 0; i < drawn.size(); ++i)
    CHECK_ABSOLUTE(drawn[i], expected[i], ulps<double>(2) * 0.02);
}

TEST_CASE_TEMPLATE("no heap in a tick", I, LinearInterpolation<double>, PhongInterpolation<double>,
                   SmoothInterpolation<double>) {
  const auto mesh = ellipsoid.mesh(300);
  auto field = make_field<I, AreaNeighbourhood<double>>(ellipsoid, mesh, AreaNeighbourhood<double>({}));
  Buffer<float> out(mesh.vertices.size());
  field.write_rest(out.view);
  Contacts contacts{pressed({0, 0.02, 0}, 1e-3), pressed({0.01, 0.0188, 0}, 1e-3)};
  const Corners corners(12, Vec3<double>(1e-4, 0, 0));
  contacts[0].area = 1e-5;
  const test::HeapCount heap;
  for (int tick = 0; tick < 20; ++tick) {
    contacts[0].position.z() = 1e-3 * tick;
    field.write(contacts, corners, out.view);
  }
  CHECK(heap.allocations() == 0);
}

TEST_CASE("set-up refuses a mesh that is not the partition's, and room for no contact") {
  const auto mesh = ellipsoid.mesh(100), other = ellipsoid.mesh(200);
  const LinearInterpolation<double> linear(make_partition(ellipsoid, mesh));
  using Field = DisplacementField<LinearInterpolation<double>, NoNeighbourhood<double>>;
  CHECK_THROWS_AS(Field(linear, {}, other), SetupError);
  CHECK_THROWS_WITH(Field(linear, {}, mesh, {.contacts = 0}),
                    "DisplacementField: contacts must be >= 1, got 0");
  auto open = mesh;
  open.triangles.pop_back();
  CHECK_THROWS_AS(Field(linear, {}, open), SetupError);
  CHECK_NOTHROW(Field(linear, {}, open, {.normals = false}));
}
