// SPDX-License-Identifier: MIT

/// @file The paper's model: beams, released ends, interpolation.

#include "shape.hpp"

#include <palpate/luo_xiao/make_beam_skeleton.hpp>

namespace touch {

using namespace palpate;

namespace {

const AreaNeighbourhood<S> neighbourhood(
    {.reference_area = 1e-4});  // up to 1 cm^2 a contact counts as a point

}  // namespace

Shape skeleton_shape(const Body& body) {
  return shape_of(make_beam_skeleton(body, body.display, EulerBernoulli<S>(rubber),
                                     VolumePreserving<S>({.volume = body.volume()}), neighbourhood));
}

S local_factor(const ContactState<S>& contact) {
  return neighbourhood.factor({.area = contact.area, .points = static_cast<S>(contact.points)});
}

}  // namespace touch
