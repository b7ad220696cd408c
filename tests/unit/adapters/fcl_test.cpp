// SPDX-License-Identifier: MIT
// First the header, so that it is seen to compile alone.
#include <palpate/adapters/fcl.hpp>

#include <fcl/math/bv/utility.h>

#include "contract/candidate_tree.hpp"

using namespace palpate;

namespace {

template <class BV>
struct Host {
  using F = typename BV::S;

  template <Real S>
  explicit Host(const MeshData<S>& mesh) {
    std::vector<fcl::Triangle> triangles;
    for (const auto& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
    model.beginModel();
    model.addSubModel(cast(mesh.vertices), triangles);
    model.endModel();
  }
  FclTree<BV> tree() const { return FclTree<BV>(model); }
  /// By turns the three ways that FclTree's docstring allows.
  template <Real S>
  void move(const std::vector<Vec3<S>>& positions) {
    const bool bottom_up = std::same_as<BV, fcl::AABB<F>>;
    if (moves++ % 2 == 0) {
      model.beginReplaceModel();
      model.replaceSubModel(cast(positions));
      model.endReplaceModel(true, bottom_up);
    } else {
      model.beginUpdateModel();
      model.updateSubModel(cast(positions));
      model.endUpdateModel(true, bottom_up);
    }
  }
  template <Real S>
  static std::vector<fcl::Vector3<F>> cast(const std::vector<Vec3<S>>& positions) {
    std::vector<fcl::Vector3<F>> all;
    for (const Vec3<S>& p : positions) all.push_back(p.template cast<F>());
    return all;
  }

  fcl::BVHModel<BV> model;
  int moves = 0;
};

}  // namespace

TEST_CASE("FCL: no candidate missed, same forces") {
  test::CandidateTreeSuite<Host<fcl::OBBRSS<double>>, double>().run();
}

TEST_CASE("FCL, axis-parallel boxes, scene in float: no candidate missed, same forces") {
  test::CandidateTreeSuite<Host<fcl::AABB<double>>, float>().run();
}

TEST_CASE("FCL: models that are not ready are refused") {
  fcl::BVHModel<fcl::AABB<double>> model;
  CHECK_THROWS_WITH_AS((FclTree<fcl::AABB<double>>{model}),
                       "FclTree: the model must be finished by endModel()", SetupError);
  model.beginModel();
  model.addVertex(fcl::Vector3<double>::Zero());
  model.endModel();
  CHECK_THROWS_WITH_AS((FclTree<fcl::AABB<double>>{model}), "FclTree: the model must be of triangles",
                       SetupError);
}
