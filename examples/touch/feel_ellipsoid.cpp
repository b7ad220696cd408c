// SPDX-License-Identifier: MIT

#include "solver_feel.hpp"

namespace touch {

std::unique_ptr<Feel> feel_ellipsoid(const Options& options, const Body&, const Tool& tool, Answer answer) {
  using Object = palpate::Ellipsoid<S>;
  return std::make_unique<SolverFeel<Object>>(options, make_solver(ellipsoid(), tool, std::move(answer)));
}

}  // namespace touch
