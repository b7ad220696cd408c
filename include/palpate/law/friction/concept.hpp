// SPDX-License-Identifier: MIT
#pragma once

/// @file What a friction law must offer. Read this before writing one.
///
/// | shipped              | limit                    | use it when                                              |
/// |----------------------|--------------------------|----------------------------------------------------------|
/// | `PowerLawFriction`   | f_max = K F_n^beta       | the paper's (Howell and Mazur): elastic or fibrous solids |
/// | `CoulombFriction`    | f_max = mu_S F_n         | beta = 1: dry, hard or rough pairs                       |
/// | `Frictionless`       | 0                        | absent: no state, no byte, no instruction                |
///
/// A law only says how large friction may be; how the origin p0 of the deformation moves when the limit is
/// passed is the slip rule's part (law/friction/slip.hpp). Absent on purpose: velocity-regularised laws,
/// because they cannot hold a tool at rest.

#include <palpate/core/scalar.hpp>
#include <palpate/law/force/concept.hpp>

namespace palpate {

/// A friction policy is absent when `active` is false; then nothing else is asked of it.
template <class F>
concept HasActive = requires {
  { F::active } -> std::convertible_to<bool>;
};

template <class F>  // f_max(F_n) [N]: the largest force that sticks
concept HasStaticLimit = requires(const F& law, typename F::Scalar normal_force) {
  { law.static_limit(normal_force) } noexcept -> std::same_as<typename F::Scalar>;
};

template <class F>  // friction while sliding [N], <= static_limit
concept HasSlidingLimit = requires(const F& law, typename F::Scalar normal_force) {
  { law.sliding_limit(normal_force) } noexcept -> std::same_as<typename F::Scalar>;
};

template <class F>  // sup f_max / F_n [-], finite: the bound on friction's share of a force step
concept HasMaxCoefficient = requires(const F& law) {
  { law.max_coefficient() } noexcept -> std::same_as<typename F::Scalar>;
};

/// Friction limits as functions of the normal force F_n [N] >= 0. Both are 0 at F_n = 0, continuous and
/// non-decreasing.
template <class F>
concept FrictionLaw = HasScalar<F> && HasActive<F> && std::copyable<F> &&
                      (!F::active || HasStaticLimit<F>)&&   // one line each, because gcc's message shows
                      (!F::active || HasSlidingLimit<F>)&&  // the line of the requirement that failed
                      (!F::active || HasMaxCoefficient<F>);

}  // namespace palpate
