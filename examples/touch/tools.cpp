// SPDX-License-Identifier: MIT

#include "tools.hpp"

#include <palpate/geometry/box.hpp>
#include <palpate/geometry/cylinder.hpp>
#include <palpate/geometry/sphere.hpp>
#include <palpate/geometry/superellipsoid.hpp>
#include <palpate/geometry/triangle_mesh.hpp>

#include <cmath>
#include <numbers>

namespace touch {

namespace {

/// A mesh moved up so that its lowest point is the origin.
palpate::MeshData<S> standing(palpate::MeshData<S> mesh) {
  S lowest = mesh.vertices.front().y();
  for (const V& v : mesh.vertices) lowest = (std::min)(lowest, v.y());
  for (V& v : mesh.vertices) v.y() -= lowest;
  return mesh;
}

/// Spheres side by side as one mesh.
palpate::MeshData<S> spheres(const std::vector<V>& centres, S radius, std::size_t vertices) {
  palpate::MeshData<S> all;
  for (const V& centre : centres) {
    const auto first = static_cast<std::uint32_t>(all.vertices.size());
    const palpate::MeshData<S> one = palpate::Sphere<S>({.radius = radius, .centre = centre}).mesh(vertices);
    all.vertices.insert(all.vertices.end(), one.vertices.begin(), one.vertices.end());
    for (const auto& t : one.triangles) all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  return all;
}

/// A flat face of the given radius, the end of a cylinder that stands on it.
Tool flat_face(S radius, S height, const V& centre_of_mass, std::vector<Rod> rods) {
  const S half = height / 2;
  return {standing(palpate::Cylinder<S>({.radius = radius, .half_height = half}).mesh(1500)),
          std::numbers::pi * radius * radius, radius / 12, centre_of_mass, std::move(rods)};
}

}  // namespace

Tool make_tool(const Options& options) {
  using namespace palpate;
  const std::string& name = options.tool;
  if (name ==
      "mallet") {  // a rounded head 24 mm wide and 16 mm high; the handle has weight but never touches
    const Superellipsoid<S> head({.axes = V(12e-3, 8e-3, 12e-3)});
    return {standing(head.mesh(1000)), 1e-4, 1e-3, V(0, 30e-3, 0), {{V(0, 12e-3, 0), V(0, 70e-3, 0), 3e-3}}};
  }
  if (name == "head") {  // of a large mallet, flat side down, the handle across
    return flat_face(30e-3, 40e-3, V(0, 20e-3, 0), {{V(25e-3, 20e-3, 0), V(110e-3, 20e-3, 0), 7e-3}});
  }
  if (name == "tail") {  // the end of the same mallet's handle
    return flat_face(
        10e-3, 20e-3, V(0, 70e-3, 0),
        {{V(0, 20e-3, 0), V(0, 80e-3, 0), 7e-3}, {V(-20e-3, 95e-3, 0), V(20e-3, 95e-3, 0), 30e-3}});
  }
  if (name == "compass") {  // two pins 36 mm apart; the origin is the tip of the one at -x
    constexpr S radius = 2e-3;
    const V one(0, radius, 0), two(compass_width, radius, 0), hinge(compass_width / 2, 60e-3, 0);
    const V through(0, 0, 5e-3);  // the bolt in the hinge
    return {spheres({one, two}, radius, 400),
            std::numbers::pi * radius * radius,
            0.25e-3,
            hinge,
            {{one, hinge, 1.2e-3},
             {two, hinge, 1.2e-3},
             {one + 0.55 * (hinge - one), hinge, 2e-3},  // legs are thicker above the pins
             {two + 0.55 * (hinge - two), hinge, 2e-3},
             {hinge - through, hinge + through, 5e-3},
             {hinge, hinge + V(0, 16e-3, 0), 2.5e-3}}};
  }
  if (name == "sphere") {
    return {standing(Sphere<S>({.radius = 6e-3}).mesh(1000)), 5e-5, 0.5e-3, V(0, 6e-3, 0)};
  }
  if (name == "pin") {
    return {standing(Sphere<S>({.radius = 1.5e-3}).mesh(500)), 3e-6, 0.15e-3, V(0, 20e-3, 0)};
  }
  if (name == "block") {
    return {standing(Box<S>({.half = V(10e-3, 6e-3, 10e-3)}).mesh(500)), 4e-4, 1e-3, V(0, 6e-3, 0)};
  }
  if (is_mesh_file(name)) {
    const TriangleMesh<S> mesh(standing(read_mesh(options.file(name))));
    // A tenth of the surface is a guess at what touches at once; about 2,000 points feel.
    return {mesh.data(), 0.1 * mesh.area(), std::sqrt(mesh.area() / 2000), mesh.centroid()};
  }
  refuse("unknown tool " + name);
}

}  // namespace touch
