// SPDX-License-Identifier: MIT

#include "play.hpp"

#include <palpate/calibrate/response_map.hpp>

#include <cmath>
#include <fstream>
#include <numbers>

namespace touch {

namespace {

constexpr std::size_t most_frames = 36;

/// One line per region and tick in contact. Without a shape w is 1.
void write_contacts(const std::string& file, const Device& device, const Shape* shape) {
  std::ofstream csv(file);
  csv << "t_s,region,tool_x_m,F_x_N,F_y_N,F_z_N,force_N,D_m,area_m2,w,modified_D_m\n";
  for (std::size_t i = 0; i < device.recorded(); ++i) {
    const auto& r = device.recording()[i];
    for (std::size_t j = 0; j < r.result.contacts.size(); ++j) {
      const palpate::ContactState<S>& c = r.result.contacts[j];
      const S w = shape != nullptr ? shape->factor(c) : 1, D = c.displacement.norm();
      csv << r.t << ',' << c.id << ',' << r.result.pose.to_tool(c.centre).x() << ',' << c.force.x() << ','
          << c.force.y() << ',' << c.force.z() << ',' << c.force.norm() << ',' << D << ',' << c.area << ','
          << w << ',' << w * D << '\n';
    }
  }
  std::printf("wrote          %s\n", file.c_str());
}

/// The largest change of the force from one tick to the next, and that at the ticks in which a region
/// appears.
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

}  // namespace

palpate::DuffingMap<S> field_force(const palpate::ResponseField& field, const AnyBody& body, const Tool& tool,
                                   const V& top) {
  const S radius = std::sqrt(tool.contact_area / std::numbers::pi_v<S>);
  auto fitted =
      palpate::response_map(field, body,
                            palpate::ResponseMapParams<S>{
                                .radius = radius, .depth = 2 * radius, .spacing = field.mesh().length / 2});
  const auto law = fitted.map.at(top).params();
  std::printf("force          of the field: c1 %.0f N/m, c3 %.2g N/m^3 on top, fits within %.1f %%\n", law.c1,
              law.c3, 100 * fitted.worst_rms);
  return std::move(fitted.map);
}

void prepare_folder(const std::string& out) {
  std::filesystem::create_directories(out);
  std::filesystem::remove_all(out + "/frames");  // those of an earlier run
}

int play(const Stage& stage, Feel& feel, const std::function<void()>& report) {
  const Options& options = stage.options;
  std::optional<Shape>& shape = stage.shape;
  // Frames from first contact on, at even distances of the updates.
  constexpr double begin = 1.0;
  const auto stride =
      static_cast<std::size_t>(std::ceil((stage.script.seconds - begin) * update_rate / most_frames));
  std::size_t updates = 0;
  std::vector<Frame> frames;
  const auto update = [&](const Device::Record& record) {
    if (!shape) return;
    shape->update(record.result);
    if (record.t >= begin && updates++ % stride == 0) frames.push_back(shape->frame(record.t, record.result));
  };
  const auto finish = [&](const Device& device) {
    if (report) report();
    print_steps(device);
    write_contacts(options.out + "/contacts.csv", device, shape ? &*shape : nullptr);
    if (!shape) return;
    std::printf("shape          %s, %zu vertices, %zu updates that moved something, %.0f us each\n",
                options.shape.c_str(), shape->rest().vertices.size(), shape->updates(),
                1e6 * shape->mean_time());
    write_series(options.out, "shape", shape->rest(), frames);
    Pictures(options.out + "/frames", stage.view, shape->rest(), stage.tool).write(stage.title, frames);
    std::printf("wrote          %s/shape.pvd, %zu frames\n", options.out.c_str(), frames.size());
  };
  return perform(options, feel, stage.tool, stage.script, stage.top, stage.title, update, finish);
}

}  // namespace touch
