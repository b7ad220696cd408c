// SPDX-License-Identifier: MIT
#pragma once

/// @file  The tick of a response field: contacts in; forces and the surface's displacement out.

#include <palpate/response/contact_near.hpp>
#include <palpate/response/contact_types.hpp>
#include <palpate/response/response_field.hpp>
#include <palpate/response/sphere_contact.hpp>

namespace palpate {

/// Solves up to `Capacity` coupled contacts and writes the field. Holds the buffers; no heap after construction.
template <std::size_t Capacity = 4>
class ResponseTick {
 public:
  struct Settings {
    bool second_order = true;
    SecondOrder constants = {};
  };
  explicit ResponseTick(const ResponseField& field, const Settings& settings = {})
      : field_(&field), settings_(settings), nodal_(field.stride(), 0.f), near_(Capacity * 4 * field.mesh().vertices.size(), 0.f),
        total_(4 * field.mesh().vertices.size(), 0.f), load_(field.touchable(), Vec3<double>::Zero()), is_loaded_(field.touchable(), 0) {
    loaded_.reserve(field.touchable());
    for (const auto& v : field.mesh().vertices) {
      x_.push_back(static_cast<float>(v.x()));
      y_.push_back(static_cast<float>(v.y()));
      z_.push_back(static_cast<float>(v.z()));
    }
    for (auto* list : {&x_, &y_, &z_}) list->resize(list->size() + 8, 0.f);  // whole lanes
  }

  /// Forces that the tool exerts on the object, one per contact [N]. At most `Capacity` contacts are used. A contact that is
  /// not finite, or whose radius or normal is absurd: no forces and no field for any.
  template <Real S>
  void solve(const ResponseContact<S>* contacts, std::size_t count, Vec3<S>* forces) noexcept {
    count_ = (std::min)(count, Capacity);
    const double mu = field_->shear_modulus();
    for (std::size_t c = 0; c < count_; ++c) {
      forces[c].setZero();
      if (!is_usable(contacts[c])) {
        count_ = 0;
        for (std::size_t i = 0; i < count; ++i) forces[i].setZero();
        return;
      }
      place(contacts[c], contact_[c]);
    }
    if (count_ == 0) return;
    System C = System::Zero(3 * Eigen::Index(count_), 3 * Eigen::Index(count_));
    Column d(3 * Eigen::Index(count_));
    for (std::size_t i = 0; i < count_; ++i) {
      const Contact& ci = contact_[i];
      d.template segment<3>(3 * Eigen::Index(i)) = ci.d;
      for (std::size_t j = 0; j < count_; ++j) {
        const Contact& cj = contact_[j];
        Mat3<double> block = i == j && ci.narrow ? field_->own_compliance(ci.triangle, ci.weight) : Mat3<double>(Mat3<double>::Zero());
        if (!(i == j && ci.narrow))
          for (const Weight& u : ci.patch)
            for (const Weight& v : cj.patch) block += (u.weight * v.weight) * field_->block(u.node, v.node);
        if (i == j) block += ci.near_compliance;
        else
          for (int l = 0; l < 3; ++l) block.col(l) += near(cj, ci.x, Vec3<double>::Unit(l), 0, Vec3<double>::Zero()) / (4 * std::numbers::pi);
        C.template block<3, 3>(3 * Eigen::Index(i), 3 * Eigen::Index(j)) = block;
      }
    }
    C = (0.5 * (C + C.transpose())).eval();  // reciprocity, exact
    const Eigen::PartialPivLU<System> lu(C);
    Column P = lu.solve(d);
    if (settings_.second_order) {
      const SecondOrder& k = settings_.constants;
      Column rhs = Column::Zero(3 * Eigen::Index(count_));
      for (std::size_t j = 0; j < count_; ++j) {
        Contact& cj = contact_[j];
        const double depth = cj.d.dot(cj.m), held = std::clamp(depth, -2 * cj.a, 2 * cj.a);
        const Vec3<double> dt = cj.d - depth * cj.m;
        cj.dipole = -k.dipole * cj.a * depth * held;
        cj.tilt = k.tilt * cj.a * held * dt;
        cj.dn2 = depth * held;
        const Vec3<double> push = k.drag * held * dt - k.softening * depth * held * cj.m;
        cj.push = cj.near_compliance * push;
        rhs.template segment<3>(3 * Eigen::Index(j)) += cj.push;
        const bool alone = count_ == 1 && cj.narrow;
        if (!alone) gather(cj);
        for (std::size_t i = 0; i < count_; ++i) {
          const Contact& ci = contact_[i];
          Vec3<double> u = alone ? field_->own_second(cj.triangle, cj.weight, 0.5 * cj.dipole * Mat3<double>::Identity() + cj.m * cj.tilt.transpose()) : Vec3<double>(Vec3<double>::Zero());
          for (std::uint32_t node : loaded_)
            for (const Weight& w : ci.patch) u += w.weight * (field_->block(w.node, node) * load_[node]);
          if (i != j) u += near(cj, ci.x, Vec3<double>::Zero(), cj.dipole, cj.tilt) / (4 * std::numbers::pi);
          rhs.template segment<3>(3 * Eigen::Index(i)) -= u;
        }
        clear();
      }
      P += lu.solve(rhs);
    }
    for (std::size_t c = 0; c < count_; ++c) {
      contact_[c].P = P.template segment<3>(3 * Eigen::Index(c));
      forces[c] = (mu * contact_[c].P).template cast<S>();
    }
  }

  /// One sphere alone; then `displace` writes its field.
  template <Real S>
  [[nodiscard]] SphereForce<double> solve(const SphereContact<S>& in) noexcept {
    const double nu = field_->params().nu, mu = field_->shear_modulus(), modulus = field_->params().E / (1 - nu * nu);
    const double ball = double(in.radius), depth = (std::max)(double(in.depth), 0.0);
    count_ = 0;
    if (!is_usable(ResponseContact<S>{in.place, in.normal, in.radius, Vec3<S>(in.normal * in.depth)}) || !is_finite(in.curvature)) return {0, 0, 0};
    const double R = 1 / (std::max)(1 / ball + 0.5 * double(in.curvature), 1e-3 / ball);
    Contact& c = contact_[0];
    count_ = depth > 0 ? 1 : 0;
    SphereForce<double> out{0, 0, 0};
    double radius = std::sqrt(0.5 * R * (std::min)(depth, R));
    for (int pass = 0; pass < 2 && count_ == 1; ++pass) {  // C_w hardly depends on a
      place(ResponseContact<S>{in.place, in.normal, S(radius), Vec3<S>(-in.normal * in.depth)}, c);
      Mat3<double> w = Mat3<double>::Zero();
      for (const Weight& u : c.patch)
        for (const Weight& v : c.patch) w += (u.weight * v.weight) * field_->block(u.node, v.node);
      out = sphere_force(depth, R, modulus, c.m.dot(w * c.m) / mu);
      radius = out.radius;
    }
    c.a = radius;
    c.ball = ball;
    c.P = out.force / mu * c.m;
    return out;
  }

  /// Displacement of every bound vertex, after `solve`: component i of vertex v at out[v * stride + i].
  ///
  /// Total field at the solve mesh's vertices, interpolated; near a contact u_near is taken at the vertex itself instead.
  template <Real S>
  void displace(const ResponseDisplay& display, S* out, std::size_t stride) noexcept {
    using detail::Lane;
    using detail::Lane3;
    const SolveMesh& m = field_->mesh();
    const std::size_t n = m.vertices.size();
    std::fill(nodal_.begin(), nodal_.end(), 0.f);
    for (std::size_t c = 0; c < count_; ++c) {
      const Contact& k = contact_[c];
      combine(k);
      const detail::ContactNear& near = near_field_[c] = near_of(k);
      float* own = &near_[c * 4 * n];
      for (std::size_t v = 0; v < n; v += 8) {
        const Lane3 u = near({Lane::Map(&x_[v]), Lane::Map(&y_[v]), Lane::Map(&z_[v])});
        for (std::size_t i = v; i < (std::min)(v + 8, n); ++i) {
          const auto l = static_cast<Eigen::Index>(i - v);
          own[4 * i] = u.x[l], own[4 * i + 1] = u.y[l], own[4 * i + 2] = u.z[l];
        }
      }
    }
    total_.assign(total_.size(), 0.f);
    for (std::size_t v = 0; v < n; ++v) {
      if (m.fixed_vertex[v]) continue;
      for (std::size_t i = 0; i < 3; ++i) total_[4 * v + i] = nodal_[3 * v + i];
      for (std::size_t c = 0; c < count_; ++c)
        for (std::size_t i = 0; i < 3; ++i) total_[4 * v + i] += near_[4 * (c * n + v) + i];
    }
    for (const auto& span : display.spans) {
      bool far = true;
      const float reach = static_cast<float>(2.5 * m.length);
      for (std::size_t c = 0; c < count_; ++c)
        far = far && (span.centre - contact_[c].x.template cast<float>()).norm() > span.radius + reach + static_cast<float>(contact_[c].a);
      if (far || m.fixed_triangle[span.triangle]) spread(display, span, out, stride);
      else refine(display, span, reach, out, stride);
    }
  }

 private:
  struct Weight {
    std::uint32_t node;
    double weight;
  };
  struct Contact {
    Vec3<double> x, m, d;
    double a = 0;
    Mat3<double> near_compliance;   // times mu
    FixedVector<Weight, 40> patch;  // mean over the patch
    FixedVector<Weight, 3> centre;
    std::uint32_t triangle = 0;
    Vec3<double> weight;            // barycentric, of the centre
    bool narrow = true;             // the patch is the centre
    Vec3<double> P = Vec3<double>::Zero();  // force / mu
    double dipole = 0, dn2 = 0;             // / mu
    double rim2 = 1;                        // see contact_near.hpp
    Vec3<double> push = Vec3<double>::Zero();
    double ball = 0;                        // radius of the sphere; 0: stuck patch
    Vec3<double> tilt = Vec3<double>::Zero();
  };
  using System = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3 * int(Capacity), 3 * int(Capacity)>;
  using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3 * int(Capacity), 1>;

  template <Real S>
  void place(const ResponseContact<S>& in, Contact& c) const noexcept {
    c.x = in.place.template cast<double>();
    c.m = -in.normal.template cast<double>();
    c.d = in.displacement.template cast<double>();
    c.a = double(in.radius);
    c.dipole = c.dn2 = 0;
    c.push.setZero();
    c.ball = 0;
    // At the rim the double force's disc moves -dipole (2 - 2 nu) 3 / (32) d_n^2 / a; the near term takes it back.
    const double rim = settings_.constants.radial * 16 / (3 * settings_.constants.dipole * (2 - 2 * field_->params().nu)) * std::numbers::pi;
    c.rim2 = rim * rim;
    c.tilt.setZero();
    const double nu = field_->params().nu, b = 1 - 2 * nu;
    // Stuck flat disc on a half-space: normal 4 mu a ln(3 - 4 nu) / (1 - 2 nu), tangential 8 mu a / (2 - nu).
    const double normal = b > 1e-6 ? b / (4 * c.a * std::log1p(2 * b)) : 1 / (8 * c.a), along = (2 - nu) / (8 * c.a);
    c.near_compliance = along * Mat3<double>::Identity() + (normal - along) * (c.m * c.m.transpose());
    c.patch.clear();
    c.centre.clear();
    const MeshPoint<double> at = field_->locate(c.x);
    c.triangle = at.triangle;
    c.weight = at.weight;
    const auto& nodes = field_->nodes_of(at.triangle);
    double size = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      c.centre.push_back({nodes[i], at.weight[Eigen::Index(i)]});
      size += at.weight[Eigen::Index(i)] * field_->node(nodes[i]).size;
    }
    // A patch wider than the columns' own sources is the mean over twelve points with the disc's weight.
    const double wide2 = c.a * c.a - 0.25 * size * size;
    c.narrow = !(wide2 > 0);
    if (c.narrow) {
      for (const Weight& w : c.centre) c.patch.push_back(w);
      return;
    }
    const Vec3<double> t1 = perpendicular(c.m), t2 = c.m.cross(t1);
    for (int ring = 0; ring < 2; ++ring) {
      const double cosine = ring == 0 ? 0.21132486540518713 : 0.78867513459481287;  // Gauss: uniform in sqrt(1 - s^2/a^2)
      const double s = std::sqrt(wide2 * (1 - cosine * cosine));
      for (int k = 0; k < 6; ++k) {
        const double angle = (k + 0.5 * ring) * std::numbers::pi / 3;
        const MeshPoint<double> p = field_->locate(c.x + s * (std::cos(angle) * t1 + std::sin(angle) * t2));
        for (std::size_t i = 0; i < 3; ++i) add(c.patch, field_->nodes_of(p.triangle)[i], p.weight[Eigen::Index(i)] / 12);
      }
    }
  }
  static void add(FixedVector<Weight, 40>& list, std::uint32_t node, double weight) noexcept {
    for (Weight& w : list)
      if (w.node == node) {
        w.weight += weight;
        return;
      }
    if (!list.full()) list.push_back({node, weight});
  }

  void add_load(std::uint32_t node, const Vec3<double>& f) noexcept {
    if (!is_loaded_[node]) {
      is_loaded_[node] = 1;
      loaded_.push_back(node);
      load_[node].setZero();
    }
    load_[node] += f;
  }
  void clear() noexcept {
    for (auto n : loaded_) is_loaded_[n] = 0;
    loaded_.clear();
  }
  // Nodal forces that stand for the double force and the tilt: derivatives of the columns along the surface.
  void gather(const Contact& c) noexcept {
    if (!settings_.second_order || c.ball > 0) return;
    for (const Weight& w : c.centre)
      for (const auto* g = field_->gradient_begin(w.node); g != field_->gradient_end(w.node); ++g)
        add_load(g->node, w.weight * (0.5 * c.dipole * g->f + g->f.dot(c.tilt) * c.m));
  }

  // Place relative to the contact, and its depth below the patch: the half-space's plane bends with the surface.
  [[nodiscard]] Vec3<double> near(const Contact& c, const Vec3<double>& x, const Vec3<double>& f, double dipole, const Vec3<double>& tilt) const noexcept {
    const double nu = field_->params().nu;
    const Vec3<double> r = x - c.x;
    const double r2 = r.squaredNorm(), z = r.dot(c.m), depth = z * (1 - (std::min)(1.0, c.a * c.a / (std::max)(r2, 1e-300)));
    Vec3<double> u = disc_load(r, c.m, depth, c.a, f, nu);
    if (dipole != 0) {
      const Vec3<double> p = r - z * c.m;
      const Disc<double> disc(p.squaredNorm(), (std::max)(depth, 0.0), c.a);
      const auto d = disc.double_force(nu), t = disc.tilt(tilt.dot(p), nu);
      u += (dipole * d.in_plane + t.in_plane) * p + (dipole * d.normal + t.normal) * c.m + t.along * tilt;
    }
    return u;
  }
  [[nodiscard]] detail::ContactNear near_of(const Contact& c) const noexcept {
    constexpr double scale = 1 / (4 * std::numbers::pi);
    const double pushed = c.P.dot(c.m);
    detail::ContactNear near;
    near.place = c.x.template cast<float>();
    near.m = c.m.template cast<float>();
    near.along = (scale * (c.P - pushed * c.m)).template cast<float>();
    near.normal = static_cast<float>(scale * pushed);
    near.tilt = (scale * c.tilt).template cast<float>();
    near.push = c.push.template cast<float>();
    near.dipole = static_cast<float>(scale * c.dipole);
    near.radial = static_cast<float>(settings_.constants.radial * c.dn2 / c.a);
    near.sink = static_cast<float>(settings_.constants.sink * c.dn2 / c.a);
    near.rim2 = static_cast<float>(c.rim2);
    near.a = static_cast<float>(c.a);
    near.nu = static_cast<float>(field_->params().nu);
    near.second = settings_.second_order;
    near.tilted = c.tilt.squaredNorm() > 0;
    near.ball = c.ball > 0;
    return near;
  }

  // Adds the columns of one contact's loads to nodal_.
  void combine(const Contact& c) noexcept {
    gather(c);
    for (const Weight& w : c.patch) add_load(w.node, w.weight * c.P);
    using Row = Eigen::Map<const Eigen::ArrayXf>;
    const auto size = static_cast<Eigen::Index>(nodal_.size());
    Eigen::Map<Eigen::ArrayXf> sum(nodal_.data(), size);
    for (std::uint32_t node : loaded_) {
      const Vec3<float> f = load_[node].template cast<float>();
      sum += f[0] * Row(field_->column(node, 0), size) + f[1] * Row(field_->column(node, 1), size) + f[2] * Row(field_->column(node, 2), size);
    }
    clear();
  }

  // Linear interpolation over one triangle of the solve mesh.
  template <Real S>
  void spread(const ResponseDisplay& display, const ResponseDisplay::Span& span, S* out, std::size_t stride) const noexcept {
    using Four = Eigen::Array4f;
    const auto& t = field_->mesh().triangles[span.triangle];
    const Four u0 = Four::Map(&total_[4 * t[0]]), e1 = Four::Map(&total_[4 * t[1]]) - u0, e2 = Four::Map(&total_[4 * t[2]]) - u0;
    for (std::uint32_t i = span.begin; i < span.end; ++i) {
      const Four u = u0 + display.b1[i] * e1 + display.b2[i] * e2;
      S* to = out + display.index[i] * stride;
      to[0] = S(u[0]), to[1] = S(u[1]), to[2] = S(u[2]);
    }
  }

  // The same with the near fields exact, fading to their interpolants at the end of their reach.
  template <Real S>
  void refine(const ResponseDisplay& display, const ResponseDisplay::Span& span, float reach, S* out, std::size_t stride) const noexcept {
    using detail::Lane;
    using detail::Lane3;
    const auto& t = field_->mesh().triangles[span.triangle];
    const std::size_t n = field_->mesh().vertices.size();
    for (std::uint32_t i = span.begin; i < span.end; i += 8) {
      const Lane b1 = Lane::Map(&display.b1[i]), b2 = Lane::Map(&display.b2[i]), b0 = 1.f - b1 - b2;
      const Lane3 at{Lane::Map(&display.x[i]), Lane::Map(&display.y[i]), Lane::Map(&display.z[i])};
      const auto interpolate = [&](const float* nodal) {
        const float *p = nodal + 4 * t[0], *q = nodal + 4 * t[1], *r = nodal + 4 * t[2];
        return Lane3{b0 * p[0] + b1 * q[0] + b2 * r[0], b0 * p[1] + b1 * q[1] + b2 * r[1], b0 * p[2] + b1 * q[2] + b2 * r[2]};
      };
      Lane3 u = interpolate(total_.data());
      for (std::size_t c = 0; c < count_; ++c) {
        const Contact& k = contact_[c];
        const Vec3<float> x = k.x.template cast<float>();
        const Lane rx = at.x - x.x(), ry = at.y - x.y(), rz = at.z - x.z(), r = (rx * rx + ry * ry + rz * rz).sqrt();
        const float end = reach + static_cast<float>(k.a), fade = 0.25f * reach;
        const Lane weight = ((end - r) / fade).max(0.f).min(1.f);
        if (!(weight > 0.f).any()) continue;
        const Lane3 exact = near_field_[c](at), linear = interpolate(&near_[4 * c * n]);
        u.x += weight * (exact.x - linear.x);
        u.y += weight * (exact.y - linear.y);
        u.z += weight * (exact.z - linear.z);
      }
      for (std::size_t c = 0; c < count_; ++c) {
        const Contact& k = contact_[c];
        const Vec3<float> x = k.x.template cast<float>(), d = k.d.template cast<float>();
        const Lane rx = at.x - x.x(), ry = at.y - x.y(), rz = at.z - x.z(), r2 = rx * rx + ry * ry + rz * rz;
        if (k.ball > 0) {
          for (Eigen::Index l = 0; l < 8; ++l) {
            if (r2[l] > static_cast<float>(4 * k.a * k.a)) continue;
            Vec3<double> v(double(u.x[l]), double(u.y[l]), double(u.z[l]));
            detail::rest_on_ball(k.m, k.d.dot(k.m), k.ball, k.a, Vec3<double>(double(at.x[l]), double(at.y[l]), double(at.z[l])) - k.x, v);
            u.x[l] = static_cast<float>(v[0]), u.y[l] = static_cast<float>(v[1]), u.z[l] = static_cast<float>(v[2]);
          }
          continue;
        }
        // Patch: arithmetic instead of a choice, see near_field.hpp. The edge's own vertices count, to rounding.
        const Lane inside = ((static_cast<float>(k.a * k.a * (1 + 1e-4)) - r2) * 1e30f).max(0.f).min(1.f);
        u.x += inside * (d.x() - u.x);
        u.y += inside * (d.y() - u.y);
        u.z += inside * (d.z() - u.z);
      }
      const std::uint32_t end = (std::min)(i + 8, span.end);
      for (std::uint32_t j = i; j < end; ++j) {
        S* to = out + display.index[j] * stride;
        to[0] = S(u.x[Eigen::Index(j - i)]);
        to[1] = S(u.y[Eigen::Index(j - i)]);
        to[2] = S(u.z[Eigen::Index(j - i)]);
      }
    }
  }

  const ResponseField* field_;
  Settings settings_;
  std::array<Contact, Capacity> contact_{};
  std::array<detail::ContactNear, Capacity> near_field_{};
  std::size_t count_ = 0;
  std::vector<float> nodal_;         // sum of w at the solve mesh's vertices, 3 each
  std::vector<float> near_, total_;  // near field per contact; all of it; 4 each
  std::vector<float> x_, y_, z_;     // the solve mesh's vertices
  std::vector<Vec3<double>> load_;
  std::vector<std::uint8_t> is_loaded_;
  std::vector<std::uint32_t> loaded_;
};

}  // namespace palpate
