// SPDX-License-Identifier: MIT
#pragma once

/// @file The mesh on which the boundary equation is solved: made from any closed triangle mesh. Set-up only.
///
/// Vertices carry displacement. A *node* is a vertex with one of the smooth parts that meet there: a vertex
/// inside a smooth part is one node, on a cube's edge two, at its corner three. Nodes carry normals,
/// tractions and the positions where loads are put. Triangles are flat or, for geometry, quadratic with a
/// point at the middle of each edge.

#include <palpate/response/setup/remesh.hpp>

namespace palpate {

namespace detail {

/// The user's mesh cut along the boundary of the fixed region, so that its rim is a line of edges.
[[nodiscard]] inline MeshData<double> cut_at_rim(const MeshData<double>& mesh, const FixedRegion& fixed) {
  MeshData<double> out{mesh.vertices, {}};
  std::vector<std::uint8_t> inside(mesh.vertices.size());
  for (std::size_t v = 0; v < inside.size(); ++v) inside[v] = fixed(mesh.vertices[v]);
  std::unordered_map<std::uint64_t, std::uint32_t> cuts;
  const auto cut = [&](std::uint32_t a, std::uint32_t b) {
    const auto [found, is_new] =
        cuts.try_emplace(edge_key(a, b), static_cast<std::uint32_t>(out.vertices.size()));
    if (!is_new) return found->second;
    Vec3d in = mesh.vertices[inside[a] ? a : b], off = mesh.vertices[inside[a] ? b : a];
    for (int i = 0; i < 50; ++i) {
      const Vec3d middle = 0.5 * (in + off);
      (fixed(middle) ? in : off) = middle;
    }
    out.vertices.push_back(in);
    return found->second;
  };
  // A crossing at an end of its edge is that end: no triangle without area.
  std::vector<std::uint8_t> on_rim(mesh.vertices.size(), 0);
  const auto near_end = [&](std::uint32_t a, std::uint32_t b) {
    const Vec3d &in = mesh.vertices[inside[a] ? a : b], &off = mesh.vertices[inside[a] ? b : a];
    if (!fixed(in + setup::rim_at_end * (off - in)))
      on_rim[inside[a] ? a : b] = 1;
    else if (fixed(in + (1 - setup::rim_at_end) * (off - in)))
      on_rim[inside[a] ? b : a] = 1;
  };
  for (const auto& t : mesh.triangles)
    for (std::size_t c = 0; c < 3; ++c)
      if (inside[t[c]] != inside[t[(c + 1) % 3]]) near_end(t[c], t[(c + 1) % 3]);
  for (const auto& t : mesh.triangles) {
    const auto crosses = [&](std::uint32_t a, std::uint32_t b) {
      return inside[a] != inside[b] && !on_rim[a] && !on_rim[b];
    };
    // Polygon with the crossings put in, cut into triangles by at most two diagonals.
    std::uint32_t polygon[6];
    std::size_t count = 0, first_cut = 6, second_cut = 6;
    for (std::size_t c = 0; c < 3; ++c) {
      polygon[count++] = t[c];
      if (crosses(t[c], t[(c + 1) % 3])) {
        (first_cut == 6 ? first_cut : second_cut) = count;
        polygon[count++] = cut(t[c], t[(c + 1) % 3]);
      }
    }
    const auto at = [&](std::size_t i) { return polygon[i % count]; };
    if (first_cut == 6) {
      out.triangles.push_back(t);
    } else if (second_cut == 6) {
      out.triangles.push_back({at(first_cut), at(first_cut + 1), at(first_cut + 2)});
      out.triangles.push_back({at(first_cut), at(first_cut + 2), at(first_cut + 3)});
    } else {
      // Two crossings: the corner between them, and the quadrilateral opposite.
      const std::size_t i =
          second_cut - first_cut == 2 ? first_cut : second_cut;  // crossing before the lone corner
      out.triangles.push_back({at(i), at(i + 1), at(i + 2)});
      out.triangles.push_back({at(i), at(i + 2), at(i + 3)});
      out.triangles.push_back({at(i), at(i + 3), at(i + 4)});
    }
  }
  return out;
}

/// A piece without a fixed triangle can move freely, and the boundary equation has no unique solution. The
/// surface of a hollow needs no fixed triangle.
inline void require_each_piece_fixed(const MeshData<double>& mesh,
                                     const std::vector<std::uint8_t>& fixed_triangle) {
  DisjointSets pieces(mesh.vertices.size());
  for (const auto& t : mesh.triangles) {
    pieces.join(t[1], t[0]);
    pieces.join(t[2], t[0]);
  }
  std::vector<double> volume(mesh.vertices.size(), 0);
  std::vector<std::uint8_t> is_fixed(mesh.vertices.size(), 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& c = mesh.triangles[t];
    const std::uint32_t r = pieces.root(c[0]);
    const Vec3d& origin = mesh.vertices[r];
    volume[r] += (mesh.vertices[c[0]] - origin)
                     .dot((mesh.vertices[c[1]] - origin).cross(mesh.vertices[c[2]] - origin));
    if (fixed_triangle[t]) is_fixed[r] = 1;
  }
  for (std::size_t v = 0; v < volume.size(); ++v)
    if (volume[v] > 0 && !is_fixed[v])
      fail_at("make_element_mesh", "each piece of the mesh must be fixed somewhere, nothing fixes the one",
              "vertex", v);
}

/// Geometry of the boundary element mesh from a remeshed surface: nodes, normals, edge middles, source
/// positions.
[[nodiscard]] inline ElementMesh finish_element_mesh(const SmoothSurface& surface, const Remesher& made) {
  ElementMesh m;
  m.vertices = made.p_;
  m.triangles = made.t_;
  m.fixed_triangle = made.fixed_;
  m.length = made.length();
  m.fixed_vertex.assign(m.vertices.size(), 0);
  for (std::size_t t = 0; t < m.triangles.size(); ++t)
    if (m.fixed_triangle[t])
      for (auto v : m.triangles[t]) m.fixed_vertex[v] = 1;
  const std::vector<MeshEdge> edges = mesh_edges(m.triangles, "ElementMesh");
  // A crease of the boundary element mesh is a kept edge that the user's mesh has as a crease there: the
  // normals differ.
  const auto corner_normal = [&](std::uint32_t t, std::uint32_t c) {
    const auto& k = m.triangles[t];
    const Vec3d centre = (m.vertices[k[0]] + m.vertices[k[1]] + m.vertices[k[2]]) / 3;
    return surface.normal_at(m.vertices[k[c]] + setup::corner_offset * (centre - m.vertices[k[c]]));
  };
  std::vector<std::uint8_t> crease(edges.size(), 0);
  std::vector<std::uint8_t> on_crease(m.vertices.size(), 0);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (!made.features_.contains(edges[e].key)) continue;
    const auto& d = edges[e];
    const Vec3d l =
        corner_normal(d.triangle[0], d.corner[0]) + corner_normal(d.triangle[0], (d.corner[0] + 1u) % 3);
    const Vec3d r =
        corner_normal(d.triangle[1], d.corner[1]) + corner_normal(d.triangle[1], (d.corner[1] + 1u) % 3);
    crease[e] = l.dot(r) < setup::kept_crease_cosine * l.norm() * r.norm();
    if (crease[e]) on_crease[d.a()] = on_crease[d.b()] = 1;
  }
  std::uint32_t count = 0;
  const std::vector<std::uint32_t> fan = corner_fans(m.triangles, edges, crease, count);
  m.nodes.resize(count);
  std::vector<std::uint32_t> parts(m.vertices.size(), 0);
  std::vector<double> weight(count, 0);
  for (auto& n : m.nodes) n = {~0u, Vec3d::Zero(), Vec3d::Zero(), 0, false};
  m.nodes_of.resize(m.triangles.size());
  for (std::uint32_t t = 0; t < m.triangles.size(); ++t) {
    for (std::uint32_t c = 0; c < 3; ++c) {
      const std::uint32_t v = m.triangles[t][c], k = fan[3 * t + c];
      m.nodes_of[t][c] = k;
      ElementMesh::Node& node = m.nodes[k];
      if (node.vertex == ~0u) ++parts[v];
      node.vertex = v;
      node.normal += on_crease[v] ? corner_normal(t, c) : surface.normal_at(m.vertices[v]);
      const Vec3d e1 = m.vertices[m.triangles[t][(c + 1) % 3]] - m.vertices[v],
                  e2 = m.vertices[m.triangles[t][(c + 2) % 3]] - m.vertices[v];
      node.size += e1.norm() + e2.norm();
      weight[k] += 2;
    }
  }
  for (std::uint32_t k = 0; k < count; ++k) {
    ElementMesh::Node& node = m.nodes[k];
    node.normal = unit_or(node.normal, Vec3d(Vec3d::UnitZ()));
    node.size /= weight[k];
    node.crease = parts[node.vertex] > 1;
    node.source = m.vertices[node.vertex];
  }
  // Middles of the edges: bulge of the tangent planes on each side; on a crease the shortest shift that meets
  // both.
  m.middle.resize(m.triangles.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto& d = edges[e];
    const Vec3d &a = m.vertices[d.a()], &b = m.vertices[d.b()];
    const Vec3d half = 0.5 * (b - a);
    Vec3d bulge[2], normal[2];
    for (int s = 0; s < 2; ++s) {
      const std::uint32_t t = d.triangle[s], c0 = d.corner[s], c1 = (c0 + 1) % 3;
      const bool swap = m.triangles[t][c0] != d.a();
      const Vec3d &na = m.nodes[m.nodes_of[t][swap ? c1 : c0]].normal,
                  &nb = m.nodes[m.nodes_of[t][swap ? c0 : c1]].normal;
      bulge[s] = -0.25 * (half.dot(na) * na - half.dot(nb) * nb);
      normal[s] = unit_or(Vec3d(na + nb), na);
    }
    Vec3d shift = 0.5 * (bulge[0] + bulge[1]);
    if (crease[e]) {
      const double b0 = bulge[0].dot(normal[0]), b1 = bulge[1].dot(normal[1]), g = normal[0].dot(normal[1]),
                   det = 1 - g * g;
      if (det > setup::min_crease_determinant)
        shift = ((b0 - g * b1) * normal[0] + (b1 - g * b0) * normal[1]) / det;
    }
    const double limit = setup::max_bulge * (b - a).norm();
    if (shift.norm() > limit) shift *= limit / shift.norm();
    for (int s = 0; s < 2; ++s) m.middle[d.triangle[s]][d.corner[s]] = 0.5 * (a + b) + shift;
  }
  // Loads on a crease are moved into the node's own part, where the tangent plane is known, but no farther
  // than its triangles reach.
  std::vector<double> room(count, (std::numeric_limits<double>::max)());
  for (std::uint32_t t = 0; t < m.triangles.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3d &x = m.vertices[m.triangles[t][c]], &p = m.vertices[m.triangles[t][(c + 1) % 3]],
                  &q = m.vertices[m.triangles[t][(c + 2) % 3]];
      const double height = 2 * area_vector(x, p, q).norm() / (std::max)((q - p).norm(), 1e-300);
      double& least = room[m.nodes_of[t][c]];
      least = (std::min)(least, height);
    }
  // Halfway between the part's two creases; around a reflex corner of the part the mean of its edges would
  // leave the body.
  std::vector<Vec3d> inward(count, Vec3d::Zero());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (!crease[e]) continue;
    for (std::size_t side = 0; side < 2; ++side) {
      const std::uint32_t t = edges[e].triangle[side], c = edges[e].corner[side], d = (c + 1) % 3;
      const Vec3d along = m.vertices[m.triangles[t][d]] - m.vertices[m.triangles[t][c]];
      for (auto corner : {c, d}) {
        const std::uint32_t k = m.nodes_of[t][corner];
        inward[k] += unit_or(m.nodes[k].normal.cross(along), Vec3d(Vec3d::Zero()));
      }
    }
  }
  for (std::uint32_t k = 0; k < count; ++k) {
    ElementMesh::Node& node = m.nodes[k];
    if (!node.crease) continue;
    const Vec3d in = inward[k];
    node.source += (std::min)(setup::load_inset * node.size, setup::max_load_inset * room[k]) *
                   unit_or(in, Vec3d(Vec3d::Zero()));
  }
  return m;
}

}  // namespace detail

/// Makes the boundary element mesh. `fixed_triangle` marks triangles of the surface's mesh where the object
/// is fixed. Reports a fixed region without a triangle, one that is the whole surface, and a piece without a
/// fixed triangle.
[[nodiscard]] inline ElementMesh make_element_mesh(const SmoothSurface& surface,
                                                   const std::vector<std::uint8_t>& fixed_triangle,
                                                   const RemeshParams& params = {}) {
  const char* where = "make_element_mesh";
  if (!(params.vertices >= 20 && params.vertices <= 5000))
    fail(where, "vertices must be in [20, 5000]", params.vertices);
  if (!(params.rim_ratio >= 0.1 && params.rim_ratio <= 1))
    fail(where, "rim_ratio must be in [0.1, 1]", params.rim_ratio);
  if (!(params.growth >= 0.1 && is_finite(params.growth)))
    fail(where, "growth must be >= 0.1", params.growth);
  std::size_t count = 0;
  for (auto f : fixed_triangle) count += f;
  if (count == 0) fail(where, "the fixed region must hold at least one whole triangle");
  if (count == fixed_triangle.size()) fail(where, "the fixed region must leave some triangles free");
  detail::require_each_piece_fixed(surface.mesh(), fixed_triangle);
  detail::Remesher remesher(surface, fixed_triangle, params);
  remesher.run();
  return detail::finish_element_mesh(surface, remesher);
}

/// Fraction of the free surface's area, in [0, 1], where the body is thinner than the boundary element mesh's
/// edges: on triangles whose mean edge is longer than the distance from the centre, inward along the normal,
/// to the other side. There bending comes out too stiff, by half and more, and the response to a contact is
/// not resolved: ask for more vertices. Next to edges sharper than about 60 degrees a body is always thin.
[[nodiscard]] inline double unresolved_area(const ElementMesh& m) {
  using detail::Vec3d;
  const TriangleBvh<double> tree(MeshData<double>{m.vertices, m.triangles});
  double all = 0, thin = 0;
  for (std::size_t t = 0; t < m.triangles.size(); ++t) {
    if (m.fixed_triangle[t]) continue;
    const Vec3d &a = m.vertices[m.triangles[t][0]], &b = m.vertices[m.triangles[t][1]],
                &c = m.vertices[m.triangles[t][2]];
    const Vec3d n = detail::area_vector(a, b, c);
    const double edge = ((a - b).norm() + (b - c).norm() + (c - a).norm()) / 3;
    all += n.norm();
    if (detail::way_through(tree, (a + b + c) / 3, -unit_or(n, Vec3d(Vec3d::Zero())), 2 * edge) < edge)
      thin += n.norm();
  }
  return all > 0 ? thin / all : 0.0;
}

}  // namespace palpate
