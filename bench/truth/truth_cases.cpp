// SPDX-License-Identifier: MIT

/// @file  Runs one reference case through the response field and writes what judge_case reads.
///
///     truth_cases CASE_DIR displacement.csv force.csv [vertices [linear]]
///
/// CASE_DIR holds meta.json, surface.obj(.gz) and vertices.csv(.gz). Prints set-up time and sizes.

#include "truth/case.hpp"

#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/geometry/mesh_extremal_points.hpp>
#include <palpate/response/response_contact.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

using namespace bench;

namespace {

std::size_t nearest_vertex(const palpate::MeshData<double>& mesh, const V& p) {
  const auto distance = [&p](const V& v) { return (v - p).squaredNorm(); };
  return static_cast<std::size_t>(std::ranges::min_element(mesh.vertices, {}, distance) -
                                  mesh.vertices.begin());
}

/// k1 + k2 [1/m] at a position: an ellipsoid's if there are semi-axes, centred at the origin unless its
/// geometry says otherwise; else the mesh's, averaged over half a ball's radius.
double curvature_at(const V& position, double radius, const palpate::MeshData<double>& mesh,
                    const std::string& meta) {
  if (const auto axes = numbers(meta, "semi_axes_m"); !axes.empty()) {
    const std::size_t geometry = meta.find("\"geometry\"");  // a contact, too, has a centre
    const auto centre = geometry == std::string::npos
                            ? std::vector<double>{}
                            : numbers(meta, "centre_m", geometry, meta.find('}', geometry));
    const palpate::Ellipsoid<double> body(
        {.axes = vector(axes), .centre = centre.empty() ? V(V::Zero()) : vector(centre)});
    const auto k = body.curvature(position);
    return k.k1 + k.k2;
  }
  return 2 * palpate::mean_curvature(palpate::TriangleMesh<double>(mesh),
                                     0.5 * radius)[nearest_vertex(mesh, position)];
}

/// The fixed region: what lies below a plane, if that is what vertices.csv says, else where the nearest
/// vertex is fixed.
palpate::FixedRegion fixed_region(const std::string& folder, const palpate::MeshData<double>& mesh,
                                  const std::string& meta) {
  const auto y_max = numbers(meta, "y_max_m");
  double y_low = 1e30;
  for (const V& v : mesh.vertices) y_low = (std::min)(y_low, v.y());
  const double y_fixed = (y_max.empty() ? y_low : y_max[0]) + 1e-6;
  std::vector<std::uint8_t> fixed;
  bool below = true;
  for (const auto& row : csv_rows(folder + "vertices.csv")) {  // vertex,x,y,z,area_m2,region,r_over_a
    fixed.push_back(row.at(5) == -1);
    below = below && fixed.back() == (row[2] <= y_fixed);
  }
  if (below) return [y_fixed](const V& p) { return p.y() <= y_fixed; };
  return [fixed, &mesh](const V& p) { return fixed.at(nearest_vertex(mesh, p)) != 0; };
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "truth_cases CASE_DIR displacement.csv force.csv [vertices [linear]]\n");
    return 1;
  }
  const std::string folder = std::string(argv[1]) + "/", meta = read_text(folder + "meta.json");
  const palpate::MeshData<double> mesh = read_obj(read_text(folder + "surface.obj"));
  const double E = numbers(meta, "E_Pa").at(0), nu = numbers(meta, "nu").at(0);
  palpate::ResponseField::Params params{.E = E, .nu = nu};
  if (argc > 4) params.mesh.vertices = std::atof(argv[4]);
  const auto t0 = std::chrono::steady_clock::now();
  const palpate::ResponseField field(mesh, fixed_region(folder, mesh, meta), params);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - t0).count();
  std::printf("%s: %zu solve vertices, %zu touchable nodes, %.1f MB, set-up %.2f s\n", argv[1],
              field.mesh().vertices.size(), field.load_mesh().nodes().size(), double(field.memory()) / 1e6,
              seconds);
  palpate::ResponseTick<4> tick(field, {.second_order = argc <= 5});
  const palpate::ResponseDisplay display(field, mesh.vertices);

  FILE* displacement = std::fopen(argv[2], "w");
  FILE* force = std::fopen(argv[3], "w");
  std::fprintf(displacement, "depth_m,vertex,ux,uy,uz\n");
  std::fprintf(force, "depth_m,patch,Fx,Fy,Fz,Tx,Ty,Tz\n");
  std::vector<double> u(3 * mesh.vertices.size());
  const auto write = [&](double depth, const std::vector<V>& F, const std::vector<V>& T) {
    tick.displace(display, u.data(), 3);
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
      std::fprintf(displacement, "%.9g,%zu,%.9g,%.9g,%.9g\n", depth, v, u[3 * v], u[3 * v + 1], u[3 * v + 2]);
    for (std::size_t c = 0; c < F.size(); ++c)
      std::fprintf(force, "%.9g,%zu,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n", depth, c + 1, F[c].x(), F[c].y(),
                   F[c].z(), T[c].x(), T[c].y(), T[c].z());
  };
  const auto depths = numbers(meta, "depths_m");
  const std::size_t ball = meta.find("\"indenter\"");
  if (ball != std::string::npos) {
    const V position = vector(numbers(meta, "first_touch_point_m", ball)),
            normal = -vector(numbers(meta, "inward_normal", ball));
    const double radius = numbers(meta, "radius_m", ball).at(0);
    const double curvature = curvature_at(position, radius, mesh, meta);
    for (double depth : depths) {
      const auto pressed =
          tick.solve(palpate::SphereContact<double>{position, normal, radius, curvature, depth});
      write(depth, {pressed.on_body(normal)}, {V::Zero()});
    }
  } else {
    const std::vector<Patch> patches = read_patches(meta);
    for (double depth : depths) {
      std::vector<palpate::ResponseContact<double>> contacts;
      for (const Patch& p : patches)
        contacts.push_back({.position = p.position,
                            .normal = p.normal,
                            .radius = p.radius,
                            .displacement = depth * p.factor * p.direction,
                            .rotation = depth * p.turn});
      std::vector<V> F(contacts.size()), T(contacts.size());
      tick.solve(contacts.data(), contacts.size(), F.data(), T.data());
      write(depth, F, T);
    }
  }
  std::fclose(displacement);
  std::fclose(force);
  return 0;
}
