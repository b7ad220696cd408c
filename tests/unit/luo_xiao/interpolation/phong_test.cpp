// SPDX-License-Identifier: MIT
#include "contract/interpolation.hpp"

#include <palpate/luo_xiao/interpolation/linear.hpp>
#include <palpate/luo_xiao/interpolation/phong.hpp>

#include <doctest/doctest.h>

using namespace palpate;
using palpate::test::field_of;
using palpate::test::ulps;

namespace {

const Ellipsoid<double> body({.axes = {0.03, 0.02, 0.025}});
constexpr double pi = 3.14159265358979323846;

/// Field along the edge from +x (corner 1) to +y (corner 3), weights from 0 to 1, without a contact.
struct Edge {
  MeshData<double> mesh = body.mesh(50);
  std::uint32_t first = static_cast<std::uint32_t>(mesh.vertices.size());
  static constexpr int steps = 20;
  PhongInterpolation<double> phong = make();
  LinearInterpolation<double> linear{phong.partition()};

  PhongInterpolation<double> make() {
    for (int i = 0; i <= steps; ++i) {
      const double s = static_cast<double>(i) / steps;
      mesh.vertices.push_back(
          body.raycast(Vec3<double>::Zero(), Vec3<double>(0.03 * (1 - s), 0.02 * s, 0)).position);
    }
    return PhongInterpolation<double>(make_partition(body, mesh));
  }
  template <class I>
  Vec3<double> at(const I& interpolation, const Vec3<double>& u1, const Vec3<double>& u3, int i) const {
    std::vector<Vec3<double>> corners(6, Vec3<double>::Zero());
    corners[1] = u1, corners[3] = u3;
    const auto field = field_of(interpolation, corners, {.position = Vec3<double>(-0.01, -0.01, -0.01)});
    return field[test::slot_of(phong.partition(), first + static_cast<std::uint32_t>(i))];
  }
  Vec3<double> normal(int i) const {
    return body.closest(mesh.vertices[first + static_cast<std::uint32_t>(i)]).normal;
  }
};

}  // namespace

TEST_CASE("along an edge: magnitude and angle to the normal are linear, the azimuth stays in its plane") {
  const Edge edge;
  // 1 mm at 40 degrees to +x, 0.4 mm at 100 degrees to +y, both turned towards -z.
  const auto displaced = [](const Vec3<double>& n, double size, double angle) {
    return Vec3<double>(size * (std::cos(angle) * n - std::sin(angle) * Vec3<double>::UnitZ()));
  };
  const double a = 40 * pi / 180, b = 100 * pi / 180;
  for (int i = 0; i <= Edge::steps; ++i) {
    const double s = static_cast<double>(i) / Edge::steps;
    const Vec3<double> u = edge.at(edge.phong, displaced(Vec3<double>::UnitX(), 1e-3, a),
                                   displaced(Vec3<double>::UnitY(), 4e-4, b), i);
    const long double size = (1 - s) * 1e-3L + s * 4e-4L, angle = (1 - s) * a + s * b;
    CHECK_RELATIVE(u.norm(), size, ulps<double>(64));  // sine, cosine and two roots
    CHECK_ABSOLUTE(std::acos(u.normalized().dot(edge.normal(i))), angle, 1e-14);
    CHECK_ABSOLUTE(u.z(), -size * std::sin(angle), 1e-18);  // t = -z is tangent all along this edge
  }
}

TEST_CASE("a corner of zero displacement gives no direction: only the magnitude falls towards it") {
  const Edge edge;
  const Vec3<double> u1(-1e-3, 0, 0);  // straight in
  for (int i = 0; i < Edge::steps; ++i) {
    const double s = static_cast<double>(i) / Edge::steps;
    const Vec3<double> u = edge.at(edge.phong, u1, Vec3<double>::Zero(), i);
    CHECK((u + (1 - s) * 1e-3 * edge.normal(i)).norm() <= 1e-18);
  }
}

TEST_CASE("a corner's direction enters without a jump as its displacement becomes nonzero") {
  const Edge edge;
  const Vec3<double> u1(-1e-3, 0, 0);
  const Vec3<double> still = edge.at(edge.phong, u1, Vec3<double>::Zero(), 10);
  for (const double size : {1e-7, 1e-9, 1e-12, 1e-300, 1e-310}) {
    const Vec3<double> u = edge.at(edge.phong, u1, Vec3<double>(0, 0, size), 10);
    CHECK((u - still).norm() <=
          100 * size + 1e-18);  // g has the slope 16 / max_size, an angle the slope pi/2
  }
}

TEST_CASE("opposite directions: the linear interpolation in the middle, no jump beside it") {
  const Edge edge;
  const double size = 1e-3;
  // In and out along the normals: angle pi/2 half way, and no tangent.
  const Vec3<double> in(-size, 0, 0), out(0, size, 0);
  CHECK((edge.at(edge.phong, in, out, 10) - edge.at(edge.linear, in, out, 10)).norm() <= 1e-17);
  // Along z and against it.
  const Vec3<double> there(0, 0, size), back(0, 0, -size);
  CHECK((edge.at(edge.phong, there, back, 10) - edge.at(edge.linear, there, back, 10)).norm() <= 1e-17);
  for (const double ratio : {1e-6, 1e-9}) {
    const Vec3<double> nearly(0, size * ratio, -size);
    CHECK((edge.at(edge.phong, there, nearly, 10) - edge.at(edge.phong, there, back, 10)).norm() <=
          10 * size * ratio + 1e-18);
  }
}

TEST_CASE("no displacement exceeds the maximum of the corners") {
  const PhongInterpolation<double> phong(make_partition(body, body.mesh(300)));
  std::mt19937_64 random(11);
  INFO("seed 11");
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vector = [&] { return Vec3<double>(unit(random), unit(random), unit(random)); };
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<Vec3<double>> corners(6);
    double max_size = 0;
    for (auto& u : corners) u = vector(), max_size = std::max(max_size, u.norm());
    ContactDisplacement<double> contact;
    contact.position = vector(), contact.displacement = vector(),
    contact.normal = body.closest(contact.position).normal;
    max_size = std::max(max_size, contact.displacement.norm());
    double max_field = 0;
    for (const Vec3<double>& u : field_of(phong, corners, contact)) max_field = std::max(max_field, u.norm());
    CHECK(max_field <= max_size * (1 + 1e-14));
  }
}

TEST_CASE("where all corners move alike along their normals, Phong inflates and linear cuts the corner") {
  const Sphere<double> sphere({.radius = 0.03});
  const auto part = make_partition(sphere, sphere.mesh(300));
  const PhongInterpolation<double> phong(part);
  const LinearInterpolation<double> linear(part);
  std::vector<Vec3<double>> corners;
  for (const auto& point : part.points()) corners.push_back(1e-3 * point.normal);
  ContactDisplacement<double> contact;
  contact.position = 0.03 * Vec3<double>(1, 1, 1).normalized();
  contact.normal = contact.position.normalized(), contact.displacement = 1e-3 * contact.normal;
  const auto round = field_of(phong, corners, contact), flat = field_of(linear, corners, contact);
  double min_field = 1;
  for (const Face<double>& face : part.faces()) {
    for (std::size_t j = 0; j < face.count; ++j) {
      const Vec3<double> n(part.normal(face, 0)[j], part.normal(face, 1)[j], part.normal(face, 2)[j]);
      CHECK((round[face.first + j] - 1e-3 * n).norm() <= 1e-17);  // exactly a larger sphere
      min_field = std::min(min_field, flat[face.first + j].norm());
    }
  }
  CHECK(min_field < 0.9e-3);
}
