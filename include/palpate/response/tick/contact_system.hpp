// SPDX-License-Identifier: MIT
#pragma once

/// @file The contacts of one tick of a response field as a linear system: what gives way to which force. Per
/// tick.
///
///     C P = d + C_near q - w_2,   C_ii = C_near + w_ii,   C_ij = u_near(sqrt(a_i^2 + a_j^2)) + w_ij,   F = mu P
///
/// | symbol | name                                                                     | unit   |
/// |--------|--------------------------------------------------------------------------|--------|
/// | C_near | compliance of a half-space to a stuck disc, times mu                     | 1/m    |
/// | w      | the body's correction, times mu                                          | 1/m    |
/// | q, w_2 | second order in depth (SecondOrder): universal forces, the body's answer | m^2, m |
///
/// Loads beside the force: contact_loads.hpp. What contacts do to each other: contact_coupling.hpp. How a
/// wide patch is held: patch_moments.hpp. Where the solve mesh does not resolve the body, a mode of the
/// system may give way too little or even pull: it is held at a tenth of the half-space's smaller compliance
/// (coupled contacts: a twentieth, and a 10,000th of all compliance, to which no mesh knows it: on a plate
/// that bends easily two contacts would else throw each other out), continuously (bounded_compliance.hpp).

#include <palpate/core/cholesky.hpp>
#include <palpate/response/contact_types.hpp>
#include <palpate/response/tick/bounded_compliance.hpp>
#include <palpate/response/tick/contact_coupling.hpp>
#include <palpate/response/tick/contact_loads.hpp>
#include <palpate/response/tick/contact_near.hpp>

#include <algorithm>
#include <limits>

namespace palpate::detail {

template <std::size_t Capacity>
class ContactSystem {
 public:
  using Contact = PlacedContact;
  struct Settings {
    bool second_order = true;
    SecondOrder constants = {};
  };
  ContactSystem(const ResponseField& field, const Settings& settings) : field_(&field), settings_(settings) {
    settings_.constants = settings.constants.at(field.nu());
  }

  /// As they are for this body's nu.
  [[nodiscard]] const SecondOrder& constants() const noexcept { return settings_.constants; }
  /// Null without second order.
  [[nodiscard]] const SecondOrder* second_order() const noexcept {
    return settings_.second_order ? &settings_.constants : nullptr;
  }
  [[nodiscard]] Contact& operator[](std::size_t c) noexcept { return contact_[c]; }
  [[nodiscard]] const Contact& operator[](std::size_t c) const noexcept { return contact_[c]; }
  /// Largest square of a way of the first `count` contacts.
  [[nodiscard]] double deepest2(std::size_t count) const noexcept {
    double way2 = 0;
    for (std::size_t c = 0; c < count; ++c) way2 = (std::max)(way2, contact_[c].way2());
    return way2;
  }

  /// P of the first `count` contacts, all located: first by the forces alone; they give the further loads.
  void solve(std::size_t count) noexcept {
    if constexpr (Capacity > 1)
      if (count > 1) {
        couple(count);
        loosen(count);
      }
    for (std::size_t i = 0; i < count; ++i)
      if (contact_[i].moments.share > 0) widen(contact_[i]);
    for (std::size_t i = 0; i < count; ++i)
      if (contact_[i].is_turned()) turn_by_tool(i, count);
    solve_once(count);
    if constexpr (Capacity > 1)
      if (count > 1) bend(count);
    bool any = false;
    for (std::size_t i = 0; i < count; ++i) {
      press(*field_, second_order(), contact_[i]);
      any = any || contact_[i].has_loads();
    }
    if (any) solve_once(count);
    for (std::size_t i = 0; i < count; ++i)
      if (contact_[i].moments.share > 0) contact_[i].hold_moments();
  }

  /// Of the tool on patch i of `count`, solved, about its middle where it has moved to / mu. Held against w's
  /// twist, of which the field knows nothing. That takes less than all of a compliance: held to half where a
  /// patch is wide for a thin part.
  [[nodiscard]] Vec3<double> torque(std::size_t i, std::size_t count) const noexcept {
    const Contact& c = contact_[i];
    const double stiff = twist_stiffness(*field_, c);
    const auto twisted = [stiff](const Vec3<double>& by_force, const Contact& pushed) {
      const double taken = stiff * by_force.squaredNorm(), whole = pushed.C.trace();
      return smooth_limit(taken * taken, 0.25 * whole * whole) * by_force.dot(pushed.P);
    };
    double angle = twisted(moved_by_twist(*field_, c), c);
    for (std::size_t j = 0; j < count; ++j)
      if (j != i) angle += twisted(coupling_of_twist(*field_, contact_[j], c), contact_[j]);
    return c.felt().cross(c.m) + (c.twist - stiff * angle) * c.m;
  }

  void locate(Contact& c) const noexcept {
    c.dipole = c.twist = c.spread = c.dn2 = c.beta = c.kept = 0;
    c.delta_t.setZero();
    c.tilt.setZero();
    c.tool_tilt.setZero();
    c.swayed.setZero();
    c.felt_tilt.setZero();
    c.turn.setZero();
    c.push.setZero();
    c.held.setZero();
    c.extra.setZero();
    c.bent.setZero();
    c.place = field_->touch().locate(c.x);
    c.nodes.clear();
    add_place(c.nodes, c.place, 1);
    const double size = mean_of(&TouchNode::size, *field_, c),
                 spacing = mean_of(&TouchNode::spacing, *field_, c);
    c.level = field_->table().level(averaged(c, spacing));
    c.sag = field_->table().edge(&MomentRow::sag, c.place.node, c.place.weight, c.a);
    // Far from the surface the nearest place may jump; there w has faded away.
    const double far2 = c.place.distance2 / (size * size);
    c.share = 1 / (1 + far2 * far2);
    c.grip = 1;
    double sum = 0;
    for (const PatchWeight& w : c.nodes) sum += w.weight;
    c.carried = 1 - c.share * (std::max)(1 - sum, 0.0);
    c.w = c.share * c.share * field_->table().own(c.place.triangle, c.place.weight, c.level);
    const FlatPunchCompliance near = flat_punch_compliance(c.a, field_->nu());
    c.C = c.w + (near.normal - near.tangential) * (c.m * c.m.transpose());
    c.C.diagonal().array() += near.tangential;
    c.least = (std::min)(near.normal, near.tangential);
    const Mat3<double> C = c.C;
    invert(c);
    c.w += c.C - C;
    c.moments.share = c.ball > 0 ? 0 : PatchMoments::share_of(c.a, size);
    c.rhs = c.d;
  }

  // s^2 of patch_table.hpp.
  [[nodiscard]] static double averaged(const Contact& c, double spacing) noexcept {
    return c.seen_loaded2() - 0.25 * spacing * spacing;
  }
  // Adds the solved nodes of a place.
  template <class List>
  void add_place(List& list, const TouchPlace& p, double share) const noexcept {
    const TouchMesh& touch = field_->touch();
    const auto add = [&list](std::uint32_t node, double weight) {
      const auto same =
          std::find_if(list.begin(), list.end(), [node](const PatchWeight& w) { return w.node == node; });
      if (same != list.end())
        same->weight += weight;
      else
        list.push_back({node, weight});
    };
    for (std::size_t i = 0; i < 3; ++i) {
      const double weight = share * p.weight[Eigen::Index(i)];
      if (p.node[i] < touch.solved())
        add(p.node[i], weight);
      else
        for (const TouchMesh::Share& s : touch.shares(p.node[i])) add(s.node, weight * double(s.weight));
    }
  }
  // Nodes that share the force: the spreads of the place's nodes (PatchTable), added up in `weight`, one
  // number per solved node, all 0 and left so by the caller. Continuous, which points of the patch's plane
  // laid onto the surface are not: off it, their nearest places jump from sheet to sheet. Returns what is
  // carried.
  [[nodiscard]] double find_patch(const Contact& c, float* weight,
                                  std::vector<std::uint32_t>& nodes) const noexcept {
    nodes.clear();
    double sum = 0;
    each_spread(*field_, c, [&](double part, std::uint32_t k, std::size_t level) {
      for (const TouchMesh::Share& s : field_->table().spread(k, level)) {
        const double w = part * double(s.weight);
        if (!(w > 1e-12)) continue;  // so that a node in the list has a weight
        if (weight[s.node] == 0) nodes.push_back(s.node);
        weight[s.node] += static_cast<float>(w);
        sum += w;
      }
    });
    return 1 - (std::max)(c.share - sum, 0.0);
  }

  // Their parts q of the moments, three numbers each; where there is no weight, none.
  void find_moments(const Contact& c, const float* weight, float* q) const noexcept {
    each_moment(*field_, c, [weight, q](std::uint32_t node, const Vec3<double>& part) {
      if (weight[node] == 0) return;
      for (std::size_t i = 0; i < 3; ++i) q[3 * node + i] += static_cast<float>(part[Eigen::Index(i)]);
    });
  }

  /// The near field as lanes take it.
  [[nodiscard]] ContactNear near_of(const Contact& c) const noexcept {
    constexpr double scale = 1 / (4 * std::numbers::pi);
    const double pushed = c.P.dot(c.m), nu = field_->nu();
    const SecondOrder& k = settings_.constants;
    // At the rim the double force's disc moves -dipole (2 - 2 nu) 3 / (32 a^2); the near term takes it back.
    // (At nu = 0 there is nothing to take back.)
    const double per_depth = 1 / (c.a * flat_punch_compliance(c.a, nu).normal);
    const double moved = (std::max)(outward(nu), 0.01) * per_depth * (2 - 2 * nu);
    const double rim = k.radial * 16 / (3 * moved) * std::numbers::pi;
    ContactNear near;
    near.place = c.x.template cast<float>();
    near.m = c.m.template cast<float>();
    near.along = (scale * (c.P - pushed * c.m)).template cast<float>();
    near.normal = static_cast<float>(scale * pushed);
    Vec3<double> tilt = c.tilt;
    double dipole = c.dipole;
    near.shear.setZero();
    near.sheared = c.moments.share > 0;
    if (near.sheared) {
      tilt += c.moments.tilt(c.held);
      dipole += c.held[0];
      near.shear = (scale * c.moments.shear(c.held)).template cast<float>();
    }
    near.tilt = (scale * tilt).template cast<float>();
    near.turn = (0.375 * (1 - nu) / (c.a * c.a * c.a) * c.turn).template cast<float>();
    near.push = c.push.template cast<float>();
    near.dipole = static_cast<float>(scale * dipole);
    const double dn2 = c.dn2 / c.a, known = (std::min)(c.beta, 1.0);
    near.radial = static_cast<float>(c.ball > 0 ? c.spread : k.radial * dn2);
    near.radial_4 = static_cast<float>(k.radial_4.at(c.beta) * dn2 / c.a);
    near.radial_6 = static_cast<float>(k.radial_6.at(c.beta) * dn2 / c.a);
    near.normal_4 = static_cast<float>(k.normal_4.at(c.beta) * dn2);
    near.normal_6 = static_cast<float>(k.normal_6.at(c.beta) * dn2);
    near.slide = (k.slide.at(known) * known * known / (c.a * c.a) * c.delta_t).template cast<float>();
    near.rim2 = static_cast<float>(rim * rim);
    near.a = static_cast<float>(c.a);
    near.sag = static_cast<float>(c.sag);
    near.grip = static_cast<float>(c.grip);
    near.nu = static_cast<float>(nu);
    near.second = dipole != 0 || c.ball > 0;
    near.tilted = tilt.squaredNorm() > 0;
    near.twist = static_cast<float>(scale * c.twist);
    near.twisted = c.twist != 0;
    if (c.is_turned()) {
      const double angle = c.rotation.norm();
      const Eigen::AngleAxis<double> turned(angle, c.rotation / angle);
      near.turned = (turned.toRotationMatrix() - Mat3<double>::Identity()).template cast<float>();
    }
    near.ball = c.ball > 0;
    return near;
  }

 private:
  // Mean displacement of patch i by contact j: by unit forces, by unit loads beside them.
  struct Coupling {
    Mat3<double> forces, moments;
  };
  [[nodiscard]] Coupling& by(std::size_t i, std::size_t j) noexcept { return coupling_[i * Capacity + j]; }

  // S, with C held.
  static void invert(Contact& c) noexcept {
    if (!is_bounded_below(c.C, one_mode * c.least)) bound_below(c.C, one_mode * c.least);
    c.S = c.C.inverse();
  }
  // What contacts do to each other. It is at most what they give way: with K = L_i N L_j^T, C = L L^T, all
  // singular values of N are below 1, so |N|^2 < 3. One that is t times too large is off by as much, for the
  // mesh does not resolve it, and counts as 1/t of it.
  void couple(std::size_t count) noexcept {
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const Contact &ci = contact_[i], &cj = contact_[j];
        const Mat3<double> K = 0.5 * (coupling(*field_, ci, cj) + coupling(*field_, cj, ci).transpose());
        const Mat3<double> one = ci.S * K, other = K * cj.S;
        const double share = 3 / (std::max)(one.cwiseProduct(other).sum(), 3.0);  // trace of S_i K S_j K^T
        by(i, j) = {share * K, share * coupling_of_moments(*field_, ci, cj)};
        by(j, i) = {share * K.transpose(), share * coupling_of_moments(*field_, cj, ci)};
      }
  }
  // A contact comes in with d = 0 where deeper ones have moved the surface by u: held there it would pull. So
  // it grips by what it has left to do, 1 - u.d/d^2, all of it from a quarter on; and nothing while d is
  // small against u, wherever that points. Deeper ones count, all from twice the depth on: of two alike
  // neither lets the other go. As it comes in, the others' moments are let go (PatchMoments).
  void loosen(std::size_t count) noexcept {
    for (std::size_t i = 0; i < count; ++i) {
      Contact& c = contact_[i];
      const double d2 = c.way2();
      Vec3<double> u = Vec3<double>::Zero();
      for (std::size_t j = 0; j < count; ++j) {
        const double deeper = contact_[j].way2();
        if (!(deeper > d2)) continue;
        u +=
            smooth(std::sqrt(deeper / (d2 + tiny)) - 1) * (by(i, j).forces * (contact_[j].S * contact_[j].d));
      }
      c.grip = smooth(4 * (1 - u.dot(c.d) / (d2 + tiny))) * smooth_limit(0.01 * u.squaredNorm(), d2);
    }
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = 0; j < count; ++j)
        if (i != j) contact_[i].moments.share *= 1 - contact_[j].grip;
  }
  [[nodiscard]] static double smooth(double x) noexcept {
    const double t = std::clamp(x, 0.0, 1.0);
    return t * t * (3 - 2 * t);
  }
  // The tool turns patch i; the others feel its twist at once, its tilt with the other loads.
  void turn_by_tool(std::size_t i, std::size_t count) noexcept {
    Contact& c = contact_[i];
    turn_patch(*field_, c);
    for (std::size_t j = 0; j < count; ++j) {
      if (j == i) continue;
      const Vec3<double> moved = c.twist * coupling_of_twist(*field_, contact_[j], c);
      contact_[j].rhs -= kept(moved.norm(), c) * moved;
    }
  }
  // What the forces do beneath the other contacts' patches.
  void bend(std::size_t count) noexcept {
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = 0; j < count; ++j)
        if (i != j) contact_[j].bent += by(i, j).moments.transpose() * contact_[i].P;
  }
  void widen(Contact& c) const noexcept {
    c.moments.read(*field_, c.place, c.level, c.m, c.a, c.share * c.share, stuck_load(c.a, field_->nu()));
    c.C -= c.moments.taken(c.C.trace());
    invert(c);
  }
  void solve_coupled(std::size_t count) noexcept {
    using System = SpdSystem<3 * Capacity>;
    System system{};
    const std::size_t n = 3 * count;
    // Unknowns P / sqrt(grip): without grip a contact has no force, and the system stays symmetric.
    std::array<double, Capacity> root;
    for (std::size_t i = 0; i < count; ++i) {
      root[i] = std::sqrt(contact_[i].grip);
      put(system, i, i, contact_[i].C);
      for (std::size_t j = 0; j < i; ++j) put(system, i, j, root[i] * root[j] * by(i, j).forces);
      for (std::size_t j = 0; j < count; ++j) {
        if (i == j || !contact_[j].has_loads()) continue;
        const Contact& cj = contact_[j];
        const Mat3<double>& moved = by(i, j).moments;
        const Vec3<double> loads(cj.dipole, cj.tilt.dot(cj.t1()), cj.tilt.dot(cj.t2()));
        contact_[i].rhs -=
            kept(size_of_both(moved.col(0).norm(), cj.dipole, moved.rightCols<2>().norm(), cj.tilt), cj) *
            (moved * loads);
      }
    }
    for (std::size_t i = 0; i < n; ++i) system.b[i] = root[i / 3] * contact_[i / 3].rhs[Eigen::Index(i % 3)];
    std::array<double, Capacity> least;
    double whole = 0;
    for (std::size_t i = 0; i < count; ++i) whole += contact_[i].C.trace();
    for (std::size_t i = 0; i < count; ++i)
      least[i] = coupled_mode * contact_[i].least + resolved_mode * whole;
    System test = system;
    for (std::size_t i = 0; i < n; ++i) test.at(i, i) -= least[i / 3];
    if (!test.factor(n)) hold(system, n, least);
    const bool ok = system.solve(n);
    for (std::size_t i = 0; i < count; ++i) {
      contact_[i].P.setZero();
      if (ok)
        contact_[i].P = root[i] * Vec3<double>(system.b[3 * i], system.b[3 * i + 1], system.b[3 * i + 2]);
    }
  }
  // In units of each contact's least compliance.
  template <class System>
  static void hold(System& system, std::size_t n, const std::array<double, Capacity>& least) noexcept {
    using Square = Eigen::Matrix<double, 3 * int(Capacity), 3 * int(Capacity)>;
    Square C = Square::Identity();  // beyond n
    const auto unit = [&least](std::size_t r, std::size_t c) {
      return std::sqrt(least[r / 3] * least[c / 3]);
    };
    for (std::size_t r = 0; r < n; ++r)
      for (std::size_t c = 0; c < n; ++c)
        C(Eigen::Index(r), Eigen::Index(c)) = system.at((std::max)(r, c), (std::min)(r, c)) / unit(r, c);
    bound_below(C, 1);
    for (std::size_t r = 0; r < n; ++r)
      for (std::size_t c = 0; c <= r; ++c) system.at(r, c) = C(Eigen::Index(r), Eigen::Index(c)) * unit(r, c);
  }
  template <class System>
  static void put(System& system, std::size_t i, std::size_t j, const Mat3<double>& block) noexcept {
    for (std::size_t r = 0; r < 3; ++r)
      for (std::size_t c = 0; c < 3; ++c)
        system.at(3 * i + r, 3 * j + c) = block(Eigen::Index(r), Eigen::Index(c));
  }
  void solve_once(std::size_t count) noexcept {
    if constexpr (Capacity > 1)
      if (count > 1) return solve_coupled(count);
    if (count == 1) contact_[0].P = contact_[0].S * contact_[0].rhs;
  }

  // Least compliance of a mode, of the half-space's; and of all contacts'.
  static constexpr double one_mode = 0.1, coupled_mode = 0.05, resolved_mode = 1e-4;
  static constexpr double tiny = (std::numeric_limits<double>::min)();

  const ResponseField* field_;
  Settings settings_;
  std::array<Contact, Capacity> contact_{};
  std::array<Coupling, Capacity == 1 ? 0 : Capacity * Capacity> coupling_{};
};

}  // namespace palpate::detail
