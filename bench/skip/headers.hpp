// SPDX-License-Identifier: MIT
#pragma once

/// @file  What the compositions are made of, no more: precompiled, and every program here loads all of it.

#include <palpate/deformation/beam_skeleton.hpp>
#include <palpate/deformation/none.hpp>
#include <palpate/force/duffing.hpp>
#include <palpate/friction/power_law.hpp>
#include <palpate/friction/slip.hpp>
#include <palpate/interpolation/phong.hpp>
#include <palpate/solver/contact_solver.hpp>
#include <palpate/surface/ellipsoid.hpp>
#include <palpate/surface/extremal_points.hpp>
