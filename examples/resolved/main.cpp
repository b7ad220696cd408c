// SPDX-License-Identifier: MIT
// [resolved]
#include <palpate/adapters/assimp.hpp>
#include <palpate/geometry/sampled_surface.hpp>
#include <palpate/geometry/shared_surface.hpp>
#include <palpate/law/friction/coulomb.hpp>
#include <palpate/resolved/contact_samples.hpp>
#include <palpate/resolved/response_compliance.hpp>
#include <palpate/solver/make_solver.hpp>
#include <palpate/touch/elastic_body.hpp>

#include <algorithm>
#include <cstdio>
using namespace palpate;

int main() {
  using Surface = SampledSurface<SharedSurface<MeshSurface<double>>>;
  using Elastic = ElasticContact<double, ResponseCompliance>;
  const ElasticBody body(read_mesh("liver.obj", {.scale = 0.03}),  // metres per unit of the file
                         {.E = 20e3, .nu = 0.49, .fixed = below(0.05), .vertices = 300});  // Pa, -, m
  const TriangleMesh<double> jaw(read_mesh("jaw.obj", {.scale = 1e-3}));
  auto solver =
      make_solver(Surface(SharedSurface(body.surface()), {.spacing = 2e-3}),                 // m
                  ToolPoints<double>(contact_samples(jaw, 1.5e-3), {.contact_area = 1e-4}),  // m, m^2
                  Elastic({.compliance = ResponseCompliance(body.field())}),
                  CoulombFriction<double>({.mu_static = 0.4, .mu_dynamic = 0.3}), ContactPoints<256>());

  Pose<double> pose;  // of the jaw: from your device, every servo tick
  pose.translation = {-0.01, 0.0995, 0};
  const auto felt = solver.tick(pose, 1e-3);  // noexcept, no heap
  double highest = 0;
  for (const auto& point : solver.state().points()) highest = std::max(highest, point.pressure);
  std::printf("F = %.3f %.3f %.3f N at %zu points, at most %.1f kPa\n", felt.wrench.force.x(),
              felt.wrench.force.y(), felt.wrench.force.z(), solver.state().points().size(), 1e-3 * highest);
}
// [resolved]
