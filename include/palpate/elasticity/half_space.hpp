// SPDX-License-Identifier: MIT
#pragma once

/// @file  Elastic shape in closed form, without a solve at set-up: the body between two half-spaces.

#include <palpate/core/simd_vec3.hpp>
#include <palpate/display/mesh_normals.hpp>
#include <palpate/display/vertex_writer.hpp>
#include <palpate/elasticity/concept.hpp>
#include <palpate/elasticity/detail/fixed_base.hpp>

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <vector>

namespace palpate {

/// Displacement of the surface as that of half-spaces in series, one under each contact and one over the
/// fixed region, and a rigid motion that holds the fixed region at rest on average:
///
///     u(x) = sum_c K_c(x) P_c + B(x) Q + U + theta x (x - o),   Q = -sum_c (P_c, (x_c - o) x P_c)
///
/// K_c is the field of a force on a bonded flat punch of the contact's radius, B that of force and moment on
/// a disc in place of the fixed region, both closed forms of the half-space (elasticity/disc.hpp); U and
/// theta make u zero over the fixed region in the least squares' sense, and the forces P_c give each contact
/// its displacement D_c, or are 0 where that would take a pull. Own derivation: what a body feels of a small
/// contact, and of a small support, is the half-space's field; the far one sees force and moment only
/// (Saint-Venant). What it leaves out is that the sides are free of traction: docs/accuracy.md says what that
/// costs. Small strain; for large depths the response field has a second-order term.
///
/// | symbol | name | unit | range |
/// |---|---|---|---|
/// | nu | `Params::nu` | - | [0, 1/2] |
/// | a | `Params::smallest_radius` | m | > 0: of a contact with less area; otherwise a = sqrt(area/pi) |
/// |  | `fixed` |  | predicate on positions: which vertices do not move |
///
/// Set-up reports nu and radius out of range, an empty mesh, vertices that do not exist or are not finite,
/// and a fixed region without area or within a line. With the same contacts as in the last tick nothing is
/// done. More than `Capacity` contacts: the surplus is left out and reported. A contact that is not finite:
/// left out.
template <Real S, std::size_t Capacity = 4>
class HalfSpaceDeformation {
 public:
  using Scalar = S;
  static constexpr bool active = true;

  struct Params {
    S nu{S(0.5)};                 ///< Poisson's ratio [-]
    S smallest_radius{S(1e-3L)};  ///< a [m]; chosen: a millimetre
    bool normals{true};           ///< false: none are ever written, and the mesh need not be closed
  };

  template <class Fixed>
  HalfSpaceDeformation(const MeshData<S>& mesh, const Fixed& fixed, const Params& params = {})
      : p_(checked(params, mesh)), base_(mesh, fixed, static_cast<double>(params.nu), name) {
    set_vertices(mesh);
    if (!p_.normals) return;
    normals_ = MeshNormals(mesh.triangles, mesh.vertices.size());
    displace();
    normals_.keep_rest();
  }

  /// Fills the whole buffer with the undeformed shape. The next write() starts from it.
  template <Real T>
  void write_rest(const VertexBuffer<T>& out) noexcept {
    given_ = count_ = 0;
    at_rest_ = true;
    displace();
    store(out);
  }

  /// Writes the shape under `contacts`.
  template <Real T>
  Moved<S> write(std::span<const ContactState<S>> contacts, const VertexBuffer<T>& out) noexcept {
    Moved<S> moved;
    if (contacts.size() > Capacity) moved.status |= Status::region_overflow;
    if (out.positions == nullptr || !take(contacts)) return moved;
    const bool solved = count_ > 0 && solve();
    if (!solved) count_ = 0;
    if (!solved && at_rest_) return moved;
    at_rest_ = !solved;
    displace();
    store(out);
    moved.vertices = moves_.size();
    for (int axis = 0; axis < 3; ++axis) {
      const auto all = Eigen::Map<const Eigen::ArrayXf>(now_[static_cast<std::size_t>(axis)].data(),
                                                        static_cast<Eigen::Index>(moves_.size()));
      moved.lower[axis] = static_cast<S>(all.minCoeff());
      moved.upper[axis] = static_cast<S>(all.maxCoeff());
    }
    return moved;
  }

  /// Forces that the tools exert by this model over the shear modulus [m^2], contact by contact of the last
  /// write(): times mu an estimate of the contact's force, to 6 to 20 % of finite elements' for small depths.
  [[nodiscard]] std::span<const Vec3<double>> forces() const noexcept { return {force_.data(), count_}; }
  [[nodiscard]] const Params& params() const noexcept { return p_; }

 private:
  static constexpr const char* name = "HalfSpaceDeformation";
  static constexpr double scale = 1 / (4 * std::numbers::pi);  // of disc.hpp
  using V = Vec3<double>;
  using Screw = detail::Screw;
  using Simd = detail::simd_at_most<float, 8>;

  struct Contact {
    V x, m, d;  // position, unit normal into the body, displacement [m]
    double a;
    [[nodiscard]] bool operator==(const Contact&) const noexcept = default;
  };

  // What the base's disc does at a vertex per load, times 4 pi mu, in its own frame.
  struct Profile {
    std::vector<float> force_in, force_down, shear_in, shear_down, shear_along, couple_in, couple_down,
        couple_along, torsion;
  };

  [[nodiscard]] static const Params& checked(const Params& p, const MeshData<S>& mesh) {
    if (!is_finite(p.nu) || !(p.nu >= S(0) && p.nu <= S(0.5)))
      fail(name, "nu must be in [0, 1/2]", static_cast<double>(p.nu));
    require_positive(p.smallest_radius, name, "smallest_radius [m] must be > 0");
    if (mesh.vertices.empty() || mesh.triangles.empty()) fail(name, "needs a mesh with triangles");
    return p;
  }

  void set_vertices(const MeshData<S>& mesh) {
    const std::size_t n = mesh.vertices.size(), padded = detail::padded<Simd>(n);
    for (auto& list : now_) list.assign(padded, 0.f);
    for (auto* list : {&x_, &y_, &z_, &ux_, &uy_, &uz_}) list->assign(padded, 0.f);
    for (auto* list : {&profile_.force_in, &profile_.force_down, &profile_.shear_in, &profile_.shear_down,
                       &profile_.shear_along, &profile_.couple_in, &profile_.couple_down,
                       &profile_.couple_along, &profile_.torsion})
      list->assign(padded, 0.f);
    for (std::size_t v = 0; v < n; ++v) {
      moves_.push_back(base_.fixed()[v] ? 0.f : 1.f);
      x_[v] = static_cast<float>(mesh.vertices[v].x());
      y_[v] = static_cast<float>(mesh.vertices[v].y());
      z_[v] = static_cast<float>(mesh.vertices[v].z());
      const Disc<double> disc = base_.disc(mesh.vertices[v].template cast<double>() - base_.middle());
      const double nu = static_cast<double>(p_.nu);
      const auto put = [&](std::vector<float>& list, double value) {
        list[v] = static_cast<float>(value * scale);
      };
      const auto force = disc.flat_punch(1, 0, nu), shear = disc.flat_punch(0, 1, nu),
                 couple = disc.bending_couple(1, nu);
      put(profile_.force_in, force.in_plane);
      put(profile_.force_down, force.normal);
      put(profile_.shear_in, shear.in_plane);
      put(profile_.shear_down, shear.normal);
      put(profile_.shear_along, shear.along);
      put(profile_.couple_in, couple.in_plane);
      put(profile_.couple_down, couple.normal);
      put(profile_.couple_along, couple.along);
      put(profile_.torsion, disc.torsional_couple());
    }
  }

  [[nodiscard]] V contact_field(const Contact& c, const V& x, const V& f) const noexcept {
    const V r = x - c.x;
    return scale * flat_punch_load(r, c.m, edge_depth(r, c.m, c.a), c.a, f, static_cast<double>(p_.nu));
  }

  // Keeps the contacts; false when they are those of the last tick.
  bool take(std::span<const ContactState<S>> contacts) noexcept {
    std::array<Contact, Capacity> now;
    std::size_t count = 0;
    for (std::size_t j = 0; j < (std::min)(contacts.size(), Capacity); ++j) {
      const ContactState<S>& c = contacts[j];
      const Vec3<S> x = c.origin();
      if (!is_finite(x) || !is_finite(c.displacement) || !is_finite(c.normal) || !is_finite(c.area)) continue;
      if (!(x.cwiseAbs().maxCoeff() <= S(1e6)) || !(c.displacement.cwiseAbs().maxCoeff() <= S(1e6))) continue;
      const double round = c.area > S(0) ? std::sqrt(static_cast<double>(c.area) / std::numbers::pi) : 0;
      now[count++] = {
          x.template cast<double>(), -unit_or<double>(c.normal.template cast<double>(), V::UnitY()),
          c.displacement.template cast<double>(), (std::max)(round, static_cast<double>(p_.smallest_radius))};
    }
    if (count == given_ &&
        std::equal(now.begin(), now.begin() + static_cast<std::ptrdiff_t>(count), contact_.begin()))
      return false;
    contact_ = now;
    given_ = count_ = count;
    return true;
  }

  // Forces over mu, base load and rigid motion. A tool cannot pull: contacts that would are released, the
  // strongest first. So one that appears where others have already moved the surface away changes nothing.
  // False: no contact is left.
  bool solve() noexcept {
    const auto n = static_cast<Eigen::Index>(3 * count_);
    System C(n, n);
    Column d(n);
    std::array<std::array<Screw, 3>, Capacity> motion;
    for (std::size_t j = 0; j < count_; ++j) {
      const Contact& cj = contact_[j];
      d.template segment<3>(static_cast<Eigen::Index>(3 * j)) = cj.d;
      const FlatPunchCompliance own = flat_punch_compliance(cj.a, static_cast<double>(p_.nu));
      for (int k = 0; k < 3; ++k) {
        const V f = V::Unit(k);
        const Screw q = base_.reaction(cj.x, f);
        Screw& w = motion[j][static_cast<std::size_t>(k)];
        w = -(base_.fit([&](const V& y) { return contact_field(cj, V(base_.middle() + y), f); }) +
              base_.fit(q));
        for (std::size_t i = 0; i < count_; ++i) {
          const Contact& ci = contact_[i];
          const V y = ci.x - base_.middle();
          const double fn = f.dot(cj.m);
          const V direct = i == j ? V(own.normal * fn * cj.m + own.tangential * (f - fn * cj.m))
                                  : contact_field(cj, ci.x, f);
          C.template block<3, 1>(static_cast<Eigen::Index>(3 * i), static_cast<Eigen::Index>(3 * j) + k) =
              direct + base_.field(y, q) + detail::rigid_motion(w, y);
        }
      }
    }
    C = (0.5 * (C + C.transpose())).eval();  // reciprocity
    std::array<std::size_t, Capacity> pressing;
    std::size_t left = count_;
    for (std::size_t j = 0; j < count_; ++j) pressing[j] = j;
    force_.fill(V::Zero());
    while (left > 0) {
      const auto rows = static_cast<Eigen::Index>(3 * left);
      System part(rows, rows);
      Column want(rows);
      for (std::size_t i = 0; i < left; ++i) {
        const auto from_i = static_cast<Eigen::Index>(3 * pressing[i]),
                   to_i = static_cast<Eigen::Index>(3 * i);
        want.template segment<3>(to_i) = d.template segment<3>(from_i);
        for (std::size_t j = 0; j < left; ++j)
          part.template block<3, 3>(to_i, static_cast<Eigen::Index>(3 * j)) =
              C.template block<3, 3>(from_i, static_cast<Eigen::Index>(3 * pressing[j]));
      }
      const Column P = part.partialPivLu().solve(want);
      std::size_t worst = left;
      double pull = 0;
      for (std::size_t i = 0; i < left; ++i) {
        const V f = P.template segment<3>(static_cast<Eigen::Index>(3 * i));
        if (!is_finite(f)) return false;
        force_[pressing[i]] = f;
        const double normal = f.dot(contact_[pressing[i]].m);
        if (normal < pull || (normal <= 0 && worst == left)) pull = normal, worst = i;
      }
      if (worst == left) break;
      force_[pressing[worst]].setZero();
      std::copy(pressing.begin() + static_cast<std::ptrdiff_t>(worst) + 1,
                pressing.begin() + static_cast<std::ptrdiff_t>(left),
                pressing.begin() + static_cast<std::ptrdiff_t>(worst));
      --left;
    }
    if (left == 0) return false;
    load_.setZero();
    motion_.setZero();
    for (std::size_t j = 0; j < count_; ++j) {
      load_ += base_.reaction(contact_[j].x, force_[j]);
      for (std::size_t k = 0; k < 3; ++k) motion_ += force_[j][static_cast<int>(k)] * motion[j][k];
    }
    return true;
  }

  void displace() noexcept {
    const std::size_t n = moves_.size();
    const std::array<const std::vector<float>*, 3> rest{&x_, &y_, &z_}, change{&ux_, &uy_, &uz_};
    if (count_ > 0) {
      add_base();
      for (std::size_t c = 0; c < count_; ++c) add_contact(contact_[c], force_[c]);
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float* PALPATE_RESTRICT const x = rest[axis]->data();
      const float* PALPATE_RESTRICT const u = change[axis]->data();
      const float* PALPATE_RESTRICT const moves = moves_.data();
      float* PALPATE_RESTRICT const out = now_[axis].data();
      if (count_ == 0)
        std::copy_n(x, n, out);
      else
        for (std::size_t v = 0; v < n; ++v) out[v] = x[v] + moves[v] * u[v];
    }
    if (p_.normals) {
      normals_.positions().set_row(0, n, now_[0].data(), now_[1].data(), now_[2].data());
      normals_.positions().pack(0);
    }
  }

  using Batch = detail::SimdVec3<Simd>;
  [[nodiscard]] static PALPATE_INLINE Simd load(const float* from) noexcept { return Simd(from); }
  // The same vector in every entry.
  [[nodiscard]] static PALPATE_INLINE Batch repeated(const V& v) noexcept {
    return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
  }
  [[nodiscard]] PALPATE_INLINE Batch from(const Batch& o, std::size_t v) const noexcept {
    return Batch{load(&x_[v]), load(&y_[v]), load(&z_[v])} - o;
  }

  void add_base() noexcept {
    const V force = load_.template head<3>(), moment = load_.template tail<3>(), &inward = base_.inward();
    const Batch o = repeated(base_.middle()), m = repeated(inward),
                shift = repeated(motion_.template head<3>()), rotation = repeated(motion_.template tail<3>()),
                t = repeated(tangential<double>(force, inward)), k = repeated(inward.cross(moment));
    const Simd fn = static_cast<float>(force.dot(inward)), torsion = static_cast<float>(moment.dot(inward)),
               one = 1.f;
    const Profile& b = profile_;
    for (std::size_t v = 0; v < x_.size(); v += Simd::size()) {
      const Batch r = from(o, v);
      const Simd z = dot(r, m);
      const Batch p = r + (-z) * m;
      const Simd tp = dot(p, t), kp = dot(p, k);
      const Simd in = fn * load(&b.force_in[v]) + tp * load(&b.shear_in[v]) + kp * load(&b.couple_in[v]);
      const Simd down =
          fn * load(&b.force_down[v]) + tp * load(&b.shear_down[v]) + kp * load(&b.couple_down[v]);
      Batch u = shift;
      u += in * p;
      u += down * m;
      u += load(&b.shear_along[v]) * t;
      u += load(&b.couple_along[v]) * k;
      u += (torsion * load(&b.torsion[v])) * cross(m, p);
      u += one * cross(rotation, r);
      put(u, v);
    }
  }

  void add_contact(const Contact& c, const V& force) noexcept {
    const Batch o = repeated(c.x), m = repeated(c.m), t = repeated(scale * tangential<double>(force, c.m));
    const float a = static_cast<float>(c.a), nu = static_cast<float>(p_.nu),
                fn = static_cast<float>(scale * force.dot(c.m));
    for (std::size_t v = 0; v < x_.size(); v += Simd::size()) {
      const Batch r = from(o, v);
      const Simd z = dot(r, m), square = (detail::max)(dot(r, r), 1e-12f * a * a);  // not 0 at the middle
      const Batch p = r + (-z) * m;
      const Simd depth = (detail::max)(z * (1.f - (detail::min)(a * a / square, 1.f)), 0.f);
      const auto w = Disc<Simd, float>(dot(p, p), depth, a).flat_punch(fn, dot(p, t), nu);
      Batch u{load(&ux_[v]), load(&uy_[v]), load(&uz_[v])};
      u += w.in_plane * p;
      u += w.normal * m;
      u += w.along * t;
      put(u, v);
    }
  }
  PALPATE_INLINE void put(const Batch& u, std::size_t v) noexcept {
    u.x.copy_to(&ux_[v]);
    u.y.copy_to(&uy_[v]);
    u.z.copy_to(&uz_[v]);
  }

  template <Real T>
  void store(const VertexBuffer<T>& out) const noexcept {
    detail::VertexWriter<T>(out.positions, out.position_stride)
        .put_run(0, moves_.size(), now_[0].data(), now_[1].data(), now_[2].data());
    if (p_.normals && out.normals != nullptr) normals_.write(out);
  }

  static constexpr int most_rows = 3 * static_cast<int>(Capacity);
  using System = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most_rows, most_rows>;
  using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_rows, 1>;

  Params p_;
  detail::FixedBase base_;
  std::vector<float> x_, y_, z_, ux_, uy_, uz_;  // undeformed positions and displacements [m], padded
  std::vector<float> moves_;                     // 0 for a fixed vertex, else 1
  Profile profile_;
  MeshNormals normals_;
  std::array<std::vector<float>, 3> now_;  // positions [m]
  std::array<Contact, Capacity> contact_{};
  std::array<V, Capacity> force_{};
  Screw load_ = Screw::Zero(), motion_ = Screw::Zero();
  std::size_t given_ = 0, count_ = 0;
  bool at_rest_ = true;
};

static_assert(DeformationModel<HalfSpaceDeformation<float>> &&
              DeformationModel<HalfSpaceDeformation<double>>);

}  // namespace palpate
