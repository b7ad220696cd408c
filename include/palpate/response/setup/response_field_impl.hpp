// SPDX-License-Identifier: MIT
#pragma once

/// @file Set-up of response_field.hpp: mesh, boundary elements, influence functions, tables. Set-up only.

#include <palpate/response/response_field.hpp>
#include <palpate/response/setup/influence_functions.hpp>
#include <palpate/response/setup/parallel.hpp>

#include <cstddef>
#include <numbers>
#include <vector>

namespace palpate {

PALPATE_COMPILED_INLINE void ResponseField::build(const MeshData<double>& mesh, const FixedRegion& fixed,
                                                  const Params& params) {
  const MeshData<double> cut = detail::cut_at_rim(mesh, fixed);
  std::vector<std::uint8_t> inside(cut.triangles.size());
  for (std::size_t t = 0; t < inside.size(); ++t) {
    const auto& c = cut.triangles[t];
    inside[t] = fixed((cut.vertices[c[0]] + cut.vertices[c[1]] + cut.vertices[c[2]]) / 3);
  }
  build_from(cut, inside, params);
}

PALPATE_COMPILED_INLINE void ResponseField::build(const MeshData<double>& mesh,
                                                  const std::vector<std::uint32_t>& fixed_vertices,
                                                  const Params& params) {
  std::vector<std::uint8_t> is_fixed(mesh.vertices.size(), 0);
  for (auto v : fixed_vertices) {
    if (v >= is_fixed.size()) fail("ResponseField", "fixed vertices must be vertices of the mesh", v);
    is_fixed[v] = 1;
  }
  std::vector<std::uint8_t> inside(mesh.triangles.size());
  for (std::size_t t = 0; t < inside.size(); ++t) {
    const auto& c = mesh.triangles[t];
    inside[t] = c[0] < is_fixed.size() && c[1] < is_fixed.size() && c[2] < is_fixed.size() &&
                is_fixed[c[0]] && is_fixed[c[1]] && is_fixed[c[2]];
  }
  build_from(mesh, inside, params);
}

PALPATE_COMPILED_INLINE ResponseField::ResponseField(ResponseParts parts)
    : E_(parts.E), nu_(parts.nu), mesh_(std::move(parts.mesh)), influence_(std::move(parts.influence)) {
  stride_ = padded(mesh_.vertices.size());
  const std::size_t levels = parts.second.size() / parts.nodes.size();
  load_mesh_ = LoadMesh(std::move(parts.nodes), std::move(parts.triangles), std::move(parts.share_begin),
                        std::move(parts.shares));
  table_ = PatchTable(load_mesh_, std::move(parts.own), std::move(parts.second), std::move(parts.moments),
                      levels, std::move(parts.spread_begin), std::move(parts.spread));
  mid_edges_ =
      MidEdgeTable(mesh_, std::move(parts.edges), std::move(parts.edge_rows), std::move(parts.vertex_rows));
  read_mesh();
}

PALPATE_COMPILED_INLINE ResponseParts ResponseField::parts() const {
  return {E_,
          nu_,
          mesh_,
          load_mesh_.nodes(),
          load_mesh_.triangles(),
          load_mesh_.share_begin(),
          load_mesh_.all_shares(),
          influence_,
          table_.own_rows(),
          table_.second_rows(),
          table_.moment_rows(),
          table_.spread_begin(),
          table_.all_spread(),
          mid_edges_.of_triangle(),
          mid_edges_.edge_rows(),
          mid_edges_.vertex_rows()};
}

PALPATE_COMPILED_INLINE double ResponseField::unresolved_area() const {
  return palpate::unresolved_area(mesh_);
}

PALPATE_COMPILED_INLINE std::vector<Vec3<double>> ResponseField::unsound_positions() const {
  const double disc = 16 * (1 - nu_) / (3 * std::numbers::pi * std::numbers::pi);
  std::vector<Vec3<double>> positions;
  for (std::size_t k = 0; k < load_mesh_.solved(); ++k) {
    const LoadNode& node = load_mesh_.nodes()[k];
    bool is_beside_fixed = false;  // next to the fixed region w is minus the disc's own
    for (std::size_t c = 0; c < 3; ++c)
      is_beside_fixed |=
          node.part[Eigen::Index(c)] > 0 && mesh_.fixed_vertex[mesh_.triangles[node.triangle][c]] != 0;
    Vec3<double> w = Vec3<double>::Zero();
    for (std::size_t l = 0; l < 3; ++l) w += node.normal[Eigen::Index(l)] * at(k, k, l);
    if (!is_beside_fixed && node.normal.dot(w) * node.size < -disc) positions.push_back(node.source);
  }
  return positions;
}

PALPATE_COMPILED_INLINE void ResponseField::build_from(const MeshData<double>& mesh,
                                                       const std::vector<std::uint8_t>& fixed_triangle,
                                                       const Params& params) {
  require_positive(params.E, "ResponseField", "E [Pa] must be > 0");
  if (!(params.nu >= 0 && params.nu <= 0.5)) fail("ResponseField", "nu must be in [0, 1/2]", params.nu);
  E_ = params.E;
  nu_ = params.nu;
  const auto report = [&params](double done) {
    if (params.progress) params.progress(done);
  };
  report(0);
  ElementMesh solve = make_element_mesh(SmoothSurface(mesh), fixed_triangle, params.mesh);
  report(0.1);
  BoundaryElements bem(std::move(solve), nu_, params.threads);
  report(0.3);
  bem.factorise();
  report(0.45);
  const detail::LoadPositions positions(bem.mesh());
  load_mesh_ = positions.load_mesh();
  const detail::Matrix w =
      solve_influence_functions(bem, nu_, std::span(load_mesh_.nodes()).first(load_mesh_.solved()));
  report(0.9);
  for (Eigen::Index c = 0; c < w.cols(); ++c)
    for (Eigen::Index r = 0; r < w.rows(); ++r)
      if (!is_finite(w(r, c)))
        fail("ResponseField",
             "the boundary equation has no finite solution: is the mesh closed, without triangles that "
             "fold over?");
  mesh_ = bem.mesh();
  mid_edges_ = MidEdgeTable(mesh_, bem.mid_edge_fit());
  stride_ = padded(mesh_.vertices.size());
  influence_.resize(loads * 3 * stride_ * load_mesh_.nodes().size(), 0.f);
  for (std::uint32_t k = 0; k < positions.solved_or_fixed(); ++k)
    for (std::size_t l = 0; l < 3; ++l) {
      float* out = row(k, l);
      for (std::uint32_t v = 0; v < mesh_.vertices.size(); ++v) {
        const Vec3<double> u =
            k < load_mesh_.solved()
                ? Vec3<double>(w.block<3, 1>(Eigen::Index(3 * v), Eigen::Index(3 * k + l)))
                : Vec3<double>(-detail::near_at_vertex(mesh_, load_mesh_.nodes()[k], v, int(l), nu_));
        for (std::size_t i = 0; i < 3; ++i) out[i * stride_ + v] = static_cast<float>(u[Eigen::Index(i)]);
      }
    }
  detail::parallel_for(positions.solved_or_fixed(), params.threads,
                       [&](std::size_t k) { derive(positions, k); });
  for (std::size_t k = positions.solved_or_fixed(); k < load_mesh_.nodes().size(); ++k) join(positions, k);
  table_ = PatchTable(mesh_, mid_edges_, load_mesh_, params.threads, functions());
  influence_.resize(loads * 3 * stride_ * load_mesh_.solved());
  influence_.shrink_to_fit();
  read_mesh();
  report(1);
}

// Force dipole, bending and torsional couples: derivatives of the forces' fields by their position. And the
// sharpened forces, of second derivatives.
PALPATE_COMPILED_INLINE void ResponseField::derive(const detail::LoadPositions& positions, std::size_t k) {
  using Row = Eigen::Map<const Eigen::ArrayXf>;
  const auto size = static_cast<Eigen::Index>(3 * stride_);
  const Vec3<double> m = -load_mesh_.nodes()[k].normal, t1 = perpendicular(Vec3<double>(-m)),
                     t2 = t1.cross(m);
  const auto field = [&](std::size_t l) { return Eigen::Map<Eigen::ArrayXf>(row(k, l), size); };
  for (std::size_t l = 3; l < sharpened; ++l) {
    auto sum = field(l);
    for (const auto& w : positions.gradient(k)) {
      const Vec3<double> f = l == 3   ? Vec3<double>(0.5 * w.g)
                             : l == 6 ? Vec3<double>(0.5 * m.cross(w.g))
                                      : Vec3<double>(w.g.dot(l == 4 ? t1 : t2) * m);
      for (int i = 0; i < 3; ++i)
        sum += static_cast<float>(f[i]) * Row(influence(w.node, std::size_t(i)), size);
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    auto sum = field(sharpened + i);
    sum = Row(influence(k, i), size);
    for (const auto& s : positions.sharpening(k))
      sum += static_cast<float>(2 * s.weight) * Row(influence(s.node, i), size);
  }
}

// The field of an edge's node is the mean of its parts' fields.
PALPATE_COMPILED_INLINE void ResponseField::join(const detail::LoadPositions& positions, std::size_t k) {
  using Row = Eigen::Map<const Eigen::ArrayXf>;
  const auto size = static_cast<Eigen::Index>(3 * stride_);
  const float share = 1.f / static_cast<float>(positions.parts(k).size());
  const Vec3<double> n = load_mesh_.nodes()[k].normal, t1 = perpendicular(n), t2 = n.cross(t1);
  const auto sum = [&](std::size_t l) { return Eigen::Map<Eigen::ArrayXf>(row(k, l), size); };
  for (auto part : positions.parts(k)) {
    for (std::size_t l = 0; l < sharpened; ++l)
      if (l != 4 && l != 5) sum(l) += share * Row(influence(part, l), size);
    const Vec3<double> pn = load_mesh_.nodes()[part].normal, p1 = perpendicular(pn), p2 = pn.cross(p1);
    sum(4) += share * (static_cast<float>(t1.dot(p1)) * Row(influence(part, 4), size) +
                       static_cast<float>(t1.dot(p2)) * Row(influence(part, 5), size));
    sum(5) += share * (static_cast<float>(t2.dot(p1)) * Row(influence(part, 4), size) +
                       static_cast<float>(t2.dot(p2)) * Row(influence(part, 5), size));
  }
}

// What a tick reads of the mesh alone.
PALPATE_COMPILED_INLINE void ResponseField::read_mesh() {
  rotation_ = RotationTable(mesh_, stride_);
  position_.assign(4 * stride_, 0.f);
  for (std::size_t v = 0; v < mesh_.vertices.size(); ++v) {
    for (std::size_t i = 0; i < 3; ++i)
      position_[i * stride_ + v] = static_cast<float>(mesh_.vertices[v][Eigen::Index(i)]);
    position_[3 * stride_ + v] = mesh_.fixed_vertex[v] ? 0.f : 1.f;
  }
}

}  // namespace palpate
