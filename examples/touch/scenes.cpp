// SPDX-License-Identifier: MIT

#include "scenes.hpp"

#include "heart.hpp"
#include "povray.hpp"
#include "session.hpp"

namespace touch {

namespace {

using namespace palpate;

constexpr std::size_t display_vertices = 5000;
constexpr std::size_t most_frames = 36;

/// Object, tool, script and parameters of one of the paper's figures.
template <class Body, class Coupling>
struct Scene {
  std::string title;
  Body body;
  std::string tool;
  DuffingForce<S> force;
  Coupling coupling;
  View view;
  Script (*script)(const Options&, const Body&, const Tool&);
};

/// Down on one place until the hand's spring holds `press` [m], and up again.
template <class Body>
Script press_at(const Body& body, double x, double press) {
  constexpr double hover = 4e-3;
  const V place = body.raycast(V(x, 1, 0), -V::UnitY()).position;
  return table(5.4, [=](double t) -> V {
    const double down = smooth_step(t, 1.2, 3.0) - smooth_step(t, 3.4, 5.2);
    return place + V(0, hover - (hover + press) * down, 0);
  });
}

/// The compass comes down tilted, with one pin, then turns about that pin until the other stands as deep.
Script with_both_pins(const Heart& heart) {
  Script script = press_at(heart, -18e-3, 6e-3);
  script.seconds = 7.0;
  const auto held = script.target;
  script.target = [held](double t) -> V { return held(t < 3.2 ? t : (std::max)(3.2, t - 1.7)); };
  script.turn = [](double t) -> Mat3<S> {
    const double angle = 0.28 * (1 - smooth_step(t, 3.0, 4.6)), c = std::cos(angle), s = std::sin(angle);
    Mat3<S> turn;
    turn << c, -s, 0, s, c, 0, 0, 0, 1;
    return turn;
  };
  return script;
}

/// One line per region and tick in contact.
template <class Device>
void write_contacts(const std::string& file, const Device& device, const Shape& shape) {
  std::ofstream csv(file);
  csv << "t_s,region,tool_x_m,F_x_N,F_y_N,F_z_N,force_N,D_m,area_m2,w,modified_D_m\n";
  for (std::size_t i = 0; i < device.recorded(); ++i) {
    const auto& r = device.recording()[i];
    for (std::size_t j = 0; j < r.result.contacts.size(); ++j) {
      const ContactState<S>& c = r.result.contacts[j];
      const S w = shape.factor(c), D = c.displacement.norm();
      csv << r.t << ',' << c.id << ',' << r.pose.to_tool(c.centre).x() << ',' << c.force.x() << ',' << c.force.y() << ','
          << c.force.z() << ',' << c.force.norm() << ',' << D << ',' << c.area << ',' << w << ',' << w * D << '\n';
    }
  }
  std::printf("wrote          %s\n", file.c_str());
}

/// The largest change of the force from one tick to the next, and that at the ticks in which a region appears.
template <class Device>
void print_steps(const Device& device) {
  double largest = 0, landing = 0;
  for (std::size_t i = 1; i < device.recorded(); ++i) {
    const Felt& before = device.recording()[i - 1].result;
    const Felt& now = device.recording()[i].result;
    const double step = (now.wrench.force - before.wrench.force).norm();
    largest = (std::max)(largest, step);
    if (now.regions > before.regions) landing = (std::max)(landing, step);
  }
  std::printf("force step     %.4f N in a tick at most; %.4f N where a region appears\n", largest, landing);
}

template <class Body, class Coupling>
int play(Options options, const Scene<Body, Coupling>& scene) {
  options.out += "/" + options.scene;
  options.tool = scene.tool;
  options.stepped = !options.real_time;
  std::filesystem::create_directories(options.out);
  const Tool tool = make_tool(options);
  const Script script = scene.script(options, scene.body, tool);
  Feel<Contact<Body, Coupling>> feel{make_contact(scene.body, tool, scene.force, scene.coupling)};
  Shape shape(scene.body, display_vertices);
  const Pictures pictures(options.out + "/frames", scene.view, shape.rest(), tool);

  // Frames from first contact on, at even distances of the updates.
  constexpr double begin = 1.0;
  const auto stride = static_cast<std::size_t>(std::ceil((script.seconds - begin) * update_rate / most_frames));
  std::size_t updates = 0;
  std::vector<Frame> frames;
  const auto update = [&](const auto& record) {
    shape.update(record.result);
    if (record.t >= begin && updates++ % stride == 0) frames.push_back(shape.frame(record.t, record.pose, record.result));
  };
  return perform(options, feel, tool, script, scene.body.raycast(V(0, 1, 0), -V::UnitY()).position, scene.title, update,
                 [&](const auto& device) {
                   print_steps(device);
                   std::printf("shape          %zu vertices, %zu updates that moved something, %.0f us each\n",
                               shape.rest().vertices.size(), shape.updates(), 1e6 * shape.mean_time());
                   write_contacts(options.out + "/contacts.csv", device, shape);
                   write_series(options.out, options.scene, shape.rest(), frames);
                   pictures.write(scene.title, frames);
                   std::printf("wrote          %s/%s.pvd, %zu frames\n", options.out.c_str(), options.scene.c_str(),
                               frames.size());
                 });
}

Scene<Box<S>, IndependentRegions> cube(const char* title, const char* tool) {
  return {.title = title,
          .body = Box<S>({.half = V(50e-3, 50e-3, 50e-3)}),
          .tool = tool,
          .force = paper_force,
          .coupling = {},
          .view = {.from = V(190, 200, 330), .at = V(12, 14, 0), .angle = 34},
          .script = [](const Options&, const Box<S>& body, const Tool&) { return press_at(body, 0, 6.2e-3); }};
}

}  // namespace

int run_scene(const Options& options) {
  if (options.scene == "ellipsoid") {
    const Ellipsoid<S> body({.axes = V(0.06, 0.04, 0.04)});
    return play(options, Scene<Ellipsoid<S>, IndependentRegions>{
                             .title = "Fig. 10: a mallet moves along an ellipsoid",
                             .body = body,
                             .tool = "mallet",
                             .force = paper_force,
                             .coupling = {},
                             .view = {.from = V(70, 150, 300), .at = V(0, 18, 0)},
                             .script = [](const Options& o, const Ellipsoid<S>& b, const Tool& tool) {
                               return make_script(o, b, tool.mesh);
                             }});
  }
  if (options.scene == "cube-head") return play(options, cube("Fig. 11: a cube under the head of a mallet", "head"));
  if (options.scene == "cube-tail") return play(options, cube("Fig. 11: a cube under the tail of a mallet", "tail"));
  if (options.scene == "heart") {
    const Heart body({});
    return play(options, Scene<Heart, Beams>{
                             .title = "Fig. 12: a compass on a heart, with one pin, then both",
                             .body = body,
                             .tool = "compass",
                             .force = DuffingForce<S>({.c1 = 100, .c3 = 1e7}),  // softer than the paper's
                             .coupling = make_beams(body),
                             .view = {.from = V(60, 120, 250), .at = V(0, 14, 0), .angle = 33, .per_newton = 30},
                             .script = [](const Options&, const Heart& heart, const Tool&) { return with_both_pins(heart); }});
  }
  refuse("unknown scene " + options.scene + " (ellipsoid, cube-head, cube-tail, heart)");
}

}  // namespace touch
