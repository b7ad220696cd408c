// SPDX-License-Identifier: MIT
#pragma once

/// @file  What the compositions are made of, no more: precompiled, and every program here loads all of it.

#include <palpate/elasticity/none.hpp>
#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/geometry/extremal_points.hpp>
#include <palpate/law/force/duffing.hpp>
#include <palpate/law/friction/power_law.hpp>
#include <palpate/law/friction/slip.hpp>
#include <palpate/luo_xiao/beam_skeleton.hpp>
#include <palpate/luo_xiao/interpolation/phong.hpp>
#include <palpate/resolved/contact_points.hpp>
#include <palpate/resolved/elastic_contact.hpp>
#include <palpate/solver/contact_solver.hpp>
