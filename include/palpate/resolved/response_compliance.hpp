// SPDX-License-Identifier: MIT
#pragma once

/// @file A body with a response field, for contact that is resolved at the tool's points.

#include <palpate/core/error.hpp>
#include <palpate/resolved/detail/regular_part.hpp>
#include <palpate/response/response_field.hpp>

#include <memory>
#include <utility>

namespace palpate {

/// Any body that has a response field: the half-space's response between the points, and the field's regular
/// part w between the nodes of the load mesh beneath them.
///
///     u_i = sum_j (K_ij + 4 pi sum_kl g_ik mu w_kl g_jl) P_j
///
/// g: a point's weights at the nodes. The field may be shared; a copy costs a reference count. Reports a
/// field that is missing.
class ResponseCompliance {
 public:
  using RegularPart = detail::RegularPart;

  explicit ResponseCompliance(std::shared_ptr<const ResponseField> field) : field_(std::move(field)) {
    if (!field_) fail("ResponseCompliance", "needs a response field");
  }
  [[nodiscard]] double E() const noexcept { return field_->E(); }
  [[nodiscard]] double nu() const noexcept { return field_->nu(); }
  [[nodiscard]] const ResponseField& field() const noexcept { return *field_; }

 private:
  std::shared_ptr<const ResponseField> field_;
};

}  // namespace palpate
