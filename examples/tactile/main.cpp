// SPDX-License-Identifier: MIT

/// @file What a resolved contact knows (docs/resolved.md): a rigid fingertip is pressed on a block of rubber,
/// tilted, and dragged until it slides. Every tick the pressures at its points become an image, as a tactile
/// sensor on the finger has it. Writes pressure.csv, the points, and tactile.csv, the images, at six moments.

#include <palpate/device/servo_statistics.hpp>
#include <palpate/geometry/box.hpp>
#include <palpate/geometry/superellipsoid.hpp>
#include <palpate/law/friction/coulomb.hpp>
#include <palpate/resolved/contact_samples.hpp>
#include <palpate/resolved/response_compliance.hpp>
#include <palpate/solver/contact_solver.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

namespace {

using namespace palpate;
using Clock = std::chrono::steady_clock;
using V = Vec3<double>;

constexpr double top = 0.02, finger_height = 5e-3;  // half of the block's height, of the finger's [m]

/// 32 x 32 taxels across the finger's x and z; each reads the normal force on it over its area. The grid and
/// how far a force spreads are the sensor's, not the contact's.
class TactileImage {
 public:
  static constexpr std::size_t size = 32;
  static constexpr double pitch = 0.7e-3;  // [m]

  [[nodiscard]] static constexpr double position(std::size_t i) noexcept {
    return (static_cast<double>(i) - (size - 1) / 2.0) * pitch;
  }
  [[nodiscard]] double pressure(std::size_t i, std::size_t k) const noexcept {
    return force_[k][i] / (pitch * pitch);
  }
  [[nodiscard]] double total() const noexcept {  // [N]
    double sum = 0;
    for (const auto& row : force_)
      for (const double f : row) sum += f;
    return sum;
  }

  void clear() noexcept { force_ = {}; }
  /// A normal force [N] at (x, z), shared out with weights that fall linearly to 0 at `width` [m] from there.
  /// Along x and along z they add up to 1, so no force is lost; beyond the grid it goes to the rim.
  void add(double force, double x, double z, double width) noexcept {
    const Weights along_x(x, width), along_z(z, width);
    for (std::size_t k = along_z.begin; k < along_z.end; ++k)
      for (std::size_t i = along_x.begin; i < along_x.end; ++i)
        force_[k][i] += force * along_z.value[k] * along_x.value[i];
  }

 private:
  struct Weights {
    std::size_t begin, end;
    std::array<double, size> value{};

    Weights(double at, double width) noexcept {
      at = std::clamp(at, position(0), position(size - 1));
      width = std::max(width, pitch);  // one taxel at least
      begin = static_cast<std::size_t>(std::max(0.0, (at - width - position(0)) / pitch));
      end = std::min(size, static_cast<std::size_t>((at + width - position(0)) / pitch) + 1);
      double sum = 0;
      for (std::size_t i = begin; i < end; ++i)
        sum += value[i] = std::max(0.0, 1 - std::abs(position(i) - at) / width);
      for (std::size_t i = begin; i < end; ++i) value[i] /= sum;
    }
  };
  std::array<std::array<double, size>, size> force_{};
};

/// A tick, to be written.
struct Moment {
  double t;  // [s]
  std::vector<PointContact<double>> points;
  TactileImage image;
};

/// In each file moments are two empty lines apart.
void write(const std::string& folder, const std::vector<Moment>& moments) {
  std::ofstream points(folder + "/pressure.csv"), taxels(folder + "/tactile.csv");
  points << "t_s,x_m,z_m,pressure_Pa,F_x_N,F_y_N,F_z_N,sticks\n";
  taxels << "t_s,x_m,z_m,pressure_Pa\n";
  for (const Moment& m : moments) {
    for (const PointContact<double>& c : m.points)
      points << m.t << ',' << c.position.x() << ',' << c.position.z() << ',' << c.pressure << ','
             << c.force.x() << ',' << c.force.y() << ',' << c.force.z() << ',' << c.sticks << '\n';
    for (std::size_t k = 0; k < TactileImage::size; ++k)
      for (std::size_t i = 0; i < TactileImage::size; ++i)
        taxels << m.t << ',' << TactileImage::position(i) << ',' << TactileImage::position(k) << ','
               << m.image.pressure(i, k) << '\n';
    points << "\n\n";
    taxels << "\n\n";
  }
  if (!points.flush() || !taxels.flush()) fail("cannot write into", folder.c_str());
  std::printf("wrote          %s/pressure.csv, tactile.csv\n", folder.c_str());
}

/// The finger at t [s]: down until 0.2, tilted until 0.3, dragged along x until 0.6.
Pose<double> pose_at(double t) {
  const auto part = [t](double begin, double end) {
    return std::clamp((t - begin) / (end - begin), 0.0, 1.0);
  };
  Pose<double> pose;
  pose.rotation = Eigen::AngleAxisd(0.05 * part(0.2, 0.3), V::UnitZ()).toRotationMatrix();
  pose.translation = V(4e-3 * part(0.3, 0.6), top + finger_height - 1.2e-3 * part(0, 0.2), 0);
  return pose;
}

int run(const std::string& folder) {
  const Box<double> block({.half = V(0.04, top, 0.04)});
  const auto field = std::make_shared<const ResponseField>(
      block.mesh(1000), [](const V& x) { return x.y() <= -top + 1e-6; },
      ResponseField::Params{.E = 60e3, .nu = 0.49, .mesh = {.vertices = 150}});
  const Superellipsoid<double> finger({.axes = V(8e-3, finger_height, 10e-3)});  // flat below, rim rounded
  const ToolPoints<double> tool(contact_samples(TriangleMesh<double>(finger.mesh(2000)), 1.8e-3),
                                {.contact_area = 1e-4});
  using Elastic = ElasticContact<double, ResponseCompliance>;
  ContactSolver<Box<double>, Elastic, CoulombFriction<double>, ContactPoints<256>> solver(
      {.object = block,
       .tool = tool,
       .force = Elastic({.compliance = ResponseCompliance(field)}),
       .friction = CoulombFriction<double>({.mu_static = 0.5, .mu_dynamic = 0.5})});

  TactileImage image;
  TimeHistogram tick_time, image_time;
  std::vector<Moment> moments;
  constexpr int ticks = 600;
  int complete = 0;
  for (int i = 1; i <= ticks; ++i) {
    const Pose<double> pose = pose_at(1e-3 * i);
    const auto start = Clock::now();
    const TickResult<double> felt = solver.tick(pose, 1e-3);
    const auto ticked = Clock::now();
    image.clear();
    for (const PointContact<double>& c : solver.state().points()) {
      const V at = tool.point(c.point);
      const double area = tool.area(c.point);
      image.add(c.pressure * area, at.x(), at.z(), std::sqrt(area));
    }
    const auto imaged = Clock::now();
    tick_time.add(std::chrono::nanoseconds(ticked - start).count());
    image_time.add(std::chrono::nanoseconds(imaged - ticked).count());

    const double force = felt.wrench.force.y();                   // the block's normal is y
    complete += std::abs(image.total() - force) <= 1e-6 * force;  // loads are float
    const auto points = solver.state().points();
    for (const int wanted : {50, 200, 250, 300, 340, 600})
      if (i == wanted) moments.push_back({1e-3 * i, {points.begin(), points.end()}, image});
  }

  std::printf("time [us]            p50      max\n");
  const auto row = [](const char* what, const TimeHistogram& time) {
    std::printf("%-14s %9.1f %8.1f\n", what, 1e-3 * static_cast<double>(time.quantile(0.5)),
                1e-3 * static_cast<double>(time.max()));
  };
  row("force tick", tick_time);
  row("tactile image", image_time);
  write(folder, moments);
  std::printf("image's total  is the normal force in %d of %d ticks\n", complete, ticks);
  return complete == ticks ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc > 1 ? argv[1] : ".");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "palpate_tactile: %s\n", error.what());
    return 1;
  }
}
