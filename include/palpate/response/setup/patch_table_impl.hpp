// SPDX-License-Identifier: MIT
#pragma once

/// @file Set-up of patch_table.hpp: means of the influence functions over patches. Set-up only.

#include <palpate/elasticity/flat_punch.hpp>
#include <palpate/response/setup/moment_rows.hpp>
#include <palpate/response/setup/parallel.hpp>
#include <palpate/response/tick/patch_table.hpp>

namespace palpate {

namespace detail {

[[nodiscard]] inline Vec3<double> node_tangent(const LoadMesh& load_mesh, std::size_t k, std::size_t number) {
  const Vec3<double>& n = load_mesh.nodes()[k].normal;
  const Vec3<double> t1 = perpendicular(n);
  return number == 1 ? t1 : Vec3<double>(n.cross(t1));
}
[[nodiscard]] inline Eigen::Vector4d in_tangents(const LoadMesh& load_mesh, std::size_t k,
                                                 const Vec3<double>& tilt) {
  return {0, tilt.dot(node_tangent(load_mesh, k, 1)), tilt.dot(node_tangent(load_mesh, k, 2)), 0};
}
[[nodiscard]] inline Vec3<double> read_vertex(const float* c, std::size_t stride, std::uint32_t v) noexcept {
  return {double(c[v]), double(c[stride + v]), double(c[2 * stride + v])};
}
inline void add_weight(std::vector<NodeWeight>& list, std::uint32_t node, double weight) {
  const auto found =
      std::find_if(list.begin(), list.end(), [node](const NodeWeight& w) { return w.node == node; });
  if (found == list.end())
    list.push_back({node, weight});
  else
    found->weight += weight;
}

// Weights of the boundary element mesh's vertices in the displacement at each node's position.
[[nodiscard]] inline std::vector<std::vector<NodeWeight>> vertices_at_nodes(const ElementMesh& mesh,
                                                                            const MidEdgeTable& mid_edges,
                                                                            const LoadMesh& load_mesh) {
  std::vector<std::vector<NodeWeight>> out(load_mesh.nodes().size());
  for (std::size_t k = 0; k < out.size(); ++k) {
    const LoadNode& node = load_mesh.nodes()[k];
    const Vec3<double> l = node.part.cast<double>();
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t d = (c + 1) % 3;
      add_weight(out[k], mesh.triangles[node.triangle][c], l[Eigen::Index(c)]);
      const double bent = 4 * l[Eigen::Index(c)] * l[Eigen::Index(d)];
      if (bent == 0) continue;
      for (const MidEdgeTable::Weight& w : mid_edges.edge_rows()[mid_edges.of_triangle()[node.triangle][c]])
        add_weight(out[k], w.vertex, bent * double(w.weight));
    }
  }
  return out;
}

// The bonded flat punch's weight around the node.
[[nodiscard]] inline std::vector<NodeWeight> patch_around(const LoadMesh& load_mesh, std::size_t k,
                                                          double s) {
  const LoadNode& node = load_mesh.nodes()[k];
  std::vector<NodeWeight> patch;
  if (!(s > 0)) {
    patch.push_back({static_cast<std::uint32_t>(k), 1});
    return patch;
  }
  const Vec3<double> t1 = perpendicular(node.normal), t2 = node.normal.cross(t1);
  for (const auto& p : flat_punch_points()) {
    const LoadPosition at = load_mesh.locate(node.source + s * (p[0] * t1 + p[1] * t2));
    for (std::size_t c = 0; c < 3; ++c)
      add_weight(patch, at.node[c], at.weight[Eigen::Index(c)] / double(flat_punch_points().size()));
  }
  return patch;
}

}  // namespace detail

PALPATE_COMPILED_INLINE PatchTable::PatchTable(const ElementMesh& mesh, const MidEdgeTable& mid_edges,
                                               const LoadMesh& load_mesh, unsigned threads,
                                               const InfluenceFunctions& influence)
    : unit_(unit(load_mesh)) {
  Vec3<double> low = mesh.vertices[0], high = low;
  for (const auto& v : mesh.vertices) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  levels_ = 2;
  while (radius2(levels_ - 1) < 0.25 * (high - low).squaredNorm()) ++levels_;
  const std::size_t n = load_mesh.nodes().size(), stride = influence.stride;
  const std::vector<std::vector<detail::NodeWeight>> at =
      detail::vertices_at_nodes(mesh, mid_edges, load_mesh);
  std::vector<std::vector<detail::NodeWeight>> loaded(n * levels_), seen(n * levels_);  // nodes; vertices
  detail::parallel_for(n * levels_, threads, [&](std::size_t i) {
    loaded[i] = detail::patch_around(load_mesh, i / levels_, std::sqrt(radius2(i % levels_)));
    for (const detail::NodeWeight& w : loaded[i])
      for (const detail::NodeWeight& v : at[w.node]) detail::add_weight(seen[i], v.node, w.weight * v.weight);
  });
  for (const auto& list : loaded) keep_solved(load_mesh, list);
  moments_.resize(n * levels_);
  detail::parallel_for(n * levels_, threads, [&](std::size_t i) {
    const std::size_t k = i / levels_;
    const auto see = [&](std::uint32_t node, const auto& each) {
      for (const detail::NodeWeight& v : at[node]) each(v.node, v.weight);
    };
    moments_[i] = detail::find_moments(load_mesh, k, spread(k, i % levels_), influence, see);
    detail::find_edge(load_mesh, k, std::sqrt(radius2(i % levels_)), moments_[i]);
  });
  std::vector<std::vector<std::uint32_t>> around(n);  // triangles
  for (std::uint32_t t = 0; t < load_mesh.triangles().size(); ++t)
    for (auto k : load_mesh.triangles()[t]) around[k].push_back(t);
  own_.resize(load_mesh.triangles().size() * levels_);
  second_.resize(n * levels_);
  std::vector<std::array<Mat3<double>, 9>> pairs(own_.size());
  detail::parallel_for(n, threads, [&](std::size_t k) {
    std::vector<std::uint32_t> slot(mesh.vertices.size(), ~0u), needed;
    std::vector<Mat3<double>> field;
    for (std::size_t level = 0; level < levels_; ++level) {
      for (auto v : needed) slot[v] = ~0u;
      needed.clear();
      for (auto t : around[k])
        for (auto i : load_mesh.triangles()[t])
          for (const detail::NodeWeight& w : seen[i * levels_ + level]) {
            if (slot[w.node] != ~0u) continue;
            slot[w.node] = static_cast<std::uint32_t>(needed.size());
            needed.push_back(w.node);
          }
      field.assign(needed.size(), Mat3<double>::Zero());
      for (const detail::NodeWeight& w : loaded[k * levels_ + level])
        for (std::size_t l = 0; l < 3; ++l) {
          const float* c = influence(w.node, l);
          for (std::size_t j = 0; j < needed.size(); ++j)
            field[j].col(Eigen::Index(l)) += w.weight * detail::read_vertex(c, stride, needed[j]);
        }
      for (auto t : around[k]) {
        const auto& corner = load_mesh.triangles()[t];
        for (std::size_t i = 0; i < 3; ++i) {
          Mat3<double> mean = Mat3<double>::Zero();
          for (const detail::NodeWeight& w : seen[corner[i] * levels_ + level])
            mean += w.weight * field[slot[w.node]];
          for (std::size_t j = 0; j < 3; ++j)
            if (corner[j] == k) pairs[t * levels_ + level][3 * i + j] = mean;
        }
      }
      for (std::size_t l = 0; l < 4; ++l) {
        Vec3<double> u = Vec3<double>::Zero();
        for (const detail::NodeWeight& q : loaded[k * levels_ + level]) {
          const Eigen::Vector4d load =
              q.weight * (l == 1 || l == 2
                              ? detail::in_tangents(load_mesh, q.node, detail::node_tangent(load_mesh, k, l))
                              : Eigen::Vector4d(Eigen::Vector4d::Unit(Eigen::Index(l))));
          for (std::size_t i = 0; i < 4; ++i)
            if (load[Eigen::Index(i)] != 0)
              for (const detail::NodeWeight& w : seen[k * levels_ + level])
                u += load[Eigen::Index(i)] * w.weight *
                     detail::read_vertex(influence(q.node, 3 + i), stride, w.node);
        }
        for (std::size_t i = 0; i < 3; ++i)
          second_[k * levels_ + level].mean[3 * l + i] = static_cast<float>(u[Eigen::Index(i)]);
      }
    }
  });
  for (std::size_t i = 0; i < own_.size(); ++i) {
    constexpr std::size_t pair_of[6][2] = {{0, 0}, {4, 4}, {8, 8}, {1, 3}, {5, 7}, {6, 2}};
    for (std::size_t p = 0; p < 6; ++p) {
      const Mat3<double> mean = 0.5 * (pairs[i][pair_of[p][0]] + pairs[i][pair_of[p][1]]);
      const Mat3<double> w = (p < 3 ? 0.5 : 1.0) * (mean + mean.transpose());
      const double entry[6] = {w(0, 0), w(1, 1), w(2, 2), w(0, 1), w(1, 2), w(2, 0)};
      for (int e = 0; e < 6; ++e) own_[i].pair[p][e] = static_cast<float>(entry[e]);
    }
  }
}

PALPATE_COMPILED_INLINE void PatchTable::keep_solved(const LoadMesh& load_mesh,
                                                     const std::vector<detail::NodeWeight>& list) {
  std::vector<detail::NodeWeight> solved;
  for (const detail::NodeWeight& w : list) {
    if (w.node < load_mesh.solved())
      detail::add_weight(solved, w.node, w.weight);
    else
      for (const Share& s : load_mesh.shares(w.node))
        detail::add_weight(solved, s.node, w.weight * double(s.weight));
  }
  for (const detail::NodeWeight& w : solved)
    if (w.weight > 0) spread_.push_back({w.node, static_cast<float>(w.weight)});
  spread_begin_.push_back(static_cast<std::uint32_t>(spread_.size()));
}

PALPATE_COMPILED_INLINE double PatchTable::unit(const LoadMesh& load_mesh) {
  double least = (std::numeric_limits<double>::max)();
  for (const auto& node : load_mesh.nodes()) least = (std::min)(least, node.spacing);
  return 0.25 * least * least;
}

}  // namespace palpate
