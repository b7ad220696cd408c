// SPDX-License-Identifier: MIT
// The seam for a host's tree, with a tree of our own behind it; other libraries' are in unit/adapters/.

#include <palpate/detection/candidates_from.hpp>

#include "contract/candidate_tree.hpp"

using namespace palpate;

namespace {

template <Real S>
struct OwnTree {
  const TriangleBvh<S>* bvh;
  bool touches(const Vec3<S>& c, S r) const noexcept {
    bool found = false;
    // More than the rounding of a distance: the body's tests may round the other way.
    const S guard = S(16) * std::numeric_limits<S>::epsilon() * (S(0.1) + c.cwiseAbs().maxCoeff() + r);
    bvh->overlap(c, r + guard, [&](const auto&) { found = true; });
    return found;
  }
};

template <Real S>
struct Host {
  explicit Host(const MeshData<S>& mesh) : bvh(mesh) {}
  OwnTree<S> tree() const { return {&bvh}; }
  void move(const std::vector<Vec3<S>>& positions) { bvh.move_all(positions); }
  TriangleBvh<S> bvh;
};

}  // namespace

TEST_CASE("candidates from a host's tree: none missed, same forces") {
  test::CandidateTreeSuite<Host<double>, double>().run();
}
