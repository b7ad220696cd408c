// SPDX-License-Identifier: MIT
#pragma once

/// @file  The contacts of one tick of a response field as a linear system: what gives way to which force. Per tick.
///
///     C P = d + C_near q - w_2,   C_ii = C_near + w_ii,   C_ij = u_near(sqrt(a_i^2 + a_j^2)) + w_ij,   F = mu P
///
/// | symbol | name                                                                     | unit   |
/// |--------|--------------------------------------------------------------------------|--------|
/// | C_near | compliance of a half-space to a stuck disc, times mu                     | 1/m    |
/// | w      | the body's correction, times mu                                          | 1/m    |
/// | q, w_2 | second order in depth (SecondOrder): universal forces, the body's answer | m^2, m |
///
/// The displacement of patch i by the force on patch j, averaged over i, is that of a disc with the square sum of the radii:
/// exact to second moments, and never singular when patches meet. Should the system not be positive definite all the
/// same, the coupling is reduced until it is.

#include <palpate/beam/cholesky.hpp>
#include <palpate/core/fixed_vector.hpp>
#include <palpate/response/contact_near.hpp>
#include <palpate/response/contact_types.hpp>
#include <palpate/response/response_field.hpp>

namespace palpate::detail {

/// One contact placed and solved.
struct PlacedContact {
  Vec3<double> x, m, d;  ///< m: unit normal into the body
  double a = 0;
  double least = 0;  ///< smaller compliance of the half-space, times mu
  double ball = 0;   ///< radius of the sphere; 0: stuck patch
  TouchPlace place;
  double share = 1;         ///< of w that counts
  PatchTable::Level level;  ///< of the radius
  Mat3<double> w, C;        ///< correction and sum, times mu
  Vec3<double> rhs;
  Vec3<double> P = Vec3<double>::Zero();  ///< force / mu
  double dipole = 0, dn2 = 0;             ///< / mu
  Vec3<double> tilt = Vec3<double>::Zero(), push = Vec3<double>::Zero();
};

/// Nodes that share a contact's force.
struct PatchWeight {
  std::uint32_t node;
  double weight;
};
using PatchNodes = FixedVector<PatchWeight, 36>;  // twelve points, three nodes each

template <std::size_t Capacity>
class ContactSystem {
 public:
  using Contact = PlacedContact;
  struct Settings {
    bool second_order = true;
    SecondOrder constants = {};
  };
  ContactSystem(const ResponseField& field, const Settings& settings) : field_(&field), settings_(settings) {}

  [[nodiscard]] Contact& operator[](std::size_t c) noexcept { return contact_[c]; }
  [[nodiscard]] const Contact& operator[](std::size_t c) const noexcept { return contact_[c]; }

  /// P of the first `count` contacts, all located: first by the linear part; its forces give the loads of second order.
  void solve(std::size_t count) noexcept {
    solve_once(count);
    if (!settings_.second_order) return;
    bool any = false;
    for (std::size_t i = 0; i < count; ++i) {
      press(contact_[i]);
      any = any || contact_[i].dipole != 0;
    }
    if (any) solve_once(count);
  }

  void locate(Contact& c) const noexcept {
    c.dipole = c.dn2 = 0;
    c.tilt.setZero();
    c.push.setZero();
    c.place = field_->touch().locate(c.x);
    const double size = mean_size(c);
    c.level = field_->table().level(averaged(c, size));
    // Far from any touchable place, deep inside the fixed region, the nearest place may jump; there w has faded away. On an
    // edge, a quarter of the size away, it is 0.996 of w.
    const double far2 = c.place.distance2 / (size * size);
    c.share = 1 / (1 + far2 * far2);
    c.w = c.share * c.share * field_->table().own(c.place.triangle, c.place.weight, c.level);
    const DiscCompliance near = disc_compliance(c.a, field_->nu());
    c.C = c.w + (near.normal - near.along) * (c.m * c.m.transpose());
    c.C.diagonal().array() += near.along;
    c.least = (std::min)(near.normal, near.along);
    c.rhs = c.d;
  }

  // More than half of d: the series in depth has ended there. Less: (1 + r^8)^(-1/8) is 1.
  [[nodiscard]] static double kept(const Vec3<double>& second, const Contact& c) noexcept {
    const double r2 = second.squaredNorm() / (0.25 * c.d.squaredNorm()), r8 = r2 * r2 * r2 * r2;
    return 1 / std::sqrt(std::sqrt(std::sqrt(1 + r8)));
  }
  // Size of the nodes around the contact's place, interpolated.
  [[nodiscard]] double mean_size(const Contact& c) const noexcept {
    double size = 0;
    for (std::size_t i = 0; i < 3; ++i)
      size += c.place.weight[Eigen::Index(i)] * field_->touch().nodes()[c.place.node[i]].size;
    return size;
  }
  // s^2 of patch_table.hpp.
  [[nodiscard]] static double averaged(const Contact& c, double size) noexcept {
    return c.a * c.a - 0.25 * size * size;
  }
  // Nodes that share the force.
  void find_patch(const Contact& c, PatchNodes& patch) const noexcept {
    patch.clear();
    const auto add = [&patch](const TouchPlace& p, double share) {
      for (std::size_t i = 0; i < 3; ++i) {
        const double weight = share * p.weight[Eigen::Index(i)];
        const auto same = std::find_if(patch.begin(), patch.end(),
                                       [&](const PatchWeight& w) { return w.node == p.node[i]; });
        if (same != patch.end())
          same->weight += weight;
        else
          patch.push_back({p.node[i], weight});
      }
    };
    const double wide2 = averaged(c, mean_size(c));
    if (!(wide2 > 0)) return add(c.place, c.share);
    const double s = std::sqrt(wide2);
    const Vec3<double> t1 = perpendicular(c.m), t2 = c.m.cross(t1);
    for (const auto& p : disc_points())
      add(field_->touch().locate(c.x + s * (p[0] * t1 + p[1] * t2)), c.share / double(disc_points().size()));
  }

  // Double force and tilts as touchable node k has them.
  [[nodiscard]] Vec3<double> second_loads(const Contact& c, std::uint32_t k) const noexcept {
    const Vec3<double>& n = field_->touch().nodes()[k].normal;
    const Vec3<double> t1 = perpendicular(n);
    return {c.dipole, c.tilt.dot(t1), c.tilt.dot(n.cross(t1))};
  }

  /// The near field as lanes take it.
  [[nodiscard]] ContactNear near_of(const Contact& c) const noexcept {
    constexpr double scale = 1 / (4 * std::numbers::pi);
    const double pushed = c.P.dot(c.m), nu = field_->nu();
    // At the rim the double force's disc moves -dipole (2 - 2 nu) 3 / (32 a^2); the near term takes it back.
    const double per_depth = 1 / (c.a * disc_compliance(c.a, nu).normal);
    const double rim = settings_.constants.radial * 16 / (3 * per_depth * (2 - 2 * nu)) * std::numbers::pi;
    ContactNear near;
    near.place = c.x.template cast<float>();
    near.m = c.m.template cast<float>();
    near.along = (scale * (c.P - pushed * c.m)).template cast<float>();
    near.normal = static_cast<float>(scale * pushed);
    near.tilt = (scale * c.tilt).template cast<float>();
    near.push = c.push.template cast<float>();
    near.dipole = static_cast<float>(scale * c.dipole);
    near.radial = static_cast<float>(settings_.constants.radial * c.dn2 / c.a);
    near.sink = static_cast<float>(settings_.constants.sink * c.dn2 / c.a);
    near.rim2 = static_cast<float>(rim * rim);
    near.a = static_cast<float>(c.a);
    near.nu = static_cast<float>(nu);
    near.second = settings_.second_order && !(c.ball > 0);
    near.tilted = c.tilt.squaredNorm() > 0;
    near.ball = c.ball > 0;
    return near;
  }

 private:
  void solve_coupled(std::size_t count) noexcept {
    using System = SpdSystem<3 * Capacity>;
    System system{};
    const std::size_t n = 3 * count;
    for (std::size_t i = 0; i < count; ++i) {
      put(system, i, i, contact_[i].C);
      for (std::size_t j = 0; j < i; ++j)
        put(system, i, j,
            0.5 * (coupling(contact_[i], contact_[j]) + coupling(contact_[j], contact_[i]).transpose()));
      for (std::size_t j = 0; j < count; ++j)
        if (i != j) contact_[i].rhs -= second_order(contact_[i], contact_[j]);
    }
    // The coupling times `share`, the diagonal less what one contact is sure to have.
    const auto scaled = [&](double share, double less) {
      System s = system;
      for (std::size_t r = 0; r < n; ++r)
        for (std::size_t c = 0; c <= r; ++c)
          s.at(r, c) =
              (r / 3 == c / 3 ? 1 : share) * s.at(r, c) - (r == c ? less * contact_[r / 3].least : 0);
      for (std::size_t i = 0; i < n; ++i) s.b[i] = contact_[i / 3].rhs[Eigen::Index(i % 3)];
      return s;
    };
    constexpr double sure = 0.05;  // PatchTable: 0.06
    double share = 1;
    System solved = scaled(share, sure);
    if (!solved.solve(n)) {
      double low = 0;
      for (int step = 0; step < 10; ++step) {
        const double middle = 0.5 * (low + share);
        solved = scaled(middle, sure);
        (solved.solve(n) ? low : share) = middle;
      }
      share = low;
    }
    solved = scaled(share, 0);
    const bool ok = solved.solve(n);
    for (std::size_t i = 0; i < count; ++i) {
      contact_[i].P.setZero();
      if (ok) contact_[i].P << solved.b[3 * i], solved.b[3 * i + 1], solved.b[3 * i + 2];
    }
  }
  template <class System>
  static void put(System& system, std::size_t i, std::size_t j, const Mat3<double>& block) noexcept {
    for (std::size_t r = 0; r < 3; ++r)
      for (std::size_t c = 0; c < 3; ++c)
        system.at(3 * i + r, 3 * j + c) = block(Eigen::Index(r), Eigen::Index(c));
  }
  // Mean displacement of patch i by unit forces on patch j.
  [[nodiscard]] Mat3<double> coupling(const Contact& ci, const Contact& cj) const noexcept {
    constexpr double scale = 1 / (4 * std::numbers::pi);
    const double nu = field_->nu(), a = std::hypot(ci.a, cj.a);
    const Vec3<double> r = ci.x - cj.x, p = tangential(r, cj.m);
    const Disc<double> disc(p.squaredNorm(), edge_depth(r, cj.m, a), a);
    Mat3<double> out;
    for (int l = 0; l < 3; ++l) {
      const double fn = cj.m[l];
      const Vec3<double> t = Vec3<double>::Unit(l) - fn * cj.m;
      const auto u = disc.flat(fn, t.dot(p), nu);
      out.col(l) = scale * (u.in_plane * p + u.normal * cj.m + u.along * t);
    }
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) {
        const double g =
            ci.share * cj.share * ci.place.weight[Eigen::Index(i)] * cj.place.weight[Eigen::Index(j)];
        for (std::size_t l = 0; l < 3; ++l)
          out.col(Eigen::Index(l)) += g * field_->at(ci.place.node[i], cj.place.node[j], l);
      }
    return out;
  }
  // Displacement of patch i by contact j's loads of second order.
  [[nodiscard]] Vec3<double> second_order(const Contact& ci, const Contact& cj) const noexcept {
    Vec3<double> out = Vec3<double>::Zero();
    if (cj.dipole == 0) return out;
    const double nu = field_->nu(), a = std::hypot(ci.a, cj.a);
    const Vec3<double> r = ci.x - cj.x, p = tangential(r, cj.m);
    const Disc<double> disc(p.squaredNorm(), edge_depth(r, cj.m, a), a);
    const auto d = disc.double_force(nu), t = disc.tilt(cj.tilt.dot(p), nu);
    out = ((cj.dipole * d.in_plane + t.in_plane) * p + (cj.dipole * d.normal + t.normal) * cj.m +
           t.along * cj.tilt) /
          (4 * std::numbers::pi);
    for (std::size_t j = 0; j < 3; ++j) {
      const Vec3<double> load =
          ci.share * cj.share * cj.place.weight[Eigen::Index(j)] * second_loads(cj, cj.place.node[j]);
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t l = 0; l < 3; ++l)
          out += ci.place.weight[Eigen::Index(i)] * load[Eigen::Index(l)] *
                 field_->at(ci.place.node[i], cj.place.node[j], 3 + l);
    }
    return kept(out, cj) * out;
  }
  // Loads of second order by a solved contact, and the body's answer. The load has moved with the tool: far away that is the
  // moment of the force F by the way d. Near by, a factor of d_n is the local indentation delta_n = C_near P, which is
  // less where the body as a whole gives way.
  void press(Contact& c) const noexcept {
    const SecondOrder& k = settings_.constants;
    const DiscCompliance near = disc_compliance(c.a, field_->nu());
    const double depth = c.d.dot(c.m), held = std::clamp(depth, -2 * c.a, 2 * c.a);
    const Vec3<double> dt = c.d - depth * c.m;
    // No force above the half-space's for d: where the body is far stiffer, the series in depth has nothing to say.
    const double normal = c.P.dot(c.m);
    const Vec3<double> indentation = near.along * c.P + (near.normal - near.along) * normal * c.m;
    const double most = c.d.norm(), length = indentation.norm();
    const Vec3<double> P = length > most ? Vec3<double>(most / length * c.P) : c.P;
    const double pushed = P.dot(c.m), indented = near.normal * pushed;
    c.dn2 = indented * held;
    c.dipole = -pushed * held;
    c.tilt = pushed * dt - held * (P - pushed * c.m);
    c.push = near.along * k.drag * indented * dt - near.normal * k.softening * c.dn2 * c.m;
    if (c.dipole == 0) return;
    Vec3<double> second = c.push;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t node = c.place.node[i];
      second -= c.share * c.share * c.place.weight[Eigen::Index(i)] *
                field_->table().second(node, second_loads(c, node), c.level);
    }
    const double share = kept(second, c);
    c.dipole *= share;
    c.dn2 *= share;
    c.tilt *= share;
    c.push *= share;
    c.rhs += share * second;
  }
  void solve_once(std::size_t count) noexcept {
    if (count == 1)
      contact_[0].P = contact_[0].C.inverse() * contact_[0].rhs;
    else if (count > 1)
      solve_coupled(count);
  }

  const ResponseField* field_;
  Settings settings_;
  std::array<Contact, Capacity> contact_{};
};

}  // namespace palpate::detail
