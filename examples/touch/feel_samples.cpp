// SPDX-License-Identifier: MIT

#include "solver_feel.hpp"

namespace touch {

std::unique_ptr<Feel> feel_samples(const Options& options, const Body& body, const Tool& tool,
                                   Answer answer) {
  using Object = palpate::SampledSurface<Body>;
  return std::make_unique<SolverFeel<Object>>(options, make_solver(samples(body), tool, std::move(answer)));
}

}  // namespace touch
