// SPDX-License-Identifier: MIT
#pragma once

/// @file What every candidate tree must keep (detection/candidates_from.hpp): on random scenes no point that
/// touches is missed, and a solver that takes its candidates from the tree gives what it gives with our own
/// search.
///
/// A host is a type with
///     explicit Host(const MeshData<S>& mesh);         // builds its tree
///     auto tree();                                    // the CandidateTree over it
///     void move(const std::vector<Vec3<S>>& positions);  // refits it to a deformed mesh

#include "support/check.hpp"
#include "support/meshes.hpp"
#include "support/no_heap.hpp"
#include "support/paths.hpp"

#include <palpate/detection/candidates.hpp>
#include <palpate/detection/candidates_from.hpp>
#include <palpate/geometry/deformed_surface.hpp>
#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/geometry/mesh_surface.hpp>
#include <palpate/law/force/linear.hpp>
#include <palpate/law/friction/coulomb.hpp>
#include <palpate/solver/contact_solver.hpp>

#include <cstddef>
#include <random>
#include <string>
#include <vector>

namespace palpate::test {

template <class Host, Real S>
class CandidateTreeSuite {
 public:
  void run() {
    for (const auto& [name, data] : five_meshes<S>(500)) {
      INFO(std::string(name));
      const TriangleMesh<S> mesh(data);
      const MeshSurface<S> body(mesh);
      Host host(data);
      undeformed(mesh, body, host);
      deformed(mesh, body, host);
    }
    CHECK(deep_ > 100);
    CHECK(too_small_a_margin_ > 0);  // or the scenes cannot show a miss
    exact_body();
    bad_input();
  }

 private:
  using V = Vec3<S>;

  struct Seen {
    int poses = 0, clear = 0, touching = 0, deep = 0, missed = 0, other_result = 0;
    std::size_t own = 0, theirs = 0, heap = 0;
  };

  /// A body without a search of its own: what a host may have.
  template <class B>
  struct DepthOnly {
    using Scalar = S;
    B body;
    SurfacePoint<S> closest(const V& x) const noexcept { return body.closest(x); }
    Penetration<S> penetration(const V& x) const noexcept { return body.penetration(x); }
    void penetration(const PointBatch<S>& x, PenetrationBatch<S>& in) const noexcept {
      body.penetration(x, in);
    }
    S reach() const noexcept { return body.reach(); }
  };

  /// The answers themselves, against the distance to the mesh as it is now.
  void distances(const TriangleBvh<S>& mesh, const MeshData<S>& around, Host& host) {
    std::uniform_real_distribution<double> unit(0, 1);
    // Own arithmetic and that of a tree in float: 100 ulp of the largest coordinate.
    const S rounding = S(100) * S(std::numeric_limits<float>::epsilon()) * S(0.1);
    int wrong = 0, near = 0, apart = 0;
    for (int i = 0; i < 500; ++i) {
      const V c = random_position(around, random_);
      const S d = std::sqrt(mesh.closest(c).distance2);
      const S r = S(2 * unit(random_)) * d, away = std::abs(d - r);
      const bool touches = host.tree().touches(c, r);
      wrong += away > rounding && touches != (d < r);
      (d < r ? near : apart) += 1;
    }
    CHECK(wrong == 0);
    int lost = 0;  // a few points in a thousand, where boxes are too small
    for (int i = 0; i < 5000; ++i) {
      const auto& t = mesh.triangles()[random_() % mesh.triangles().size()];
      const S a = S(unit(random_)), b = (S(1) - a) * S(unit(random_));
      const auto v = mesh.vertices();
      lost += !host.tree().touches(V(a * v[t[0]] + b * v[t[1]] + (S(1) - a - b) * v[t[2]]), S(0));
    }
    CHECK(lost == 0);
    CHECK(near > 100);
    CHECK(apart > 100);
  }

  void undeformed(const TriangleMesh<S>& mesh, const MeshSurface<S>& body, Host& host) {
    distances(body.bvh(), mesh.data(), host);
    const DepthOnly<MeshSurface<S>> without_search{body};
    for (const ToolPoints<S>& tool : {ball(mesh), pin(mesh)}) {
      const Seen seen = compare(body, CandidatesFrom(without_search, host.tree()), tool, mesh, 120);
      require_equal(seen);
      CHECK(seen.touching > seen.poses / 5);
      CHECK(seen.clear > seen.poses / 20);
      deep_ += seen.deep;
      CHECK(seen.theirs < seen.own + seen.own / 10);  // and not by taking every point
    }
  }

  /// Waves of a tenth of the body's size, in all directions, so that vertices also move along the surface.
  void deformed(const TriangleMesh<S>& mesh, const MeshSurface<S>& body, Host& host) {
    std::uniform_real_distribution<double> phase(0, 6);
    const S height = S(0.05) * size(mesh), wave = S(8) / size(mesh), turn = S(phase(random_));
    std::vector<V> positions = mesh.vertices();
    S largest = S(0);
    for (V& v : positions) {
      const V u = height * V(std::sin(wave * v.y() + turn), std::cos(wave * v.z()), std::sin(wave * v.x()));
      largest = (std::max)(largest, u.norm());
      v += u;
    }
    const DepthOnly<MeshSurface<S>> without_search{body};
    DeformedSurface<MeshSurface<S>> now(body, mesh);
    now.update(positions);
    host.move(positions);
    distances(now.tree(), mesh.data(), host);
    for (const ToolPoints<S>& tool : {ball(mesh), pin(mesh)}) {
      // Depth of the undeformed shape, then with what has bulged out.
      require_equal(compare(body, CandidatesFrom(without_search, host.tree(), largest), tool, mesh, 30));
      require_equal(compare(now, CandidatesFrom(now, host.tree(), 2 * largest), tool, mesh, 30));
      too_small_a_margin_ +=
          compare(body, CandidatesFrom(without_search, host.tree()), tool, mesh, 30).missed;
    }
    host.move(mesh.vertices());
    distances(body.bvh(), mesh.data(), host);
    require_equal(compare(body, CandidatesFrom(without_search, host.tree()), pin(mesh), mesh, 30));
  }

  /// An exact body beside a coarse mesh of it; its points at once are handed on.
  void exact_body() {
    const Ellipsoid<S> egg({.axes = V(S(0.06), S(0.03), S(0.02))});
    const TriangleMesh<S> mesh(egg.mesh(800));
    S chord = S(0);
    for (const auto& t : mesh.triangles()) {
      const V middle = (mesh.vertices()[t[0]] + mesh.vertices()[t[1]] + mesh.vertices()[t[2]]) / S(3);
      chord = (std::max)(chord, std::abs(egg.closest(middle).distance));
    }
    Host host(mesh.data());
    // Twice: between vertices the middle of a triangle need not be the farthest point.
    const CandidatesFrom theirs(egg, host.tree(), 2 * chord);
    static_assert(HasPenetrationBatch<Ellipsoid<S>> && HasPenetrationBatch<decltype(theirs)>);
    require_equal(compare(egg, theirs, ball(mesh), mesh, 120));
  }

  void bad_input() {
    const Sphere<S> body({.radius = S(0.03)});
    Host host(body.mesh(200));
    CandidatesFrom theirs(body, host.tree(), S(0.001));
    const S nan = std::numeric_limits<S>::quiet_NaN();
    const V far(S(0.1), S(0), S(0));
    CHECK(theirs.separated(far, S(0.01)));
    CHECK(!theirs.separated(far, S(0.08)));
    CHECK(theirs.separated(V::Constant(S(1e6)), S(0.01)));
    CHECK(!theirs.separated(V::Zero(), S(0.001)));  // no triangle near: inside
    CHECK(!theirs.separated(V(nan, S(0), S(0)), S(0.01)));
    CHECK(!theirs.separated(far, nan));
    CHECK(!theirs.separated(far, S(-0.01)));
    for (const S margin : {nan, S(-1), std::numeric_limits<S>::infinity()}) {
      theirs.set_margin(margin);
      CHECK(!theirs.separated(far, S(0.01)));
      CHECK_THROWS_AS(CandidatesFrom(body, host.tree(), margin), SetupError);
    }
    theirs.set_margin(S(0.09));
    CHECK(!theirs.separated(far, S(0)));
    theirs.set_margin(S(0));
    CHECK(theirs.separated(far, S(0.01)));
  }

  static void require_equal(const Seen& seen) {
    CHECK(seen.missed == 0);
    // To the bit: only leaves with a touching point are added up, by the body's depths and in the same order.
    CHECK(seen.other_result == 0);
    CHECK(seen.heap == 0);
  }

  template <class Own, class Theirs>
  Seen compare(const Own& own, const Theirs& theirs, const ToolPoints<S>& tool, const TriangleMesh<S>& mesh,
               int poses) {
    static_assert(ContactSurface<Theirs>);
    const LinearForce<S> law({.k = S(200)});
    const CoulombFriction<S> dry({.mu_static = S(0.5), .mu_dynamic = S(0.3)});
    using Contacts = SingleRegion<AreaSharing>;
    ContactSolver<Own, LinearForce<S>, CoulombFriction<S>, Contacts> solver({own, tool, law, dry, {}, {}});
    ContactSolver<Theirs, LinearForce<S>, CoulombFriction<S>, Contacts> other(
        {theirs, tool, law, dry, {}, {}});
    Seen seen;
    seen.poses = poses;
    std::vector<bool> candidate(tool.size());
    for (int i = 0; i < poses; ++i) {
      const Pose<S> X = pose(mesh);
      std::fill(candidate.begin(), candidate.end(), false);
      std::size_t count = 0;
      for_each_candidate(tool, X, theirs, [&](std::uint32_t k, const V&) {
        candidate[k] = true;
        ++count;
      });
      for_each_candidate(tool, X, own, [&](std::uint32_t, const V&) { ++seen.own; });
      seen.theirs += count;
      S deepest = S(0);
      for (std::size_t k = 0; k < tool.size(); ++k) {
        const S depth = own.penetration(X * tool.point(k)).depth;
        deepest = (std::max)(deepest, depth);
        seen.missed += depth > S(0) && !candidate[k];
      }
      seen.clear += count == 0;
      seen.touching += deepest > S(0);
      seen.deep += deepest > own.reach() / S(2);
      const auto mine = solver.tick(X);
      const HeapCount heap;
      const auto result = other.tick(X);
      seen.heap += heap.allocations();
      seen.other_result += result.wrench.force != mine.wrench.force ||
                           result.wrench.torque != mine.wrench.torque || result.status != mine.status;
    }
    return seen;
  }

  static S size(const TriangleMesh<S>& mesh) { return (mesh.upper() - mesh.lower()).maxCoeff(); }

  static ToolPoints<S> ball(const TriangleMesh<S>& mesh) {
    return ToolPoints<S>(TriangleMesh<S>(Sphere<S>({.radius = S(0.2) * size(mesh)}).mesh(200)),
                         {.contact_area = S(1e-4)});
  }
  /// A row of points, longer than the body is thick.
  static ToolPoints<S> pin(const TriangleMesh<S>& mesh) {
    std::vector<V> points;
    for (int i = 0; i < 100; ++i) points.push_back(V(S(0), S(0.008) * S(i) * size(mesh), S(0)));
    return ToolPoints<S>(points, std::vector<S>(points.size(), S(1e-6)), {.contact_area = S(1e-4)});
  }

  Pose<S> pose(const TriangleMesh<S>& mesh) {
    std::uniform_real_distribution<double> unit(-1, 1);
    Pose<S> X;
    const V axis(S(unit(random_)), S(unit(random_)), S(unit(random_)));
    X.rotation = rotation_about<S>(unit_or<S>(axis, V::UnitX()), S(3) * S(unit(random_)));
    X.translation = random_position(mesh.data(), random_);
    return X;
  }

  std::mt19937_64 random_{20051121};  // fixed seed
  int deep_ = 0, too_small_a_margin_ = 0;
};

}  // namespace palpate::test
