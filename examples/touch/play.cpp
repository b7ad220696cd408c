// SPDX-License-Identifier: MIT

#include "play.hpp"

#include <palpate/device/recorder.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "scenes.hpp"
#include "scripts.hpp"
#include "session.hpp"

namespace touch {

namespace {

constexpr std::size_t most_frames = 36;

/// One line per region and tick in contact. Other shapes than the paper's have no w: 1.
void write_contacts(const std::string& file, const Device& device, bool skeleton) {
  std::ofstream csv(file);
  csv << "t_s,region,tool_x_m,F_x_N,F_y_N,F_z_N,force_N,D_m,area_m2,w,modified_D_m\n";
  for (std::size_t i = 0; i < device.recorded(); ++i) {
    const auto& r = device.recording()[i];
    for (std::size_t j = 0; j < r.result.contacts.size(); ++j) {
      const palpate::ContactState<S>& c = r.result.contacts[j];
      const S w = skeleton ? local_factor(c) : 1, D = c.displacement.norm();
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

/// The shape beside the servo loop: newest contacts into the vertices, and some of them kept as frames.
class Pictured {
 public:
  Pictured(Feel& feel, const Body& body, double seconds) : feel_(feel), drawing_(body.display) {
    feel.draw_rest(drawing_.buffer());
    stride_ = static_cast<std::size_t>(std::ceil((seconds - begin) * update_rate / most_frames));
  }

  void update(const Device::Record& record) {
    const Felt& felt = record.result;
    const auto start = std::chrono::steady_clock::now();
    const auto moved = feel_.draw({felt.contacts.begin(), felt.contacts.size()}, drawing_.buffer());
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
    if (moved.vertices > 0) seconds_ += spent.count(), ++updates_;
    // From first contact on, at even distances of the updates.
    if (record.t >= begin && seen_++ % stride_ == 0)
      frames_.push_back({record.t, felt, drawing_.positions(), drawing_.normals()});
  }
  [[nodiscard]] const std::vector<Frame>& frames() const noexcept { return frames_; }
  void report(const std::string& shape) const {
    const double mean = updates_ > 0 ? seconds_ / static_cast<double>(updates_) : 0;
    std::printf(
        "shape          %s, %zu vertices, %zu updates that moved something, %.0f us each: %.0f a second\n",
        shape.c_str(), drawing_.positions().size(), updates_, 1e6 * mean, mean > 0 ? 1 / mean : 0);
  }

 private:
  static constexpr double begin = 1.0;  // [s]

  Feel& feel_;
  Drawing drawing_;
  std::vector<Frame> frames_;
  std::size_t stride_ = 1, seen_ = 0, updates_ = 0;
  double seconds_ = 0;
};

/// The recorded ticks once more.
int play_again(const std::string& file, Feel& feel) {
  const palpate::LoadedTicks loaded = palpate::load_ticks(file);
  const palpate::Replayed again = palpate::replay(feel, loaded.ticks);
  std::printf("%zu ticks of %s, %zu skipped before the first without contact: ", again.ticks, file.c_str(),
              again.skipped);
  if (again.same) {
    std::printf("all wrenches have the same bits\n");
    return 0;
  }
  const palpate::TickRecord& was = again.recorded;
  std::printf("tick %llu differs\n", static_cast<unsigned long long>(was.tick));
  const auto print = [](const char* when, const palpate::Wrench<S>& w, palpate::Status status) {
    std::printf("%-9s F %.17g %.17g %.17g N, torque %.17g %.17g %.17g N m, status 0x%x\n", when, w.force.x(),
                w.force.y(), w.force.z(), w.torque.x(), w.torque.y(), w.torque.z(),
                static_cast<unsigned>(status));
  };
  print("recorded", was.wrench, was.status);
  print("now", again.wrench, again.status);
  return 1;
}

}  // namespace

int play(Options options) {
  if (!options.scene.empty()) {
    preset(options);
    options.out += "/" + options.scene;
    options.stepped = !options.real_time;
  }
  if (options.replay.empty()) {
    std::filesystem::create_directories(options.out);
    std::filesystem::remove_all(options.out + "/frames");  // those of an earlier run
  }
  const Body body = make_body(options);
  if (options.shape.empty())
    options.shape = options.paper ? "skeleton" : body.is_file ? "half-space" : "response";
  const Tool tool = make_tool(options);
  const Script script = make_script(options, body, tool);
  Answer answer = make_answer(options, body, tool);
  const bool drawn = answer.shape.exists();
  const std::unique_ptr<Feel> feel = make_feel(options, body, tool, std::move(answer));
  if (!options.replay.empty()) return play_again(options.replay, *feel);

  const std::string title = title_of(options, body);
  Pictured picture(*feel, body, script.seconds);
  const auto update = [&](const Device::Record& record) {
    if (drawn) picture.update(record);
  };
  const auto finish = [&](const Device& device) {
    if (options.deformed)
      std::printf("detection      on the deformed shape, bulges up to %.3f mm\n",
                  1e3 * feel->highest_bulge());
    print_steps(device);
    write_contacts(options.out + "/contacts.csv", device, options.shape == "skeleton");
    if (!drawn) return;
    picture.report(options.shape);
    write_series(options.out, "shape", body.display, picture.frames());
    Pictures(options.out + "/frames", scene_view(options, body), body.display, tool)
        .write(title, picture.frames());
    std::printf("wrote          %s/shape.pvd, %zu frames\n", options.out.c_str(), picture.frames().size());
  };
  return perform(options, *feel, tool, script, body.top(), title, update, finish);
}

}  // namespace touch
