// SPDX-License-Identifier: MIT
#pragma once

/// @file Deformation model of a resolved contact: displacement of the whole surface by the loads at the
/// tool's points.

#include <palpate/core/error.hpp>
#include <palpate/elasticity/concept.hpp>
#include <palpate/resolved/detail/load_drawing.hpp>

#include <memory>
#include <utility>
#include <vector>

namespace palpate {

/// Loads to vertices: the shape of the same body under the same forces that the hand feels. Nothing of it is
/// inside the tool, as far as the tool is convex and its points resolve it.
///
///     FixedVector<SurfaceLoad<S>, 256> loads;
///     solver.state().loads(loads);                          // servo thread, to hand over
///     solver.draw({loads.begin(), loads.size()}, buffer);   // render thread
///
/// A load that is not usable is left out, invalid_load; loads beyond the capacity, point_overflow. With the
/// same loads as in the last write nothing is written. All vertices move: `Moved` counts them all.
///
/// Set-up reports a field that is missing, and a mesh that is not finite or, with normals, not closed.
template <Real S, std::size_t Capacity = 256>
class ResponseLoadDeformation {
 public:
  using Scalar = S;
  using Drawn = SurfaceLoad<S>;
  static constexpr bool active = true;

  /// `mesh`: what is drawn, bound to the field once; any mesh of the same body.
  template <Real M>
  ResponseLoadDeformation(std::shared_ptr<const ResponseField> field, const MeshData<M>& mesh,
                          bool normals = true)
      : field_(field ? std::move(field) : fail_without()), drawing_(*field_, mesh, normals, Capacity) {
    last_.reserve(Capacity);
    kept_.reserve(Capacity);
  }

  template <Real T>
  void write_rest(const VertexBuffer<T>& out) noexcept {
    last_.clear();
    drawing_.write_rest(out);
  }

  /// Writes the shape under `loads`, unless it is the one already there.
  template <Real T>
  Moved<S> write(std::span<const SurfaceLoad<S>> loads, const VertexBuffer<T>& out) noexcept {
    Moved<S> moved;
    kept_.clear();
    for (const SurfaceLoad<S>& load : loads) {
      if (!is_usable(load, static_cast<S>(field_->E())))
        moved.status |= Status::invalid_load;
      else if (kept_.size() == Capacity)
        moved.status |= Status::point_overflow;
      else
        kept_.push_back(load);
    }
    if (out.positions == nullptr || std::equal(kept_.begin(), kept_.end(), last_.begin(), last_.end(), same))
      return moved;
    std::swap(kept_, last_);
    const Status status = moved.status;
    moved = drawing_.write(std::span<const SurfaceLoad<S>>(last_), out);
    moved.status = status;
    return moved;
  }

  [[nodiscard]] const ResponseField& field() const noexcept { return *field_; }

 private:
  [[noreturn]] static std::shared_ptr<const ResponseField> fail_without() {
    fail("ResponseLoadDeformation", "needs a response field");
  }
  [[nodiscard]] static bool same(const SurfaceLoad<S>& a, const SurfaceLoad<S>& b) noexcept {
    return a.position == b.position && a.direction == b.direction && a.force == b.force && a.area == b.area &&
           a.by_strain == b.by_strain && a.shift == b.shift && a.tool_point == b.tool_point &&
           a.tool_normal == b.tool_normal && a.raised == b.raised;
  }

  std::shared_ptr<const ResponseField> field_;
  detail::LoadDrawing drawing_;
  std::vector<SurfaceLoad<S>> last_, kept_;
};

}  // namespace palpate
