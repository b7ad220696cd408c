// SPDX-License-Identifier: MIT
#pragma once

/// @file  Response field: an object's elastic answer to contact anywhere on its surface, computed once at set-up from the
/// closed surface mesh, E, nu and the fixed region. The tick that uses it is in response_contact.hpp.
///
/// | symbol | name                          | unit | range                                   |
/// |--------|-------------------------------|------|-----------------------------------------|
/// | E      | Young's modulus               | Pa   | > 0                                     |
/// | nu     | Poisson's ratio               | -    | [0, 1/2]; 1/2 is exact, nothing locks   |
/// | n      | vertices of the solve mesh    | -    | [20, 5000]; error about 1/n             |
///
/// Memory: 36 n n_free bytes for the columns (n = 600: 12 MB), see `memory()`. Set-up: O(n^3), seconds.
/// Limits: small strain per unit load; one closed piece; parts thinner than two edges of the solve mesh are not resolved.
/// Reports (error.hpp) bad E, nu, mesh or fixed region. Source: [brebbia1984], [james1999].

#include <palpate/core/fixed_vector.hpp>
#include <palpate/response/response_columns.hpp>

namespace palpate {

/// Display vertices bound to the solve mesh, sorted by its triangles. Built by `ResponseField::bind`.
struct ResponseDisplay {
  struct Span {
    std::uint32_t triangle, begin, end;
    Vec3<float> centre;
    float radius;
  };
  std::vector<Span> spans;
  std::vector<float> x, y, z, b1, b2;   ///< rest position [m]; barycentric weights of corners 1 and 2
  std::vector<std::uint32_t> index;     ///< the caller's vertex number
  [[nodiscard]] std::size_t size() const noexcept { return index.size(); }
};

class ResponseField {
 public:
  struct Params {
    double E = 1e6;             ///< Young's modulus [Pa], > 0
    double nu = 0.5;            ///< Poisson's ratio [-], [0, 1/2]
    RemeshParams mesh = {};     ///< solve mesh
    unsigned threads = 2;       ///< at set-up only
  };
  /// A weighted node of the surface: one of the places whose columns are combined.
  struct Load {
    std::uint32_t node;  ///< touchable node
    Vec3<double> f;
  };

  /// `fixed` is true where the object is held; the mesh is cut along its boundary.
  template <Real S>
  ResponseField(const MeshData<S>& mesh, const FixedRegion& fixed, const Params& params) : params_(params) {
    const MeshData<double> cut = detail::cut_at_rim(to_double(mesh), fixed);
    std::vector<std::uint8_t> inside(cut.triangles.size());
    for (std::size_t t = 0; t < inside.size(); ++t) {
      const auto& c = cut.triangles[t];
      inside[t] = fixed((cut.vertices[c[0]] + cut.vertices[c[1]] + cut.vertices[c[2]]) / 3);
    }
    build(cut, inside);
  }
  /// The object is held at the listed vertices: on every triangle that has all three of its corners in the list.
  template <Real S>
  ResponseField(const MeshData<S>& mesh, const std::vector<std::uint32_t>& fixed_vertices, const Params& params) : params_(params) {
    std::vector<std::uint8_t> held(mesh.vertices.size(), 0);
    for (auto v : fixed_vertices) {
      if (v >= held.size()) fail("ResponseField", "fixed vertices must be vertices of the mesh", v);
      held[v] = 1;
    }
    std::vector<std::uint8_t> inside(mesh.triangles.size());
    for (std::size_t t = 0; t < inside.size(); ++t) {
      const auto& c = mesh.triangles[t];
      inside[t] = c[0] < held.size() && c[1] < held.size() && c[2] < held.size() && held[c[0]] && held[c[1]] && held[c[2]];
    }
    build(to_double(mesh), inside);
  }

  [[nodiscard]] const Params& params() const noexcept { return params_; }
  [[nodiscard]] double shear_modulus() const noexcept { return params_.E / (2 * (1 + params_.nu)); }
  [[nodiscard]] const SolveMesh& mesh() const noexcept { return mesh_; }
  [[nodiscard]] std::size_t touchable() const noexcept { return node_.size(); }
  /// Bytes that a tick may read.
  [[nodiscard]] std::size_t memory() const noexcept { return (columns_.size() + own_.size()) * sizeof(float) + gradient_.size() * sizeof(Load); }
  /// Column of a unit force along axis l at touchable node j: mu w, 3 values per vertex [1/m].
  [[nodiscard]] const float* column(std::size_t j, std::size_t l) const noexcept { return &columns_[(3 * j + l) * stride_]; }
  [[nodiscard]] std::size_t stride() const noexcept { return stride_; }
  /// mu w at the vertex of touchable node i of a unit force at touchable node j.
  [[nodiscard]] Mat3<double> block(std::size_t i, std::size_t j) const noexcept {
    Mat3<double> w;
    const std::size_t row = 3 * std::size_t(node_[i].vertex);
    for (int l = 0; l < 3; ++l) {
      const float* c = column(j, std::size_t(l)) + row;
      w.col(l) << double(c[0]), double(c[1]), double(c[2]);
    }
    return w;
  }
  [[nodiscard]] const SolveMesh::Node& node(std::size_t j) const noexcept { return node_[j]; }
  /// Place on the touchable surface nearest to x; its triangle's touchable nodes.
  [[nodiscard]] MeshPoint<double> locate(const Vec3<double>& x) const noexcept { return tree_.closest(x); }
  [[nodiscard]] const std::array<std::uint32_t, 3>& nodes_of(std::size_t triangle) const noexcept { return touch_.triangles[triangle]; }
  /// Loads (node, vector g) such that sum g h(node) = tangential gradient of h at touchable node j, for any h.
  [[nodiscard]] const Load* gradient_begin(std::size_t j) const noexcept { return &gradient_[gradient_start_[j]]; }
  [[nodiscard]] const Load* gradient_end(std::size_t j) const noexcept { return gradient_.data() + gradient_start_[j + 1]; }

  /// mu w at a place of a touchable triangle of unit forces there: one short read.
  [[nodiscard]] Mat3<double> own_compliance(std::size_t triangle, const Vec3<double>& weight) const noexcept {
    const float* table = &own_[triangle * 9 * 36];
    Mat3<double> w = Mat3<double>::Zero();
    for (int i = 0; i < 9; ++i, table += 36)
      for (int e = 0; e < 9; ++e) w(e % 3, e / 3) += weight[i / 3] * weight[i % 3] * double(table[e]);
    return w;
  }
  /// The same of a double force: `load` (load axis, place axis) contracts the gradient of w by the load's place.
  [[nodiscard]] Vec3<double> own_second(std::size_t triangle, const Vec3<double>& weight, const Mat3<double>& load) const noexcept {
    const float* table = &own_[triangle * 9 * 36 + 9];
    Vec3<double> u = Vec3<double>::Zero();
    for (int i = 0; i < 9; ++i, table += 36)
      for (int e = 0; e < 27; ++e) u[e / 9] += weight[i / 3] * weight[i % 3] * double(table[e]) * load(e / 3 % 3, e % 3);
    return u;
  }

  /// Binds the vertices of a display mesh. The table is the caller's; it serves any number of ticks.
  template <Real S>
  [[nodiscard]] ResponseDisplay bind(const std::vector<Vec3<S>>& points) const {
    TriangleTree<double> tree(MeshData<double>{mesh_.vertices, mesh_.triangles});
    std::vector<MeshPoint<double>> at(points.size());
    std::vector<std::uint32_t> order(points.size());
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      if (!is_finite(points[i])) fail_at("ResponseField::bind", "points must be finite", "point", i);
      at[i] = tree.closest(points[i].template cast<double>());
      order[i] = i;
    }
    std::stable_sort(order.begin(), order.end(), [&](auto l, auto r) { return at[l].triangle < at[r].triangle; });
    ResponseDisplay d;
    for (std::uint32_t i : order) {
      const auto n = static_cast<std::uint32_t>(d.index.size());
      if (d.spans.empty() || d.spans.back().triangle != at[i].triangle) {
        const auto& t = mesh_.triangles[at[i].triangle];
        const Vec3<double> c = (mesh_.vertices[t[0]] + mesh_.vertices[t[1]] + mesh_.vertices[t[2]]) / 3;
        d.spans.push_back({at[i].triangle, n, n, c.cast<float>(), 0});
      }
      const Vec3<float> p = points[i].template cast<float>();
      d.spans.back().end = n + 1;
      d.spans.back().radius = (std::max)(d.spans.back().radius, (p - d.spans.back().centre).norm());
      d.x.push_back(p.x());
      d.y.push_back(p.y());
      d.z.push_back(p.z());
      d.b1.push_back(static_cast<float>(at[i].weight[1]));
      d.b2.push_back(static_cast<float>(at[i].weight[2]));
      d.index.push_back(i);
    }
    for (auto* list : {&d.x, &d.y, &d.z, &d.b1, &d.b2}) list->resize(list->size() + 8, 0.f);  // whole lanes
    return d;
  }

 private:
  template <Real S>
  [[nodiscard]] static MeshData<double> to_double(const MeshData<S>& mesh) {
    MeshData<double> out;
    out.triangles = mesh.triangles;
    out.vertices.reserve(mesh.vertices.size());
    for (const auto& v : mesh.vertices) out.vertices.push_back(v.template cast<double>());
    return out;
  }

  void build(const MeshData<double>& mesh, const std::vector<std::uint8_t>& fixed_triangle) {
    require_positive(params_.E, "ResponseField", "E [Pa] must be > 0");
    if (!(params_.nu >= 0 && params_.nu <= 0.5)) fail("ResponseField", "nu must be in [0, 1/2]", params_.nu);
    BoundaryElements bem(make_solve_mesh(SmoothSurface(mesh), fixed_triangle, params_.mesh), params_.nu, params_.threads);
    bem.factorise();
    const ResponseColumns columns = solve_columns(bem, params_.nu);
    for (Eigen::Index c = 0; c < columns.w.cols(); ++c)
      for (Eigen::Index r = 0; r < columns.w.rows(); ++r)
        if (!is_finite(columns.w(r, c))) fail("ResponseField", "the boundary equation has no finite solution: is the mesh closed, without triangles that fold over?");
    mesh_ = bem.mesh();
    std::vector<std::uint32_t> number(mesh_.nodes.size(), ~0u);
    for (std::uint32_t j = 0; j < columns.touchable.size(); ++j) {
      number[columns.touchable[j]] = j;
      node_.push_back(mesh_.nodes[columns.touchable[j]]);
      touch_.vertices.push_back(node_.back().source);
    }
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (mesh_.fixed_triangle[t]) continue;
      const auto& k = mesh_.nodes_of[t];
      touch_.triangles.push_back({number[k[0]], number[k[1]], number[k[2]]});
    }
    tree_ = TriangleTree<double>(touch_);
    stride_ = 3 * mesh_.vertices.size();
    columns_.resize(stride_ * 3 * node_.size());
    for (std::size_t c = 0; c < 3 * node_.size(); ++c)
      for (std::size_t r = 0; r < stride_; ++r) columns_[c * stride_ + r] = static_cast<float>(columns.w(Eigen::Index(r), Eigen::Index(c)));
    fit_gradients();
    own_.reserve(touch_.triangles.size() * 9 * 36);
    for (const auto& t : touch_.triangles)
      for (auto i : t)
        for (auto k : t) {
          const Mat3<double> w = block(i, k);
          for (int e = 0; e < 9; ++e) own_.push_back(static_cast<float>(w(e % 3, e / 3)));
          Mat3<double> gradient[3];
          for (auto& g : gradient) g.setZero();
          for (const Load* g = gradient_begin(k); g != gradient_end(k); ++g) {
            const Mat3<double> wg = block(i, g->node);
            for (int axis = 0; axis < 3; ++axis) gradient[axis] += g->f[axis] * wg;
          }
          for (int c = 0; c < 3; ++c)
            for (int l = 0; l < 3; ++l)
              for (int axis = 0; axis < 3; ++axis) own_.push_back(static_cast<float>(gradient[axis](c, l)));
        }
  }

  // Least squares over the neighbours: g = argmin sum |g.d_j - (h_j - h_k)|^2 / |d_j|^2 in the tangent plane.
  void fit_gradients() {
    std::vector<std::vector<std::uint32_t>> ring(node_.size());
    for (const auto& t : touch_.triangles)
      for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t o = 1; o < 3; ++o) {
          auto& r = ring[t[c]];
          if (std::find(r.begin(), r.end(), t[(c + o) % 3]) == r.end()) r.push_back(t[(c + o) % 3]);
        }
    gradient_start_.push_back(0);
    for (std::uint32_t k = 0; k < node_.size(); ++k) {
      const Vec3<double> n = node_[k].normal, t1 = perpendicular(n), t2 = n.cross(t1);
      Eigen::Matrix2d A = Eigen::Matrix2d::Zero();
      for (auto j : ring[k]) {
        const Vec3<double> d = touch_.vertices[j] - touch_.vertices[k];
        const Eigen::Vector2d s(d.dot(t1), d.dot(t2));
        A += s * s.transpose() / d.squaredNorm();
      }
      A += 1e-6 * A.trace() * Eigen::Matrix2d::Identity();
      const Eigen::Matrix2d inverse = A.inverse();
      Vec3<double> sum = Vec3<double>::Zero();
      for (auto j : ring[k]) {
        const Vec3<double> d = touch_.vertices[j] - touch_.vertices[k];
        const Eigen::Vector2d g = inverse * Eigen::Vector2d(d.dot(t1), d.dot(t2)) / d.squaredNorm();
        gradient_.push_back({j, g[0] * t1 + g[1] * t2});
        sum += gradient_.back().f;
      }
      gradient_.push_back({k, -sum});
      gradient_start_.push_back(static_cast<std::uint32_t>(gradient_.size()));
    }
  }

  Params params_;
  SolveMesh mesh_;
  std::vector<SolveMesh::Node> node_;  // touchable
  MeshData<double> touch_;             // triangles of source places, in touchable nodes
  TriangleTree<double> tree_;
  std::vector<float> columns_;
  // Per touchable triangle and pair of corners i, k: w(i, k), 9 by column; its gradient by the load's place, 27.
  std::vector<float> own_;
  std::size_t stride_ = 0;
  std::vector<Load> gradient_;
  std::vector<std::uint32_t> gradient_start_;
};

}  // namespace palpate
