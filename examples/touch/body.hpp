// SPDX-License-Identifier: MIT
#pragma once

/// @file The elastic object of the command line: a body whose type is known at run time only. Set-up asks it
/// through virtual functions; the servo loop has samples of it.

#include <palpate/geometry/extremal_points.hpp>

#include <memory>
#include <string>
#include <vector>

#include "options.hpp"

namespace touch {

class Body {
 public:
  using Scalar = S;
  class Interface {
   public:
    Interface() = default;
    Interface(const Interface&) = delete;
    Interface& operator=(const Interface&) = delete;
    virtual ~Interface() = default;
    [[nodiscard]] virtual palpate::SurfacePoint<S> closest(const V& x) const noexcept = 0;
    [[nodiscard]] virtual palpate::RayHit<S> raycast(const V& from, const V& along) const noexcept = 0;
    [[nodiscard]] virtual V shading_normal(const V& x) const = 0;
    [[nodiscard]] virtual std::vector<palpate::ExtremalPoint<S>> extremal_points() const = 0;
  };

  std::string title;
  palpate::MeshData<S> display;  ///< the mesh that is drawn
  bool is_file = false;

  [[nodiscard]] palpate::SurfacePoint<S> closest(const V& x) const noexcept { return it_->closest(x); }
  [[nodiscard]] palpate::RayHit<S> raycast(const V& from, const V& along) const noexcept {
    return it_->raycast(from, along);
  }
  [[nodiscard]] V lower() const noexcept { return lower_; }
  [[nodiscard]] V upper() const noexcept { return upper_; }
  [[nodiscard]] S reach() const noexcept { return reach_; }
  [[nodiscard]] S volume() const noexcept { return volume_; }
  /// The topmost point over the middle.
  [[nodiscard]] V top() const noexcept { return raycast(V(0, 1, 0), -V::UnitY()).position; }

  friend std::vector<palpate::ExtremalPoint<S>> extremal_points(const Body& body) {
    return body.it_->extremal_points();
  }
  friend V shading_normal(const Body& body, const V& x) { return body.it_->shading_normal(x); }

 private:
  friend Body make_body(const Options&);
  template <class Surface>
  static Body of(std::string title, const Surface& surface, palpate::MeshData<S> display);
  Body() = default;

  std::shared_ptr<const Interface> it_;
  V lower_, upper_;
  S reach_ = 0, volume_ = 0;
};

/// What options.object names: an exact surface, the heart, or a mesh file, the middle of whose box becomes
/// the origin.
[[nodiscard]] Body make_body(const Options& options);

}  // namespace touch
