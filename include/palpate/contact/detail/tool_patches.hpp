// SPDX-License-Identifier: MIT
#pragma once

/// @file A rigid tool in patches, and how these relieve each other through the elastic body (VI).

#include <palpate/contact/compliant_regions.hpp>
#include <palpate/core/complementarity.hpp>
#include <palpate/core/error.hpp>
#include <palpate/detection/detail/proximity_graph.hpp>
#include <palpate/detection/tool_points.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

namespace palpate::detail {

/// Patches of a tool and their matrix R. A part of the tool is what its proximity graph joins. A part of the
/// nominal contact area's extent is one patch, as a pin's tip is; a larger one is cut into patches about a
/// from middle to rim, those most remote from each other first. A tool with more than `max_patches` of them
/// gets larger ones.
///
/// Pressure on the tool's surface is a potential over closed surfaces only: a cut through what is inside the
/// body would add a force along it. With it a part is one patch, however large.
class ToolPatches {
 public:
  static constexpr std::size_t max_patches = 64;
  using List = std::array<double, max_patches>;

  /// `cuts`: large parts are cut. Reports a ratio that is not in [0, 1].
  template <ComplianceRatio C, Real S>
  ToolPatches(const C& compliance, const ToolPoints<S>& tool, const ProximityGraph<S>& graph, bool cuts) {
    const double a = std::sqrt(static_cast<double>(tool.contact_area()) / std::numbers::pi);
    const std::vector<std::uint32_t> part = parts(tool.size(), graph);
    const std::vector<std::uint32_t> seeds = divide(tool, part, a, cuts);
    set_matrix(compliance, tool, part, seeds, a);
  }

  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  /// The patch of a point, and of the tool's last batch of points where it is filled up.
  [[nodiscard]] std::size_t of(std::size_t point) const noexcept { return of_[point]; }
  /// R_jk.
  [[nodiscard]] double ratio(std::size_t j, std::size_t k) const noexcept {
    return k <= j ? matrix_[j * (j + 1) / 2 + k] : matrix_[k * (k + 1) / 2 + j];
  }

  /// The factors x_j/e_j of all patches' forces, from the energies that they have alone [J].
  void relieve(const List& energy, List& factor) const noexcept {
    std::array<std::uint8_t, max_patches> patch;
    List e, x;
    std::size_t n = 0;
    for (std::size_t j = 0; j < size_; ++j) {
      factor[j] = 1;
      if (!(energy[j] > 0)) continue;
      e[n] = std::sqrt(2 * energy[j]);
      patch[n++] = static_cast<std::uint8_t>(j);
    }
    if (n < 2) return;
    (void)solve_complementarity<max_patches>(
        [&](std::size_t i, std::size_t k) { return ratio(patch[i], patch[k]); }, e, n, x);
    for (std::size_t i = 0; i < n; ++i) factor[patch[i]] = (std::min)(x[i] / e[i], 1.0);
  }

 private:
  static constexpr const char* name = "CompliantRegions";
  static constexpr std::uint32_t nobody = (std::numeric_limits<std::uint32_t>::max)();
  static constexpr double no_patch = (std::numeric_limits<double>::max)();
  // The least eigenvalue that R may have: rounding then stays below 1e-12.
  static constexpr double min_eigenvalue = 1e-3;
  // A round face of area A_0 is 2 a across, a square one 2.51 a.
  static constexpr double whole_within = 2.6;
  // Distances whose ratio is nearer to 1 are equal: the earlier patch or point counts, in the tool's order.
  static constexpr double tie = 1 - 1e-6;
  // Within one part of the tool patches are uncoupled up to 2 a and wholly coupled from 3 a on (chosen).
  static constexpr double uncoupled_within = 2, coupled_from = 3;

  // The part of each point.
  template <Real S>
  [[nodiscard]] static std::vector<std::uint32_t> parts(std::size_t points, const ProximityGraph<S>& graph) {
    std::vector<std::uint32_t> part(points, nobody), queue;
    std::uint32_t count = 0;
    for (std::uint32_t first = 0; first < points; ++first) {
      if (part[first] != nobody) continue;
      part[first] = count;
      queue.assign(1, first);
      while (!queue.empty()) {
        const std::uint32_t i = queue.back();
        queue.pop_back();
        for (const std::uint32_t j : graph.neighbours(i)) {
          if (part[j] != nobody) continue;
          part[j] = count;
          queue.push_back(j);
        }
      }
      ++count;
    }
    return part;
  }

  // Sets the patch of each point and returns the patches' first points.
  template <Real S>
  std::vector<std::uint32_t> divide(const ToolPoints<S>& tool, const std::vector<std::uint32_t>& part,
                                    double a, bool cuts) {
    const std::size_t n = tool.size();
    std::vector<double> distance(n, no_patch);
    std::vector<std::uint32_t> seeds;
    of_.assign(n, 0);
    std::uint32_t next = 0;
    while (seeds.size() < max_patches) {
      const auto patch = static_cast<std::uint8_t>(seeds.size());
      seeds.push_back(next);
      const bool is_new_part = distance[next] == no_patch;
      double reach = 0;
      for (std::uint32_t i = 0; i < n; ++i) {
        if (part[i] != part[next]) continue;
        const double d = static_cast<double>((tool.point(i) - tool.point(next)).norm());
        if (d < distance[i] * tie) distance[i] = d, of_[i] = patch;
        reach = (std::max)(reach, d);
      }
      if (is_new_part && (!cuts || reach * tie <= whole_within * a)) {
        for (std::uint32_t i = 0; i < n; ++i)
          if (part[i] == part[next]) distance[i] = 0;
      }
      next = 0;
      for (std::uint32_t i = 1; i < n; ++i)
        if (distance[i] * tie > distance[next]) next = i;
      if (distance[next] * tie <= a) break;
    }
    for (std::uint32_t i = 0; i < n; ++i) {  // parts that got no patch of their own
      if (distance[i] != no_patch) continue;
      const auto gap = [&](std::uint32_t seed) { return (tool.point(i) - tool.point(seed)).squaredNorm(); };
      of_[i] = static_cast<std::uint8_t>(
          std::min_element(seeds.begin(), seeds.end(),
                           [&gap](std::uint32_t l, std::uint32_t r) { return gap(l) < gap(r) * S(tie); }) -
          seeds.begin());
    }
    of_.resize((n + batch_size - 1) / batch_size * batch_size, of_[n - 1]);
    return seeds;
  }

  template <ComplianceRatio C, Real S>
  void set_matrix(const C& compliance, const ToolPoints<S>& tool, const std::vector<std::uint32_t>& part,
                  const std::vector<std::uint32_t>& seeds, double a) {
    size_ = seeds.size();
    std::vector<double> area(size_, 0);
    std::vector<Vec3<double>> centre(size_, Vec3<double>::Zero());
    for (std::size_t i = 0; i < tool.size(); ++i) {
      const double A = static_cast<double>(tool.area(i));
      area[of_[i]] += A;
      centre[of_[i]] += A * tool.point(i).template cast<double>();
    }
    for (std::size_t j = 0; j < size_; ++j) centre[j] /= area[j];
    matrix_.assign(size_ * (size_ + 1) / 2, 1);
    for (std::size_t j = 0; j < size_; ++j) {
      for (std::size_t k = 0; k < j; ++k) {
        const double r = (centre[j] - centre[k]).norm(), ratio = compliance.ratio(r, a);
        if (!(ratio >= 0 && ratio <= 1)) fail(name, "ratio(r, a) must be in [0, 1]", ratio);
        const double share = std::sqrt(share_of(area[j], a) * share_of(area[k], a));
        matrix_[j * (j + 1) / 2 + k] =
            share * ratio * (part[seeds[j]] == part[seeds[k]] ? coupled_within_a_part(r / a) : 1);
      }
    }
    // R of a ratio that is positive definite, and of parts that are not cut, is so already. Any other: by a
    // factor that is the largest that makes it so, or up to a tenth less (chosen).
    while (!is_definite()) {
      for (std::size_t j = 0; j < size_; ++j)
        for (std::size_t k = 0; k < j; ++k) matrix_[j * (j + 1) / 2 + k] *= 0.9;
    }
  }
  [[nodiscard]] static double share_of(double area, double a) noexcept {
    return (std::min)(area / (std::numbers::pi * a * a), 1.0);
  }
  [[nodiscard]] static double coupled_within_a_part(double distance) noexcept {
    const double t = std::clamp((distance - uncoupled_within) / (coupled_from - uncoupled_within), 0.0, 1.0);
    return t * t * (3 - 2 * t);
  }
  [[nodiscard]] bool is_definite() const {
    SpdSystem<max_patches> system;
    for (std::size_t j = 0; j < size_; ++j) {
      for (std::size_t k = 0; k < j; ++k) system.at(j, k) = ratio(j, k);
      system.at(j, j) = 1 - min_eigenvalue;
    }
    return system.factor(size_);
  }

  std::vector<std::uint8_t> of_;  // patch of each point
  std::vector<double> matrix_;    // lower triangle of R, row by row
  std::size_t size_ = 0;
};

}  // namespace palpate::detail
