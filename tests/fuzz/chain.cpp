// SPDX-License-Identifier: MIT

/// @file The chain to the motors: devices of every kind, poses and steps from bytes, and a solver that
/// answers whatever the bytes say.

#include "bytes.hpp"

#include <palpate/core/fixed_vector.hpp>
#include <palpate/device/servo_chain.hpp>
#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/law/force/linear.hpp>
#include <palpate/law/friction/coulomb.hpp>
#include <palpate/solver/contact_solver.hpp>

namespace {
using namespace palpate;
using fuzz::Bytes;
using fuzz::require;

/// A solver out of its mind: any number, any status.
class Stub {
 public:
  struct Result {
    Wrench<double> wrench;
    Status status;
    FixedVector<ContactState<double>, 2> contacts;
  };
  explicit Stub(Bytes& in) : in_(in) {}
  Result tick(const Pose<double>&, double) noexcept {
    Result out{};
    const std::uint8_t how = in_.byte();
    const auto vector = [&](std::uint8_t bit) {
      return how & bit ? in_.numbers<double>() : in_.units<double>();
    };
    out.status = how & 1   ? Status::contact
                 : how & 2 ? static_cast<Status>(in_.raw<std::uint32_t>())
                           : Status::ok;
    out.wrench = {vector(4), 0.1 * vector(8)};
    for (int k = 0; k < (how >> 6) % 3; ++k) {
      ContactState<double> c{};
      c.points = in_.byte();
      c.centre = vector(16), c.normal = Vec3<double>::UnitY();
      c.displacement = 0.01 * vector(32), c.force = out.wrench.force;
      c.normal_force = how & 32 ? in_.number<double>() : c.force.norm();
      c.depth = how & 16 ? in_.number<double>() : 0.01 * in_.unit<double>();
      out.contacts.push_back(c);
    }
    return out;
  }

 private:
  Bytes& in_;
};

template <class Chain>
typename Chain::Params params(Bytes& in, typename Chain::Params p) {
  const auto some = [&in](double& x, double low, double high) {
    if (in.byte() % 2) x = in.between<double>(low, high);
  };
  some(p.mapping.scale, 1e-3, 1e3);
  some(p.device.mass, 1e-3, 10);
  some(p.device.damping, 1e-6, 100);
  some(p.device.friction, 1e-6, 1);
  some(p.device.resolution, 1e-9, 1e-2);
  some(p.limits.max_force, 1e-3, 100);
  some(p.limits.max_torque, 1e-3, 10);
  some(p.limits.arm_after, 1e-3, 1);
  some(p.limits.ramp_time, 1e-3, 1);
  some(p.stiffness, 1, 1e5);
  p.device.delay = in.byte() % 9;
  p.has_torque = in.byte() % 2;
  return p;
}

/// Ticks of 1 ms in and out of a body of 30 mm about the origin, and what comes in between.
template <class Chain>
void walk(Chain& chain, Bytes& in) {
  Pose<double> X;
  X.translation = {0, 0.05, 0};
  double dt = 1e-3, speed = 0;
  for (int k = 0; k < 300 && !in.empty(); ++k) {
    const std::uint8_t op = in.byte();
    switch (op % 16) {
      case 0:
        X.translation = in.numbers<double>();
        break;
      case 1:
        X.rotation(op / 16 % 3, in.byte() % 3) = in.number<double>();
        break;
      case 2:
        X.rotation = Mat3<double>::Identity();
        break;
      case 3:
        dt = in.number<double>();
        break;
      case 4:
        speed = in.number<double>();
        break;
      case 5:
        dt = 1e-3, speed = 0;
        break;
      case 6:
        chain.reset();
        break;
      case 7:
        chain.disarm();
        break;
      case 8:
        X.translation = 0.03 * in.units<double>();
        break;
      case 9: {  // turn
        const Vec3<double> axis = in.units<double>();
        if (axis.norm() > 0.01)
          X.rotation =
              Eigen::AngleAxis<double>(in.unit<double>(), axis.normalized()).toRotationMatrix() * X.rotation;
        break;
      }
      default:  // a short step
        X.translation += in.units<double>() * (op & 16 ? 1e-4 : 2e-3);
    }
    const int ticks = op & 32 ? 1 + in.byte() : 1;  // at rest it arms
    for (int i = 0; i < ticks; ++i) {
      const auto out = [&] {
        const fuzz::NoHeap none;
        return chain.tick(X, dt, speed);
      }();
      const auto& [force, torque] = out.wrench;
      require(is_finite(force) && is_finite(torque), "what is sent is finite");
      const auto& limits = chain.params().limits;  // 1e-12: some roundings of the norm, scaled
      require(force.norm() <= limits.max_force * (1 + 1e-12), "no force is above the limit");
      require(torque.norm() <= limits.max_torque * (1 + 1e-12), "no torque is above the limit");
      if (!chain.params().has_torque) require(torque.isZero(0), "no torque without motors for it");
      if (!is_usable(X)) require(force.isZero(0) && torque.isZero(0), "a bad pose gets no force");
      if (!chain.limits().armed()) require(force.isZero(0) && torque.isZero(0), "unarmed, no force");
      require(out.passivity >= 0 && out.passivity <= 1, "passivity scales down");
      const double softened = chain.passivity().softened();
      require(softened >= 0 && softened <= 1, "so does softening");
    }
  }
}

const Ellipsoid<double> egg({.axes = {0.03, 0.02, 0.01}});
using Touch = ContactSolver<Ellipsoid<double>, LinearForce<double>, CoulombFriction<double>>;
Touch touch(Bytes& in) {
  return Touch({egg,
                {.tip = {0, 0, 0}, .centre_of_mass = {0, 0.05, 0}},
                LinearForce<double>({.k = in.between<double>(10, 1e5)}),
                CoulombFriction<double>({.mu_static = 0.5, .mu_dynamic = 0.3})});
}

void direct(Bytes& in) {
  Touch solver = touch(in);
  using Chain = ServoChain<Touch>;
  Chain chain(solver, params<Chain>(in, {}));
  walk(chain, in);
}
void coupled(Bytes& in) {
  Touch solver = touch(in);
  using Chain = ServoChain<Touch, VirtualCoupling<double>>;
  Chain chain(solver, params<Chain>(in, {.coupling = {.stiffness = in.between<double>(10, 1e4),
                                                      .rotational_stiffness = in.between<double>(1e-3, 10),
                                                      .contact_stiffness = in.between<double>(1, 1e5),
                                                      .contact_rotational_stiffness = 1}}));
  walk(chain, in);
}
void stub(Bytes& in) {
  Stub solver(in);
  using Chain = ServoChain<Stub>;
  Chain chain(solver, params<Chain>(in, {}));
  walk(chain, in);
}
void stub_coupled(Bytes& in) {
  Stub solver(in);
  using Chain = ServoChain<Stub, VirtualCoupling<double>>;
  Chain chain(solver, params<Chain>(in, {.coupling = {.stiffness = 1000,
                                                      .rotational_stiffness = 0.1,
                                                      .contact_stiffness = in.between<double>(1, 1e5),
                                                      .contact_rotational_stiffness = 1}}));
  walk(chain, in);
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static void (*const walks[])(Bytes&) = {direct, coupled, stub, stub_coupled};
  Bytes in(data, size);
  walks[in.byte() % std::size(walks)](in);
  return 0;
}
