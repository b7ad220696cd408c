// SPDX-License-Identifier: MIT
#pragma once

/// @file  Tabulated force law: a monotone curve through measured or computed samples.

#include <palpate/core/error.hpp>
#include <palpate/core/fixed_vector.hpp>
#include <palpate/law/force/concept.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

namespace palpate {

/// Monotone piecewise cubic through samples (D_i, F_i).
///
///     F = F_i + t (s_i + t (q_i + t r_i)),  t = D - D_i,  D_i <= D < D_(i+1)     (0 for D <= 0)
///     F = F_last + s_last (D - D_last)                    beyond the last sample
///
/// | symbol   | name             | unit   | range                                         |
/// |----------|------------------|--------|-----------------------------------------------|
/// | D_i, F_i | `Sample`         | m, N   | (0, 0) first; both strictly increasing; finite |
/// | s_i      | slope at sample  | N/m    | > 0                                           |
/// | N        | template         | -      | 2 to N samples are stored inside the object   |
///
/// C1, rising everywhere, no overshoot between samples. Slopes inside: weighted harmonic mean of the
/// neighbouring secants (as PCHIP). At the two ends: the secants continued geometrically, at most 2 secants;
/// own choice, because PCHIP's end slope may be 0, and then nothing beyond the last sample could be inverted.
/// Energy and tangent are exact for the curve; the inverse is a bounded, bracketed Newton iteration in the
/// piece. Bad data: SetupError with the sample's index and value. A query costs a binary search over the
/// samples. No equation: IV.A's "pre-calculations". Source: [fritsch1980], [fritsch1984].
template <Real S, std::size_t N>
class TabulatedForce {
  static_assert(N >= 2, "a curve needs two samples");

 public:
  using Scalar = S;

  struct Sample {
    S depth;  ///< D [m]
    S force;  ///< F [N]
  };

  explicit TabulatedForce(std::span<const Sample> samples) {
    check(samples);
    const std::size_t last = samples.size() - 1;
    const auto step = [&](std::size_t i) { return samples[i + 1].depth - samples[i].depth; };
    const auto secant = [&](std::size_t i) { return (samples[i + 1].force - samples[i].force) / step(i); };
    for (std::size_t i = 0; i <= last; ++i) {
      Piece piece{samples[i].depth, samples[i].force, S(0), S(0), S(0), S(0)};
      if (last == 1) {
        piece.slope = secant(0);
      } else if (i == 0) {
        piece.slope = end_slope(step(0), step(1), secant(0), secant(1));
      } else if (i == last) {
        piece.slope = end_slope(step(i - 1), step(i - 2), secant(i - 1), secant(i - 2));
      } else {
        const S before = S(2) * step(i) + step(i - 1), after = step(i) + S(2) * step(i - 1);
        piece.slope = (before + after) / (before / secant(i - 1) + after / secant(i));
      }
      if (!is_finite(piece.slope) || !(piece.slope > S(0))) {
        fail_at("TabulatedForce", "slope of the curve [N/m] is out of the scalar's range", "sample", i,
                static_cast<double>(piece.slope));
      }
      pieces_.push_back(piece);
    }
    for (std::size_t i = 0; i < last; ++i) {
      Piece& p = pieces_[i];
      const S h = step(i), d = secant(i), s0 = p.slope, s1 = pieces_[i + 1].slope;
      p.quadratic = (S(3) * d - S(2) * s0 - s1) / h;
      p.cubic = (s0 + s1 - S(2) * d) / h / h;
      pieces_[i + 1].energy = p.energy_at(h);
      // The coefficients' rounding below the smallest normal number must not show in the slope.
      const S span = (std::max)(h, S(1));
      if (!((std::numeric_limits<S>::min)() * span * span <= d) || !is_finite(S(2) * p.quadratic) ||
          !is_finite(S(3) * p.cubic) || !is_finite(pieces_[i + 1].energy)) {
        fail_at("TabulatedForce", "curvature or energy of the curve is out of the scalar's range", "sample",
                i, static_cast<double>(h));
      }
    }
  }

  /// F [N] at depth D [m].
  [[nodiscard]] S force(S depth) const noexcept {
    if (!is_positive(depth)) return S(0);
    const Piece& p = piece_at(depth);
    return p.force + p.rise(p.from(depth));
  }
  /// dF/dD [N/m] at depth D [m].
  [[nodiscard]] S stiffness(S depth) const noexcept {
    if (!is_positive(depth)) return S(0);
    const Piece& p = piece_at(depth);
    return p.slope_at(p.from(depth));
  }
  /// Integral of F from 0 to D [J].
  [[nodiscard]] S energy(S depth) const noexcept {
    if (!is_positive(depth)) return S(0);
    const Piece& p = piece_at(depth);
    return p.energy_at(p.from(depth));
  }
  /// D [m] at the force F [N].
  [[nodiscard]] S depth(S force) const noexcept {
    if (!is_positive(force)) return S(0);
    const auto above = std::upper_bound(pieces_.begin(), pieces_.end(), force,
                                        [](S f, const Piece& p) { return f < p.force; });
    const Piece& p = *(above - 1);
    const S wanted = force - p.force;
    if (above == pieces_.end()) return p.depth + wanted / p.slope;
    S low = S(0), high = above->depth - p.depth;
    S t = (std::min)(wanted / p.slope, high);
    for (int i = 0; i < 64; ++i) {  // Newton needs about 5; halving, its fallback, 64
      const S excess = p.rise(t) - wanted;
      (excess > S(0) ? high : low) = t;
      S next = t - excess / p.slope_at(t);
      if (!(next >= low && next <= high)) next = low + (high - low) / S(2);
      t = next;
      if (std::abs(excess) <= S(8) * std::numeric_limits<S>::epsilon() * force) break;
    }
    return p.depth + t;
  }
  /// No limit: infinity.
  [[nodiscard]] S max_depth() const noexcept { return std::numeric_limits<S>::infinity(); }
  /// Number of samples.
  [[nodiscard]] std::size_t size() const noexcept { return pieces_.size(); }
  /// Sample i < size().
  [[nodiscard]] Sample sample(std::size_t i) const noexcept { return {pieces_[i].depth, pieces_[i].force}; }

 private:
  struct Piece {
    S depth, force;             // where it begins
    S slope, quadratic, cubic;  // F = force + t (slope + t (quadratic + t cubic))
    S energy;                   // at its beginning

    // Infinity times the last piece's coefficients of 0 would be NaN.
    S from(S D) const noexcept { return (std::min)(D, (std::numeric_limits<S>::max)()) - depth; }
    S rise(S t) const noexcept { return t * (slope + t * (quadratic + t * cubic)); }
    S slope_at(S t) const noexcept { return slope + t * (S(2) * quadratic + t * (S(3) * cubic)); }
    S energy_at(S t) const noexcept {
      return energy + t * (force + t * (slope / S(2) + t * (quadratic / S(3) + t * (cubic / S(4)))));
    }
  };

  static void check(std::span<const Sample> samples) {
    const auto count = static_cast<double>(samples.size());
    if (samples.size() < 2) fail("TabulatedForce", "needs at least 2 samples", count);
    if (samples.size() > N) fail("TabulatedForce", "more samples than the object holds", count);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const S depth = samples[i].depth, force = samples[i].force;
      const auto refuse = [i](const char* rule, S value) {
        fail_at("TabulatedForce", rule, "sample", i, static_cast<double>(value));
      };
      if (!is_finite(depth)) refuse("depth [m] must be finite", depth);
      if (!is_finite(force)) refuse("force [N] must be finite", force);
      if (i == 0) {
        if (depth != S(0)) refuse("the first depth [m] must be 0", depth);
        if (force != S(0)) refuse("the first force [N] must be 0", force);
        continue;
      }
      if (!(depth > samples[i - 1].depth)) refuse("depth [m] must be above the sample before", depth);
      if (!(force > samples[i - 1].force)) refuse("force [N] must be above the sample before", force);
    }
  }

  // Secants taken at their midpoints, continued to the end of the nearer step as a geometric sequence: always
  // > 0.
  static S end_slope(S step, S next_step, S secant, S next_secant) {
    return (std::min)(secant * std::pow(secant / next_secant, step / (step + next_step)), S(2) * secant);
  }

  const Piece& piece_at(S depth) const noexcept {
    return *(std::upper_bound(pieces_.begin(), pieces_.end(), depth,
                              [](S d, const Piece& p) { return d < p.depth; }) -
             1);
  }

  FixedVector<Piece, N> pieces_;
};

static_assert(ForceLaw<TabulatedForce<float, 8>> && ForceLaw<TabulatedForce<double, 8>>);

}  // namespace palpate
