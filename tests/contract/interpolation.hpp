// SPDX-License-Identifier: MIT
#pragma once

/// @file What every interpolation must keep (luo_xiao/interpolation/concept.hpp), run on each policy over
/// several bodies.

#include "support/check.hpp"
#include "support/paths.hpp"

#include <palpate/luo_xiao/interpolation/concept.hpp>

#include <algorithm>
#include <random>
#include <vector>

namespace palpate::test {

/// The field of one load at all slots.
template <BlockInterpolation I>
[[nodiscard]] std::vector<Vec3<typename I::Scalar>> field_of(const I& interpolation,
                                                             const typename I::Load& load) {
  using S = typename I::Scalar;
  const auto& partition = interpolation.partition();
  std::vector<Vec3<S>> field(partition.size());
  std::fill(field.begin(), field.end(), Vec3<S>::Zero());
  for (std::size_t f = 0; f < partition.faces().size(); ++f) {
    const Face<S>& face = partition.faces()[f];
    if (!interpolation.moves(load, f)) continue;
    for (std::size_t from = 0; from < face.count; from += block_size) {
      const std::size_t count = std::min(block_size, face.count - from);
      Block<S> u[3] = {};
      interpolation.add(load, f, from, count, {u[0].value, u[1].value, u[2].value},
                        {u[0].value, u[1].value, u[2].value});
      for (std::size_t i = 0; i < count; ++i)
        field[face.first + from + i] = Vec3<S>(u[0][i], u[1][i], u[2][i]);
    }
  }
  return field;
}

template <BlockInterpolation I>
[[nodiscard]] std::vector<Vec3<typename I::Scalar>> field_of(
    const I& interpolation, const std::vector<Vec3<typename I::Scalar>>& corners,
    const ContactDisplacement<typename I::Scalar>& contact) {
  typename I::Load load;
  interpolation.prepare(corners, contact, load);
  return field_of(interpolation, load);
}

/// The slot of mesh vertex `vertex`.
template <Real S>
[[nodiscard]] std::size_t slot_of(const FacePartition<S>& partition, std::uint32_t vertex) {
  std::size_t slot = 0;
  while (partition.order()[slot] != vertex) ++slot;
  return slot;
}

/// What an interpolation sees of a body. A type of the scalar only, so that the checks are compiled once for
/// all bodies. Corners and contact are vertices of their own, so that the field there can be read.
template <Real S>
struct InterpolationBody {
  template <class Body>
  InterpolationBody(const Body& body)
      : points(extremal_points(body)), mesh(with_corners(body)), partition(make_partition(body, mesh)) {
    for (const Vec3<S>& v : mesh.vertices) normals.push_back(shading_normal(body, v));
  }

  std::vector<ExtremalPoint<S>> points;
  std::uint32_t at_corner = 0, at_contact = 0;  // vertices: the first corner, the contact
  MeshData<S> mesh;
  FacePartition<S> partition;
  std::vector<Vec3<S>> normals;  // of the mesh's vertices

 private:
  template <class Body>
  MeshData<S> with_corners(const Body& body) {
    MeshData<S> m = body.mesh(400);
    at_corner = static_cast<std::uint32_t>(m.vertices.size());
    for (const auto& point : points) m.vertices.push_back(point.position);
    at_contact = static_cast<std::uint32_t>(m.vertices.size());
    const Vec3<S> size = body.upper() - body.lower();
    m.vertices.push_back(
        body.closest(body.lower() + Vec3<S>(S(0.8), S(0.95), S(0.7)).cwiseProduct(size)).position);
    return m;
  }
};

/// `Make` is a callable FacePartition<S> -> interpolation. `tolerance` in units of the max displacement.
template <Real S, class Make>
void check_interpolation(const InterpolationBody<S>& body, const Make& make, long double tolerance) {
  const MeshData<S>& mesh = body.mesh;
  const auto& points = body.points;
  const std::uint32_t at_corner = body.at_corner, at_contact = body.at_contact;
  const Vec3<S> position = mesh.vertices[at_contact];
  const auto interpolation = make(body.partition);
  using I = std::remove_cvref_t<decltype(interpolation)>;
  const auto& partition = interpolation.partition();

  std::mt19937_64 random(20050608);
  INFO("seed 20050608");
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vector = [&](double size) {
    return Vec3<S>(S(size * unit(random)), S(size * unit(random)), S(size * unit(random)));
  };
  std::vector<Vec3<S>> corners(points.size()), still(points.size(), Vec3<S>::Zero());
  for (auto& u : corners) u = vector(1e-3);
  ContactDisplacement<S> contact{
      .position = position, .normal = body.normals[at_contact], .displacement = vector(4e-3)};
  const S max_size = S(4e-3);
  const auto field = field_of(interpolation, corners, contact);

  // The corners and the contact keep their own displacements.
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3<S> u = field[slot_of(partition, at_corner + static_cast<std::uint32_t>(i))];
    INFO("corner ", i);
    CHECK((u - corners[i]).norm() <= tolerance * max_size);
  }
  CHECK((field[slot_of(partition, at_contact)] - contact.displacement).norm() <= tolerance * max_size);

  // Zero load, and no load at all: exactly zero everywhere, and said so.
  typename I::Load nothing, zero;
  ContactDisplacement<S> at_rest = contact;
  at_rest.displacement.setZero();
  interpolation.prepare(still, at_rest, zero);
  for (const auto* load : {&nothing, &zero}) {
    for (std::size_t f = 0; f < partition.faces().size(); ++f) CHECK(!interpolation.moves(*load, f));
    for (const Vec3<S>& u : field_of(interpolation, *load)) CHECK(u.isZero(S(0)));
  }

  // Input that makes no sense moves nothing; so does a list of the wrong length.
  const S nan = std::numeric_limits<S>::quiet_NaN(), infinity = std::numeric_limits<S>::infinity();
  for (const S bad : {nan, infinity, -infinity, S(1e30)}) {
    for (int entry = 0; entry < 9; ++entry) {
      ContactDisplacement<S> spoilt = contact;
      std::vector<Vec3<S>> u = corners;
      (entry < 3 ? spoilt.position : entry < 6 ? spoilt.displacement : u[0])[entry % 3] = bad;
      typename I::Load load;
      interpolation.prepare(u, spoilt, load);
      CHECK(!interpolation.moves(load, 0));
    }
  }
  typename I::Load short_list;
  interpolation.prepare(std::span<const Vec3<S>>(corners).first(corners.size() - 1), contact, short_list);
  CHECK(!interpolation.moves(short_list, 0));

  // The same load is the same field, and a changed contact is seen in its own face.
  typename I::Load one, two;
  interpolation.prepare(corners, contact, one);
  for (std::size_t f = 0; f < partition.faces().size(); ++f) CHECK(interpolation.same(one, one, f));
  ContactDisplacement<S> other = contact;
  other.displacement *= S(1.5);
  interpolation.prepare(corners, other, two);
  CHECK(!interpolation.same(one, two, partition.locate(position).face));
  // Where `same` says so, it is.
  const auto field_two = field_of(interpolation, two);
  for (std::size_t f = 0; f < partition.faces().size(); ++f) {
    if (!interpolation.same(one, two, f)) continue;
    const Face<S>& face = partition.faces()[f];
    for (std::size_t slot = face.first; slot < face.first + face.count; ++slot)
      CHECK(field[slot] == field_two[slot]);
  }

  // Scaling the load by a power of 2 scales the field, to the bit.
  auto doubled = corners;
  for (auto& u : doubled) u *= S(2);
  other.displacement = S(2) * contact.displacement;
  const auto field_doubled = field_of(interpolation, doubled, other);
  for (std::size_t slot = 0; slot < field.size(); ++slot)
    CHECK((field_doubled[slot] - S(2) * field[slot]).isZero(S(0)));

  // Rotation equivariance: body, mesh, normals and load turned together turn the field.
  const Mat3<S> turn = rotation_about<S>(Vec3<S>(S(2), S(-1), S(2)) / S(3), S(0.7));
  MeshData<S> turned = mesh;
  std::vector<Vec3<S>> normals;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    turned.vertices[i] = turn * mesh.vertices[i];
    normals.push_back(turn * body.normals[i]);
  }
  auto turned_points = points;
  for (auto& point : turned_points) point = {turn * point.position, turn * point.normal};
  const auto turned_interpolation = make(FacePartition<S>(turned, normals, turned_points));
  auto turned_corners = corners;
  for (auto& u : turned_corners) u = turn * u;
  ContactDisplacement<S> turned_contact = contact;
  turned_contact.position = turn * contact.position;
  turned_contact.normal = turn * contact.normal;
  turned_contact.displacement = turn * contact.displacement;
  const auto turned_field = field_of(turned_interpolation, turned_corners, turned_contact);
  long double worst = 0;
  for (std::uint32_t vertex = 0; vertex < mesh.vertices.size(); ++vertex) {
    const Vec3<S> u = field[slot_of(partition, vertex)],
                  v = turned_field[slot_of(turned_interpolation.partition(), vertex)];
    worst = std::max(worst, static_cast<long double>((turn * u - v).norm() / max_size));
  }
  // The fields' slope with respect to positions is up to 1/fade, so their rounding counts ten times.
  CHECK(worst <= 20 * tolerance);
}

}  // namespace palpate::test
