// SPDX-License-Identifier: MIT
// Policies of the beam skeleton and its shape that a user wrote, as docs/extending.md shows them.
#include "support/check.hpp"
#include "support/no_heap.hpp"

#include <palpate/geometry/box.hpp>
#include <palpate/geometry/cylinder.hpp>
#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/luo_xiao/beam/rectangular_section.hpp>
#include <palpate/luo_xiao/beam/timoshenko.hpp>
#include <palpate/luo_xiao/beam_skeleton.hpp>
#include <palpate/luo_xiao/interpolation/linear.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <concepts>
#include <random>
#include <type_traits>
#include <vector>

using namespace palpate;
using palpate::test::ulps;

namespace {

using V = Vec3<double>;

// [extending]
struct SquareSection {  // a cross-section: a square of half width a, shear as at nu = 0
  using Scalar = double;
  double a;  // m
  double area() const noexcept { return 4 * a * a; }
  double second_moment_y() const noexcept { return a * a * area() / 3; }
  double second_moment_z() const noexcept { return second_moment_y(); }
  palpate::FlexureShear<double> flexure_shear(double, double y, double) const noexcept {
    return {1.5 * (1 - y * y / (a * a)) / area(), 0};
  }
};
// [extending]
static_assert(BeamSection<SquareSection>);

// [extending]
struct ShearBeam {  // a beam theory: across it shear alone, F_y = G S y / l, for beams as thick as long
  using Scalar = double;
  palpate::IsotropicElasticity<double> elastic;
  template <palpate::BeamSection C>
  double axial_stiffness(const C& section, double length) const noexcept {
    return elastic.params().E * section.area() / length;
  }
  template <palpate::BeamSection C>
  double transverse_stiffness(const C& section, double length) const noexcept {
    return elastic.shear_modulus() * section.area() / length;
  }
  template <palpate::BeamSection C>
  double deflection(const C& section, double, double F_y, double x) const noexcept {
    return F_y * x / (elastic.shear_modulus() * section.area());
  }
  const palpate::IsotropicElasticity<double>& material() const noexcept { return elastic; }
};
// [extending]
static_assert(BeamTheory<ShearBeam>);

// [extending]
struct TenthOfLength {  // a section rule: squares as wide as a tenth of the beams' mean length
  using Section = SquareSection;
  double beams;
  Section section(double total_length) const noexcept {
    return {0.05 * (std::max)(total_length, 1e-3) / beams};
  }
};
// [extending]
static_assert(SectionRule<TenthOfLength>);

// [extending]
struct EqualShares {  // a load sharing: every beam carries F / n; d is D
  static bool share(std::span<palpate::SkeletonBeam> beams, const V& F, const V& D, V& d) noexcept {
    for (palpate::SkeletonBeam& beam : beams) beam.force = F / double(beams.size());
    d = D;
    return true;
  }
};
// [extending]
static_assert(LoadSharing<EqualShares>);

// [extending]
struct HalfBeams {  // how contacts couple: any two that press share half a beam
  static constexpr bool coupled = true;
  static double share_of_beam(double N_j, double N_k) noexcept { return N_j > 0 && N_k > 0 ? 0.5 : 0; }
};
// [extending]
static_assert(RegionCoupling<HalfBeams>);

// [extending]
struct Halved {  // a local neighbourhood: half of the dent around a contact of several points, from 5 mm on
  using Scalar = double;
  static constexpr bool active = true;
  static constexpr auto form = palpate::NeighbourhoodForm::tool_face;
  using Contact = palpate::ContactDisplacement<double>;
  double factor(const Contact& contact) const noexcept { return contact.points > 1 ? 0.5 : 1; }
  double radius(const Contact&) const noexcept { return 5e-3; }
};
// [extending]
static_assert(Neighbourhood<Halved>);

// [extending]
struct Quadratic {  // an interpolation: u = sum w^2 u / sum w^2, flat at the corners
  using Scalar = double;
  V displacement(std::span<const double> weights, std::span<const palpate::FaceCorner<double>> corners,
                 const V& /*normal*/) const noexcept {
    V u = V::Zero();
    double sum = 0;
    for (std::size_t k = 0; k < weights.size(); ++k) {
      u += weights[k] * weights[k] * corners[k].displacement;
      sum += weights[k] * weights[k];
    }
    return u / sum;
  }
};
// [extending]
static_assert(VertexInterpolation<Quadratic> && Interpolation<Quadratic> && !BlockInterpolation<Quadratic>);

template <Real S>
struct Linear {
  using Scalar = S;
  Vec3<S> displacement(std::span<const S> weights, std::span<const FaceCorner<S>> corners,
                       const Vec3<S>& /*normal*/) const noexcept {
    Vec3<S> u = Vec3<S>::Zero();
    for (std::size_t k = 0; k < weights.size(); ++k) u += weights[k] * corners[k].displacement;
    return u;
  }
};

const IsotropicElasticity<double> rubber({.E = 1e5, .nu = 0.3});

template <class Body>
std::vector<V> ends_of(const Body& body) {
  std::vector<V> ends;
  for (const auto& point : extremal_points(body)) ends.push_back(point.position);
  return ends;
}

template <class Body>
void check_linear(const Body& body) {
  using S = typename Body::Scalar;
  const MeshData<S> mesh = body.mesh(700);
  const AreaNeighbourhood<S> local({.reference_area = S(1e-6), .radius = S(0.01)});
  DisplacementField<LinearInterpolation<S>> shipped(LinearInterpolation<S>(make_partition(body, mesh)), local,
                                                    mesh);
  DisplacementField<Linear<S>> own({make_partition(body, mesh), Linear<S>{}}, local, mesh);
  std::mt19937_64 random(33);
  INFO("seed 33");
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vector = [&](double size) {
    const double x = unit(random), y = unit(random), z = unit(random);
    return Vec3<S>(S(size * x), S(size * y), S(size * z));
  };
  std::vector<S> a(3 * mesh.vertices.size()), b(a.size());
  shipped.write_rest(VertexBuffer<S>{.positions = a.data()});
  own.write_rest(VertexBuffer<S>{.positions = b.data()});
  std::size_t count = 0;
  for (int tick = 0; tick < 20; ++tick) {
    std::vector<ContactDisplacement<S>> contacts;
    for (int c = 0; c < 1 + tick % 3; ++c) {
      const auto at = body.closest(vector(0.05));
      contacts.push_back({at.position, at.normal, vector(3e-3), S(1e-5)});
    }
    std::vector<Vec3<S>> corners(contacts.size() * extremal_points(body).size());
    for (Vec3<S>& u : corners) u = vector(1e-3);
    const auto expected = shipped.write(contacts, corners, VertexBuffer<S>{.positions = a.data()});
    const auto found = own.write(contacts, corners, VertexBuffer<S>{.positions = b.data()});
    CHECK(found.vertices == expected.vertices);
    count += found.vertices;
    // Sums of up to nine products for each of three contacts, in another order; positions below 0.1 m.
    for (std::size_t i = 0; i < a.size(); ++i) CHECK_ABSOLUTE(b[i], a[i], ulps<S>(4) * 0.1);
  }
  CHECK(count > mesh.vertices.size());
}

}  // namespace

TEST_CASE("the user's section and beam: the shipped ones' values where they are the same") {
  const RectangularSection<double> square({.half_y = 0.003, .half_z = 0.003});
  const SquareSection own{0.003};
  CHECK_RELATIVE(own.area(), square.area(), ulps<double>(2));
  CHECK_RELATIVE(own.second_moment_z(), square.second_moment_z(), ulps<double>(4));
  CHECK_RELATIVE(own.flexure_shear(0, 0.001, 0).yx, square.flexure_shear(0, 0.001, 0).yx, ulps<double>(8));
  // Timoshenko's beam with kappa = 1 tends to it where it is much thicker than long: 4 (l / 2a)^2 / (12 E /
  // G).
  const Timoshenko<double> thick(rubber, 1.0);
  CHECK_RELATIVE(ShearBeam{rubber}.transverse_stiffness(own, 1e-6), thick.transverse_stiffness(own, 1e-6),
                 1e-6);
  CHECK_RELATIVE(
      ShearBeam{rubber}.deflection(own, 0.01, 2.0, 0.01) * ShearBeam{rubber}.transverse_stiffness(own, 0.01),
      2.0, ulps<double>(4));
}

TEST_CASE("the user's theory, section rule and sharing make a skeleton; his coupling joins contacts") {
  const Ellipsoid<double> body({.axes = {0.03, 0.02, 0.025}});
  using Own = Skeleton<double, ShearBeam, TenthOfLength, EqualShares>;
  static_assert(ContactSkeleton<Own>);
  const Own skeleton(ends_of(body), ShearBeam{rubber}, TenthOfLength{6});
  typename Own::Load load;
  const V F(0.1, -1, 0.2);
  skeleton.share({.position = V(0.01, 0.018, 0), .force = F, .displacement = V(0, -1e-3, 0)}, load);
  REQUIRE(load.shared);
  for (const auto& beam : load.beams) CHECK((beam.force - F / 6).norm() == 0);

  const RegionSkeletons<Own, HalfBeams> regions(skeleton);
  const std::vector<SkeletonContact<double>> contacts{
      {.position = V(0.01, 0.018, 0), .force = F, .normal_force = 1},
      {.position = V(-0.01, 0.018, 0), .force = F, .normal_force = 0.1},
      {.position = V(0, 0.018, 0.01), .force = F, .normal_force = 0}};
  typename RegionSkeletons<Own, HalfBeams>::Result result;
  regions.share(contacts, result);
  REQUIRE(result.shared);
  CHECK(result.from_others[0].norm() > 0);
  CHECK(result.from_others[1].norm() > 0);
  CHECK(result.from_others[2].norm() == 0);  // it does not press: no beam to the others
}

TEST_CASE("the user's linear interpolation of one vertex gives the shipped one's field to rounding") {
  SUBCASE("triangles, float") { check_linear(Ellipsoid<float>({.axes = {0.03F, 0.02F, 0.025F}})); }
  SUBCASE("triangles, double") { check_linear(Ellipsoid<double>({.axes = {0.03, 0.02, 0.025}})); }
  SUBCASE("quadrilaterals, float") { check_linear(Box<float>({})); }
  SUBCASE("quadrilaterals, double") { check_linear(Box<double>({})); }
  SUBCASE("polygons, double") { check_linear(Cylinder<double>({})); }
}

TEST_CASE("types are deduced from parts; a user's interpolation is given with its partition") {
  const Ellipsoid<double> body({.axes = {0.03, 0.02, 0.025}});
  const MeshData<double> mesh = body.mesh(100);
  const auto partition = make_partition(body, mesh);
  const DisplacementField shipped(LinearInterpolation<double>(partition), Halved{}, mesh);
  static_assert(
      std::same_as<std::remove_cvref_t<decltype(shipped.interpolation())>, LinearInterpolation<double>>);
  const DisplacementField own(InterpolationBlocks(partition, Quadratic{}), Halved{}, mesh, {.contacts = 2});
  static_assert(
      std::same_as<std::remove_cvref_t<decltype(own.interpolation())>, InterpolationBlocks<Quadratic>>);
  CHECK(own.params().contacts == 2);
}

TEST_CASE("the user's policies together draw a shape, without the heap") {
  const Ellipsoid<double> body({.axes = {0.03, 0.02, 0.025}});
  MeshData<double> mesh = body.mesh(500);
  const SurfacePoint<double> top = body.closest(V(0.01, 0.03, 0.004));
  mesh.vertices.push_back(top.position);
  using Beams = RegionSkeletons<Skeleton<double, ShearBeam, TenthOfLength, EqualShares>, HalfBeams>;
  using Model = BeamSkeletonDeformation<Beams, Quadratic, Halved>;
  static_assert(DeformationModel<Model>);
  Model model(Beams({ends_of(body), ShearBeam{rubber}, TenthOfLength{6}}),
              {make_partition(body, mesh), Quadratic{}}, Halved{}, mesh,
              {.fixed = V(0, -0.02, 0), .normals = false});
  std::vector<double> x(3 * mesh.vertices.size());
  const VertexBuffer<double> out{.positions = x.data()};
  model.write_rest(out);
  ContactState<double> contact{};
  contact.points = 2;
  contact.normal = top.normal;
  contact.displacement = -2e-3 * top.normal;
  contact.centre = top.position + contact.displacement;
  contact.force = 0.5 * top.normal;
  contact.normal_force = 0.5;
  const test::HeapCount heap;
  const auto moved = model.write({&contact, 1}, out);
  CHECK(heap.allocations() == 0);
  CHECK(moved.vertices > mesh.vertices.size() / 2);
  // Under the tool the surface is the tool's face, whatever the user's w.
  const V at(x[x.size() - 3], x[x.size() - 2], x[x.size() - 1]);
  CHECK((at - top.position - contact.displacement).norm() <= ulps<double>(40) * 0.03);
}
