// SPDX-License-Identifier: MIT
#pragma once

/// @file Edge length that the boundary element mesh should have at each position of the surface. Set-up only.
///
///     B(x) = min over y of (min(h, max(t(y), f h) min(1, s u(y) / n)) + g dist(x, y))
///     L(x) = min(B, 3/4 B + g dist(x, crease), r B + g dist(x, rim), 2 r B + g dist(x, rim along a crease))
///
/// | symbol | name                                     | value                                              |
/// |--------|------------------------------------------|----------------------------------------------------|
/// | h      | edge length where nothing is special [m] | N = integral of 2 / (sqrt(3) L^2) over the surface |
/// | t      | thickness, along the inward normal [m]   | of the surface                                     |
/// | f      | shortest edge in thin parts over h [-]   | 1/4 to 1: h grows by 1/4 at most                   |
/// | u      | perimeter of a slender part over t [-]   | of the surface                                     |
/// | n      | edges around a slender part [-]          | 7                                                  |
/// | s      | factor on u [-]                          | from 1: 2 N vertices at most                       |
/// | r, g   | `rim_ratio`, `growth` [-]                | RemeshParams                                       |
///
/// Only convex creases count. Reasons for short edges: bending of a plate needs edges of its thickness,
/// bending of a slender part (a bone's shaft, an ear) seven of them around it: with three to five its field
/// may have the wrong sign. Next to a crease the response to a contact varies over the distance to the
/// crease. Traction at the rim grows like dist^-0.5 within a smooth part, along a right angle's edge like
/// dist^-0.4 only (nu = 1/2) [williams1952]. Where all of a body is thin, no vertices are left over for its
/// thin parts. Those of slender parts come on top of the wanted number, so that no other part gets coarser.

#include <palpate/response/setup/element_mesh.hpp>
#include <palpate/response/setup/feature_lines.hpp>

#include <limits>
#include <numbers>

namespace palpate {

namespace detail {

/// Wanted edge length at the vertices of a mesh.
class EdgeLength {
 public:
  EdgeLength(const SmoothSurface& surface, const RemeshParams& params) : surface_(surface), params_(params) {
    Vec3d low = surface.mesh().vertices[0], high = low;
    for (const Vec3d& p : surface.mesh().vertices) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    reach_ = (high - low).norm();
  }

  /// The same length everywhere, until the next measure().
  void uniform(double h) {
    h_ = h;
    wanted_.clear();
  }
  /// Measures thickness, and perimeter over it, at the vertices: the least of the triangles around each.
  void measure_sections(const std::vector<Vec3d>& p, const std::vector<Triangle>& t) {
    at_.assign(p.size(), {reach_, no_ratio, beyond(), beyond(), beyond()});
    for (const Triangle& c : t) {
      if (is_sliver(p[c[0]], p[c[1]], p[c[2]])) continue;  // its normal says nothing
      const Vec3d centre = (p[c[0]] + p[c[1]] + p[c[2]]) / 3;
      const double thickness = surface_.thickness_at(centre, reach_);
      // A thicker part has that many edges around it anyway.
      const bool slender = std::numbers::pi * thickness < setup::edges_around * h_;
      const double ratio = slender ? surface_.perimeter_at(centre, thickness, reach_) / thickness : no_ratio;
      for (auto v : c) {
        at_[v].thickness = (std::min)(at_[v].thickness, thickness);
        at_[v].perimeter_ratio = (std::min)(at_[v].perimeter_ratio, ratio);
      }
    }
  }
  /// Measures sections and distances at the vertices.
  void measure(const std::vector<Vec3d>& p, const std::vector<Triangle>& t,
               const std::vector<std::uint8_t>& fixed, const FeatureLines& features) {
    std::vector<Vec3d> crease, rim[2];
    std::vector<std::uint8_t> side(p.size(), 0), sharp(p.size(), 0);
    for (std::uint32_t i = 0; i < t.size(); ++i)
      for (auto v : t[i]) side[v] = static_cast<std::uint8_t>(side[v] | (fixed[i] ? 1 : 2));
    for (const MeshEdge& e : mesh_edges(t, "Remesher")) {
      if (!features.contains(e.key)) continue;
      const Triangle &l = t[e.triangle[0]], &r = t[e.triangle[1]];
      const Vec3d nl = area_vector(p[l[0]], p[l[1]], p[l[2]]), nr = area_vector(p[r[0]], p[r[1]], p[r[2]]);
      const bool convex = nl.dot(p[r[0]] + p[r[1]] + p[r[2]] - 3 * p[e.a()]) < 0;
      if (convex && nl.dot(nr) < setup::crease_cosine * nl.norm() * nr.norm())
        sharp[e.a()] = sharp[e.b()] = 1;
    }
    for (std::size_t v = 0; v < p.size(); ++v) {
      if (side[v] == 3) rim[sharp[v]].push_back(p[v]);
      if (sharp[v]) crease.push_back(p[v]);
    }
    measure_sections(p, t);
    for (std::uint32_t v = 0; v < p.size(); ++v) {
      at_[v].crease = distance(p[v], crease);
      at_[v].rim = distance(p[v], rim[0]);
      at_[v].sharp_rim = distance(p[v], rim[1]);
    }
    sides_.clear();
    for (const Triangle& c : t)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = c[k], b = c[(k + 1) % 3];
        if (a < b) sides_.push_back({a, b, params_.growth * (p[a] - p[b]).norm()});
      }
    update();
  }
  /// Chooses h, f and s for a number of vertices. After measure(). How many vertices slender parts need on
  /// top.
  double fit(const std::vector<Vec3d>& p, const std::vector<Triangle>& t, double vertices) {
    slender_ = no_ratio;
    fit_thin(p, t, vertices);
    const double without = expected(p, t);
    for (slender_ = 1; std::numbers::pi * slender_ < setup::edges_around; slender_ *= std::sqrt(2.0)) {
      update();
      const double further = expected(p, t) - without;
      if (further <= setup::max_further * vertices) return further;
    }
    slender_ = no_ratio;
    update();
    return 0;
  }
  /// Vertices were dropped: number[v] is the new number of v, or ~0.
  void renumber(const std::vector<std::uint32_t>& number, std::size_t count) {
    for (std::size_t v = 0; v < at_.size(); ++v)
      if (number[v] != ~0u) {
        at_[number[v]] = at_[v];
        if (!wanted_.empty()) wanted_[number[v]] = wanted_[v];
      }
    at_.resize(count);
    if (!wanted_.empty()) wanted_.resize(count);
  }

  [[nodiscard]] double length() const noexcept { return h_; }
  [[nodiscard]] double operator()(std::uint32_t v) const noexcept {
    return wanted_.empty() ? h_ : wanted_[v];
  }
  [[nodiscard]] double operator()(std::uint32_t a, std::uint32_t b) const noexcept {
    return 0.5 * ((*this)(a) + (*this)(b));
  }
  [[nodiscard]] double thickness(std::uint32_t v) const noexcept { return at_[v].thickness; }

 private:
  static constexpr double no_ratio = std::numeric_limits<double>::infinity();
  struct At {
    double thickness, perimeter_ratio, crease, rim, sharp_rim;
  };
  struct Side {
    std::uint32_t a, b;
    double growth;
  };

  [[nodiscard]] double beyond() const noexcept { return setup::far_away * reach_; }
  [[nodiscard]] double distance(const Vec3d& x, const std::vector<Vec3d>& points) const noexcept {
    double best = beyond() * beyond();
    for (const Vec3d& q : points) best = (std::min)(best, (q - x).squaredNorm());
    return std::sqrt(best);
  }
  // Number of vertices that the wanted lengths make.
  [[nodiscard]] double expected(const std::vector<Vec3d>& p, const std::vector<Triangle>& t) const {
    double sum = 0;
    for (const Triangle& c : t) {
      const double l = (wanted_[c[0]] + wanted_[c[1]] + wanted_[c[2]]) / 3;
      sum += area_vector(p[c[0]], p[c[1]], p[c[2]]).norm() * 2 / (std::sqrt(3.0) * l * l);
    }
    return sum;
  }
  void fit_thin(const std::vector<Vec3d>& p, const std::vector<Triangle>& t, double vertices) {
    thin_ = 1;
    fit_h(p, t, vertices);
    const double most = setup::max_growth_of_h * h_;
    for (thin_ = setup::min_thin_ratio; thin_ < 1; thin_ *= std::sqrt(2.0)) {
      fit_h(p, t, vertices);
      if (!(h_ > most)) return;
    }
    thin_ = 1;
    fit_h(p, t, vertices);
  }
  void fit_h(const std::vector<Vec3d>& p, const std::vector<Triangle>& t, double vertices) {
    double low = setup::min_h_factor * h_, high = setup::max_h_factor * h_;
    for (int i = 0; i < 40; ++i) {
      h_ = std::sqrt(low * high);
      update();
      (expected(p, t) > vertices ? low : high) = h_;
    }
  }
  void update() {
    wanted_.resize(at_.size());
    for (std::size_t v = 0; v < at_.size(); ++v) {
      const At& at = at_[v];
      const double around = (std::min)(slender_ * at.perimeter_ratio / setup::edges_around, 1.0);
      wanted_[v] = (std::min)(h_, (std::max)(at.thickness, thin_ * h_) * around);
    }
    for (bool changed = true; changed;) {
      changed = false;
      for (const Side& s : sides_) {
        double &a = wanted_[s.a], &b = wanted_[s.b];
        if (std::abs(a - b) <= s.growth * (1 + setup::growth_slack)) continue;
        (a > b ? a : b) = (std::min)(a, b) + s.growth;
        changed = true;
      }
    }
    for (std::size_t v = 0; v < at_.size(); ++v) {
      const At& at = at_[v];
      const double b = wanted_[v], g = params_.growth;
      wanted_[v] = (std::min)({b, setup::crease_ratio * b + g * at.crease, params_.rim_ratio * b + g * at.rim,
                               (std::min)(2 * params_.rim_ratio, 1.0) * b + g * at.sharp_rim});
    }
  }

  const SmoothSurface& surface_;
  RemeshParams params_;
  std::vector<At> at_;
  std::vector<Side> sides_;
  std::vector<double> wanted_;
  double h_ = 1, thin_ = 1, slender_ = 1, reach_ = 0;
};

}  // namespace detail
}  // namespace palpate
