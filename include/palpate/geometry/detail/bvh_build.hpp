// SPDX-License-Identifier: MIT
#pragma once

/// @file A node of a tree of boxes, and how the tree is built: surface area heuristic over bins (set-up
/// only).

#include <palpate/core/simd.hpp>
#include <palpate/core/vector.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace palpate::detail {

template <Real S>
struct BvhBox {
  Vec3<S> low = Vec3<S>::Constant((std::numeric_limits<S>::max)());
  Vec3<S> high = -low;
  void add(const Vec3<S>& l, const Vec3<S>& h) noexcept {
    low = low.cwiseMin(l);
    high = high.cwiseMax(h);
  }
  [[nodiscard]] S half_area() const noexcept {
    const Vec3<S> e = high - low;
    return e.x() * e.y() + e.y() * e.z() + e.z() * e.x();
  }
};

/// Boxes of up to eight children, coordinate by coordinate and in float, relative to the tree's origin.
struct BvhNode {
  static constexpr std::size_t width = 8;
  std::array<std::array<float, width>, 3> low, high;  // [m]
  std::array<std::uint32_t, width> child;             // leaf: triangles; else nodes
  std::uint32_t count;                                // children; boxes past them are never looked at
  std::uint32_t leaf;                                 // 1 or 0

  /// Squared distances from x to all eight boxes.
  void distances(const std::array<float, 3>& x, std::array<float, width>& d2) const noexcept {
    using V = Simd<float, 4>;
    for (std::size_t from = 0; from < width; from += V::size()) {
      V sum{};
      for (std::size_t k = 0; k < 3; ++k) {
        const V here = x[k];
        const V away = (max)((max)(load<V>(&low[k][from]) - here, here - load<V>(&high[k][from])), 0.0f);
        sum += away * away;
      }
      store(&d2[from], sum);
    }
  }
};

/// Splits in two along the longest axis of the centres, where area times count is least over 16 bins
/// [wald2007], until at most eight triangles are left; then pairs are opened, the larger first, until a node
/// has eight children [wald2008]. Children come after their parent; depth is at most 62. Boxes are left
/// empty.
template <Real S>
class BvhBuild {
 public:
  std::vector<BvhNode> nodes;  // the root first

  explicit BvhBuild(std::span<const BvhBox<S>> boxes) {
    std::vector<Item> items;
    items.reserve(boxes.size());
    for (const Box& box : boxes)
      items.push_back({box.low, box.high, static_cast<std::uint32_t>(items.size())});
    pairs_.reserve(items.size());
    pairs_.emplace_back();
    split(items, 0, 0, static_cast<std::uint32_t>(items.size()), 0);
    nodes.emplace_back();
    widen(items, 0, 0);
  }

 private:
  using Box = BvhBox<S>;
  static constexpr int sah_depth = 31;  // below it the median is taken: 31 more levels hold 1e9 items
  static constexpr int bins = 16;

  struct Item {
    Vec3<S> low, high;
    std::uint32_t triangle;
    [[nodiscard]] S centre(int axis) const noexcept { return low[axis] + high[axis]; }  // twice
  };
  struct Pair {
    std::uint32_t begin, end;  // items
    std::uint32_t left = 0;    // 0: not split; the right one follows
  };

  void split(std::vector<Item>& items, std::size_t index, std::uint32_t begin, std::uint32_t end, int depth) {
    Box box, centres;
    for (std::uint32_t i = begin; i < end; ++i) {
      box.add(items[i].low, items[i].high);
      const Vec3<S> c = items[i].low + items[i].high;
      centres.add(c, c);
    }
    pairs_[index] = {begin, end};
    if (end - begin <= BvhNode::width) return;
    int axis = 0;
    (centres.high - centres.low).maxCoeff(&axis);
    const auto from = items.begin() + begin, to = items.begin() + end;
    auto middle = from;
    if (depth < sah_depth) middle = divide(from, to, axis, centres.low[axis], centres.high[axis]);
    if (middle == from || middle == to) {
      middle = from + (end - begin) / 2;
      std::nth_element(from, middle, to, [axis](const Item& l, const Item& r) {
        const S x = l.centre(axis), y = r.centre(axis);
        return x < y || (x == y && l.triangle < r.triangle);
      });
    }
    const auto cut = begin + static_cast<std::uint32_t>(middle - from);
    const std::size_t left = pairs_.size();
    pairs_[index].left = static_cast<std::uint32_t>(left);
    pairs_.emplace_back();
    pairs_.emplace_back();
    split(items, left, begin, cut, depth + 1);
    split(items, left + 1, cut, end, depth + 1);
  }

  void widen(const std::vector<Item>& items, std::size_t index, std::uint32_t pair) {
    std::array<std::uint32_t, BvhNode::width> child{};
    std::uint32_t count = 0;
    const Pair& p = pairs_[pair];
    const bool leaf = p.left == 0;
    if (leaf) {
      for (std::uint32_t i = p.begin; i < p.end; ++i) child[count++] = items[i].triangle;
    } else {
      child = {p.left, p.left + 1};
      count = 2;
      while (count < BvhNode::width) {
        std::uint32_t largest = count, most = 0;
        for (std::uint32_t i = 0; i < count; ++i) {
          const Pair& c = pairs_[child[i]];
          if (c.left != 0 && c.end - c.begin > most) largest = i, most = c.end - c.begin;
        }
        if (largest == count) break;
        const std::uint32_t left = pairs_[child[largest]].left;
        child[largest] = left;
        child[count++] = left + 1;
      }
    }
    nodes[index].count = count;
    nodes[index].leaf = leaf ? 1 : 0;
    const auto first = static_cast<std::uint32_t>(nodes.size());
    if (!leaf) nodes.resize(nodes.size() + count);
    for (std::uint32_t i = 0; i < count; ++i) nodes[index].child[i] = leaf ? child[i] : first + i;
    for (std::uint32_t i = 0; i < count && !leaf; ++i) widen(items, first + i, child[i]);
  }

  // Cut with the least sum of area times count; `from` where all centres fall into one bin.
  template <class Iterator>
  [[nodiscard]] static Iterator divide(Iterator from, Iterator to, int axis, S low, S high) {
    const S scale = S(bins) / (high - low);
    if (!(high > low) || !is_finite(scale)) return from;
    const auto bin = [&](const Item& item) {
      return (std::min)(bins - 1, static_cast<int>((item.centre(axis) - low) * scale));
    };
    std::array<Box, bins> box;
    std::array<std::size_t, bins> count{};
    for (auto i = from; i != to; ++i) {
      const auto b = static_cast<std::size_t>(bin(*i));
      box[b].add(i->low, i->high);
      ++count[b];
    }
    std::array<S, bins> above{};  // cost of the bins from k on
    Box grown;
    std::size_t items = 0;
    for (std::size_t k = bins; k-- > 1;) {
      grown.add(box[k].low, box[k].high);
      items += count[k];
      above[k] = items > 0 ? grown.half_area() * static_cast<S>(items) : S(0);
    }
    grown = Box{};
    items = 0;
    int best = 0;
    S least = (std::numeric_limits<S>::max)();
    for (std::size_t k = 0; k + 1 < bins; ++k) {
      grown.add(box[k].low, box[k].high);
      items += count[k];
      const S cost = (items > 0 ? grown.half_area() * static_cast<S>(items) : S(0)) + above[k + 1];
      if (cost < least && items > 0) {
        least = cost;
        best = static_cast<int>(k);
      }
    }
    return std::partition(from, to, [&](const Item& item) { return bin(item) <= best; });
  }

  std::vector<Pair> pairs_;
};

}  // namespace palpate::detail
