// SPDX-License-Identifier: MIT

#include <palpate/geometry/triangle_mesh.hpp>

#include <palpate/geometry/box.hpp>
#include <palpate/geometry/ellipsoid.hpp>
#include <support/check.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <string>

using namespace palpate;

namespace {

using Mesh = MeshData<double>;
using V = Vec3<double>;

Mesh tetrahedron() {
  return {{V(0, 0, 0), V(1, 0, 0), V(0, 1, 0), V(0, 0, 1)}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

Mesh cube(const V& centre = V::Zero(), double half = 0.5, bool turned = false) {
  Mesh mesh = Box<double>({.half = V::Constant(half), .centre = centre}).mesh(8);
  if (turned)
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

Mesh together(Mesh a, const Mesh& b) {
  const auto shift = static_cast<std::uint32_t>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const auto& t : b.triangles) a.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  return a;
}

#if PALPATE_HAS_EXCEPTIONS
std::string refusal(const Mesh& mesh) {
  try {
    const TriangleMesh<double> made(mesh);
  } catch (const SetupError& error) {
    return error.what();
  }
  return "accepted";
}
// Appends: gcc 12 warns of an operator+ of a text of this length (its bug 105651).
std::string refused_as(const char* text) {
  std::string message = "TriangleMesh: ";
  message += text;
  return message;
}
#define CHECK_REFUSED(mesh, text) CHECK(refusal(mesh) == refused_as(text))
#else
#define CHECK_REFUSED(mesh, text) (void)0
#endif

// One defect alone, counted and placed as expected.
void check_only(const Mesh& mesh, MeshDefect defect, std::size_t count, std::size_t first, const char* text) {
  INFO(std::string(text));
  const MeshReport report = inspect(mesh);
  for (std::size_t d = 0; d < mesh_defect_count; ++d) {
    const bool expected = d == static_cast<std::size_t>(defect);
    CAPTURE(d);
    CHECK(report.defects[d].count == (expected ? count : 0));
  }
  CHECK(report[defect].first == first);
  CHECK(std::string(describe(report, defect).text) == text);
  CHECK_REFUSED(mesh, text);
}

}  // namespace

TEST_CASE("mesh: a good one has no defect and an empty description") {
  const MeshReport report = inspect(tetrahedron());
  CHECK(report.valid());
  CHECK(std::string(describe(report, MeshDefect::open_edge).text).empty());
}

TEST_CASE("mesh: empty") {
  check_only({}, MeshDefect::empty, 1, 0, "has no triangles");
  check_only({tetrahedron().vertices, {}}, MeshDefect::empty, 1, 0, "has no triangles");
}

TEST_CASE("mesh: an index out of range") {
  Mesh mesh = tetrahedron();
  mesh.triangles[2][1] = 4;
  mesh.triangles[3][0] = 0xffffffffu;
  check_only(mesh, MeshDefect::bad_index, 2, 2,
             "2 triangles name a vertex that does not exist, first triangle 2, vertex 4 of 4");
}

TEST_CASE("mesh: a vertex that is not finite, or absurd") {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::infinity(), 1.1e6}) {
    Mesh mesh = tetrahedron();
    mesh.vertices[3].y() = bad;
    check_only(mesh, MeshDefect::bad_vertex, 1, 3,
               "1 vertices are not finite or beyond 1e6 m, first vertex 3");
  }
}

TEST_CASE("mesh: a triangle that names a vertex twice") {
  Mesh mesh = tetrahedron();
  mesh.triangles.push_back({1, 1, 2});
  const MeshReport report = inspect(mesh);
  CHECK(report[MeshDefect::repeated_index].count == 1);
  CHECK(report[MeshDefect::repeated_index].first == 4);
  CHECK_REFUSED(mesh, "1 triangles name a vertex twice, first triangle 4; drop them");
}

TEST_CASE("mesh: vertices at one position, as STL files have them") {
  Mesh mesh;
  const Mesh good = tetrahedron();
  for (const auto& t : good.triangles) {
    for (const std::uint32_t v : t) mesh.vertices.push_back(good.vertices[v]);
    const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.triangles.push_back({n - 3, n - 2, n - 1});
  }
  const MeshReport report = inspect(mesh);
  CHECK(report[MeshDefect::duplicate_vertex].count == 8);
  CHECK(report[MeshDefect::open_edge].count == 12);
  CHECK_REFUSED(mesh, "8 vertices stand where another does, first vertices 0 and 3; weld them");
}

TEST_CASE("mesh: 0 and -0 are one position") {
  Mesh mesh = together(tetrahedron(), tetrahedron());
  for (std::size_t v = 4; v < 8; ++v) mesh.vertices[v] = V(-mesh.vertices[v] - V(3, 0, 0));
  mesh.vertices[4] = V(-0.0, 0, -0.0);
  CHECK(inspect(mesh)[MeshDefect::duplicate_vertex].count == 1);
}

TEST_CASE("mesh: a triangle without area") {
  Mesh mesh = cube();
  // A vertex put in the middle of an edge makes a flat triangle between the two halves.
  const auto [a, b, c] = mesh.triangles[0];
  mesh.vertices.push_back(0.5 * (mesh.vertices[a] + mesh.vertices[b]));
  const std::uint32_t m = 8;
  mesh.triangles[0] = {a, m, c};
  mesh.triangles.push_back({m, b, c});
  mesh.triangles.push_back({a, b, m});
  check_only(mesh, MeshDefect::zero_area, 1, 13,
             "1 triangles have no area, first triangle 13; collapse or flip an edge");
  // Lifted by a millionth of its length it is thin, and allowed.
  const V inward = -mesh.vertices[m].normalized();
  mesh.vertices[m] += 1e-6 * inward;
  CHECK(inspect(mesh)[MeshDefect::zero_area].count == 0);
}

TEST_CASE("mesh: unused vertices") {
  Mesh mesh = tetrahedron();
  mesh.vertices.push_back(V(2, 2, 2));
  mesh.vertices.push_back(V(3, 2, 2));
  check_only(mesh, MeshDefect::unused_vertex, 2, 4,
             "2 vertices belong to no triangle, first vertex 4; drop them");
}

TEST_CASE("mesh: a hole") {
  Mesh mesh = cube();
  mesh.triangles.erase(mesh.triangles.begin() + 5);
  const MeshReport report = inspect(mesh);
  const auto& e = report[MeshDefect::open_edge];
  CHECK(e.count == 3);
  char text[200];
  std::snprintf(
      text, sizeof text,
      "not closed: 3 boundary edges, first between vertices %zu and %zu of triangle %zu; fill the hole", e.a,
      e.b, e.first);
  check_only(mesh, MeshDefect::open_edge, 3, e.first, text);
  const auto& t = mesh.triangles[e.first];
  CHECK(std::count(t.begin(), t.end(), e.a) == 1);
  CHECK(std::count(t.begin(), t.end(), e.b) == 1);
}

TEST_CASE("mesh: an edge with four triangles") {
  // Two tetrahedra that share the edge 0 1.
  Mesh mesh = tetrahedron();
  mesh.vertices.push_back(V(0, -1, 0));
  mesh.vertices.push_back(V(0, 0, -1));
  for (const auto& t : {std::array<std::uint32_t, 3>{0, 4, 1}, {0, 1, 5}, {0, 5, 4}, {1, 4, 5}})
    mesh.triangles.push_back(t);
  check_only(
      mesh, MeshDefect::non_manifold_edge, 1, 0,
      "1 edges have more than two triangles, first between vertices 0 and 1 of triangle 0; split the parts");
}

TEST_CASE("mesh: one triangle turned") {
  Mesh mesh = tetrahedron();
  std::swap(mesh.triangles[3][0], mesh.triangles[3][1]);
  check_only(mesh, MeshDefect::inconsistent_orientation, 3, 0,
             "3 edges join triangles of opposite orientation, first between vertices 1 and 2 of triangle 0; "
             "turn one");
}

TEST_CASE("mesh: two parts that share a vertex") {
  Mesh mesh = tetrahedron();
  for (const V& v : {V(-1, 0, 0), V(0, -1, 0), V(0, 0, -1)}) mesh.vertices.push_back(v);
  for (const auto& t : {std::array<std::uint32_t, 3>{0, 4, 5}, {0, 6, 4}, {0, 5, 6}, {4, 6, 5}})
    mesh.triangles.push_back(t);
  check_only(mesh, MeshDefect::non_manifold_vertex, 1, 0,
             "1 vertices join parts that touch there only, first vertex 0; split the vertex");
}

TEST_CASE("mesh: inside out, flat, nested and apart") {
  const char* text =
      "1 closed parts are inside out, overlap another or hold no volume, first with triangle %d; turn its "
      "triangles";
  char at_0[200], at_12[200];
  std::snprintf(at_0, sizeof at_0, text, 0);
  std::snprintf(at_12, sizeof at_12, text, 12);
  check_only(cube(V::Zero(), 0.5, true), MeshDefect::inside_out, 1, 0, at_0);
  check_only({{V(0, 0, 0), V(1, 0, 0), V(0, 1, 0)}, {{0, 1, 2}, {0, 2, 1}}}, MeshDefect::inside_out, 1, 0,
             at_0);
  // A cavity is turned inwards; a second body is not; a body in a cavity is not.
  CHECK(inspect(together(cube(), cube(V(0.1, 0, 0), 0.2, true))).valid());
  CHECK(inspect(together(cube(), cube(V(3, 0, 0), 0.2))).valid());
  CHECK(inspect(together(together(cube(), cube(V(0.1, 0, 0), 0.2, true)), cube(V(0.1, 0, 0), 0.1))).valid());
  check_only(together(cube(), cube(V(3, 0, 0), 0.2, true)), MeshDefect::inside_out, 1, 12, at_12);
  check_only(together(cube(), cube(V(0.1, 0, 0), 0.2)), MeshDefect::inside_out, 1, 12, at_12);
}

TEST_CASE("mesh: a larger part inside out whose first vertex is in a smaller one, which it runs through") {
  // The first vertex of each says nothing: the smaller part's is outside, the larger part's is inside.
  const Mesh small = cube(V::Zero(), 0.2), large = cube(V::Constant(0.5), 0.5, true);
  CHECK(large.vertices[0].cwiseAbs().maxCoeff() < 0.2);
  CHECK(inspect(together(small, large))[MeshDefect::inside_out].first == 12);
  CHECK(!inspect(together(large, small)).valid());
  // Nor does a third part far away hide it, by its volume or by where it stands.
  CHECK(!inspect(together(together(small, large), cube(V(9, 0, 0), 4))).valid());
  // The same size, and beyond the part that it is in by its first vertex.
  CHECK(!inspect(together(cube(V::Zero(), 0.5), cube(V::Constant(0.6), 0.45, true))).valid());
  // A cavity that touches the part's own walls is one.
  CHECK(inspect(together(cube(), cube(V(0.25, 0, 0), 0.25, true))).valid());
}

TEST_CASE("mesh: cavities that run through each other and take more than the part has") {
  // Each fits into the part and has its first vertex outside the others.
  const Mesh one = together(cube(), cube(V(0.05, 0.05, 0), 0.4, true));
  CHECK(inspect(one).valid());
  CHECK(!inspect(together(one, cube(V(-0.05, -0.04, 0), 0.4, true))).valid());
}

TEST_CASE_TEMPLATE("mesh: measures of a cube far from its origin", S, float, double) {
  const V centre(3, -2, 5);
  MeshData<S> data;
  for (const V& v : cube(centre).vertices) data.vertices.push_back(v.cast<S>());
  data.triangles = cube().triangles;
  const TriangleMesh<S> mesh(data);
  // Sums are in double; each result is rounded to S once, the vertices are exact.
  const auto close = test::ulps<S>(2);
  CHECK_RELATIVE(mesh.area(), 6.0, close);
  CHECK_RELATIVE(mesh.volume(), 1.0, close);
  for (int i = 0; i < 3; ++i) {
    CHECK_RELATIVE(mesh.centroid()[i], centre[i], close);
    CHECK(mesh.lower()[i] == static_cast<S>(centre[i] - 0.5));
    CHECK(mesh.upper()[i] == static_cast<S>(centre[i] + 0.5));
  }
  S sum = 0;
  for (std::size_t v = 0; v < 8; ++v) {
    sum += mesh.vertex_areas()[v];
    // Angle weighting gives the diagonal at a cube's corner, however its faces are cut.
    const Vec3<S> outward = (mesh.vertices()[v] - mesh.centroid()).normalized();
    CHECK_ABSOLUTE((mesh.vertex_normals()[v] - outward).norm(), 0,
                   test::ulps<S>(8));  // a few operations of size 1
  }
  CHECK_RELATIVE(sum, 6.0, test::ulps<S>(8));  // 8 roundings
}

TEST_CASE("mesh: measures of an ellipsoid converge with order 2") {
  const Ellipsoid<double> body({.axes = V(0.03, 0.02, 0.01), .centre = V(0.1, 0, 0)});
  double before = 0;
  for (const std::size_t n : {386u, 1538u, 6146u}) {  // each has edges half as long
    const TriangleMesh<double> mesh(body.mesh(n));
    const double error = 1 - mesh.volume() / body.volume();
    // The chord's error is proportional to the edge length squared: 4, and 10 % for the next order.
    if (before > 0) CHECK_RELATIVE(before / error, 4.0, 0.1);
    before = error;
    CHECK_ABSOLUTE((mesh.centroid() - body.params().centre).norm(), 0, 1e-15);  // by symmetry, to rounding
  }
}
