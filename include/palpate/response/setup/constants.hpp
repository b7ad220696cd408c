// SPDX-License-Identifier: MIT
#pragma once

/// @file Chosen constants of the response field's set-up: value, unit, reason, range. Set-up only.
///
/// None of them is a property of the material. Most bound an error that the references of docs/accuracy.md
/// then showed to be small; where a value was fitted, its cases are named. Lengths are in edge lengths of the
/// mesh unless stated.

namespace palpate::detail::setup {

// Smooth surface (smooth_surface.hpp).

/// Cosine of the angle between two triangles beyond which their edge stays sharp [-]. 40 degrees: between a
/// circle of 9 sides, which is smooth, and a hexagonal prism, which is not. (0, 1).
inline constexpr double crease_cosine = 0.77;
/// Start of a ray through the body, over its longest length [-], so that it does not meet the triangles that
/// the point lies on.
inline constexpr double ray_start = 1e-4;

// Wanted edge length (edge_length.hpp).

/// Largest growth of h by which vertices go to thin parts [-]. Chosen.
inline constexpr double max_growth_of_h = 1.25;
/// Shortest edge in thin parts over h [-]: edges are as short as a plate is thick, down to a quarter of h.
/// (0, 1].
inline constexpr double min_thin_ratio = 0.25;
/// Edges around a slender part [-]; as its width is taken by up to 1.4 times too large, six or seven. A
/// round bar 1:10 deflects right within 2 % with seven; a bone's shaft and a rabbit's ears lose reciprocity
/// with four. [6, 9].
inline constexpr double edges_around = 7;
/// Most vertices for slender parts on top of the wanted number, over that [-]: set-up grows by 2^3. Chosen.
inline constexpr double max_further = 1;
/// Edge length at a convex crease over that of the body [-]. In (rim_ratio, 1].
inline constexpr double crease_ratio = 0.75;
/// Distance that stands for no crease and no rim, over the body's size [-].
inline constexpr double far_away = 1e3;
/// Bracket of the bisection for h, over its last value [-].
inline constexpr double min_h_factor = 0.02, max_h_factor = 50;
/// Relative slack of growing lengths [-], more than their rounding.
inline constexpr double growth_slack = 1e-9;

// Remeshing (remesh.hpp). Split and collapse: [botsch2004].

/// Edges are split when longer than this times what is wanted, collapsed when shorter [-]. A split edge is
/// then no candidate for a collapse.
inline constexpr double split_ratio = 4.0 / 3.0, collapse_ratio = 0.8;
/// Largest distance of a split edge's new vertex from the edge's middle [edge]; of a quarter circle 0.21.
/// (0, 0.5).
inline constexpr double max_shift = 0.3;
/// Vertices over the wanted number: of the first uniform mesh, and of a mesh that is made coarser before all
/// else [-].
inline constexpr double fine_vertices = 4, too_fine_vertices = 8;
/// Usual ratio of made to expected vertices [-]: triangles are not all alike, creases are cut into whole
/// edges.
inline constexpr double usual_excess = 1.1;
/// Fewest vertices aimed at, over the wanted number [-].
inline constexpr double min_aim = 0.75;
/// A pass of collapses that removes less than this of the triangles is the last [-].
inline constexpr double min_progress = 0.01;
/// Area of a triangle over the square of its longest edge below which it is a sliver, which no collapse may
/// make [-]; equilateral 0.43.
inline constexpr double min_shape = 0.05;
/// Cosine of the largest turn of a triangle by a collapse or a relaxation [-]: 60 degrees.
inline constexpr double max_turn_cosine = 0.5;
/// Shortest crease [edge of the body]: shorter chains of edges that turn by more than a crease's angle are
/// coarse facets of a round part, or noise.
inline constexpr double min_crease_length = 1.5;
/// Length of an edge between rough feature lines below which it is a detail, that may collapse: over what
/// is wanted there, and over the thickness at its ends [-]. The edge at a plate's end is as long as the
/// plate is thick.
inline constexpr double detail_ratio = 0.5, detail_thickness = 0.5;
/// Part of the vertices of joined feature lines, at which these turn, cross or end, from which on they are
/// noise [-]. Of a plate's of 20 edges a side 5 %, of scanned and noisy surfaces' 25 to 100 %.
inline constexpr double rough_chain = 0.25;
/// Sum of the angles opposite an edge beyond which it is flipped [rad]: Delaunay's pi, with a margin so that
/// flips end.
inline constexpr double flip_angle = 3.2;
/// Cosine of the largest angle between a flipped edge's triangles and the plane of both before [-]: 37
/// degrees.
inline constexpr double flip_cosine = 0.8;
/// Part of the distance to the neighbours' weighted mean that a relaxation takes [-]. (0, 1]; at 1 it may
/// oscillate.
inline constexpr double relaxation = 0.7;
/// Smallest area of a triangle after a relaxation over that before [-].
inline constexpr double min_area_ratio = 0.2;

// Boundary element mesh (make_element_mesh.hpp).

/// A rim that crosses an edge nearer to one of its ends than this goes through the end [edge]: no triangle
/// without area.
inline constexpr double rim_at_end = 0.02;
/// Position at which a corner's normal is read, from the corner to the centre [-]: inside its own smooth
/// part.
inline constexpr double corner_offset = 0.1;
/// Cosine of the angle between normals beyond which a kept edge is a crease of the new mesh [-]: 32 degrees,
/// less than crease_cosine's 40 because the normals are the smooth surface's.
inline constexpr double kept_crease_cosine = 0.85;
/// Least 1 - cos^2 of a crease's angle at which both sides' tangent planes tell the middle of the edge [-].
inline constexpr double min_crease_determinant = 0.1;
/// Largest distance of an edge's middle from its chord [edge]: a half circle's is 0.5, and more means a bad
/// normal.
inline constexpr double max_bulge = 0.15;
/// Distance by which a crease's load is moved into its smooth part, over the mean edge; its bound over the
/// height of its triangles [-]. There the tangent plane is the surface's. (0, 0.5).
inline constexpr double load_inset = 0.35, max_load_inset = 0.45;

// Load mesh (load_positions.hpp).

/// Length of an edge, over the distance of its middle to the next free crease, beyond which a load acts at
/// its middle, too [-]. Without these loads a contact between two nodes next to a crease is three times as
/// wrong as one at a node.
inline constexpr double middle_ratio = 0.5;
/// Least cosine of the angle between the normals of neighbours that enter a gradient [-]: those round a
/// corner do not.
inline constexpr double gradient_cosine = 0.3;
/// Least determinant, over the square of the trace, with which neighbours determine a gradient in both
/// directions [-]; at most 1/4.
inline constexpr double min_gradient_determinant = 0.1;
/// Penalty on gradients that the neighbours do not determine, over the trace of their matrix [-].
inline constexpr double gradient_penalty = 1e-6;
/// Least size of a search grid's cell over the largest size of the body [-], and a length that counts as zero
/// [m].
inline constexpr double min_cell = 1e-3, min_cell_length = 1e-30;

// Quadratic correction (mid_edge_fit.hpp).

/// Least cosine of the angle between the normals of neighbours that enter second derivatives [-].
inline constexpr double curvature_cosine = 0.3;
/// Penalty on second derivatives over the slopes' weight [-]: 0.05^2, 0.3 % of a derivative that the
/// neighbours determine well. It keeps them small where the neighbours do not determine them, as across a
/// strip of two rows.
inline constexpr double curvature_penalty = 0.05 * 0.05;
/// The same on slopes [-]: only against a singular matrix.
inline constexpr double slope_penalty = 1e-9;
/// Penalty on weights that draw the middle of an edge onto the surface, over the neighbours' spread [-].
/// Where these lie nearly in a plane the middle stays where they place it. From 1e-4 to 1e-2 reciprocity
/// on a thin rim is missed by 1.3 %, with 0.1 by 1.8 %.
inline constexpr double middle_penalty = 1e-3;

// Rotation of the surface (rotation_table.hpp).

/// Penalties on the slopes along the surface, only against a singular matrix, and on the normal derivative,
/// which neighbours on a smooth surface hardly determine; over the slopes' weight [-].
inline constexpr double tangent_penalty = 1e-6, normal_penalty = 0.01;
/// Weight that keeps a matrix regular where no neighbour gives slopes.
inline constexpr double no_weight = 1e-30;

// Boundary elements (boundary_element.hpp).

/// Distance from an element, in its longest edges, beyond which it is not divided, beyond which seven points
/// do for all of it, and beyond which three do [-]. Chosen.
inline constexpr double near_elements = 1.8, seven_point_elements = near_elements + 0.6,
                        three_point_elements = 5;
/// An element is cut in four at most so many times: down to 1/64 of its edge.
inline constexpr int max_divisions = 6;
/// Points of Gauss's rule in each direction over an element that contains the position [-].
inline constexpr int self_points = 8;
/// A part of an element smaller than this is left out [-].
inline constexpr double min_share = 1e-9;

// Influence functions (influence_functions.hpp). Distances in the load's mean edge.

/// Distance from a load within which the near field's traction is integrated itself, not by its values at the
/// nodes [-].
inline constexpr double near_traction = 2.2;
/// Distance from a load within which it lies on the element [-]: more than rounding.
inline constexpr double on_element = 1e-6;
/// Distance from a load within which its traction is not smooth over an element [-]: no nodal value there,
/// and points of Duffy's map.
inline constexpr double singular_traction = 0.6;
/// Points of that map in each direction.
inline constexpr int traction_points = 6;
/// Distance, over that of the farthest vertex of the near elements, beyond which forces at their vertices
/// replace an integral [-].
inline constexpr double far_from_elements = 1.5;
/// Distance from a load within which a vertex is the load's own [-].
inline constexpr double own_vertex = 0.3;
/// At the load's own vertex: radius within which 1/R^2 is cut off, and radius of the disc over which u_near
/// is averaged [-].
inline constexpr double own_cut_off = 0.35, own_disc = 0.5;
/// Least part of a unit force that acts on the body, by which its field is divided [-]. On the liver's folded
/// rims one node in a hundred has less than 0.44, and 10 of 1546 less than 0.25. With 0.25 a node of a fold
/// wins work; 0.5 is more than a coarse, thin rim truly has (reciprocity off by 5 % in place of 1.5).
inline constexpr double min_force = 0.35;
/// Loads, and right-hand sides, that are worked on together. Chosen.
inline constexpr int loads_together = 64, solved_together = 48;

// Patch table (patch_table.hpp, moment_loads.hpp).

/// Second moment of a patch's nodes, over the square of their spacing, below which it is one position [-].
inline constexpr double min_second_moment = 0.1;
/// Least sum of weights to divide by [-].
inline constexpr double min_weight = 1e-12;
/// Depth of a patch's edge over the deepest of six positions on it [-]. Of a quadric's edge one of six lies
/// within 30 degrees of the deepest, whose depth is at most 4/3 of that one's.
inline constexpr double deepest_edge = 4.0 / 3;

}  // namespace palpate::detail::setup
