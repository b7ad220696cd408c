// SPDX-License-Identifier: MIT
// Which points of a leaf press, how deep and which way: registers against the formula for one point.
#include <palpate/resolved/detail/tool_surface.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <random>

using namespace palpate;

namespace {

/// 20 points, so that the second leaf is filled up; normals in all directions, one not known.
template <class S>
SurfaceSamples<S> samples(std::mt19937& random, bool with_normals) {
  std::uniform_real_distribution<S> any(-1, 1);
  SurfaceSamples<S> out;
  for (int i = 0; i < 20; ++i) {
    out.points.push_back(S(0.01) * Vec3<S>(any(random), any(random), any(random)));
    out.areas.push_back(S(1e-6) * (2 + any(random)));
    if (with_normals)
      out.vector_areas.push_back(i == 3 ? Vec3<S>(Vec3<S>::Zero())
                                        : Vec3<S>(out.areas.back() * Vec3<S>(any(random), 1, any(random))));
  }
  return out;
}

}  // namespace

TEST_CASE_TEMPLATE("points of a leaf press by their depth, less where the tool's wall is upright", S, float,
                   double) {
  std::mt19937 random(5);
  std::uniform_real_distribution<S> any(-1, 1);
  for (const bool with_normals : {true, false}) {
    const ToolPoints<S> tool(samples<S>(random, with_normals), {.contact_area = S(1e-4)});
    const detail::ToolSurface<S> surface(tool);
    const Mat3<S> R = Eigen::AngleAxis<S>(S(0.3), Vec3<S>(1, 2, 3).normalized()).toRotationMatrix();
    const Vec3<S> origin(S(0.1), S(-0.2), S(0.3));
    int pressing = 0, fading = 0, away = 0;
    for (const std::size_t begin : {std::size_t(0), batch_size}) {
      PointBatch<S> x;
      PenetrationBatch<S> in;
      for (std::size_t k = 0; k < batch_size; ++k) {
        x.x[k] = origin.x() + S(0.01) * any(random), x.y[k] = origin.y() + S(0.01) * any(random),
        x.z[k] = origin.z() + S(0.01) * any(random);
        in.depth[k] = begin + k < tool.size() ? S(1e-3) * (any(random) + S(0.5)) : S(0);
        in.gradient_x[k] = any(random), in.gradient_y[k] = any(random), in.gradient_z[k] = any(random);
      }
      in.gradient_x[1] = in.gradient_y[1] = in.gradient_z[1] = 0;  // beneath the middle of a body
      in.gradient_y[2] = std::numeric_limits<S>::quiet_NaN();
      in.depth[1] = in.depth[2] = S(1e-3);
      const detail::TouchingLeaf leaf = surface.find(begin, R.template cast<float>(), x, in, origin);
      double deepest = 0, volume = 0;
      Vec3<double> volume_x = Vec3<double>::Zero(), volume_m = volume_x;
      for (std::size_t k = 0; k < batch_size; ++k) {
        CAPTURE(k);
        const Vec3<double> gradient(in.gradient_x[k], in.gradient_y[k], in.gradient_z[k]);
        double depth = (std::max)(double(in.depth[k]), 0.);
        if (!(gradient.norm() > 0)) depth = 0;
        const Vec3<double> m = -gradient.normalized();
        Vec3<double> outward = m;
        if (depth > 0 && with_normals) {
          const Vec3<S>& a = tool.vector_areas()[begin + k];
          outward = a.norm() > 0 ? Vec3<double>((R * a).template cast<double>().normalized())
                                 : Vec3<double>(Vec3<double>::Zero());
          const double facing = outward.dot(m) - 1e-4;  // out before it is upright, whole from 0.2 on
          facing <= 0 ? ++away : facing < 0.2 ? ++fading : 0;
          depth *= std::clamp(facing / 0.2, 0., 1.);
        }
        // Depths up to 1.5 mm in float: 1e-10 m. Where a wall fades, by five times what its cosine is off, a
        // product of two rotated unit vectors: some ten roundings, 1.5e-3 m * 5 * 6e-7 = 5e-9 m. Twice that.
        CHECK(std::abs(leaf.depth[k] - depth) <= 1e-5 * 1e-3);
        if (!(depth > 0)) continue;
        ++pressing;
        const detail::TouchingPoint at = leaf.point(k, 7, 3, 0.f);
        CHECK(at.group == 3);
        CHECK(at.point == 7);
        CHECK(at.depth == leaf.depth[k]);
        const Vec3<double> position(double(x.x[k] - origin.x()), double(x.y[k] - origin.y()),
                                    double(x.z[k] - origin.z()));
        // Unit vectors, one of them rotated: some ten roundings of 6e-8 each. Positions within 17 mm: 1e-9 m
        // each, and the origin is taken off in S on both sides.
        CHECK((at.m.template cast<double>() - m).norm() < 1e-6);
        CHECK((at.outward.template cast<double>() - outward).norm() < 1e-6);
        CHECK((at.x.template cast<double>() - position).norm() < 1e-8);
        const double weight = depth * double(tool.area(begin + k));
        deepest = (std::max)(deepest, depth), volume += weight;
        volume_x += weight * position, volume_m += weight * m;
      }
      // As of a depth above, which is 1e-5 of a millimetre; sums of 16 round by 1e-6 more. x: up to 17 mm.
      CHECK(std::abs(leaf.deepest - deepest) <= 1e-5 * 1e-3);
      CHECK(std::abs(leaf.volume - volume) <= 1e-5 * volume);
      CHECK((leaf.volume_x.template cast<double>() - volume_x).norm() <= 1e-5 * 0.02 * volume);
      CHECK((leaf.volume_m.template cast<double>() - volume_m).norm() <= 1e-5 * volume);
    }
    CHECK(pressing >= 5);
    if (with_normals) {
      CHECK(fading > 0);
      CHECK(away > 0);
    }
  }
}
