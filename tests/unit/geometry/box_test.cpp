// SPDX-License-Identifier: MIT

#include "support/check.hpp"

#include <palpate/geometry/box.hpp>

#include <string>

using namespace palpate;

TEST_CASE_TEMPLATE("box: face, edge and corner regions outside", S, float, double) {
  const Box<S> body({.half = {S(3), S(2), S(1)}});
  const SurfacePoint<S> face = body.closest(Vec3<S>(1, 0, 4));
  CHECK(face.position == Vec3<S>(1, 0, 1));
  CHECK(face.normal == Vec3<S>(0, 0, 1));
  CHECK(face.distance == S(3));
  const SurfacePoint<S> edge = body.closest(Vec3<S>(0, 5, -5));
  CHECK(edge.position == Vec3<S>(0, 2, -1));
  CHECK_ABSOLUTE(edge.distance, 5.0L, test::ulps<S>(8) * 5);
  CHECK_ABSOLUTE(edge.normal.y(), 0.6L, test::ulps<S>(4));
  CHECK_ABSOLUTE(edge.normal.z(), -0.8L, test::ulps<S>(4));
  const SurfacePoint<S> corner = body.closest(Vec3<S>(4, 4, 3));
  CHECK(corner.position == Vec3<S>(3, 2, 1));
  CHECK_ABSOLUTE(corner.distance, 3.0L, test::ulps<S>(8) * 3);
}

TEST_CASE_TEMPLATE("box: ties inside and on the surface", S, float, double) {
  const Box<S> cube({.half = Vec3<S>::Constant(1)});
  CHECK(cube.closest(Vec3<S>::Zero()).position == Vec3<S>(1, 0, 0));
  CHECK(cube.closest(Vec3<S>(0, S(0.5), S(-0.5))).position == Vec3<S>(0, 1, S(-0.5)));
  const SurfacePoint<S> corner = cube.closest(Vec3<S>(1, 1, -1));
  CHECK(corner.position == Vec3<S>(1, 1, -1));
  CHECK(corner.distance == S(0));
  CHECK(corner.normal == Vec3<S>(1, 0, 0));
  CHECK(!cube.inside(Vec3<S>(1, 0, 0)));  // the surface itself is not touched
  CHECK(cube.penetration(Vec3<S>(1, 0, 0)).depth == S(0));
  CHECK(cube.penetration(Vec3<S>::Zero()).gradient == Vec3<S>(0, 0, 0));
}

TEST_CASE_TEMPLATE("box: depth is exact away from edges, and turns half way over one", S, float, double) {
  const Box<S> body({.half = Vec3<S>::Constant(1)});
  const Penetration<S> flat = body.penetration(Vec3<S>(0, S(0.5), S(0.75)));
  CHECK(flat.depth == S(0.25));
  CHECK(flat.gradient == Vec3<S>(0, 0, 1));
  const Penetration<S> edge = body.penetration(Vec3<S>(0, S(0.75), S(0.75)));
  CHECK(edge.gradient.y() == edge.gradient.z());
  CHECK_RELATIVE(edge.depth, 0.25L * (0.5L + std::sqrt(0.125L)), test::ulps<S>(8));
  CHECK_RELATIVE(edge.gradient.z(), 0.5L * (0.5L + std::sqrt(0.125L)),
                 test::ulps<S>(8));  // weight t / 2 each
}

TEST_CASE_TEMPLATE("box: rays along faces and edges", S, float, double) {
  const Box<S> body({.half = {S(3), S(2), S(1)}});
  const RayHit<S> hit = body.raycast(Vec3<S>(-5, 1, 0), Vec3<S>(2, 0, 0));
  CHECK(hit.hit);
  CHECK(hit.t == S(1));
  CHECK(hit.position == Vec3<S>(-3, 1, 0));
  CHECK(body.raycast(Vec3<S>::Zero(), Vec3<S>(0, 0, -4)).t == S(0.25));  // from inside: where it leaves
  CHECK(body.raycast(Vec3<S>(-5, 2, 0), Vec3<S>(1, 0, 0)).hit);          // in the plane of a face
  CHECK(!body.raycast(Vec3<S>(-5, S(2.001), 0), Vec3<S>(1, 0, 0)).hit);
  CHECK(!body.raycast(Vec3<S>(5, 0, 0), Vec3<S>(1, 0, 0)).hit);  // behind
  CHECK(!body.raycast(Vec3<S>(5, 0, 0), Vec3<S>::Zero()).hit);
}

TEST_CASE_TEMPLATE("box: a ball over an edge is as far as the edge", S, float, double) {
  const Box<S> body({.half = {S(3), S(2), S(1)}});
  CHECK(body.separated(Vec3<S>(0, 5, -5), S(4.99)));  // 3 and 4 beyond the edge
  CHECK(!body.separated(Vec3<S>(0, 5, -5), S(5.01)));
}

TEST_CASE_TEMPLATE("box: many points at once are as one by one, next to faces, edges and corners", S, float,
                   double) {
  const Box<S> body({.half = {S(3), S(2), S(1)}, .centre = {S(1), S(-2), S(3)}});
  PointBatch<S> x;
  for (std::size_t round = 0; round < 8; ++round) {
    for (std::size_t i = 0; i < batch_size; ++i) {  // from 0.3 of the way to beyond the face, axis by axis
      const auto part = [&](std::size_t step) { return S(0.3) + S(0.1) * static_cast<S>(step % 8); };
      x.x[i] = S(1) + S(3) * part(i), x.y[i] = S(-2) - S(2) * part(i + i / 4),
      x.z[i] = S(3) + part(i + round);
    }
    PenetrationBatch<S> in;
    body.penetration(x, in);
    for (std::size_t i = 0; i < batch_size; ++i) {
      const Penetration<S> one = body.penetration(Vec3<S>(x.x[i], x.y[i], x.z[i]));
      CHECK_ABSOLUTE(in.depth[i], one.depth, test::ulps<S>(16));  // of lengths up to 1 m
      CHECK_ABSOLUTE(in.gradient_z[i], one.gradient.z(), test::ulps<S>(64));
    }
  }
}

TEST_CASE("box: meshes of needles and plates stay within the count; corners are vertices") {
  for (const Vec3<double>& h :
       {Vec3<double>(1, 0.001, 0.001), Vec3<double>(1, 1, 0.001), Vec3<double>(0.02, 0.02, 0.02)}) {
    const Box<double> body({.half = h});
    for (const std::size_t n : {8u, 50u, 3000u}) {
      const MeshData<double> mesh = body.mesh(n);
      CHECK(mesh.vertices.size() <= n);
      CHECK(mesh.vertices.size() >= (n == 50 ? 26u : n * 4 / 5));
      int corners = 0;
      for (const Vec3<double>& v : mesh.vertices) corners += v.cwiseAbs() == h;
      CHECK(corners == 8);
    }
  }
}

TEST_CASE("box: bad parameters are refused by name and value") {
  std::string message;
  try {
    Box<double>({.half = {1, 1, 0.0001}});
  } catch (const SetupError& error) {
    message = error.what();
  }
  CHECK(message == "Box: ratio of half lengths must be at most 1000, got 10000");
  try {
    (void)Box<double>({.half = {1, 1, 1}}).mesh(7);
  } catch (const SetupError& error) {
    message = error.what();
  }
  CHECK(message == "Box: mesh needs at least 8 vertices, got 7");
}
