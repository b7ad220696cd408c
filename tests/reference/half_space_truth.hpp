// SPDX-License-Identifier: MIT
#pragma once

/// @file What geometrically nonlinear finite elements (neo-Hookean, nu = 0.49) have beyond linear ones around
/// a bonded flat punch of radius a on a block of 60 x 30 x 60 a, fixed at its base:
/// `bench/truth/make_reference.cpp`, half_space and half_space_askew, elements of a/16 and a/12 at the disc's
/// edge. Means over rings of the top around the disc; in parts of the disc's displacement d.

namespace palpate::test {

/// s: distance over a. pressed: along the radius (outward) and the normal (into the body), d = 0.4, 0.8, 1.2
/// a. askew: 35 degrees off the normal, d = 0.4 and 1 a; along the radius, its part that goes with the cosine
/// of the angle from the lean.
inline constexpr struct {
  double s, pressed[3][2], askew[2];
} half_space_truth[] = {
    {1.177, {{-0.0662, 0.0203}, {-0.1086, 0.0648}, {-0.1184, 0.0898}}, {0.0038, -0.0297}},
    {1.326, {{-0.0572, 0.0083}, {-0.1069, 0.0400}, {-0.1293, 0.0648}}, {0.0065, -0.0320}},
    {1.500, {{-0.0466, 0.0014}, {-0.0935, 0.0215}, {-0.1207, 0.0408}}, {0.0113, -0.0158}},
    {1.730, {{-0.0360, -0.0025}, {-0.0756, 0.0081}, {-0.1026, 0.0206}}, {0.0121, -0.0054}},
    {2.034, {{-0.0263, -0.0044}, {-0.0572, -0.0000}, {-0.0807, 0.0064}}, {0.0129, 0.0054}},
    {2.453, {{-0.0180, -0.0048}, {-0.0401, -0.0042}, {-0.0584, -0.0019}}, {0.0112, 0.0086}},
    {3.106, {{-0.0111, -0.0044}, {-0.0252, -0.0056}, {-0.0376, -0.0060}}, {0.0102, 0.0130}},
    {4.167, {{-0.0062, -0.0033}, {-0.0141, -0.0050}, {-0.0214, -0.0064}}, {0.0079, 0.0114}},
};
inline constexpr double half_space_pressed[] = {0.4, 0.8, 1.2}, half_space_askew[] = {0.4, 1};  // d / a

}  // namespace palpate::test
