// SPDX-License-Identifier: MIT
// The scenes of Fig. 10 to 12, as examples/touch plays them, at the depth that the hand's spring holds: what
// the drawn shape must keep whatever the model gives (V.A.2, V.B, II).
#include "support/check.hpp"
#include "support/joined.hpp"
#include "touch/heart.hpp"

#include <palpate/geometry/mesh_surface.hpp>
#include <palpate/law/force/duffing.hpp>
#include <palpate/luo_xiao/beam_skeleton.hpp>
#include <palpate/luo_xiao/interpolation/linear.hpp>
#include <palpate/luo_xiao/interpolation/phong.hpp>
#include <palpate/solver/contact_solver.hpp>

#include <doctest/doctest.h>

using namespace palpate;

namespace {

using V = Vec3<double>;

struct Tool {
  MeshData<double> mesh;
  double contact_area, spacing;
};

MeshData<double> standing(MeshData<double> mesh) {
  double lowest = mesh.vertices.front().y();
  for (const V& v : mesh.vertices) lowest = std::min(lowest, v.y());
  for (V& v : mesh.vertices) v.y() -= lowest;
  return mesh;
}

Tool flat_face(double radius) {
  return {standing(Cylinder<double>({.radius = radius, .half_height = 10e-3}).mesh(1500)),
          3.14159265358979 * radius * radius, radius / 12};
}
Tool mallet() {
  return {standing(Superellipsoid<double>({.axes = V(12e-3, 8e-3, 12e-3)}).mesh(1000)), 1e-4, 1e-3};
}
Tool compass(bool both) {
  Tool tool{{}, 5e-5, 0.25e-3};
  for (const double x : {0.0, 36e-3}) {
    if (x > 0 && !both) continue;
    test::append<double>(tool.mesh, Sphere<double>({.radius = 2e-3, .centre = V(x, 2e-3, 0)}).mesh(400),
                         V::Zero());
  }
  return tool;
}

const DuffingForce<double> paper({.c1 = 40, .c3 = 3e8}), soft({.c1 = 100, .c3 = 1e7});

template <class Body>
Vec3<typename Body::Scalar> bottom(const Body& body) {
  using S = typename Body::Scalar;
  const Vec3<S> middle = (body.lower() + body.upper()) / S(2);
  return body.raycast(Vec3<S>(middle.x(), body.lower().y() - S(1), middle.z()), Vec3<S>::UnitY()).position;
}

/// The tool on the body, as deep as a hand of 300 N/m holds it that aims `press` [m] below the surface at x.
struct Pressed {
  Tool tool;
  Pose<double> pose;
  std::vector<V> points;  // of the tool, in object coordinates
  std::vector<ContactState<double>> contacts;
};
template <class Body>
Pressed press(const Body& body, Tool tool, const DuffingForce<double>& force, double x, double aim) {
  using Solver = ContactSolver<Body, DuffingForce<double>, Frictionless<double>, Regions<4>>;
  Solver solver({.object = body,
                 .tool = ToolPoints<double>(TriangleMesh<double>(tool.mesh),
                                            {.contact_area = tool.contact_area}, tool.spacing),
                 .force = force,
                 .contacts = {.distance = 2.5 * tool.spacing}});
  const V top = body.raycast(V(x, 1, 0), -V::UnitY()).position;
  Pressed result{std::move(tool), {}, {}, {}};
  double low = -aim, high = 0.02;
  for (int i = 0; i < 50; ++i) {
    const double y = (low + high) / 2;
    result.pose.translation = top + V(0, y, 0);
    (solver.tick(result.pose).wrench.force.y() < 300 * (aim + y) ? high : low) = y;
  }
  (void)solver.tick(result.pose);
  for (std::uint32_t i = 0; i < solver.tool().size(); ++i)
    result.points.push_back(result.pose * solver.tool().point(i));
  result.contacts.assign(solver.contacts().begin(), solver.contacts().end());
  REQUIRE(!result.contacts.empty());
  return result;
}

/// Displacements of a display mesh of 5,000 vertices, of points on rays from the first contact, and of o.
template <class D>
struct Drawn {
  MeshData<D> mesh;
  std::vector<Vec3<D>> u;
  std::size_t vertices;  // then rays times steps points, then o
  static constexpr std::size_t rays = 48, steps = 120;
  Vec3<D> position;  // of the first contact

  [[nodiscard]] double size(std::size_t i) const { return static_cast<double>(u[i].norm()); }
  [[nodiscard]] double fixed_moved() const { return size(u.size() - 1); }
  [[nodiscard]] double largest() const {
    double most = 0;
    for (std::size_t i = 0; i < u.size(); ++i) most = std::max(most, size(i));
    return most;
  }
  /// The most that |u| grows along a ray, from its least so far.
  [[nodiscard]] double rise() const {
    double most = 0;
    for (std::size_t ray = 0; ray < rays; ++ray) {
      double least = 1;
      for (std::size_t i = 0; i < steps; ++i) {
        const double here = size(vertices + ray * steps + i);
        least = std::min(least, here);
        most = std::max(most, here - least);
      }
    }
    return most;
  }
  /// How deep the tool stands in the drawn triangles.
  [[nodiscard]] double tool_inside(const Pressed& pressed) const {
    MeshData<double> drawn{{}, mesh.triangles};
    for (std::size_t i = 0; i < vertices; ++i)
      drawn.vertices.push_back((mesh.vertices[i] + u[i]).template cast<double>());
    const MeshSurface<double> surface{TriangleMesh<double>(drawn)};
    double deepest = 0;
    for (const V& x : pressed.points) deepest = std::max(deepest, surface.penetration(x).depth);
    return deepest;
  }
};

template <class I, class N, class Body>
Drawn<typename I::Scalar> draw(const Body& body, const Pressed& pressed, const N& neighbourhood) {
  using D = typename I::Scalar;
  Drawn<D> drawn;
  drawn.mesh = body.mesh(5000);
  drawn.vertices = drawn.mesh.vertices.size();
  std::vector<V> ends;
  Vec3<D> centre = Vec3<D>::Zero();
  const auto extremal = extremal_points(body);
  for (const auto& point : extremal) {
    ends.push_back(point.position.template cast<double>());
    centre += point.position / static_cast<D>(extremal.size());
  }
  drawn.position = body.closest(pressed.contacts[0].origin().template cast<D>()).position;
  const Vec3<D> to = (drawn.position - centre).normalized(), side = perpendicular<D>(to),
                other = to.cross(side);
  for (std::size_t ray = 0; ray < drawn.rays; ++ray) {
    for (std::size_t i = 0; i < drawn.steps; ++i) {
      const double turn = 6.283185307179586 * static_cast<double>(ray) / drawn.rays,
                   bend = 3.141592653589793 * static_cast<double>(i) / drawn.steps;
      const Vec3<D> d =
          D(std::cos(bend)) * to + D(std::sin(bend)) * (D(std::cos(turn)) * side + D(std::sin(turn)) * other);
      drawn.mesh.vertices.push_back(body.raycast(centre + d, -d).position);
    }
  }
  const Vec3<D> o = bottom(body);
  drawn.mesh.vertices.push_back(o);
  using Beams = RegionSkeletons<Skeleton<double>, CoupledRegions, 4>;
  const IsotropicElasticity<double> rubber({.E = 1e5, .nu = 0.5});
  BeamSkeletonDeformation<Beams, I, N> model(
      Beams(Skeleton<double>(ends, EulerBernoulli<double>(rubber),
                             VolumePreserving<double>({.volume = static_cast<double>(body.volume())}))),
      I(make_partition(body, drawn.mesh, o)), neighbourhood, drawn.mesh,
      {.fixed = o.template cast<double>(), .normals = false});
  std::vector<D> x(3 * drawn.mesh.vertices.size());
  model.write_rest(VertexBuffer<D>{.positions = x.data()});
  model.write(pressed.contacts, VertexBuffer<D>{.positions = x.data()});
  for (std::size_t i = 0; i < drawn.mesh.vertices.size(); ++i)
    drawn.u.push_back(Vec3<D>(x[3 * i], x[3 * i + 1], x[3 * i + 2]) - drawn.mesh.vertices[i]);
  return drawn;
}

template <class D>
AreaNeighbourhood<D> by_area() {
  return AreaNeighbourhood<D>({.reference_area = D(1e-4)});  // as examples/touch
}

/// The body as the force sees it, and as it is drawn.
template <class I, class Body, class Display>
void check_scene(const std::string& name, const Body& body, const Display& display, const Pressed& pressed,
                 double most_rise) {
  using D = typename I::Scalar;
  INFO(name);
  const auto drawn = draw<I>(display, pressed, by_area<D>());
  double depth = 0, D_least = 1;
  for (const auto& contact : pressed.contacts) {
    depth = std::max(depth, contact.depth);
    D_least = std::min(D_least, contact.depth);  // IV.B: D ends at the point of largest deformation
  }
  const double noise =
      static_cast<double>(test::ulps<D>(8)) * (body.upper() - body.lower()).norm();  // of position - position
  const double inside = drawn.tool_inside(pressed), rise = drawn.rise();
  MESSAGE(name, ": D ", 1e3 * D_least, " mm, tool's depth ", 1e3 * depth, " mm, largest displacement ",
          1e3 * drawn.largest(), " mm, rise ", rise / depth, " of the depth, tool inside by ",
          inside / D_least, " D");
  CHECK(drawn.largest() <= depth + noise);
  // At the contact; a face that is level to 0.002 degree is a thousandth of its depth deeper at its rim.
  CHECK(drawn.largest() <= drawn.size(drawn.vertices) + 1e-3 * depth + noise);
  CHECK(drawn.fixed_moved() <= noise);
  CHECK(inside <= 0.05 * D_least + noise);
  if (pressed.contacts.size() == 1) CHECK(rise <= most_rise * depth + noise);
}

const Box<double> cube({.half = V(50e-3, 50e-3, 50e-3)});
const Box<float> cube_f({.half = {50e-3f, 50e-3f, 50e-3f}});
const Ellipsoid<double> ellipsoid({.axes = V(0.06, 0.04, 0.04)});
const Ellipsoid<float> ellipsoid_f({.axes = {0.06f, 0.04f, 0.04f}});

// In a face the linear field of a dent that turns into a bulge passes through zero, and rises to the bulge,
// which is at most w a/l of D (a/l <= 1/5 here). Phong's passes through a stretch where the direction of u is
// undefined and its fall-back shortens u, at up to half of D: most where a corner bulges next to the mallet.
constexpr double linear_rise = 0.1, phong_rise = 0.2;

template <class Body, class Display>
void check_all(const std::string& name, const Body& body, const Display& display, const Pressed& pressed) {
  using D = typename Display::Scalar;
  check_scene<LinearInterpolation<D>>(name, body, display, pressed, linear_rise);
  check_scene<PhongInterpolation<D>>(name, body, display, pressed, phong_rise);
}

}  // namespace

TEST_CASE("Fig. 11, head and tail on a cube: nothing moves more than under the tool, which stays outside") {
  const Pressed head = press(cube, flat_face(30e-3), paper, 0, 6.2e-3),
                tail = press(cube, flat_face(10e-3), paper, 0, 6.2e-3);
  check_all("head, double", cube, cube, head);
  check_all("head, float", cube, cube_f, head);
  check_all("tail, double", cube, cube, tail);
  check_all("tail, float", cube, cube_f, tail);
}

TEST_CASE("Fig. 10, a mallet along an ellipsoid: the same at five positions of its path") {
  for (const double x : {-0.036, -0.02, 0.0, 0.01, 0.03}) {
    const Pressed pressed = press(ellipsoid, mallet(), paper, x, 8e-3);
    check_all("mallet, double", ellipsoid, ellipsoid, pressed);
    check_all("mallet, float", ellipsoid, ellipsoid_f, pressed);
  }
}

TEST_CASE("Fig. 12, a compass on a heart: the same with one pin, and with both") {
  const touch::Heart heart({});
  const Pressed one = press(heart, compass(false), soft, -18e-3, 6e-3),
                both = press(heart, compass(true), soft, -18e-3, 6e-3);
  REQUIRE(both.contacts.size() == 2);
  check_all("one pin", heart, heart, one);
  check_all("both pins", heart, heart, both);
}

TEST_CASE("under a flat face the surface is the face; a body that curves away from it stays below") {
  const auto check = [](const auto& body, const Pressed& pressed, double radius, bool is_flat) {
    const auto drawn = draw<PhongInterpolation<double>>(body, pressed, by_area<double>());
    // Of a vertex: a plane that is level to 0.1 degree over the head's 30 mm, in a mesh of 3.5 mm.
    const double face = pressed.pose.translation.y(), tolerance = 0.05 * pressed.contacts[0].depth;
    std::size_t seen = 0;
    for (std::size_t i = 0; i < drawn.vertices; ++i) {
      const V& v = drawn.mesh.vertices[i];
      if (v.y() < face || std::hypot(v.x(), v.z()) > radius) continue;  // not under the face
      const double y = (v + drawn.u[i]).y();
      ++seen;
      CHECK(y <= face + tolerance);
      if (is_flat) CHECK_ABSOLUTE(y, face, tolerance);
    }
    CHECK(seen >= 20);
    const V at_contact = drawn.position + drawn.u[drawn.vertices];
    CHECK_ABSOLUTE(at_contact.y(), face, tolerance);
  };
  check(cube, press(cube, flat_face(30e-3), paper, 0, 6.2e-3), 30e-3, true);
  check(cube, press(cube, flat_face(10e-3), paper, 0, 6.2e-3), 10e-3, true);
  // At rest 0.8 mm lower 8 mm from its top.
  check(ellipsoid, press(ellipsoid, flat_face(30e-3), paper, 0, 2e-3), 8e-3, false);
}

TEST_CASE("the printed form: w D at the contact, a hill beside it, and the tool stands in it") {
  const Pressed tail = press(cube, flat_face(10e-3), paper, 0, 6.2e-3);
  using Printed = Printed<AreaNeighbourhood<double>>;
  const auto drawn = draw<PhongInterpolation<double>>(cube, tail, Printed({.reference_area = 1e-4}));
  const auto& contact = tail.contacts[0];
  const double D = contact.displacement.norm(), w = by_area<double>().factor({.area = contact.area});
  CHECK_RELATIVE(drawn.size(drawn.vertices), w * D, 1e-3);  // p0 is a fifth of a millimetre off the axis
  CHECK(drawn.largest() > 1.2 * w * D);                     // 0.71 and 0.90 mm in the paper's scene
  CHECK(drawn.tool_inside(tail) > 0.5 * (1 - w) * D);
}

TEST_CASE("without o as a corner the cube's bottom centre moves with the corners around it") {
  const Pressed head = press(cube, flat_face(30e-3), paper, 0, 6.2e-3);
  const MeshData<double> mesh = cube.mesh(100);
  CHECK(make_partition(cube, mesh).points().size() == 8);
  const auto partition = make_partition(cube, mesh, bottom(cube));
  REQUIRE(partition.points().size() == 9);
  CHECK(partition.points()[8].position == bottom(cube));
  CHECK(partition.points()[8].normal.dot(-V::UnitY()) > 0.999);
  CHECK(make_partition(cube, mesh, V(0, 0, 0)).points().size() == 8);                             // inside
  CHECK(make_partition(ellipsoid, ellipsoid.mesh(100), bottom(ellipsoid)).points().size() == 6);  // is one
}
