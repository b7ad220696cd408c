// SPDX-License-Identifier: MIT
#pragma once

/// @file A map of a law's coefficients from a fit at every node of a grid over a body. Set-up only.

#include <palpate/geometry/sampled_surface.hpp>
#include <palpate/law/map/concept.hpp>
#include <palpate/response/setup/parallel.hpp>

#include <cstddef>
#include <exception>
#include <utility>
#include <vector>

namespace palpate::detail {

/// What was fitted at every node, and the worst of it.
template <ForceMap Map>
struct FittedMap {
  using S = typename Map::Scalar;
  Map map;
  double worst_rms = 0;
  Vec3<S> where = Vec3<S>::Zero();
};

/// fit(point of the surface) -> DuffingFit or the like, for the point of the body closest to each node of a
/// grid over it. The first error is reported; the result is the same with any number of threads.
template <ForceMap Map, SampledBody B, class Fit>
[[nodiscard]] FittedMap<Map> fit_map(const B& body, typename B::Scalar spacing, unsigned threads,
                                     const Fit& fit) {
  using S = typename B::Scalar;
  struct Node {
    typename Map::Coefficients coefficients;
    double rms = 0;
    Vec3<S> at = Vec3<S>::Zero();
#if PALPATE_HAS_EXCEPTIONS
    std::exception_ptr error;
#endif
  };
  const typename Map::Params grid{.spacing = spacing, .lower = body.lower(), .upper = body.upper()};
  const std::vector<Vec3<S>> nodes = Map::nodes(grid);
  std::vector<Node> fits(nodes.size());
  const auto at_node = [&](std::size_t i) {
    const SurfacePoint<S> at = body.closest(nodes[i]);
    const auto fitted = fit(at);
    const auto& [first, second] = fitted.params;
    fits[i].coefficients = {static_cast<S>(first), static_cast<S>(second)};
    fits[i].rms = fitted.fit.relative_rms;
    fits[i].at = at.position;
  };
#if PALPATE_HAS_EXCEPTIONS
  parallel_for(nodes.size(), threads, [&](std::size_t i) {
    try {  // an error must not end its thread
      at_node(i);
    } catch (...) {
      fits[i].error = std::current_exception();
    }
  });
  for (const Node& node : fits)
    if (node.error) std::rethrow_exception(node.error);
#else
  parallel_for(nodes.size(), threads, at_node);
#endif
  std::size_t next = 0, worst = 0;
  for (std::size_t i = 0; i < fits.size(); ++i)
    if (fits[i].rms > fits[worst].rms) worst = i;
  Map map(grid, [&](const Vec3<S>&) { return fits[next++].coefficients; });
  return {std::move(map), fits[worst].rms, fits[worst].at};
}

}  // namespace palpate::detail
