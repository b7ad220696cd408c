// SPDX-License-Identifier: MIT
#pragma once

/// @file What makes the stages of a contact (stages.hpp) from those before, and their parts of the field.
/// With PALPATE_COMPILED src/response_tick.cpp alone includes the files that define it.
///
/// | function | file |
/// |---|---|
/// | place_contact, spread_force, spread_moments | placement.hpp |
/// | bond_contact, torsional_stiffness, moved_by_torsion | linear_loads.hpp |
/// | coupling, coupling_of_moments, coupling_of_torsion, loads_of_node | contact_coupling.hpp |
/// | second_order_loads | second_order_loads.hpp |
/// | press_sphere | pressed_sphere.hpp |
/// | draw_contact | near_coefficients.hpp |

#include <palpate/response/second_order.hpp>
#include <palpate/response/tick/sphere_contact.hpp>
#include <palpate/response/tick/stages.hpp>

#include <vector>

namespace palpate::detail {

PlacedContact place_contact(const ResponseField& field, const Indenter& tool) noexcept;
double spread_force(const ResponseField& field, const PlacedContact& c, double loaded2, float* weight,
                    std::vector<std::uint32_t>& nodes) noexcept;
void spread_moments(const ResponseField& field, const PlacedContact& c, double loaded2, const float* weight,
                    float* q) noexcept;
BondedContact bond_contact(const ResponseField& field, const PlacedContact& c, double activation,
                           double wide) noexcept;
double torsional_stiffness(const ResponseField& field, const PlacedContact& c, double activation) noexcept;
Vec3<double> moved_by_torsion(const ResponseField& field, const PlacedContact& c) noexcept;
Mat3<double> coupling(const ResponseField& field, const PlacedContact& ci, const PlacedContact& cj) noexcept;
Mat3<double> coupling_of_moments(const ResponseField& field, const PlacedContact& ci,
                                 const PlacedContact& cj) noexcept;
Vec3<double> coupling_of_torsion(const ResponseField& field, const PlacedContact& ci,
                                 const PlacedContact& cj) noexcept;
Vec3<double> loads_of_node(const ResponseField& field, std::uint32_t k, double dipole,
                           const Vec3<double>& couple) noexcept;
SecondOrderContact second_order_loads(const ResponseField& field, const SecondOrder* constants,
                                      const PlacedContact& c, const BondedContact& bonded,
                                      const LinearContact& linear) noexcept;
PressedSphere press_sphere(const ResponseField& field, const SecondOrder* k, const Indenter& tool,
                           double sum_of_curvatures, PlacedContact& placed, SecondOrderContact& second,
                           SolvedContact& solved) noexcept;
DrawnContact draw_contact(const SecondOrder& k, double nu, const PlacedContact& c,
                          const BondedContact& bonded, const SecondOrderContact& second,
                          const SolvedContact& solved) noexcept;

}  // namespace palpate::detail

#ifndef PALPATE_COMPILED
#include <palpate/response/tick/contact_coupling.hpp>
#include <palpate/response/tick/near_coefficients.hpp>
#include <palpate/response/tick/pressed_sphere.hpp>
#endif
