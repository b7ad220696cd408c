// SPDX-License-Identifier: MIT
#pragma once

/// @file The tick of one contact and of four, which programs with PALPATE_COMPILED link:
/// src/response_tick.cpp.

#include <palpate/config.hpp>

#ifdef PALPATE_COMPILED
#include <palpate/response/tick/contact_system.hpp>
#include <palpate/response/tick/drawing.hpp>
#include <palpate/response/tick/field_sum.hpp>

#ifndef PALPATE_TICK_INSTANCE
#define PALPATE_TICK_INSTANCE extern template
#endif

namespace palpate::detail {

PALPATE_TICK_INSTANCE void ContactSystem<1>::solve(std::size_t) noexcept;
PALPATE_TICK_INSTANCE Vec3<double> ContactSystem<1>::torque(std::size_t, std::size_t) const noexcept;
PALPATE_TICK_INSTANCE void FieldSum<1>::add_up(const ContactSystem<1>&, std::size_t) noexcept;
PALPATE_TICK_INSTANCE void ResponseDrawing<1>::read(const float*, const DrawnContacts&) noexcept;
PALPATE_TICK_INSTANCE void ResponseDrawing<1>::find_close(const ResponseDisplay&,
                                                          const DrawnContacts&) noexcept;
PALPATE_TICK_INSTANCE void ContactSystem<4>::solve(std::size_t) noexcept;
PALPATE_TICK_INSTANCE Vec3<double> ContactSystem<4>::torque(std::size_t, std::size_t) const noexcept;
PALPATE_TICK_INSTANCE void FieldSum<4>::add_up(const ContactSystem<4>&, std::size_t) noexcept;
PALPATE_TICK_INSTANCE void ResponseDrawing<4>::read(const float*, const DrawnContacts&) noexcept;
PALPATE_TICK_INSTANCE void ResponseDrawing<4>::find_close(const ResponseDisplay&,
                                                          const DrawnContacts&) noexcept;

}  // namespace palpate::detail
#endif
