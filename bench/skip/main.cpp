// SPDX-License-Identifier: MIT

/// @file What an absent policy and an idle phase save. Compiled once with each COMPOSITION=name, so that the
/// program's size is that composition's: `palpate_bench_skip_NAME PHASE [normals]` prints scene, composition,
/// bytes of solver and deformation model, heap allocations and a checksum. bench/skip/run has callgrind count
/// the instructions of `counted`, exactly. A picture's normals are chosen at run time: one program for both.

#include "skip/headers.hpp"
#include "support/no_heap.hpp"

#include <cstdio>
#include <cstring>
#include <vector>

namespace {

using namespace palpate;

// Templates, so that a composition that is not asked for is not compiled.
template <class S>
struct Parts {
  using Body = Ellipsoid<S>;
  using Law = DuffingForce<S>;
  using Fibre = PowerLawFriction<S>;
  using Beams = Skeleton<S>;
  using Shape = BeamSkeletonDeformation<RegionSkeletons<Beams>, PhongInterpolation<S>>;

  static Body body() { return Body({.axes = Vec3<S>(S(0.06), S(0.04), S(0.04))}); }
  static Law law() { return Law({.c1 = 40, .c3 = S(3e8)}); }
  static Fibre fibre() { return Fibre({.K = S(0.562), .beta = S(0.75), .mu_dynamic = S(0.3)}); }
  /// n x n points 1 mm apart; `gap` [m] more in the middle: two regions where it is above 0.5 mm.
  static ToolPoints<S> face(S gap = 0, int n = 10) {
    std::vector<Vec3<S>> points;
    const S middle = S(n - 1) / 2;
    for (int i = 0; i < n * n; ++i) {
      const S apart = i % n < n / 2 ? -gap / 2 : gap / 2;
      points.emplace_back(S(1e-3) * (S(i % n) - middle) + apart, S(0), S(1e-3) * (S(i / n) - middle));
    }
    return ToolPoints<S>(points, std::vector<S>(points.size(), S(1e-6)), {.contact_area = S(1e-4)});
  }
  static RegionSkeletons<Beams> beams() {
    std::vector<Vec3<S>> ends;
    for (const auto& end : extremal_points(body())) ends.push_back(end.position);
    return RegionSkeletons<Beams>(
        Beams(ends, EulerBernoulli<double>(IsotropicElasticity<double>({.E = 1e5, .nu = 0.5})),
              VolumePreserving<double>({.volume = double(body().volume())})));
  }
  static Shape shape(bool normals) {
    const MeshData<S> mesh = body().mesh(2000);
    return Shape(beams(), PhongInterpolation<S>(make_partition(body(), mesh)), AreaNeighbourhood<S>({}), mesh,
                 {.fixed = Vec3<S>(S(0), S(-0.04), S(0)), .normals = normals});
  }
};

struct Nothing {  // moves the tool, and no more
  using Scalar = double;
  double tick(const Pose<double>& X) noexcept { return X.translation.y(); }
};
template <class Solver>
double force(Solver& solver, const Pose<double>& X) {
  if constexpr (std::is_same_v<Solver, Nothing>)
    return solver.tick(X);
  else
    return solver.tick(X).wrench.force.y();
}

/// A solver, and a deformation model that writes into a buffer; NoDeformation where the scene has no picture.
template <class Solver, class Shape = NoDeformation<double>>
struct Scene {
  Solver solver;
  Shape shape{};
  std::vector<float> positions{}, normals{};

  static constexpr std::size_t state_bytes = sizeof(Solver) + (Shape::active ? sizeof(Shape) : 0);

  void begin([[maybe_unused]] bool with_normals) {
    if constexpr (Shape::active) {
      positions.resize(3 * shape.field().partition().size());
      if (with_normals) normals.resize(positions.size());
      shape.write_rest(buffer());
    }
  }
  double tick(const Pose<double>& X) noexcept {
    double sum = force(solver, X);
    if constexpr (Shape::active) sum += double(shape.write(solver.contacts(), buffer()).vertices);
    return sum;
  }
  VertexBuffer<float> buffer() noexcept {
    return {.positions = positions.data(), .normals = normals.empty() ? nullptr : normals.data()};
  }
};

using None = Frictionless<double>;

struct none {
  template <class S>
  static auto make() {
    return Scene<Nothing>{{}};
  }
};
struct point {
  template <class S, class P = Parts<S>>
  static auto make() {
    return Scene<ContactSolver<typename P::Body, typename P::Law>>{
        ContactSolver<typename P::Body, typename P::Law>({P::body(), {}, P::law()})};
  }
};
template <class S, class Friction, class Contacts, class Acting = AtContact,
          class Coupling = IndependentRegions>
using Solver = ContactSolver<typename Parts<S>::Body, typename Parts<S>::Law, Friction, Contacts,
                             NoDeformation<S>, Acting, Coupling>;
struct point_at_mass_centre {
  template <class S, class P = Parts<S>>
  static auto make() {
    using T = Solver<S, typename P::Fibre, SinglePoint, AtMassCentre>;
    return Scene<T>{T({P::body(), {}, P::law(), P::fibre()})};
  }
};
struct point_friction {
  template <class S, class P = Parts<S>>
  static auto make() {
    using T = Solver<S, typename P::Fibre, SinglePoint>;
    return Scene<T>{T({P::body(), {}, P::law(), P::fibre()})};
  }
};
struct region {
  template <class S, class P = Parts<S>>
  static auto make() {
    using T = Solver<S, None, SingleRegion<AreaSharing>>;
    return Scene<T>{T({P::body(), P::face(), P::law()})};
  }
};
struct region_friction {
  template <class S, class P = Parts<S>>
  static auto make() {
    using T = Solver<S, typename P::Fibre, SingleRegion<AreaSharing>>;
    return Scene<T>{T({P::body(), P::face(), P::law(), P::fibre()})};
  }
};
template <class S>
using Several = Solver<S, typename Parts<S>::Fibre, Regions<8, AreaSharing>>;
struct regions_friction {
  template <class S, class P = Parts<S>>
  static auto make() {
    using T = Several<S>;
    return Scene<T>{T({P::body(), P::face(S(1e-3)), P::law(), P::fibre(), {1.5e-3}})};
  }
};
struct regions_coupled {
  template <class S, class P = Parts<S>>
  static auto make() {
    using T =
        Solver<S, typename P::Fibre, Regions<8, AreaSharing>, AtContact, RegionSkeletons<typename P::Beams>>;
    return Scene<T>{T({P::body(), P::face(S(1e-3)), P::law(), P::fibre(), {1.5e-3}, {}, P::beams()})};
  }
};
struct regions_shape {
  template <class S, class P = Parts<S>>
  static auto make(bool normals) {
    using T = Several<S>;
    return Scene<T, typename P::Shape>{T({P::body(), P::face(S(1e-3)), P::law(), P::fibre(), {1.5e-3}}),
                                       P::shape(normals)};
  }
};
template <class S, class Friction>
auto resolved_scene(const Friction& friction) {
  using Force = ElasticContact<S, HalfSpace>;
  using T = ContactSolver<typename Parts<S>::Body, Force, Friction, ContactPoints<64>>;
  return Scene<T>{T({Parts<S>::body(), Parts<S>::face(S(0), 6),
                     Force({.compliance = HalfSpace({.E = 1e5, .nu = 0.5})}), friction})};
}
struct resolved {
  template <class S>
  static auto make() {
    return resolved_scene<S>(None{});
  }
};
struct resolved_friction {
  template <class S>
  static auto make() {
    return resolved_scene<S>(Parts<S>::fibre());
  }
};

template <class Composition>
auto make(bool normals) {
  if constexpr (std::is_same_v<Composition, regions_shape>)
    return Composition::template make<double>(normals);
  else
    return Composition::template make<double>();
}

/// A hundred ticks.
template <class Scene>
[[gnu::noinline]] double counted(Scene& scene, bool resting, double height) {
  double sum = 0;
  Pose<double> X;
  for (int i = 0; i < 100; ++i) {
    X.translation = Vec3<double>(resting ? 0 : 1e-5 * i, height, 0);
    sum += scene.tick(X);
  }
  return sum;
}

template <class Composition>
int run(const char* composition, const char* phase, bool normals) {
  const bool contact = std::strcmp(phase, "contact") == 0;
  const bool resting = std::strcmp(phase, "nothing_moved") == 0;
  if (!contact && !resting && std::strcmp(phase, "out_of_reach") != 0) return 2;
  auto scene = make<Composition>(normals);
  scene.begin(normals);
  const palpate::test::HeapCount heap;
  // The first hundred are warming up: callgrind counts both, bench/skip/run takes the second.
  double sum = 0;
  for (int k = 0; k < 2; ++k) sum += counted(scene, resting, contact || resting ? 0.038 : 0.2);
  std::printf("%s,%s%s,%zu,%zu,%.12g\n", phase, composition, normals ? "_normals" : "", scene.state_bytes,
              heap.allocations(), sum);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const bool normals = argc == 3 && std::strcmp(argv[2], "normals") == 0;
  if (argc != (normals ? 3 : 2)) {
    std::fprintf(stderr, "usage: %s contact|nothing_moved|out_of_reach [normals]\n", argv[0]);
    return 2;
  }
#define NAME_OF(composition) #composition
#define NAME(composition) NAME_OF(composition)
  return run<COMPOSITION>(NAME(COMPOSITION), argv[1], normals);
}
