// SPDX-License-Identifier: MIT

/// @file Detection on the shape of the last tick, which is worked out in the servo loop.

#include <palpate/device/energy_limit.hpp>
#include <palpate/geometry/deformed_surface.hpp>

#include "solver_feel.hpp"

namespace touch {

namespace {

using Object = palpate::DeformedSurface<palpate::SampledSurface<Body>>;

/// After each tick the object takes that tick's shape. Its force is not passive by itself: a limit stands
/// behind it.
class DeformedFeel final : public SolverFeel<Object> {
 public:
  DeformedFeel(const Options& options, Solver<Object> solver, const palpate::EnergyLimit<S>& limit,
               Shape shape, const palpate::MeshData<S>& rest)
      : SolverFeel(options, std::move(solver)),
        limit_(limit),
        shape_(std::move(shape)),
        position_(rest.vertices) {
    shape_.write_rest(buffer());
  }

  Felt tick(const palpate::Pose<S>& X, S dt) noexcept override {
    Felt felt = SolverFeel::tick(X, dt);
    felt.wrench = limit_.pass(felt.wrench, X, solver_.contacts());
    if (shape_.write(solver_.contacts(), buffer()).vertices > 0) {
      Object& object = solver_.mutable_object();
      object.update(position_);
      highest_ = (std::max)(highest_, object.highest_bulge());
    }
    return felt;
  }
  void reset() noexcept override {
    SolverFeel::reset();
    limit_.reset();
  }
  [[nodiscard]] S highest_bulge() const noexcept override { return highest_; }

 private:
  [[nodiscard]] Shape::Buffer buffer() noexcept {
    return {.positions = position_.front().data(), .position_stride = sizeof(V)};
  }

  palpate::EnergyLimit<S> limit_;
  Shape shape_;  ///< of the servo thread; the solver's own is the one that is drawn
  std::vector<V> position_;
  S highest_ = 0;
};

}  // namespace

std::unique_ptr<Feel> feel_deformed(const Options& options, const Body& body, const Tool& tool,
                                    Answer answer) {
  if (!answer.shape.exists()) refuse("--detect deformed needs a shape");
  Shape shape(answer.shape);
  return std::make_unique<DeformedFeel>(
      options,
      make_solver(Object(samples(body), palpate::TriangleMesh<S>(body.display)), tool, std::move(answer)),
      palpate::EnergyLimit<S>({.centre_of_mass = tool.centre_of_mass, .contact_area = tool.contact_area}),
      std::move(shape), body.display);
}

}  // namespace touch
