// SPDX-License-Identifier: MIT
#pragma once

/// @file Contact against closed forms on a half-space: a block of 200 contact radii, small strain.

#include "truth/contact_reference.hpp"

#include <functional>

namespace bench {

struct ContactCheck {
  const char* name;
  ContactCase setting;
  /// Force [N] and what else is known, by name, at a step: computed and closed form.
  struct Value {
    const char* what;
    double computed, exact;
  };
  std::function<std::vector<Value>(const std::vector<ToolLoad>& load, std::size_t step)> compare;
};

/// E = 1 MPa, contact radius about 1 mm.
inline std::vector<ContactCheck> contact_checks() {
  constexpr double height = 200, nu = 0.49, E = 1, modulus = E / (1 - nu * nu), mu = 0.3,
                   pi = 3.14159265358979;
  ContactCase base;
  base.body = {Body::box, {2 * height, height, 2 * height}, 0, true, true};
  base.E = E;
  base.nu = nu;
  base.linear = true;
  const auto above = [=](double middle, double depth, double aside = 0) {
    return std::vector<Pose>{{V(aside, height + middle - depth, 0), Eigen::Quaterniond::Identity()}};
  };
  std::vector<ContactCheck> checks;

  ContactCase ball = base;
  constexpr double R = 20, d = 0.05;
  ball.tools = {{RigidTool::ball, R * V::UnitX(), 0, {}}};
  ball.poses = {above(R, 0), above(R, d), above(R, 2 * d)};
  checks.push_back({"hertz", ball, [=](const auto& load, std::size_t step) {
                      const double a2 = R * d * double(step);
                      return std::vector<ContactCheck::Value>{
                          {"force", load[0].force.y(), -4. / 3 * modulus * std::sqrt(a2) * a2 / R},
                          {"area", load[0].area, pi * a2}};
                    }});

  ball.body.half_x = false;
  ball.friction = mu;
  constexpr double deep = 2 * d, a = 1.4142135623730951;  // sqrt(R deep)
  const double P = 4. / 3 * modulus * a * a * a / R, full = 1.5 * mu * P * (2 - nu) * (1 + nu) / (4 * E * a);
  ball.poses = {above(R, 0),
                above(R, deep),
                above(R, deep, 0.25 * full),
                above(R, deep, 0.5 * full),
                above(R, deep, 0.75 * full),
                above(R, deep, 1.5 * full)};
  checks.push_back({"cattaneo", ball, [=](const auto& load, std::size_t step) {
                      constexpr double share[] = {0, 0.25, 0.5, 0.75, 1};
                      const double left = 1 - share[step - 1], Q = mu * P * (1 - std::pow(left, 1.5));
                      return std::vector<ContactCheck::Value>{
                          {"normal", load[0].force.y(), -P},
                          {"tangential", load[0].force.x(), Q},
                          {"stuck area", load[0].stuck, pi * a * a * left}};
                    }});

  ContactCase egg = base;  // radii of curvature 80 and 20 mm
  egg.tools = {{RigidTool::ellipsoid, {40, 20, 20}, 0, {}}};
  egg.poses = {above(20, 0), above(20, d), above(20, 2 * d)};
  checks.push_back(
      {"elliptic", egg, [=](const auto& load, std::size_t step) {
         // Semi-axes A > B, e their eccentricity: force by depth, from the ratio of curvatures.
         const auto integrals = [](double e) {
           double K = 0, L = 0;  // complete elliptic integrals
           for (int i = 0; i < 400; ++i) {
             const double s = std::sin(pi / 2 * (i + 0.5) / 400), root = std::sqrt(1 - e * e * s * s);
             K += pi / 800 / root;
             L += pi / 800 * root;
           }
           return std::pair{K, L};
         };
         double low = 0, high = 1;
         for (int i = 0; i < 60; ++i) {
           const double e = (low + high) / 2;
           const auto [K, L] = integrals(e);
           (((L / (1 - e * e) - K) / (K - L) < 80. / 20) ? low : high) = e;
         }
         const auto [K, L] = integrals(low);
         // p0 = 3 F / (2 pi A B); 1/(2 R) = p0 B (K - L) / (E* e^2 A^2); depth = p0 B K / E*
         const double depth = d * double(step), p0b = depth * modulus / K,
                      A = std::sqrt(2 * 80 * p0b * (K - L) / (modulus * low * low)),
                      B = A * std::sqrt(1 - low * low);
         return std::vector<ContactCheck::Value>{{"force", load[0].force.y(), -2 * pi / 3 * A * p0b},
                                                 {"area", load[0].area, pi * A * B}};
       }});

  ContactCase punch = base;  // flat to 0.9 mm, the rim's radius 0.1 mm
  constexpr double flat = 0.9, rim = 0.1;
  punch.tools = {{RigidTool::cylinder, {flat + rim, 4, 0}, rim, {}}};
  punch.poses = {above(2, -0.001), above(2, 0.02), above(2, 0.05)};
  checks.push_back({"rounded punch", punch, [=](const auto& load, std::size_t step) {
                      // Abel's transform of the rim: the depth at which the contact's radius is x.
                      const auto profile = [=](double x) {
                        double g = 0;
                        for (int i = 0; i < 400; ++i) {
                          if (x <= flat) break;
                          const double t = std::acos(flat / x) * (i + 0.5) / 400, r = x * std::cos(t) - flat;
                          g += x * std::acos(flat / x) / 400 * r / std::sqrt(rim * rim - r * r);
                        }
                        return g;
                      };
                      const double depth = step == 1 ? 0.02 : 0.05;
                      double low = flat, high = flat + rim;
                      for (int i = 0; i < 60; ++i)
                        (profile((low + high) / 2) < depth ? low : high) = (low + high) / 2;
                      double force = 0;
                      for (int i = 0; i < 2000; ++i)
                        force += 2 * modulus * (depth - profile(low * (i + 0.5) / 2000)) * low / 2000;
                      return std::vector<ContactCheck::Value>{{"force", load[0].force.y(), -force},
                                                              {"area", load[0].area, pi * low * low}};
                    }});
  return checks;
}

/// Prints computed and closed values of a check, false if there is none of that name.
inline bool run_check(const std::string& name, const std::string& folder, double fineness, double stiffness,
                      double strides) {
  for (const ContactCheck& check : contact_checks()) {
    if (name != check.name) continue;
    const auto loads = ContactReference(check.setting, folder, fineness, stiffness, strides).make();
    for (std::size_t step = 1; step <= loads.size(); ++step)
      for (const auto& [what, computed, exact] : check.compare(loads[step - 1], step))
        std::printf("%s, fineness %g, step %zu: %s %.5g, closed form %.5g, %+.2f %%\n", check.name, fineness,
                    step, what, computed, exact, exact != 0 ? 100 * (computed / exact - 1) : 0);
    return true;
  }
  return false;
}

}  // namespace bench
