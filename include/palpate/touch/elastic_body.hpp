// SPDX-License-Identifier: MIT
#pragma once

/// @file An elastic body from a closed triangle mesh, E, nu and where it is fixed. Set-up only.

#include <palpate/geometry/mesh_surface.hpp>
#include <palpate/response/response_field.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace palpate {

/// Where a body is fixed: true inside. The mesh is cut along the boundary.
using FixedPredicate = std::function<bool(const Vec3<double>&)>;
/// The same, or vertices of the mesh: then it is fixed on every triangle that has all three of its corners in
/// the list.
using FixedPart = std::variant<FixedPredicate, std::vector<std::uint32_t>>;

/// Fixed where y is at most `height` [m]: what stands on something. y is up.
[[nodiscard]] inline FixedPredicate below(double height) {
  return [height](const Vec3<double>& x) { return x.y() <= height; };
}
/// Fixed where y is at least `height` [m]: what hangs.
[[nodiscard]] inline FixedPredicate above(double height) {
  return [height](const Vec3<double>& x) { return x.y() >= height; };
}

/// An elastic body that tools touch: its surface (`MeshSurface`), and its response to loads anywhere on it
/// (`ResponseField`), from which Touch takes force and shape alike.
///
/// | symbol | name       | unit | range, default                                                          |
/// |--------|------------|------|-------------------------------------------------------------------------|
/// | E      | `E`        | Pa   | >= 10, no default: liver 1e3 to 1e4, soft rubber 1e5 to 1e6             |
/// | nu     | `nu`       | -    | [0, 1/2], 0.49: tissue and rubber hardly change their volume            |
/// |        | `fixed`    |      | no default: `below(y)`, `above(y)`, any predicate, a list of vertices   |
/// | n      | `vertices` | -    | [20, 5000], 600: of the boundary element mesh; error about 1/n          |
///
/// Slender parts get up to as many vertices on top. Set-up takes seconds and grows as n^3; a copy costs a
/// reference count, and all copies may be used by any thread. `cache`: a file that keeps the field; it is
/// read where it was written for the same mesh, E, nu, fixed part and n by this version, and written where
/// not.
///
/// Reports a mesh that is not closed and oriented (the first defect of mesh_report.hpp), one longer than 10 m
/// or shorter than 1 mm, which is one in other units than metres, E below 10 Pa, which is one in kPa or MPa,
/// a fixed part that holds nothing or everything, with the mesh's box, a body whose response is none at more
/// than a tenth of its positions (`ResponseField::unsound_positions()`, which tells of fewer), a cache that
/// is damaged or cannot be written, and what ResponseField reports.
class ElasticBody {
 public:
  struct Params {
    double E = 0;                               ///< Young's modulus [Pa]
    double nu = 0.49;                           ///< Poisson's ratio [-]
    FixedPart fixed = {};                       ///< where it is fixed
    double vertices = 600;                      ///< n
    unsigned threads = 2;                       ///< at set-up only
    std::function<void(double)> progress = {};  ///< called in the calling thread with what is done, 0 to 1
    std::string cache = {};                     ///< name of a file; empty: none
  };

  template <Real S>
  ElasticBody(const MeshData<S>& mesh, const Params& params) {
    build(mesh_cast<double>(mesh), params);
  }

  /// As it was given: what is drawn, vertex by vertex.
  [[nodiscard]] const TriangleMesh<double>& mesh() const noexcept { return parts_->mesh; }
  [[nodiscard]] const std::shared_ptr<const MeshSurface<double>>& surface() const noexcept {
    return parts_->surface;
  }
  [[nodiscard]] const std::shared_ptr<const ResponseField>& field() const noexcept { return parts_->field; }
  [[nodiscard]] unsigned threads() const noexcept { return parts_->threads; }
  /// Was the field read from the cache?
  [[nodiscard]] bool from_cache() const noexcept { return parts_->from_cache; }

 private:
  struct Parts {
    TriangleMesh<double> mesh;
    std::shared_ptr<const MeshSurface<double>> surface;
    std::shared_ptr<const ResponseField> field;
    unsigned threads = 1;
    bool from_cache = false;
  };
  void build(MeshData<double> mesh, const Params& params);

  std::shared_ptr<const Parts> parts_;
};

}  // namespace palpate

#ifndef PALPATE_COMPILED
#include <palpate/touch/setup/elastic_body_impl.hpp>
#endif
