// SPDX-License-Identifier: MIT

/// @file  Prints the errors of displacements and forces against a reference case, in percent.
///
///     judge_case CASE_DIR displacement.csv force.csv [linear]
///
/// CASE_DIR holds vertices.csv, displacement.csv and force.csv, plain or .gz; `linear`: displacement_linear.csv, force_linear.csv.
/// Displacement: relative L2 over the surface's area, largest error over largest displacement, and L2 beyond two patch radii.
/// Force: difference of the vectors over the reference's length. Depths that either side lacks are left out.

#include "truth/case.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

namespace {

using namespace bench;

using Vectors = std::map<long, V>;       // by vertex or patch
using Depths = std::map<long, Vectors>;  // by depth [nm]

Depths read(const std::string& path) {
  Depths out;
  for (const auto& r : csv_rows(path))
    out[std::lround(1e9 * r.at(0))][std::lround(r.at(1))] = V(r.at(2), r.at(3), r.at(4));
  return out;
}

struct Errors {
  double l2 = 0, far = 0, largest = 0;
};
Errors displacement_errors(const Vectors& found, const Vectors& reference,
                           const std::vector<std::vector<double>>& vertices) {
  double sum = 0, norm = 0, far_sum = 0, far_norm = 0, largest = 0, most = 0;
  for (const auto& v : vertices) {
    const long vertex = std::lround(v.at(0));
    const V &u = reference.at(vertex), error = found.at(vertex) - u;
    const double area = v.at(4);
    sum += area * error.squaredNorm();
    norm += area * u.squaredNorm();
    if (v.at(6) > 2) far_sum += area * error.squaredNorm(), far_norm += area * u.squaredNorm();
    largest = (std::max)(largest, error.norm());
    most = (std::max)(most, u.norm());
  }
  return {100 * std::sqrt(sum / norm), 100 * std::sqrt(far_sum / far_norm), 100 * largest / most};
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 4) {
    std::fprintf(stderr, "judge_case CASE_DIR displacement.csv force.csv [linear]\n");
    return 1;
  }
  const std::string folder = std::string(argv[1]) + "/", which = argc > 4 ? "_linear.csv" : ".csv";
  const auto vertices = csv_rows(folder + "vertices.csv");
  const Depths reference = read(folder + "displacement" + which), found = read(argv[2]);
  const Depths forces = read(folder + "force" + which), found_forces = read(argv[3]);
  std::printf("%s\n%8s %8s %8s %8s %8s   [%%]\n", argv[1], "mm", "L2", "far", "largest", "force");
  Errors deepest;
  double mean_l2 = 0, mean_far = 0, squares = 0, worst = 0;
  int depths = 0, count = 0;
  for (const auto& [depth, u] : reference) {
    const auto at = found.find(depth);
    if (at == found.end()) continue;
    deepest = displacement_errors(at->second, u, vertices);
    mean_l2 += deepest.l2, mean_far += deepest.far;
    ++depths;
    double off = 0;
    for (const auto& [patch, force] : forces.at(depth)) {
      const double error = 100 * (found_forces.at(depth).at(patch) - force).norm() / force.norm();
      squares += error * error, ++count;
      off = (std::max)(off, error);
    }
    worst = (std::max)(worst, off);
    std::printf("%8.3g %8.2f %8.2f %8.2f %8.2f\n", 1e-6 * static_cast<double>(depth), deepest.l2, deepest.far,
                deepest.largest, off);
  }
  if (depths == 0) throw std::runtime_error("no depth in common");
  std::printf("displacement mean %.1f, deepest %.1f; far %.1f, %.1f; force RMS %.1f, max %.1f\n",
              mean_l2 / depths, deepest.l2, mean_far / depths, deepest.far, std::sqrt(squares / count),
              worst);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "judge_case: %s\n", error.what());
  return 1;
}
