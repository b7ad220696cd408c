// SPDX-License-Identifier: MIT
#pragma once

/// @file Response field: an object's elastic answer to contact anywhere on its surface, computed once at
/// set-up from the closed surface mesh, E, nu and the fixed region. The tick that uses it is in
/// response_contact.hpp.
///
/// | symbol | name                          | unit | range                                   |
/// |--------|-------------------------------|------|-----------------------------------------|
/// | E      | Young's modulus               | Pa   | > 0                                     |
/// | nu     | Poisson's ratio               | -    | [0, 1/2]; 1/2 is exact, nothing locks   |
/// | n      | vertices of the solve mesh    | -    | [20, 5000]; error about 1/n             |
///
/// Memory: 84 n m bytes for the columns, m the places of loads (load_places.hpp): with n = 600 34 MB for a
/// smooth body, 95 to 110 MB for one that is all next to its edges, as a block; see `memory()`. During set-up
/// about twice that and 150 n^2 bytes more. Set-up: O(n^3), seconds. Several pieces are allowed, each held
/// somewhere. Limits: small strain per unit load; parts thinner than an edge of the solve mesh bend too
/// little: `unresolved_area()`. Reports (error.hpp) bad E, nu, mesh or fixed region. Source: [brebbia1984],
/// [james1999].

#include <palpate/response/setup/response_columns.hpp>
#include <palpate/response/tick/mid_edge_table.hpp>
#include <palpate/response/tick/patch_table.hpp>
#include <palpate/response/tick/rotation_table.hpp>

namespace palpate {

/// All that a tick reads; what save.hpp writes.
struct ResponseParts {
  double E = 0, nu = 0;
  SolveMesh mesh;                                       ///< without nodes_of, middle and nodes
  std::vector<TouchNode> nodes;                         ///< of the touch mesh
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< between them
  std::vector<std::uint32_t> share_begin;               ///< see TouchMesh
  std::vector<TouchMesh::Share> shares;
  std::vector<float> columns;
  std::vector<PatchTable::Own> own;
  std::vector<PatchTable::Second> second;
  std::vector<PatchTable::Moments> moments;
  std::vector<std::uint32_t> spread_begin;  ///< see PatchTable
  std::vector<TouchMesh::Share> spread;
  std::vector<MidEdgeTable::Edges> edges;  ///< see MidEdgeTable
  MidEdgeTable::Rows bends, raises;
};

class ResponseField {
 public:
  struct Params {
    double E = 1e6;                             ///< Young's modulus [Pa], > 0
    double nu = 0.5;                            ///< Poisson's ratio [-], [0, 1/2]
    RemeshParams mesh = {};                     ///< solve mesh
    unsigned threads = 2;                       ///< at set-up only; see parallel.hpp for hosts without
    std::function<void(double)> progress = {};  ///< called in the calling thread with what is done, 0 to 1
  };
  /// Fields per solved node of the touch mesh: unit forces along x, y, z; unit radial double force; unit
  /// tilts along its two tangents; unit twist about its inward normal.
  static constexpr std::size_t loads = 7;

  /// `fixed` is true where the object is held; the mesh is cut along its boundary.
  template <Real S>
  ResponseField(const MeshData<S>& mesh, const FixedRegion& fixed, const Params& params) {
    const MeshData<double> cut = detail::cut_at_rim(to_double(mesh), fixed);
    std::vector<std::uint8_t> inside(cut.triangles.size());
    for (std::size_t t = 0; t < inside.size(); ++t) {
      const auto& c = cut.triangles[t];
      inside[t] = fixed((cut.vertices[c[0]] + cut.vertices[c[1]] + cut.vertices[c[2]]) / 3);
    }
    build(cut, inside, params);
  }
  /// The object is held at the listed vertices: on every triangle that has all three of its corners in the
  /// list.
  template <Real S>
  ResponseField(const MeshData<S>& mesh, const std::vector<std::uint32_t>& fixed_vertices,
                const Params& params) {
    std::vector<std::uint8_t> held(mesh.vertices.size(), 0);
    for (auto v : fixed_vertices) {
      if (v >= held.size()) fail("ResponseField", "fixed vertices must be vertices of the mesh", v);
      held[v] = 1;
    }
    std::vector<std::uint8_t> inside(mesh.triangles.size());
    for (std::size_t t = 0; t < inside.size(); ++t) {
      const auto& c = mesh.triangles[t];
      inside[t] = c[0] < held.size() && c[1] < held.size() && c[2] < held.size() && held[c[0]] &&
                  held[c[1]] && held[c[2]];
    }
    build(to_double(mesh), inside, params);
  }
  /// From parts that were saved (save.hpp), which has checked them.
  explicit ResponseField(ResponseParts parts)
      : E_(parts.E), nu_(parts.nu), mesh_(std::move(parts.mesh)), columns_(std::move(parts.columns)) {
    stride_ = padded(mesh_.vertices.size());
    const std::size_t levels = parts.second.size() / parts.nodes.size();
    touch_ = TouchMesh(std::move(parts.nodes), std::move(parts.triangles), std::move(parts.share_begin),
                       std::move(parts.shares));
    table_ = PatchTable(touch_, std::move(parts.own), std::move(parts.second), std::move(parts.moments),
                        levels, std::move(parts.spread_begin), std::move(parts.spread));
    bends_ = MidEdgeTable(mesh_, std::move(parts.edges), std::move(parts.bends), std::move(parts.raises));
    read_mesh();
  }
  [[nodiscard]] ResponseParts parts() const {
    return {E_,
            nu_,
            mesh_,
            touch_.nodes(),
            touch_.triangles(),
            touch_.share_begin(),
            touch_.all_shares(),
            columns_,
            table_.own_rows(),
            table_.second_rows(),
            table_.moment_rows(),
            table_.spread_begin(),
            table_.all_spread(),
            bends_.of_triangle(),
            bends_.edge_rows(),
            bends_.vertex_rows()};
  }

  [[nodiscard]] double E() const noexcept { return E_; }
  [[nodiscard]] double nu() const noexcept { return nu_; }
  [[nodiscard]] double shear_modulus() const noexcept { return E_ / (2 * (1 + nu_)); }
  [[nodiscard]] const SolveMesh& mesh() const noexcept { return mesh_; }
  /// Fraction of the free surface's area where the body is thinner than the solve mesh's edges (see
  /// palpate::unresolved_area): 0 is good, 1 is a plate with too few vertices. Milliseconds; set-up only.
  [[nodiscard]] double unresolved_area() const { return palpate::unresolved_area(mesh_); }
  [[nodiscard]] const TouchMesh& touch() const noexcept { return touch_; }
  [[nodiscard]] const PatchTable& table() const noexcept { return table_; }
  [[nodiscard]] const MidEdgeTable& bends() const noexcept { return bends_; }
  [[nodiscard]] const RotationTable& rotation() const noexcept { return rotation_; }
  /// Bytes that a tick may read.
  [[nodiscard]] std::size_t memory() const noexcept {
    return columns_.size() * sizeof(float) + table_.memory() + bends_.memory() + rotation_.memory();
  }
  /// Vertices of the solve mesh, rounded up to whole registers, whatever this processor's.
  [[nodiscard]] std::size_t stride() const noexcept { return stride_; }
  [[nodiscard]] static constexpr std::size_t padded(std::size_t vertices) noexcept {
    return (vertices + 7) / 8 * 8;
  }
  /// mu w of load l of solved node k: x at every vertex, y and z `stride()` further each [1/m]; l >= 3:
  /// [1/m^2].
  [[nodiscard]] const float* column(std::size_t k, std::size_t l) const noexcept {
    return &columns_[(loads * k + l) * 3 * stride_];
  }
  /// The same at the place of node i.
  [[nodiscard]] Vec3<double> at(std::size_t i, std::size_t k, std::size_t l) const noexcept {
    const TouchNode& node = touch_.nodes()[i];
    const float* const c = column(k, l);
    Vec3<float> w = Vec3<float>::Zero();
    for (std::size_t j = 0; j < 3; ++j) {
      if (node.part[Eigen::Index(j)] == 0) continue;
      const float* const at = c + mesh_.triangles[node.triangle][j];
      w += node.part[Eigen::Index(j)] * Vec3<float>(at[0], at[stride_], at[2 * stride_]);
    }
    return w.template cast<double>();
  }
  /// The solve mesh's vertices by coordinate, padded; 1 where free, 0 where fixed.
  [[nodiscard]] const float* coordinate(int axis) const noexcept {
    return &place_[static_cast<std::size_t>(axis) * stride_];
  }
  [[nodiscard]] const float* is_free() const noexcept { return &place_[3 * stride_]; }

 private:
  template <Real S>
  [[nodiscard]] static MeshData<double> to_double(const MeshData<S>& mesh) {
    MeshData<double> out;
    out.triangles = mesh.triangles;
    out.vertices.reserve(mesh.vertices.size());
    for (const auto& v : mesh.vertices) out.vertices.push_back(v.template cast<double>());
    return out;
  }

  void build(const MeshData<double>& mesh, const std::vector<std::uint8_t>& fixed_triangle,
             const Params& params) {
    require_positive(params.E, "ResponseField", "E [Pa] must be > 0");
    if (!(params.nu >= 0 && params.nu <= 0.5)) fail("ResponseField", "nu must be in [0, 1/2]", params.nu);
    E_ = params.E;
    nu_ = params.nu;
    const auto report = [&params](double done) {
      if (params.progress) params.progress(done);
    };
    report(0);
    SolveMesh solve = make_solve_mesh(SmoothSurface(mesh), fixed_triangle, params.mesh);
    report(0.1);
    BoundaryElements bem(std::move(solve), nu_, params.threads);
    report(0.3);
    bem.factorise();
    report(0.45);
    const detail::LoadPlaces places(bem.mesh());
    touch_ = places.touch_mesh();
    const detail::Matrix w = solve_columns(bem, nu_, std::span(touch_.nodes()).first(touch_.solved()));
    report(0.9);
    for (Eigen::Index c = 0; c < w.cols(); ++c)
      for (Eigen::Index r = 0; r < w.rows(); ++r)
        if (!is_finite(w(r, c)))
          fail("ResponseField",
               "the boundary equation has no finite solution: is the mesh closed, without triangles that "
               "fold over?");
    mesh_ = bem.mesh();
    bends_ = MidEdgeTable(mesh_, bem.bend());
    stride_ = padded(mesh_.vertices.size());
    columns_.resize(loads * 3 * stride_ * touch_.nodes().size(), 0.f);
    for (std::uint32_t k = 0; k < places.solved_or_held(); ++k)
      for (std::size_t l = 0; l < 3; ++l) {
        float* out = &columns_[(loads * k + l) * 3 * stride_];
        for (std::uint32_t v = 0; v < mesh_.vertices.size(); ++v) {
          const Vec3<double> u =
              k < touch_.solved()
                  ? Vec3<double>(w.block<3, 1>(Eigen::Index(3 * v), Eigen::Index(3 * k + l)))
                  : Vec3<double>(-detail::near_at_vertex(mesh_, touch_.nodes()[k], v, int(l), nu_));
          for (std::size_t i = 0; i < 3; ++i) out[i * stride_ + v] = static_cast<float>(u[Eigen::Index(i)]);
        }
      }
    detail::parallel_for(places.solved_or_held(), params.threads, [&](std::size_t k) { derive(places, k); });
    for (std::size_t k = places.solved_or_held(); k < touch_.nodes().size(); ++k) join(places, k);
    table_ = PatchTable(mesh_, bends_, touch_, params.threads, stride_,
                        [this](std::size_t k, std::size_t l) { return column(k, l); });
    columns_.resize(loads * 3 * stride_ * touch_.solved());
    columns_.shrink_to_fit();
    read_mesh();
    report(1);
  }

  // Double force, tilts and twist: derivatives of the forces' fields by their place.
  void derive(const detail::LoadPlaces& places, std::size_t k) {
    using Row = Eigen::Map<const Eigen::ArrayXf>;
    const auto size = static_cast<Eigen::Index>(3 * stride_);
    const Vec3<double> m = -touch_.nodes()[k].normal, t1 = perpendicular(Vec3<double>(-m)), t2 = t1.cross(m);
    for (std::size_t l = 3; l < loads; ++l) {
      Eigen::Map<Eigen::ArrayXf> sum(&columns_[(loads * k + l) * 3 * stride_], size);
      for (const auto& w : places.gradient(k)) {
        const Vec3<double> f = l == 3   ? Vec3<double>(0.5 * w.g)
                               : l == 6 ? Vec3<double>(0.5 * m.cross(w.g))
                                        : Vec3<double>(w.g.dot(l == 4 ? t1 : t2) * m);
        for (int i = 0; i < 3; ++i)
          sum += static_cast<float>(f[i]) * Row(column(w.node, std::size_t(i)), size);
      }
    }
  }

  // An edge's node: the mean of its parts' loads.
  void join(const detail::LoadPlaces& places, std::size_t k) {
    using Row = Eigen::Map<const Eigen::ArrayXf>;
    const auto size = static_cast<Eigen::Index>(3 * stride_);
    const float share = 1.f / static_cast<float>(places.parts(k).size());
    const Vec3<double> n = touch_.nodes()[k].normal, t1 = perpendicular(n), t2 = n.cross(t1);
    const auto sum = [&](std::size_t l) {
      return Eigen::Map<Eigen::ArrayXf>(&columns_[(loads * k + l) * 3 * stride_], size);
    };
    for (auto part : places.parts(k)) {
      for (std::size_t l = 0; l < loads; ++l)
        if (l != 4 && l != 5) sum(l) += share * Row(column(part, l), size);
      const Vec3<double> pn = touch_.nodes()[part].normal, p1 = perpendicular(pn), p2 = pn.cross(p1);
      sum(4) += share * (static_cast<float>(t1.dot(p1)) * Row(column(part, 4), size) +
                         static_cast<float>(t1.dot(p2)) * Row(column(part, 5), size));
      sum(5) += share * (static_cast<float>(t2.dot(p1)) * Row(column(part, 4), size) +
                         static_cast<float>(t2.dot(p2)) * Row(column(part, 5), size));
    }
  }

  // What a tick reads of the mesh alone.
  void read_mesh() {
    rotation_ = RotationTable(mesh_, stride_);
    place_.assign(4 * stride_, 0.f);
    for (std::size_t v = 0; v < mesh_.vertices.size(); ++v) {
      for (std::size_t i = 0; i < 3; ++i)
        place_[i * stride_ + v] = static_cast<float>(mesh_.vertices[v][Eigen::Index(i)]);
      place_[3 * stride_ + v] = mesh_.fixed_vertex[v] ? 0.f : 1.f;
    }
  }

  double E_ = 0, nu_ = 0;
  SolveMesh mesh_;
  TouchMesh touch_;
  PatchTable table_;
  MidEdgeTable bends_;
  RotationTable rotation_;
  std::vector<float> columns_, place_;
  std::size_t stride_ = 0;
};

}  // namespace palpate
