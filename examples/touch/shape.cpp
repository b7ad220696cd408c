// SPDX-License-Identifier: MIT

#include "shape.hpp"

#include <palpate/elasticity/half_space.hpp>
#include <palpate/luo_xiao/beam_skeleton.hpp>
#include <palpate/luo_xiao/interpolation/phong.hpp>
#include <palpate/response/deformation.hpp>

#include <chrono>
#include <cstdio>

namespace touch {

using namespace palpate;

Shape skeleton_shape(const Beams& beams, FacePartition<S> partition, const V& fixed,
                     const MeshData<S>& mesh) {
  using Interpolation = PhongInterpolation<S>;
  const AreaNeighbourhood<S> neighbourhood(
      {.reference_area = 1e-4});  // up to 1 cm^2 a contact counts as a point
  BeamSkeletonDeformation<Beams, Interpolation> model(beams, Interpolation(std::move(partition)),
                                                      neighbourhood, mesh, {.fixed = fixed});
  return Shape(mesh, std::move(model), neighbourhood);
}

Shape mesh_shape(const std::string& model, const MeshData<S>& mesh, S fixed_below) {
  const auto fixed = [fixed_below](const auto& position) { return position.y() <= fixed_below; };
  if (model == "half-space")
    return Shape(mesh, HalfSpaceDeformation<S>(mesh, fixed, {.nu = rubber.params().nu}));
  if (model == "response") {
    const auto begin = std::chrono::steady_clock::now();
    const auto field = std::make_shared<const ResponseField>(
        mesh, fixed,
        ResponseField::Params{
            .E = rubber.params().E, .nu = rubber.params().nu, .threads = 2, .progress = [](double done) {
              std::printf("\rresponse field %3.0f %%", 100 * done);
              std::fflush(stdout);
            }});
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
    std::printf("\rresponse field of %zu boundary element vertices in %.1f s\n",
                field->mesh().vertices.size(), spent.count());
    Shape shape(mesh, ResponseFieldDeformation<S, most_regions>(field, mesh));
    shape.field = field;
    return shape;
  }
  refuse("unknown shape " + model + " (skeleton, half-space, response, none)");
}

}  // namespace touch
