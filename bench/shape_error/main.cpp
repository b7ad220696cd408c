// SPDX-License-Identifier: MIT

/// @file Where on the surface a deformed shape is wrong: the library's closed-form and solved fields against
/// nonlinear finite elements (truth/data), a bonded patch pressed 4 mm deep. shape_error.csv: relative L2
/// error; shape_error.tsv beside it, for the plot: per vertex its position, the reference's displacement and
/// the model's [mm]. bodies.tsv: bodies that have no reference.

#include "scenes.hpp"
#include "shape_error/bodies.hpp"
#include "work_precision_shape/body.hpp"

#include <palpate/elasticity/half_space.hpp>
#include <palpate/response/response_contact.hpp>
#include <palpate/response/response_display.hpp>

namespace {

using namespace bench;
constexpr std::size_t depth_index = 2;

std::vector<V> half_space(const Truth& t) {
  const MeshData<double> mesh{t.rest, t.triangles};
  HalfSpaceDeformation<double> model(
      mesh, [&](const V& p) { return p.y() <= t.fixed_height(); },
      HalfSpaceDeformation<double>::Params{.nu = t.nu, .smallest_radius = t.patch, .normals = false});
  std::vector<V> now(t.rest.size());
  const VertexBuffer<double> buffer{.positions = now.front().data(), .position_stride = sizeof(V)};
  model.write_rest(buffer);
  const ContactState<double> contact = pressed(t, t.depth[depth_index], t.force[depth_index]);
  (void)model.write(std::span(&contact, 1), buffer);
  for (std::size_t v = 0; v < now.size(); ++v) now[v] -= t.rest[v];
  return now;
}

std::vector<V> response(const Truth& t) {
  const ResponseField field(MeshData<double>{t.rest, t.triangles},
                            [&](const V& p) { return p.y() <= t.fixed_height(); },
                            {.E = t.E, .nu = t.nu, .mesh = {.vertices = 600}, .threads = 2});
  ResponseTick<1> tick(field);
  const ResponseContact<double> contact{.position = t.top,
                                        .normal = V::UnitY(),
                                        .radius = t.patch,
                                        .displacement = -t.depth[depth_index] * V::UnitY()};
  V force;
  (void)tick.solve(&contact, 1, &force);
  std::vector<V> u(t.rest.size());
  tick.displace(ResponseDisplay(field, t.rest), u.front().data(), 3);
  return u;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) {
    std::fprintf(stderr, "usage: %s OUTPUT.csv FOLDER_OF_TRUTH OUTPUT.tsv BODIES.tsv\n", argv[0]);
    return 2;
  }
  const Output out(2, argv, "case,model,depth_mm,error_l2");
  std::FILE* fields = std::fopen(argv[3], "w");
  std::FILE* bodies = std::fopen(argv[4], "w");
  if (fields == nullptr || bodies == nullptr) return 2;
  for (const char* name : {"ellipsoid", "cube"}) {
    const Truth t = read_truth(argv[2], name);
    const std::array<std::vector<V>, 2> models{half_space(t), response(t)};
    for (std::size_t m = 0; m < 2; ++m) {
      const double error = judge(t, depth_index, models[m]).l2;
      char text[128];
      std::snprintf(text, sizeof text, "%s,%s,%g,%.4f", name, m == 0 ? "HalfSpace" : "ResponseField 600",
                    1e3 * t.depth[depth_index], error);
      out.row(text, "error_l2", error);
    }
    for (std::size_t v = 0; v < t.rest.size(); ++v) {
      for (const V& x : {t.rest[v], t.displacement[depth_index][v], models[0][v], models[1][v]})
        std::fprintf(fields, "%.4f\t%.4f\t%.4f\t", 1e3 * x.x(), 1e3 * x.y(), 1e3 * x.z());
      std::fputc('\n', fields);
    }
    std::fputs("\n\n", fields);
  }
  draw_bodies(bodies);
  return std::fclose(fields) == 0 && std::fclose(bodies) == 0 ? 0 : 2;
}
