// SPDX-License-Identifier: MIT
#pragma once

/// @file What a force law whose parameters vary over the object must offer: one solver for uniform and
/// calibrated objects.

#include <palpate/core/vector.hpp>
#include <palpate/law/force/linear.hpp>

namespace palpate {

/// A force law for every point. `at(x)` [m, object coordinates; any finite x] is the law there, continuous in
/// x, and `at(x).configurational_force(D)` = - dU/dx [N] the force on the tool because its energy U(D, x) at
/// fixed depth D is less elsewhere. Without it a tool that presses where the object is soft and leaves where
/// it is hard would gain energy. `max_depth()` is the least of all these laws'.
template <class M>
concept ForceMap = HasScalar<M> && ForceLaw<typename M::Local> && HasMaxDepth<M> && std::copyable<M> &&
                   requires(const M& map, const typename M::Local& local, const Vec3<typename M::Scalar>& x,
                            typename M::Scalar depth) {
                     { map.at(x) } noexcept -> std::same_as<typename M::Local>;
                     {
                       local.configurational_force(depth)
                     } noexcept -> std::same_as<Vec3<typename M::Scalar>>;
                   };

namespace detail {
/// Checked instead of a map where there is none. An alternative (`||`) would do, but compilers do not
/// say which member of an alternative is missing.
struct NoMap {
  using Scalar = double;
  struct Local : LinearForce<double> {
    [[nodiscard]] Vec3<double> configurational_force(double) const noexcept { return Vec3<double>::Zero(); }
  };
  [[nodiscard]] Local at(const Vec3<double>&) const noexcept;
  [[nodiscard]] double max_depth() const noexcept;
};
template <class F>
struct LawOf {
  using Law = F;
  using Map = NoMap;
};
template <class M>
  requires requires { typename M::Local; }
struct LawOf<M> {
  using Law = typename M::Local;
  using Map = M;
};
}  // namespace detail

/// A force model that asks an elastic body at the tool's points (resolved/elastic_contact.hpp).
template <class F>
concept ElasticForceModel = requires { typename F::Compliance; };

namespace detail {
template <ElasticForceModel F>
struct LawOf<F> {
  using Law = LinearForce<double>;
  using Map = NoMap;
};
}  // namespace detail

/// What the solver takes: one law for the whole object, a map, or an elastic body.
template <class F>
concept ForceModel = ForceLaw<typename detail::LawOf<F>::Law> && ForceMap<typename detail::LawOf<F>::Map>;

namespace detail {
/// The law at x; the law itself where there is one for the whole object.
template <ForceModel F>
[[nodiscard]] inline decltype(auto) law_at(const F& force, const Vec3<typename F::Scalar>& x) noexcept {
  if constexpr (ForceMap<F>) {
    return force.at(x);
  } else {
    return (force);
  }
}
}  // namespace detail

}  // namespace palpate
