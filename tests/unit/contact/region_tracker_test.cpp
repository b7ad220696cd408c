// SPDX-License-Identifier: MIT
#include <palpate/contact/detail/region_tracker.hpp>

#include <doctest/doctest.h>

#include <random>
#include <set>
#include <vector>

using namespace palpate;

namespace {

/// Points 1 mm apart on a line; the tracker joins direct neighbours only. Points go by their position on the
/// line, which the tool's own order may not follow.
struct Line {
  explicit Line(int n)
      : tool(positions(n), std::vector<double>(std::size_t(n), 1e-6), {.contact_area = 1e-4}),
        graph(tool, 1.5e-3),
        tracker(tool.size()),
        index(tool.size()) {
    for (std::uint32_t i = 0; i < tool.size(); ++i) index[tool.original(i)] = i;
  }

  static std::vector<Vec3<double>> positions(int n) {
    std::vector<Vec3<double>> p;
    for (int i = 0; i < n; ++i) p.emplace_back(1e-3 * i, 0, 0);
    return p;
  }

  Status touch(const std::vector<std::uint32_t>& now) {
    touching = now;
    std::vector<std::uint32_t> indices;
    for (const std::uint32_t position : now) indices.push_back(index[position]);
    return tracker.update(graph, indices, [&](std::size_t i) { return tool.point(indices[i]); });
  }
  [[nodiscard]] const RegionSlot& slot_at(std::uint32_t point) const {
    for (std::size_t i = 0; i < touching.size(); ++i)
      if (touching[i] == point) return tracker.slots()[tracker.slot_of()[i]];
    FAIL("point ", point, " does not touch");
    return tracker.slots()[0];
  }
  [[nodiscard]] int regions() const {
    int n = 0;
    for (const RegionSlot& s : tracker.slots()) n += s.active;
    return n;
  }

  ToolPoints<double> tool;
  ProximityGraph<double> graph;
  RegionTracker<double, 4> tracker;
  std::vector<std::uint32_t> index;  // of the point at a position
  std::vector<std::uint32_t> touching;
};

}  // namespace

TEST_CASE("phases: nothing, first contact, contact before and now, nothing") {
  Line line(20);
  CHECK(line.touch({}) == Status::ok);
  CHECK(line.regions() == 0);
  line.touch({3, 4, 5});
  CHECK(line.regions() == 1);
  CHECK(line.slot_at(3).merged == 0);  // new
  const auto id = line.slot_at(3).id;
  line.touch({3, 4, 5});
  CHECK_FALSE(line.tracker.changed());
  CHECK(line.slot_at(4).id == id);
  CHECK(line.slot_at(4).merged != 0);  // lives on
  line.touch({});
  CHECK(line.regions() == 0);
  line.touch({3});
  CHECK(line.slot_at(3).id != id);  // an id is never used twice
}

TEST_CASE("growing and shrinking keep the identity") {
  Line line(20);
  line.touch({5});
  const auto id = line.slot_at(5).id;
  for (const auto& set :
       std::vector<std::vector<std::uint32_t>>{{4, 5, 6}, {3, 4, 5, 6, 7}, {6, 7}, {7, 8, 9}}) {
    line.touch(set);
    CHECK(line.regions() == 1);
    CHECK(line.slot_at(set[0]).id == id);
  }
}

TEST_CASE("merging: lives on in the region with most points, and says whom it took in") {
  Line line(20);
  line.touch({2, 3, 8, 9, 10});
  REQUIRE(line.regions() == 2);
  const auto large = line.slot_at(9).id;
  line.touch({2, 3, 4, 5, 6, 7, 8, 9, 10});
  CHECK(line.regions() == 1);
  CHECK(line.slot_at(2).id == large);
  CHECK(line.slot_at(2).merged == 0b11);
}

TEST_CASE("splitting: the larger piece lives on, the other names its parent") {
  Line line(20);
  line.touch({2, 3, 4, 5, 6, 7, 8});
  const auto id = line.slot_at(2).id;
  line.touch({2, 3, 5, 6, 7, 8});
  REQUIRE(line.regions() == 2);
  CHECK(line.slot_at(6).id == id);
  CHECK(line.slot_at(2).id != id);
  CHECK(line.slot_at(2).merged == 0);
  CHECK(line.slot_at(2).parent == 0);
  CHECK(line.slot_at(2).inherits(0));
  CHECK(line.slot_at(6).inherits(0));
}

TEST_CASE("ties: pieces of a size, regions of a size: the earlier piece and the lower slot live on") {
  Line line(20);
  line.touch({2, 3, 4, 5, 6});
  auto id = line.slot_at(4).id;
  line.touch({2, 3, 5, 6});  // two each
  CHECK(line.slot_at(2).id == id);
  CHECK(line.slot_at(5).id != id);
  line.touch({2, 3, 4, 5, 6});
  id = line.slot_at(4).id;
  CHECK(line.slot_at(4).merged == 0b11);
  line.touch({5, 6, 2, 3});  // the other way round
  CHECK(line.slot_at(5).id == id);
  CHECK(line.slot_at(2).id != id);

  Line merging(20);
  merging.touch({8, 9, 2, 3});
  const auto lower = merging.slot_at(8).id;  // slot 0: it came first
  merging.touch({2, 3, 4, 5, 6, 7, 8, 9});
  CHECK(merging.slot_at(2).id == lower);

  Line between(20);  // a new piece with one point of either region
  between.touch({2, 3, 4, 5, 7, 8, 9, 10});
  REQUIRE(between.regions() == 2);
  between.touch({2, 3, 5, 6, 7, 9, 10});
  REQUIRE(between.regions() == 3);
  CHECK(between.slot_at(6).merged == 0);
  CHECK(between.slot_at(6).parent == 0);
}

TEST_CASE("a region that two others end in keeps its own slot, and theirs are free") {
  Line line(20);
  line.touch({1, 2, 5, 6, 7, 12, 13, 14, 15});
  REQUIRE(line.regions() == 3);
  const auto large = line.slot_at(12).id;
  line.touch({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15});
  CHECK(line.regions() == 1);
  CHECK(line.slot_at(1).id == large);
  CHECK(line.slot_at(1).merged == 0b111);
  line.touch({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 18});  // a new one has a slot of its own
  CHECK(line.regions() == 2);
  CHECK(line.slot_at(18).id != large);
}

TEST_CASE("a roll that exchanges every point within r is still the same region") {
  Line line(20);
  line.touch({4, 5});
  const auto id = line.slot_at(4).id;
  line.touch({6, 7});
  CHECK(line.slot_at(6).id == id);
  line.touch({12, 13});  // a leap further than r is not
  CHECK(line.slot_at(12).id != id);
}

TEST_CASE("more regions than there is room for: the surplus joins the nearest, and it is said") {
  Line line(20);
  CHECK(line.touch({0, 4, 8, 12}) == Status::ok);
  CHECK(line.regions() == 4);
  CHECK(line.touch({0, 4, 8, 12, 19}) == Status::region_overflow);
  CHECK(line.regions() == 4);
  CHECK(line.slot_at(19).id == line.slot_at(12).id);
  CHECK(line.touch({0, 4, 8, 12, 19}) == Status::region_overflow);  // still so while nothing changes
  CHECK(line.touch({0, 4, 8, 12}) == Status::ok);
  CHECK(line.touch({0, 4, 8, 12, 2}) == Status::region_overflow);  // as far from 0 as from 4: the lower slot
  CHECK(line.slot_at(2).id == line.slot_at(0).id);
}

TEST_CASE("random sets: regions are the connected components, whatever came before") {
  constexpr std::uint64_t seed = 11;
  std::mt19937_64 random(seed);
  INFO("seed ", seed);
  Line line(12);
  for (int trial = 0; trial < 5000; ++trial) {
    std::vector<std::uint32_t> set;
    for (std::uint32_t i = 0; i < 12; ++i)
      if (random() % 2) set.push_back(i);
    const Status status = line.touch(set);
    // On a line, a component is a run of consecutive points.
    int runs = 0;
    for (std::size_t i = 0; i < set.size(); ++i) runs += i == 0 || set[i] != set[i - 1] + 1;
    CHECK(line.regions() == (std::min)(runs, 4));
    CHECK((status == Status::region_overflow) == (runs > 4));
    for (std::size_t i = 1; i < set.size(); ++i) {
      if (set[i] == set[i - 1] + 1) CHECK(line.slot_at(set[i]).id == line.slot_at(set[i - 1]).id);
      if (runs <= 4 && set[i] != set[i - 1] + 1)
        CHECK(line.slot_at(set[i]).id != line.slot_at(set[i - 1]).id);
    }
  }
}
