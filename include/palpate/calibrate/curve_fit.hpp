// SPDX-License-Identifier: MIT
#pragma once

/// @file A law's few parameters from a measured or computed curve: bounded least squares. Set-up only.
///
/// Minimises sum w_i (f(p, x_i) - y_i)^2 over low <= p <= high by Levenberg and Marquardt's steps on the
/// parameters that are not at an active bound. Derivatives by central differences. Source: [more1978].

#include <palpate/core/cholesky.hpp>
#include <palpate/core/error.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

namespace palpate {

/// A point of a curve: depth D [m], force F [N], how much it counts [-].
struct CurvePoint {
  double depth = 0, force = 0, weight = 1;
};

/// A fitted curve. Confidence: the true value lies within value +- half_width with 95 % probability if the
/// law is right and the errors are independent and normal; for curves that were computed it says how well the
/// law fits instead.
template <std::size_t N>
struct CurveFit {
  std::array<double, N> value{};       ///< parameters
  std::array<double, N> half_width{};  ///< of their 95 % confidence intervals; 0 for those at a bound
  std::array<bool, N> at_bound{};
  std::vector<double> residual;  ///< fitted less given, per point [N]
  double rms = 0;                ///< root mean square residual, weighted [N]
  double relative_rms = 0;       ///< over the forces' own; infinite where the curve determines no fit
};

struct CurveFitParams {
  double worst_rms = 0.2;  ///< relative: a fit worse than this is refused; infinite: none is; chosen
  int max_steps = 200;
};

/// Fits law(p, depth) -> force. Reports: fewer than N + 2 points, numbers that are not finite, weights < 0,
/// bounds the wrong way round, no force anywhere, parameters that the points do not determine, a fit that
/// does not settle or is worse than `worst_rms`. If that is infinite the last three are told by
/// `relative_rms`.
template <std::size_t N, class Law>
[[nodiscard]] CurveFit<N> fit_curve(std::span<const CurvePoint> points, const Law& law,
                                    const std::array<double, N>& start, const std::array<double, N>& low,
                                    const std::array<double, N>& high, const CurveFitParams& params = {}) {
  using Vector = Eigen::Matrix<double, int(N), 1>;
  using Matrix = Eigen::Matrix<double, int(N), int(N)>;
  const char* where = "fit_curve";
  const std::size_t m = points.size();
  if (m < N + 2) fail(where, "points must be at least the parameters and two", double(m));
  double weights = 0, forces = 0;
  for (std::size_t i = 0; i < m; ++i) {
    const CurvePoint& q = points[i];
    if (!is_finite(q.depth) || !is_finite(q.force) || !is_finite(q.weight))
      fail_at(where, "numbers must be finite", "point", i);
    if (q.weight < 0) fail_at(where, "weights must be >= 0", "point", i, q.weight);
    weights += q.weight;
    forces += q.weight * q.force * q.force;
  }
  if (!(weights > 0) || !(forces > 0)) fail(where, "some point must have a weight and a force");
  Vector p, scale;
  for (std::size_t k = 0; k < N; ++k) {
    const auto i = Eigen::Index(k);
    if (!is_finite(start[k]) || !(low[k] < high[k]))
      fail_at(where, "start must be finite and low < high", "parameter", k);
    p[i] = std::clamp(start[k], low[k], high[k]);
    scale[i] = p[i] != 0 ? std::abs(p[i]) : (is_finite(high[k] - low[k]) ? high[k] - low[k] : 1);
  }
  const auto evaluate = [&](const Vector& at, std::size_t i) {
    std::array<double, N> value;
    for (std::size_t k = 0; k < N; ++k) value[k] = at[Eigen::Index(k)];
    return law(value, points[i].depth);
  };
  const auto cost = [&](const Vector& at) {
    double sum = 0;
    for (std::size_t i = 0; i < m; ++i) {
      const double r = evaluate(at, i) - points[i].force;
      sum += points[i].weight * r * r;
    }
    return is_finite(sum) ? sum : (std::numeric_limits<double>::max)();
  };
  // In units of `scale`: normal matrix, gradient.
  Matrix A;
  Vector g;
  const auto linearise = [&] {
    A.setZero();
    g.setZero();
    for (std::size_t i = 0; i < m; ++i) {
      Vector row;
      for (Eigen::Index k = 0; k < Eigen::Index(N); ++k) {
        const double step = 1e-6 * scale[k];  // about the cube root of epsilon
        Vector up = p, down = p;
        up[k] += step;
        down[k] -= step;
        row[k] = (evaluate(up, i) - evaluate(down, i)) / 2e-6;
      }
      A += points[i].weight * row * row.transpose();
      g += points[i].weight * (evaluate(p, i) - points[i].force) * row;
    }
  };
  // At a bound, and downhill is beyond it.
  const auto active = [&](Eigen::Index k) {
    return (p[k] <= low[std::size_t(k)] && g[k] > 0) || (p[k] >= high[std::size_t(k)] && g[k] < 0);
  };
  const auto without_active = [&](double damping) {
    Matrix B = A;
    for (Eigen::Index k = 0; k < Eigen::Index(N); ++k) {
      B(k, k) += damping * (A(k, k) + 1e-300);  // never 0
      if (!active(k)) continue;
      B.row(k).setZero();
      B.col(k).setZero();
      B(k, k) = 1;
    }
    return B;
  };
  // Marquardt's start and factors; at a damping of 1e27 the step is below rounding, and at 1e-12 it is
  // Gauss and Newton's.
  double damping = 1e-3, now = cost(p);
  detail::SpdSystem<N> system;
  bool settled = false;
  for (int step = 0; step < params.max_steps && !settled; ++step) {
    linearise();
    bool better = false;
    for (int tries = 0; tries < 30 && !better; ++tries) {
      system.set(without_active(damping));
      for (std::size_t k = 0; k < N; ++k) system.b[k] = active(Eigen::Index(k)) ? 0 : -g[Eigen::Index(k)];
      if (!system.solve(N)) {  // undamped it is singular
        damping *= 10;
        continue;
      }
      Vector next = p + scale.cwiseProduct(Vector(system.b.data()));
      for (Eigen::Index k = 0; k < Eigen::Index(N); ++k)
        next[k] = std::clamp(next[k], low[std::size_t(k)], high[std::size_t(k)]);
      const double then = cost(next);
      if (then <= now && is_finite(then)) {
        settled = now - then <= 1e-14 * forces;  // some roundings of the sum
        better = true;
        p = next;
        now = then;
        damping = (std::max)(0.1 * damping, 1e-12);
      } else {
        damping *= 10;
      }
    }
    settled = settled || !better;  // no step downhill is left
  }
  const auto none = [&](auto... why) {
    if (is_finite(params.worst_rms)) fail(where, why...);
    CurveFit<N> out;
    out.relative_rms = std::numeric_limits<double>::infinity();
    return out;
  };
  if (!settled) return none("the fit does not settle within the steps allowed", double(params.max_steps));
  linearise();
  CurveFit<N> fit;
  std::size_t open = 0;
  for (std::size_t k = 0; k < N; ++k) {
    const auto i = Eigen::Index(k);
    fit.value[k] = p[i];
    fit.at_bound[k] = p[i] <= low[k] || p[i] >= high[k];
    open += fit.at_bound[k] ? 0u : 1u;
  }
  fit.rms = std::sqrt(now / weights);
  fit.relative_rms = std::sqrt(now / forces);
  for (std::size_t i = 0; i < m; ++i) fit.residual.push_back(evaluate(p, i) - points[i].force);
  if (fit.relative_rms > params.worst_rms)
    fail(where, "the law does not fit: relative rms residual", fit.relative_rms);
  // Covariance of the free parameters; correlation matrix first, so that units do not count.
  Matrix B = A;
  for (std::size_t k = 0; k < N; ++k) {
    const auto i = Eigen::Index(k);
    if (!fit.at_bound[k] && !(A(i, i) > 0)) return none("the points do not determine parameter", double(k));
    if (!fit.at_bound[k]) continue;
    B.row(i).setZero();
    B.col(i).setZero();
    B(i, i) = 1;
  }
  const Vector unit = B.diagonal().cwiseSqrt().cwiseInverse();
  system.set(Matrix(unit.asDiagonal() * B * unit.asDiagonal()));
  // Central differences carry about ten digits, a normal matrix half of them.
  if (!system.factor(N) || system.pivot_ratio() < 1e-9)
    return none("the points do not determine all parameters: too many, or the depths are too alike");
  Matrix correlation;
  system.invert(correlation);
  const Matrix inverse = unit.asDiagonal() * correlation * unit.asDiagonal();
  const double freedom = double(m - open), variance = now / freedom, z = 1.959963985;
  // z: of a normal distribution, 97.5 % are below it.
  // Student's t by Cornish and Fisher's expansion; 2 % low at two degrees of freedom.
  const double t = z + (z * z * z + z) / (4 * freedom) +
                   (5 * std::pow(z, 5) + 16 * z * z * z + 3 * z) / (96 * freedom * freedom);
  for (std::size_t k = 0; k < N; ++k)
    if (!fit.at_bound[k])
      fit.half_width[k] =
          t * std::sqrt(variance * inverse(Eigen::Index(k), Eigen::Index(k))) * scale[Eigen::Index(k)];
  return fit;
}

}  // namespace palpate
