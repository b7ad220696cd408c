// SPDX-License-Identifier: MIT

/// @file Parameters from bytes: a part reports them (SetupError), or it is finished and every answer of it is
/// finite.

#include "bytes.hpp"

#include <palpate/detection/tool_points.hpp>
#include <palpate/device/gate.hpp>
#include <palpate/elasticity/isotropic.hpp>
#include <palpate/geometry/box.hpp>
#include <palpate/geometry/cylinder.hpp>
#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/geometry/sampled_surface.hpp>
#include <palpate/geometry/sphere.hpp>
#include <palpate/geometry/superellipsoid.hpp>
#include <palpate/law/force/damped.hpp>
#include <palpate/law/force/duffing.hpp>
#include <palpate/law/force/hertz.hpp>
#include <palpate/law/force/linear.hpp>
#include <palpate/law/force/plastic.hpp>
#include <palpate/law/force/power_law.hpp>
#include <palpate/law/force/relaxing.hpp>
#include <palpate/law/force/saturated.hpp>
#include <palpate/law/force/tabulated.hpp>
#include <palpate/law/friction/coulomb.hpp>
#include <palpate/law/friction/power_law.hpp>
#include <palpate/law/map/hertz_map.hpp>
#include <palpate/luo_xiao/beam/euler_bernoulli.hpp>
#include <palpate/luo_xiao/beam/rectangular_section.hpp>
#include <palpate/luo_xiao/beam/skeleton.hpp>
#include <palpate/luo_xiao/beam/timoshenko.hpp>
#include <palpate/luo_xiao/neighbourhood.hpp>
#include <palpate/solver/contact_solver.hpp>
#include <palpate/solver/wrench_ramp.hpp>

#include <cmath>

namespace {
using namespace palpate;
using fuzz::Bytes;
using fuzz::require;

using S = float;  // whose range ends sooner; double has the same code

bool is_nan(S x) { return x != x; }

template <ForceLaw L>
void queries(const L& law, Bytes& in) {
  for (int k = 0; k < 8; ++k) {
    const S D = in.number<S>(), F = law.force(D);
    require(F >= S(0), "a law's force is a number >= 0");
    if (!(D > S(0))) require(F == S(0), "no depth, no force");
    require(law.stiffness(D) >= S(0) && law.energy(D) >= S(0), "stiffness and energy are numbers >= 0");
    const S deeper = law.force(D + std::abs(D) / S(8));
    if (!is_nan(D)) require(deeper >= F * (S(1) - S(1e-5)), "a law does not fall");
    const S f = in.number<S>(), at = law.depth(f);
    require(at >= S(0) && at <= law.max_depth(), "a law's depth is a number within the law");
  }
}
template <FrictionLimits L>
void limits(const L& law, Bytes& in) {
  for (int k = 0; k < 4; ++k) {
    const S F = in.number<S>(), at_rest = law.static_limit(F), sliding = law.sliding_limit(F);
    require(at_rest >= S(0) && sliding >= S(0) && sliding <= at_rest, "friction's limits");
    if (!(F > S(0))) require(at_rest == S(0), "no load, no friction");
  }
}
template <StatefulForceLaw L>
void memory(const L& law, Bytes& in) {
  typename L::State state;
  for (int k = 0; k < 16 && !in.empty(); ++k) {
    const S D = in.number<S>(), dt = in.number<S>();
    state = law.advance(state, D, dt);
    require(law.force(D, state) >= S(0), "a law with memory pushes");
    require(law.energy(D, state) >= S(0) && law.stiffness(D, state) >= S(0), "its energy is a number >= 0");
    require(law.depth(in.number<S>(), state) >= S(0), "its depth is a number >= 0");
  }
}

/// A point on a sphere that takes whatever law and friction come: its wrench is finite.
template <ForceLaw L, FrictionLaw F>
void ticks(const L& law, const F& friction, Bytes& in) {
  ContactSolver<Sphere<S>, L, F> solver({Sphere<S>({.radius = S(0.03)}), {}, law, friction});
  Pose<S> X;
  for (int k = 0; k < 8; ++k) {
    X.translation = Vec3<S>(in.unit<S>(), in.unit<S>(), in.unit<S>()) * S(0.03);
    const fuzz::NoHeap none;
    const auto felt = solver.tick(X, S(1e-3));
    require(is_finite(felt.wrench.force) && is_finite(felt.wrench.torque), "a wrench is finite");
  }
}

template <ContactSurface B>
void surface(const B& body, Bytes& in) {
  for (int k = 0; k < 8; ++k) {
    const Vec3<S> x = in.byte() % 2 ? in.numbers<S>()
                                    : Vec3<S>(in.units<S>().cwiseProduct(body.upper() - body.lower()) +
                                              (body.upper() + body.lower()) / S(2));
    const auto at = body.closest(x);
    require(is_finite(at.position) && is_finite(at.normal) && is_finite(at.distance),
            "a closest point is finite");
    require(std::abs(at.normal.norm() - S(1)) < S(1e-4), "its normal is a unit vector");
    const auto in_it = body.penetration(x);
    require(is_finite(in_it.depth) && is_finite(in_it.gradient) && in_it.gradient.norm() < S(1.01),
            "a depth is finite");
    if (is_finite(x)) {
      const S size = stable_norm(x) + body.upper().cwiseAbs().maxCoeff() + body.lower().cwiseAbs().maxCoeff();
      const S away = stable_norm(Vec3<S>(x - at.position));
      if (is_finite(size) && is_finite(away))
        require(std::abs(away - std::abs(at.distance)) <= S(1e-4) * size,
                "distance is that to the closest point");
    }
    (void)body.separated(x, in.number<S>());
    if constexpr (HasRaycast<B>) (void)body.raycast(x, in.numbers<S>());
  }
}

void one(std::uint8_t kind, Bytes& in) {
  const auto n = [&] { return in.number<S>(); };
  switch (kind) {
    case 0: {
      const S c1 = n(), c3 = n(), mu = n(), slides = n();
      const DuffingForce<S> law({c1, c3});
      queries(law, in);
      const CoulombFriction<S> friction({mu, slides});
      limits(friction, in);
      return ticks(law, friction, in);
    }
    case 1: {
      const S k = n(), C = n(), K = n(), beta = n(), mu = n(), below = n();
      const HertzForce<S> law({k, C});
      queries(law, in);
      const PowerLawFriction<S> friction({K, beta, mu, below});
      limits(friction, in);
      return ticks(law, friction, in);
    }
    case 2: {
      const S k = n(), p = n();
      return queries(PowerLawForce<S>({k, p}), in);
    }
    case 3: {
      const S k = n(), limit = n(), knee = n();
      return queries(SaturatedForce<LinearForce<S>>(LinearForce<S>({k}), {limit, knee}), in);
    }
    case 4: {
      const S c1 = n(), c3 = n(), limit = n(), knee = n();
      return queries(SaturatedForce<DuffingForce<S>>(DuffingForce<S>({c1, c3}), {limit, knee}), in);
    }
    case 5: {
      const S c1 = n(), c3 = n(), yield = n(), hardening = n(), extent = n();
      return memory(PlasticForce<DuffingForce<S>>(DuffingForce<S>({c1, c3}), {yield, hardening, extent}), in);
    }
    case 6: {
      const S k = n(), g1 = n(), t1 = n(), g2 = n(), t2 = n(), extent = n();
      return memory(RelaxingForce<LinearForce<S>, 2>(LinearForce<S>({k}), {{{{g1, t1}, {g2, t2}}}, extent}),
                    in);
    }
    case 7: {
      const S k = n(), c = n();
      const DampedForce<LinearForce<S>, Viscous> law(LinearForce<S>({k}), {c});
      const S D = n(), rate = n();
      return require(law.force(D, rate) >= S(0), "a damped law pushes");
    }
    case 8: {
      std::array<typename TabulatedForce<S, 8>::Sample, 8> samples;
      for (auto& s : samples) s = {n(), n()};
      samples[0] = {S(0), S(0)};
      const std::size_t count = 2 + in.byte() % 7;
      return queries(TabulatedForce<S, 8>(std::span(samples).first(count)), in);
    }
    case 9: {
      const S r = n();
      return surface(Sphere<S>({r, in.numbers<S>()}), in);
    }
    case 10: {
      const Vec3<S> a = in.numbers<S>();
      return surface(Ellipsoid<S>({a, in.numbers<S>()}), in);
    }
    case 11: {
      const Vec3<S> a = in.numbers<S>();
      return surface(Box<S>({a, in.numbers<S>()}), in);
    }
    case 12: {
      const S r = n(), h = n();
      return surface(Cylinder<S>({r, h, in.numbers<S>()}), in);
    }
    case 13: {
      const Vec3<S> a = in.numbers<S>();
      const S e1 = n(), e2 = n();
      return surface(Superellipsoid<S>({a, e1, e2, in.numbers<S>()}), in);
    }
    case 14: {
      const S w = n();
      if (w > S(0) && w < S(1.5e-3)) return;  // right, but slow to set up
      const SampledSurface<Sphere<S>> body(Sphere<S>({.radius = S(0.01)}), {w});
      const auto at = body.penetration(in.units<S>() * S(0.01));
      return require(is_finite(at.depth) && is_finite(at.gradient), "a sampled depth is finite");
    }
    case 15: {
      typename Gate<S>::Params p;
      for (S* x : {&p.max_force, &p.continuous_force, &p.heat_time, &p.max_torque, &p.arm_after, &p.ramp_time,
                   &p.max_gap, &p.max_speed})
        if (in.byte() % 2) *x = n();
      Gate<S> gate(p);
      for (int k = 0; k < 64 && !in.empty(); ++k) {
        const Wrench<S> wish{in.numbers<S>(), in.numbers<S>()};
        const std::uint8_t how = in.byte();
        const S dt = how & 1 ? S(1e-3) : n(), speed = how & 2 ? S(0) : n();
        if (how & 4) gate.disarm();
        const fuzz::NoHeap none;
        const Wrench<S> sent = gate.pass(wish, how & 8, dt, speed);
        require(is_finite(sent.force) && is_finite(sent.torque), "what the gate lets through is finite");
        require(sent.force.norm() <= p.max_force && sent.torque.norm() <= p.max_torque,
                "the gate lets no more through than its limits");
      }
      return;
    }
    case 16: {
      const S time = n();
      WrenchRamp<S> ramp({time});
      for (int k = 0; k < 16 && !in.empty(); ++k) {
        const Wrench<S> wish{in.units<S>(), in.units<S>()};
        if (in.byte() % 4 == 0) ramp.begin();
        const Wrench<S> sent = ramp.pass(wish, in.byte() % 4 != 0, n());
        require(is_finite(sent.force) && is_finite(sent.torque), "what a ramp sends is finite");
      }
      return;
    }
    case 17: {
      const S area = n();
      const Vec3<S> mass = in.numbers<S>();
      std::vector<Vec3<S>> points(in.byte() % 40);
      std::vector<S> areas(points.size());
      for (Vec3<S>& p : points) p = in.byte() % 2 ? in.numbers<S>() : in.units<S>();
      for (S& a : areas) a = in.byte() % 2 ? n() : S(1e-6);
      const ToolPoints<S> tool(points, areas, {area, mass});
      for (const auto& node : tool.nodes())
        for (std::uint32_t i = node.begin; i < node.end; ++i)
          require((tool.point(i) - node.centre).norm() <= node.radius, "a node's ball holds its points");
      return;
    }
    case 18: {
      const S E = n(), nu = n(), rho = n(), kappa = n(), y = n(), z = n(), l = n();
      const IsotropicElasticity<S> material({E, nu, rho});
      require(material.shear_modulus() >= S(0), "a shear modulus is a number >= 0");
      const EllipticSection<S> ellipse({y, z});
      const RectangularSection<S> rectangle({y, z});
      (void)Timoshenko<S>(material, kappa).transverse_stiffness(ellipse, l);
      (void)EulerBernoulli<S>(material).transverse_stiffness(rectangle, l);
      (void)rectangle.flexure_shear(nu, n(), n());
      return;
    }
    case 19: {
      const S reference = n(), radius = n();
      const AreaNeighbourhood<S> neighbourhood({reference, radius});
      ContactDisplacement<S> contact{};
      contact.area = n();
      const S w = neighbourhood.factor(contact);
      return require(w > S(0) && w <= S(1), "a factor is in (0, 1]");
    }
    case 20: {
      const double volume = in.number<double>();
      const VolumePreserving<double> rule({volume});
      const double radius = rule.section(in.number<double>()).radius();
      return require(radius > 0 && is_finite(radius), "a section has a radius");
    }
    default: {
      const S w = n();
      const Vec3<S> low = in.units<S>(), high = low + in.units<S>();
      if (w > S(0) && w < S(0.05)) return;  // right, but slow to set up
      const S k = n(), C = n();
      const HertzMap<S> map({w, low, high}, [&](const Vec3<S>& x) {
        return typename HertzForce<S>::Params{k * (S(2) + x.x()), C};
      });
      const auto law = map.at(in.numbers<S>());
      queries(law, in);
      return require(is_finite(law.configurational_force(n())), "a configurational force is finite");
    }
  }
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes in(data, size);
  const std::uint8_t kind = in.byte();
  try {
    one(kind % 22, in);
  } catch (const SetupError&) {
  }
  return 0;
}
