// SPDX-License-Identifier: MIT

/// @file Makes references by finite elements, which the library takes no part in: bonded patches, contact.
///
///     make_reference                                  the names of the cases with bonded patches
///     make_reference NAME CASE_DIR FINENESS           one of them: those of docs/accuracy.md
///     make_reference --case FILE CASE_DIR FINENESS [STIFFNESS [STRIDES]]   contact: see case_file.hpp
///     make_reference --check NAME CASE_DIR FINENESS [STIFFNESS [STRIDES]]  see contact_checks.hpp
///
/// Needs gmsh as a command. Of a case with bonded flat punches, pressed by their depth and rotated, or a
/// frictionless ball it writes what truth_cases reads into CASE_DIR: meta.json, surface.obj, vertices.csv,
/// displacement.csv, displacement_linear.csv (small strain), force.csv, force_linear.csv, with the torques
/// about the patches' middles, where they have moved to. Vertices: the elements' nodes on the surface.
/// FINENESS: patch radius over edges at its rim. Of a ball there is nothing linear.
///
/// Of contact, by step: load.csv (force and torque of each tool on the body, about the tool's origin, area,
/// what of it sticks, highest pressure: N, N mm, mm^2, MPa), shape.csv (displacement of 300 vertices of the
/// meshed part and the area that each stands for, mm); surface.obj, vertices.csv, displacement.csv,
/// traction.csv for all vertices, SI. Pressure and area are those of the deformed surface. FINENESS:
/// contact_mesh.hpp; STIFFNESS: of the penalty, E over the shortest edge, 30 if left out; STRIDES: how many
/// times as short as usual.

#include "truth/bonded_reference.hpp"
#include "truth/contact_checks.hpp"

#include <cstdio>
#include <cstdlib>

using namespace bench;

int main(int argc, char** argv) try {
  const std::string first = argc > 1 ? argv[1] : "";
  const double fineness = argc > 4 ? std::atof(argv[4]) : 0, stiffness = argc > 5 ? std::atof(argv[5]) : 30,
               strides = argc > 6 ? std::atof(argv[6]) : 1;
  if (argc >= 5 && first == "--case") {
    const ContactCase c = CaseFile::read(argv[2]);
    ContactReference(c, argv[3], fineness, stiffness, strides).make();
    return 0;
  }
  if (argc >= 5 && first == "--check") {
    if (run_check(argv[2], argv[3], fineness, stiffness, strides)) return 0;
    for (const ContactCheck& check : contact_checks()) std::printf("%s\n", check.name);
    return 1;
  }
  for (const Case& c : cases()) {
    if (argc < 4)
      std::printf("%s\n", c.name);
    else if (first == c.name) {
      Reference(c, argv[2], std::atof(argv[3])).make();
      return 0;
    }
  }
  return argc < 4 ? 0 : (std::fprintf(stderr, "no case %s\n", argv[1]), 1);
} catch (const std::exception& error) {
  std::fprintf(stderr, "make_reference: %s\n", error.what());
  return 1;
}
