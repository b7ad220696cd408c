// SPDX-License-Identifier: MIT

/// @file Prints the errors of displacements and forces against a reference case, in percent.
///
///     judge_case CASE_DIR displacement.csv force.csv [linear]
///
/// CASE_DIR holds vertices.csv, displacement.csv and force.csv, plain or .gz; `linear`:
/// displacement_linear.csv, force_linear.csv. Displacement: relative L2 over the surface's area, largest
/// error over largest displacement, and L2 beyond two patch radii. Force: difference of the vectors over the
/// reference's |F|, of a patch that is rotated only over |F| + |T|/a; torque, where both have one, over |T| +
/// a |F|. Depths that either side lacks are left out.

#include "truth/case.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

namespace {

using namespace bench;

using Vectors = std::map<long, V>;       // by vertex or patch
using Depths = std::map<long, Vectors>;  // by depth [nm]

// Vectors that begin at `column`; none of a file without it.
Depths read(const std::string& path, std::size_t column = 2) {
  Depths out;
  for (const auto& r : csv_rows(path))
    if (r.size() > column)
      out[std::lround(1e9 * r.at(0))][std::lround(r.at(1))] =
          V(r.at(column), r.at(column + 1), r.at(column + 2));
  return out;
}

// Of force or torque, over all depths and patches.
struct LoadErrors {
  double squares = 0, worst = 0;
  int count = 0;
  // The largest of a depth [%]; size(patch): what an error is measured by.
  template <class Size>
  double add(const Vectors& found, const Vectors& reference, Size size) {
    double off = 0;
    for (const auto& [patch, load] : reference) {
      const double error = 100 * (found.at(patch) - load).norm() / size(patch);
      squares += error * error, ++count;
      off = (std::max)(off, error);
    }
    worst = (std::max)(worst, off);
    return off;
  }
  double rms() const { return std::sqrt(squares / count); }
};

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
  const std::vector<Patch> patches = read_patches(read_text(folder + "meta.json"));  // none with a ball
  const Depths reference = read(folder + "displacement" + which), found = read(argv[2]),
               forces = read(folder + "force" + which), found_forces = read(argv[3]),
               torques = read(folder + "force" + which, 5), found_torques = read(argv[3], 5);
  std::printf("%s\n%8s %8s %8s %8s %8s %8s   [%%]\n", argv[1], "mm", "L2", "far", "largest", "force",
              "torque");
  Errors deepest;
  LoadErrors force, torque;
  double mean_l2 = 0, mean_far = 0;
  int depths = 0;
  for (const auto& [depth, u] : reference) {
    const auto at = found.find(depth);
    if (at == found.end()) continue;
    deepest = displacement_errors(at->second, u, vertices);
    mean_l2 += deepest.l2, mean_far += deepest.far;
    ++depths;
    const Vectors& F = forces.at(depth);
    const bool has_torques = torques.count(depth) > 0 && found_torques.count(depth) > 0 && !patches.empty();
    const Vectors none, &T = has_torques ? torques.at(depth) : none;
    const auto patch = [&](long number) { return patches.at(static_cast<std::size_t>(number - 1)); };
    const auto size = [&](long k) {
      return F.at(k).norm() + (has_torques && patch(k).factor == 0 ? T.at(k).norm() / patch(k).radius : 0);
    };
    std::printf("%8.3g %8.2f %8.2f %8.2f %8.2f", 1e-6 * static_cast<double>(depth), deepest.l2, deepest.far,
                deepest.largest, force.add(found_forces.at(depth), F, size));
    if (has_torques)
      std::printf(" %8.2f", torque.add(found_torques.at(depth), T, [&](long k) {
        return T.at(k).norm() + patch(k).radius * F.at(k).norm();
      }));
    std::printf("\n");
  }
  if (depths == 0) throw std::runtime_error("no depth in common");
  std::printf("displacement mean %.1f, deepest %.1f; far %.1f, %.1f; force RMS %.1f, max %.1f",
              mean_l2 / depths, deepest.l2, mean_far / depths, deepest.far, force.rms(), force.worst);
  if (torque.count > 0) std::printf("; torque RMS %.1f, max %.1f", torque.rms(), torque.worst);
  std::printf("\n");
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "judge_case: %s\n", error.what());
  return 1;
}
