// SPDX-License-Identifier: MIT
#pragma once

/// @file  A spring between the device and the tool in the scene: the hand feels at most its stiffness.

#include <palpate/core/error.hpp>
#include <palpate/core/pose.hpp>
#include <palpate/device/detail/turned.hpp>

#include <cmath>

namespace palpate {

/// No coupling: the tool is where the device is.
template <Real S>
struct NoVirtualCoupling {
  using Scalar = S;
  static constexpr bool active = false;
  struct Params {};
  explicit NoVirtualCoupling(const Params&) {}
};

/// A virtual coupling [colgate1995] whose tool has no mass: a proxy that rests where contact and spring
/// balance, near the surface. In place of the contact's stiffness K_c the hand feels K K_c/(K + K_c).
///
///     P' = P + (K (X - P) + F(P))/(K + K_m)      one step a tick towards K (X - P) + F = 0
///     sent = K (P' - X)
///
/// for the tool's centre of mass, and the same for rotation with K_r, K_mr and the rotation vector of
/// R_X R_P^T. X: the tool's pose by the device; F(P): contact force at the tool's pose P in the scene.
///
/// | symbol | name                            | unit    | range |
/// |--------|---------------------------------|---------|-------|
/// | K      | `stiffness`                     | N/m     | > 0   |
/// | K_r    | `rotational_stiffness`          | N m/rad | > 0   |
/// | K_m    | `contact_stiffness`             | N/m     | >= 0  |
/// | K_mr   | `contact_rotational_stiffness`  | N m/rad | >= 0  |
/// |        | `centre_of_mass`                | m       | finite|
///
/// Choose K_m and K_mr no less than the scene's largest tangent stiffness (largest_stiffness()): each step
/// then lowers 1/2 K |X - P|^2 + U(P), U the contact's potential. So all that a tick can make is what holding
/// K (P - X) makes, 1/2 K |dX|^2, and a device is passive with
///
///     K s <= 2 b/((2 d + 1) T)                   (passive_stiffness(), s the workspace's scale)
///
/// however stiff the scene is and whatever hand holds it. A smaller K_m may buzz, a larger one lets the tool
/// lag. Without contact the tool is where the device is and the force is exactly 0. In the tick in which
/// contact begins it is 0 too: the proxy still lies at the device's pose.
///
/// noexcept, no heap. A pose or wrench that is not finite: zero wrench, and the coupling begins anew.
template <Real S>
class VirtualCoupling {
 public:
  using Scalar = S;
  static constexpr bool active = true;

  struct Params {
    S stiffness;
    S rotational_stiffness;
    S contact_stiffness;
    S contact_rotational_stiffness;
    Vec3<S> centre_of_mass = Vec3<S>::Zero();  ///< of the tool, in tool coordinates
  };

  /// Reports a parameter out of the range above.
  explicit VirtualCoupling(const Params& params) : p_(params) {
    require_positive(p_.stiffness, "VirtualCoupling", "stiffness [N/m] must be > 0");
    require_positive(p_.rotational_stiffness, "VirtualCoupling",
                     "rotational_stiffness [N m/rad] must be > 0");
    require_non_negative(p_.contact_stiffness, "VirtualCoupling", "contact_stiffness [N/m] must be >= 0");
    require_non_negative(p_.contact_rotational_stiffness, "VirtualCoupling",
                         "contact_rotational_stiffness [N m/rad] must be >= 0");
    if (!is_finite(p_.centre_of_mass)) fail("VirtualCoupling", "centre_of_mass must be finite");
  }

  /// Where the tool is in the scene in this tick; the solver is asked there. X: by the device.
  [[nodiscard]] const Pose<S>& tool(const Pose<S>& X) noexcept {
    if (!touches_ || !is_usable(X)) {
      tool_ = X;
      return tool_;
    }
    const Vec3<S> centre = tool_ * p_.centre_of_mass;
    const Vec3<S> pull = p_.stiffness * (X * p_.centre_of_mass - centre) + contact_.force;
    const Vec3<S> twist =
        p_.rotational_stiffness * detail::turned(tool_.rotation, X.rotation) + contact_.torque;
    const Vec3<S> step = pull / (p_.stiffness + p_.contact_stiffness);
    const Vec3<S> turn = twist / (p_.rotational_stiffness + p_.contact_rotational_stiffness);
    const S angle = turn.norm();
    if (angle > S(0)) {
      const Mat3<S> by = Eigen::AngleAxis<S>(angle, Vec3<S>(turn / angle)).toRotationMatrix();
      tool_.rotation = orthonormal(by * tool_.rotation);
    }
    tool_.translation = centre + step - tool_.rotation * p_.centre_of_mass;
    return tool_;
  }

  /// The wrench on the tool as the device has it, about its centre of mass, for the contact's at tool().
  [[nodiscard]] Wrench<S> answer(const Pose<S>& X, const Wrench<S>& contact, bool touches) noexcept {
    touches_ = touches && is_usable(X) && is_finite(contact.force) && is_finite(contact.torque);
    energy_ = S(0);
    if (!touches_) return {};
    contact_ = contact;
    const Vec3<S> stretch = tool_ * p_.centre_of_mass - X * p_.centre_of_mass;
    const Vec3<S> turn = detail::turned(X.rotation, tool_.rotation);
    energy_ = (p_.stiffness * stretch.squaredNorm() + p_.rotational_stiffness * turn.squaredNorm()) / S(2);
    return {p_.stiffness * stretch, p_.rotational_stiffness * turn};
  }

  /// What the spring stores [J].
  [[nodiscard]] S energy() const noexcept { return energy_; }
  [[nodiscard]] const Params& params() const noexcept { return p_; }

  /// The tool is where the device is from the next tick on.
  void reset() noexcept { touches_ = false; }

 private:
  /// Rounding of a million ticks must not add up.
  [[nodiscard]] static Mat3<S> orthonormal(const Mat3<S>& R) noexcept {
    const Vec3<S> x = R.col(0).normalized();
    const Vec3<S> y = (R.col(1) - x.dot(R.col(1)) * x).normalized();
    Mat3<S> out;
    out << x, y, x.cross(y);
    return out;
  }

  Params p_;
  Pose<S> tool_{};
  Wrench<S> contact_{};
  S energy_ = S(0);
  bool touches_ = false;
};

}  // namespace palpate
