// SPDX-License-Identifier: MIT
#pragma once

/// @file A ball's cap that is resolved at its points, on a block of rubber that stands on its fixed base.

#include <palpate/geometry/box.hpp>
#include <palpate/resolved/contact_samples.hpp>
#include <palpate/resolved/response_compliance.hpp>
#include <palpate/solver/contact_solver.hpp>

#include "support/bowl.hpp"
#include "support/response_fields.hpp"

#include <memory>
#include <utility>
#include <vector>

namespace palpate::test {

inline constexpr double block_E = 1e6, block_nu = 0.49;  // Pa, -

/// Its base is in y = 0, about the y axis.
[[nodiscard]] inline Box<double> standing_block(const Vec3<double>& size) {
  return Box<double>({.half = size / 2, .centre = Vec3<double>(0, size.y() / 2, 0)});
}

/// Of the block's field, which is set up once for all tests of a program.
[[nodiscard]] inline ResponseCompliance block_compliance(const Vec3<double>& size, double vertices) {
  using Key = std::pair<Vec3<double>, double>;
  static std::vector<std::pair<Key, std::shared_ptr<const ResponseField>>> made;
  const Key key(size, vertices);
  for (const auto& [of, field] : made)
    if (of == key) return ResponseCompliance(field);
  made.emplace_back(key,
                    std::make_shared<const ResponseField>(block_field(size, block_E, block_nu, vertices)));
  return ResponseCompliance(made.back().second);
}

template <class Compliance, FrictionLaw F>
using OnBlock = ContactSolver<Box<double>, ElasticContact<double, Compliance>, F, ContactPoints<256, 256>>;

template <class Compliance, FrictionLaw F>
[[nodiscard]] OnBlock<Compliance, F> on_block(const Vec3<double>& size, const Compliance& compliance,
                                              const F& friction, const SurfaceSamples<double>& tool) {
  return OnBlock<Compliance, F>({.object = standing_block(size),
                                 .tool = ToolPoints<double>(tool, {.contact_area = 1e-4}),
                                 .force = ElasticContact<double, Compliance>({.compliance = compliance}),
                                 .friction = friction});
}

/// Cap of a ball of the radius R [m] that faces down, of half the width `half`, points `spacing` apart.
[[nodiscard]] inline SurfaceSamples<double> cap_samples(double R, double half, double spacing) {
  return contact_samples(TriangleMesh<double>(ball_cap(R, half)), spacing);
}

}  // namespace palpate::test
