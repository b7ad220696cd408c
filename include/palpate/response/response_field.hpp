// SPDX-License-Identifier: MIT
#pragma once

/// @file Response field: an object's elastic response to contact anywhere on its surface, computed once at
/// set-up from the closed surface mesh, E, nu and the fixed region. The tick that uses it is in
/// response_contact.hpp.
///
/// | symbol | name                                  | unit | range                                 |
/// |--------|---------------------------------------|------|---------------------------------------|
/// | E      | Young's modulus                       | Pa   | > 0                                   |
/// | nu     | Poisson's ratio                       | -    | [0, 1/2]; 1/2 is exact, nothing locks |
/// | n      | vertices of the boundary element mesh | -    | [20, 5000]; error about 1/n           |
///
/// Memory: 84 n m bytes for the influence functions, m the positions of loads (load_positions.hpp): with n =
/// 600 34 MB for a smooth body, 95 to 110 MB for one that is all next to its edges, as a block; see
/// `memory()`. During set-up about twice that and 150 n^2 bytes more. Set-up: O(n^3), seconds. Several pieces
/// are allowed, each fixed somewhere. Limits: small strain per unit load; parts thinner than an edge of the
/// boundary element mesh bend too little: `unresolved_area()`. Reports (error.hpp) bad E, nu, mesh or fixed
/// region. Source: [brebbia1984], [james1999].

#include <palpate/geometry/concept.hpp>
#include <palpate/response/setup/element_mesh.hpp>
#include <palpate/response/tick/mid_edge_table.hpp>
#include <palpate/response/tick/patch_table.hpp>
#include <palpate/response/tick/rotation_table.hpp>

namespace palpate {

/// All that a tick reads; what save.hpp writes.
struct ResponseParts {
  double E = 0, nu = 0;
  ElementMesh mesh;                                     ///< without nodes_of, middle and nodes
  std::vector<LoadNode> nodes;                          ///< of the load mesh
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< between them
  std::vector<std::uint32_t> share_begin;               ///< see LoadMesh
  std::vector<LoadMesh::Share> shares;
  std::vector<float> influence;  ///< see InfluenceFunctions
  std::vector<PatchTable::Own> own;
  std::vector<PatchTable::Second> second;
  std::vector<PatchTable::Moments> moments;
  std::vector<std::uint32_t> spread_begin;  ///< see PatchTable
  std::vector<LoadMesh::Share> spread;
  std::vector<MidEdgeTable::Edges> edges;  ///< see MidEdgeTable
  MidEdgeTable::Rows edge_rows, vertex_rows;
};

namespace detail {
class LoadPositions;
}

class ResponseField {
 public:
  struct Params {
    double E = 1e6;                             ///< Young's modulus [Pa], > 0
    double nu = 0.5;                            ///< Poisson's ratio [-], [0, 1/2]
    RemeshParams mesh = {};                     ///< boundary element mesh
    unsigned threads = 2;                       ///< at set-up only; see parallel.hpp for hosts without
    std::function<void(double)> progress = {};  ///< called in the calling thread with what is done, 0 to 1
  };
  /// Fields per solved node of the load mesh, see InfluenceFunctions.
  static constexpr std::size_t loads = InfluenceFunctions::loads, sharpened = InfluenceFunctions::sharpened;

  /// `fixed` is true where the object is fixed; the mesh is cut along its boundary.
  template <Real S>
  ResponseField(const MeshData<S>& mesh, const FixedRegion& fixed, const Params& params) {
    build(mesh_cast<double>(mesh), fixed, params);
  }
  /// The object is fixed at the listed vertices: on every triangle that has all three of its corners in the
  /// list.
  template <Real S>
  ResponseField(const MeshData<S>& mesh, const std::vector<std::uint32_t>& fixed_vertices,
                const Params& params) {
    build(mesh_cast<double>(mesh), fixed_vertices, params);
  }
  /// From parts that were saved (save.hpp), which has checked them.
  explicit ResponseField(ResponseParts parts);
  [[nodiscard]] ResponseParts parts() const;

  [[nodiscard]] double E() const noexcept { return E_; }
  [[nodiscard]] double nu() const noexcept { return nu_; }
  [[nodiscard]] double shear_modulus() const noexcept { return E_ / (2 * (1 + nu_)); }
  [[nodiscard]] const ElementMesh& mesh() const noexcept { return mesh_; }
  /// Fraction of the free surface's area where the body is thinner than the boundary element mesh's edges
  /// (see palpate::unresolved_area): 0 is good, 1 is a plate with too few vertices. Milliseconds; set-up
  /// only.
  [[nodiscard]] double unresolved_area() const;
  /// Positions of the mesh's nodes where the response is no elastic body's: what presses there on a disc as
  /// wide as an edge would draw the surface towards itself,
  ///
  ///     n.w n < -8 (1 - nu)/(3 pi^2 mu (l/2))      the disc's own mean displacement; l: the edges' length
  ///
  /// A part is too thin for its elements there (ask for more vertices), or fixed at few of them. A contact
  /// there goes on as on a half-space (`Status::near_field_only`). None is good. Set-up only.
  [[nodiscard]] std::vector<Vec3<double>> unsound_positions() const;
  [[nodiscard]] const LoadMesh& load_mesh() const noexcept { return load_mesh_; }
  [[nodiscard]] const PatchTable& table() const noexcept { return table_; }
  [[nodiscard]] const MidEdgeTable& mid_edges() const noexcept { return mid_edges_; }
  [[nodiscard]] const RotationTable& rotation() const noexcept { return rotation_; }
  /// Bytes that a tick may read.
  [[nodiscard]] std::size_t memory() const noexcept {
    return influence_.size() * sizeof(float) + table_.memory() + mid_edges_.memory() + rotation_.memory();
  }
  /// Vertices of the boundary element mesh, rounded up to whole registers, whatever this processor's.
  [[nodiscard]] std::size_t stride() const noexcept { return stride_; }
  [[nodiscard]] static constexpr std::size_t padded(std::size_t vertices) noexcept {
    return (vertices + 7) / 8 * 8;
  }
  /// mu w of load l of solved node k: x at every vertex, y and z `stride()` further each [1/m]; of dipole and
  /// couples [1/m^2].
  [[nodiscard]] const float* influence(std::size_t k, std::size_t l) const noexcept {
    return functions()(k, l);
  }
  /// The same at the position of node i.
  [[nodiscard]] Vec3<double> at(std::size_t i, std::size_t k, std::size_t l) const noexcept {
    const LoadNode& node = load_mesh_.nodes()[i];
    const float* const c = influence(k, l);
    Vec3<float> w = Vec3<float>::Zero();
    for (std::size_t j = 0; j < 3; ++j) {
      if (node.part[Eigen::Index(j)] == 0) continue;
      const float* const at = c + mesh_.triangles[node.triangle][j];
      w += node.part[Eigen::Index(j)] * Vec3<float>(at[0], at[stride_], at[2 * stride_]);
    }
    return w.template cast<double>();
  }
  /// The boundary element mesh's vertices by coordinate, padded; 1 where free, 0 where fixed.
  [[nodiscard]] const float* coordinate(int axis) const noexcept {
    return &position_[static_cast<std::size_t>(axis) * stride_];
  }
  [[nodiscard]] const float* is_free() const noexcept { return &position_[3 * stride_]; }

 private:
  [[nodiscard]] InfluenceFunctions functions() const noexcept { return {influence_.data(), stride_}; }
  void build(const MeshData<double>& mesh, const FixedRegion& fixed, const Params& params);
  void build(const MeshData<double>& mesh, const std::vector<std::uint32_t>& fixed_vertices,
             const Params& params);
  void build_from(const MeshData<double>& mesh, const std::vector<std::uint8_t>& fixed_triangle,
                  const Params& params);
  // At set-up: what influence() reads.
  [[nodiscard]] float* row(std::size_t k, std::size_t l) noexcept {
    return &influence_[(loads * k + l) * 3 * stride_];
  }
  void derive(const detail::LoadPositions& positions, std::size_t k);
  void join(const detail::LoadPositions& positions, std::size_t k);
  void read_mesh();

  double E_ = 0, nu_ = 0;
  ElementMesh mesh_;
  LoadMesh load_mesh_;
  PatchTable table_;
  MidEdgeTable mid_edges_;
  RotationTable rotation_;
  std::vector<float> influence_, position_;
  std::size_t stride_ = 0;
};

}  // namespace palpate

#ifndef PALPATE_COMPILED
#include <palpate/response/setup/response_field_impl.hpp>
#endif
