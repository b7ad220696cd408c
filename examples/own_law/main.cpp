// SPDX-License-Identifier: MIT

/// @file Choosing policies, and writing one: a force law for tissue that is soft at first and stiff when
/// compressed (Fung's exponential), decorated with damping and a cap, on a cylinder touched by a ball in
/// up to four regions.

#include <palpate/palpate.hpp>

#include <cmath>
#include <cstdio>
#include <limits>

namespace {

/// F = A (exp(B D) - 1). Everything a force law must offer; docs/extending.md lists it.
struct FungForce {
  using Scalar = double;
  double A;  ///< [N]
  double B;  ///< [1/m]

  double force(double D) const noexcept { return D > 0 ? A * std::expm1(B * D) : 0; }
  double stiffness(double D) const noexcept { return D > 0 ? A * B * std::exp(B * D) : 0; }
  double energy(double D) const noexcept { return D > 0 ? A * (std::expm1(B * D) / B - D) : 0; }
  double depth(double F) const noexcept { return F > 0 ? std::log1p(F / A) / B : 0; }
  double max_depth() const noexcept { return std::numeric_limits<double>::max(); }
};
static_assert(palpate::ForceLaw<FungForce>);

}  // namespace

int main() {
  using namespace palpate;
  using Law = DampedForce<SaturatedForce<FungForce>>;  // decorators are laws too
  using Touch = ContactSolver<Cylinder<double>, Law, CoulombFriction<double>, Regions<4>>;

  const TriangleMesh<double> ball(Sphere<double>({.radius = 8e-3}).mesh(500));
  Touch touch({
      .object = Cylinder<double>({.radius = 0.05, .half_height = 0.03}),
      .tool = ToolPoints<double>(ball, {.contact_area = 5e-5}),
      .force = Law(SaturatedForce<FungForce>({.A = 0.05, .B = 900}, {.limit = 3.0}), {.damping = 0.5}),
      .friction = CoulombFriction<double>({.mu_static = 0.4, .mu_dynamic = 0.3}),
      .contacts = {.distance = 2e-3},
  });

  std::printf("   x [mm]   F_x      F_y    [N]  regions  state\n");
  for (int i = 0; i <= 1000; ++i) {  // 1 s at 1 kHz: down by 2 mm, then along
    Pose<double> pose;
    pose.translation = {i < 200 ? 0.0 : 3e-5 * (i - 200), 0.038 - 1e-5 * (i < 200 ? i : 200), 0};
    const TickResult<double> felt = touch.tick(pose, 1e-3);
    if (i % 100 != 0) continue;
    const bool sliding = !touch.contacts().empty() && touch.contacts()[0].mode == ContactMode::sliding;
    std::printf("  %7.2f %7.3f %8.3f        %zu     %s\n", 1e3 * pose.translation.x(), felt.wrench.force.x(),
                felt.wrench.force.y(), touch.contacts().size(),
                touch.contacts().empty() ? "free"
                : sliding                ? "slip"
                                         : "stick");
  }
}
