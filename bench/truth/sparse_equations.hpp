// SPDX-License-Identifier: MIT
#pragma once

/// @file Sparse linear equations by MUMPS.

#include <dmumps_c.h>
#include <Eigen/Core>

#include <stdexcept>
#include <string>
#include <vector>

namespace bench {

/// Symmetric indefinite sparse equations by MUMPS; entries of the lower triangle, repeated ones add up.
class SymmetricEquations {
 public:
  SymmetricEquations(int n, std::vector<int> rows, std::vector<int> columns)
      : rows_(std::move(rows)), columns_(std::move(columns)) {
    id_.par = 1;
    id_.sym = 2;
    id_.comm_fortran = -987654;
    call(-1);
    for (int k : {0, 1, 2}) id_.icntl[k] = -1;  // prints nothing
    id_.icntl[13] = 60;                         // percent of room more than it estimates, for pivots
    id_.n = n;
    id_.nnz = static_cast<MUMPS_INT8>(rows_.size());
    id_.irn = rows_.data();
    id_.jcn = columns_.data();
    call(1);
  }
  SymmetricEquations(const SymmetricEquations&) = delete;
  SymmetricEquations& operator=(const SymmetricEquations&) = delete;
  ~SymmetricEquations() {
    id_.job = -2;
    dmumps_c(&id_);
  }
  /// Replaces `b` by the solution.
  void solve(std::vector<double>& values, Eigen::VectorXd& b) {
    id_.a = values.data();
    call(2);
    id_.rhs = b.data();
    call(3);
  }

 private:
  void call(int job) {
    id_.job = job;
    dmumps_c(&id_);
    if (id_.infog[0] < 0)
      throw std::runtime_error("MUMPS: error " + std::to_string(id_.infog[0]) + " in job " +
                               std::to_string(job));
  }
  DMUMPS_STRUC_C id_{};
  std::vector<int> rows_, columns_;
};

}  // namespace bench
