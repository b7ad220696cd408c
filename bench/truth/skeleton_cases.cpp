// SPDX-License-Identifier: MIT

/// @file Runs one reference case through the beam skeleton and writes the displacements that judge_case
/// reads, beside the case's own force.csv.
///
///     skeleton_cases CASE_DIR displacement.csv linear|phong
///
/// CASE_DIR holds meta.json, surface.obj(.gz) and force.csv; its body is an ellipsoid or a box, its contacts
/// are patches. Each contact has the reference's force and depth: what is judged is the shape alone, and
/// nothing is tuned. The paper's model: beams of constant volume to the curvature extremal points, the lowest
/// point of the body fixed, no local neighbourhood (the depth is given).

#include "truth/case.hpp"

#include <palpate/geometry/box.hpp>
#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/luo_xiao/beam_skeleton.hpp>
#include <palpate/luo_xiao/interpolation/linear.hpp>
#include <palpate/luo_xiao/interpolation/phong.hpp>

#include <cmath>
#include <map>

namespace {

using namespace bench;
using namespace palpate;

struct Case {
  std::string meta;
  MeshData<double> mesh;  // in the body's coordinates: its centre is the origin
  std::vector<Patch> patches;
  std::map<double, std::vector<V>> force;  // by depth [m]: on the object, patch by patch [N]
};

std::map<double, std::vector<V>> read_force(const std::string& path) {
  std::map<double, std::vector<V>> force;
  for (const auto& row : csv_rows(path))  // depth_m,patch,Fx,Fy,Fz,...: patches in order
    force[row.at(0)].push_back(V(row.at(2), row.at(3), row.at(4)));
  return force;
}

template <template <class> class I, class Body>
int run(const Body& body, const Case& test, const char* output) {
  const auto& mesh = test.mesh;
  std::vector<V> ends;
  for (const auto& point : extremal_points(body)) ends.push_back(point.position);
  using Beams = RegionSkeletons<Skeleton<double>>;
  const IsotropicElasticity<double> material(
      {.E = numbers(test.meta, "E_Pa").at(0), .nu = numbers(test.meta, "nu").at(0)});
  BeamSkeletonDeformation<Beams, I<double>, NoNeighbourhood<double>> model(
      Beams(Skeleton<double>(ends, EulerBernoulli<double>(material),
                             VolumePreserving<double>({.volume = body.volume()}))),
      I<double>(make_partition(body, mesh)), NoNeighbourhood<double>{}, mesh,
      {.fixed = V(0, body.lower().y(), 0), .normals = false});
  std::vector<double> x(3 * mesh.vertices.size());
  const VertexBuffer<double> buffer{.positions = x.data()};
  model.write_rest(buffer);
  std::FILE* const file = std::fopen(output, "w");
  if (file == nullptr) return 1;
  std::fprintf(file, "depth_m,vertex,ux,uy,uz\n");
  for (const auto& [depth, force] : test.force) {
    std::vector<ContactState<double>> contacts(test.patches.size());
    for (std::size_t c = 0; c < contacts.size(); ++c) {
      const Patch& patch = test.patches[c];
      contacts[c].points = 1;
      contacts[c].area = std::acos(-1.0) * patch.radius * patch.radius;
      contacts[c].normal = patch.normal;
      contacts[c].displacement = depth * patch.factor * patch.direction;
      contacts[c].centre = patch.position + contacts[c].displacement;
      contacts[c].force = -force.at(c);  // on the tool
      contacts[c].normal_force = -force.at(c).dot(patch.normal);
    }
    model.write(contacts, buffer);
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
      std::fprintf(file, "%.9g,%zu,%.9g,%.9g,%.9g\n", depth, v, x[3 * v] - mesh.vertices[v].x(),
                   x[3 * v + 1] - mesh.vertices[v].y(), x[3 * v + 2] - mesh.vertices[v].z());
  }
  return std::fclose(file);
}

template <template <class> class I>
int run(Case test, const char* output) {
  const auto axes = numbers(test.meta, "semi_axes_m");
  if (!axes.empty()) return run<I>(Ellipsoid<double>({.axes = vector(axes)}), test, output);
  V low, high;
  const char* const keys[3] = {"x_range_m", "y_range_m", "z_range_m"};
  for (int k = 0; k < 3; ++k) {
    const auto range = numbers(test.meta, keys[k]);
    low[k] = range.at(0), high[k] = range.at(1);
  }
  const V centre = (low + high) / 2;
  for (V& vertex : test.mesh.vertices) vertex -= centre;
  for (Patch& patch : test.patches) patch.position -= centre;
  return run<I>(Box<double>({.half = (high - low) / 2}), test, output);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string field = argc > 3 ? argv[3] : "";
  if (field != "linear" && field != "phong") {
    std::fprintf(stderr, "usage: skeleton_cases CASE_DIR displacement.csv linear|phong\n");
    return 1;
  }
  const std::string folder = std::string(argv[1]) + "/";
  Case test{read_text(folder + "meta.json"),
            read_obj(read_text(folder + "surface.obj")),
            {},
            read_force(folder + "force.csv")};
  test.patches = read_patches(test.meta);
  if (test.patches.empty() || test.mesh.vertices.empty()) {
    std::fprintf(stderr, "skeleton_cases: %s has no patches or no surface\n", argv[1]);
    return 1;
  }
  return field == "linear" ? run<LinearInterpolation>(test, argv[2]) : run<PhongInterpolation>(test, argv[2]);
}
