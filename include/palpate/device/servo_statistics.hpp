// SPDX-License-Identifier: MIT
#pragma once

/// @file  How regular a servo loop runs: distributions, because a mean hides what the hand feels.

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace palpate {

/// Counts durations [ns] in buckets of constant relative width: exact below 32 ns, 32 buckets per octave
/// above, so that a quantile is too large by at most 1/32 (3.1 %), up to 2^40 ns (18 min; longer counts
/// there). Fixed size (9 KB), add() takes a few instructions. One thread; read it when that thread has
/// stopped.
class TimeHistogram {
 public:
  void add(std::int64_t ns) noexcept {
    const std::uint64_t value = ns < 0 ? 0 : (std::min)(static_cast<std::uint64_t>(ns), max_ns);
    ++counts_[bucket(value)];
    ++count_;
    sum_ += value;
    max_ = (std::max)(max_, value);
    min_ = (std::min)(min_, value);
  }

  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  /// Exact; 0 when empty [ns].
  [[nodiscard]] std::uint64_t max() const noexcept { return max_; }
  [[nodiscard]] std::uint64_t min() const noexcept { return count_ == 0 ? 0 : min_; }
  [[nodiscard]] double mean() const noexcept {
    return count_ == 0 ? 0.0 : static_cast<double>(sum_) / static_cast<double>(count_);
  }
  /// The smallest bucket edge [ns] which at least the share `q` of all durations does not exceed; 0 when
  /// empty.
  [[nodiscard]] std::uint64_t quantile(double q) const noexcept {
    const double wanted = q * static_cast<double>(count_);
    std::uint64_t seen = 0;
    for (std::size_t i = 0; i < counts_.size(); ++i) {
      seen += counts_[i];
      if (seen > 0 && static_cast<double>(seen) >= wanted) return (std::min)(upper_edge(i), max_);
    }
    return max_;
  }

 private:
  static constexpr std::size_t octave = 32;  // buckets per octave, and the exact range
  static constexpr std::uint64_t max_ns = (std::uint64_t{1} << 40) - 1;

  [[nodiscard]] static constexpr std::size_t bucket(std::uint64_t value) noexcept {
    if (value < octave) return static_cast<std::size_t>(value);
    const auto shift = static_cast<std::size_t>(std::bit_width(value)) - 6;  // leaves the top six bits
    return octave * shift + static_cast<std::size_t>(value >> shift);
  }
  [[nodiscard]] static constexpr std::uint64_t upper_edge(std::size_t i) noexcept {
    if (i < octave) return i;
    const std::size_t shift = i / octave - 1;
    return ((static_cast<std::uint64_t>(i - octave * shift) + 1) << shift) - 1;
  }

  std::array<std::uint64_t, octave * 36> counts_{};
  std::uint64_t count_ = 0, sum_ = 0, max_ = 0, min_ = ~std::uint64_t{0};
};

/// Of one run of a servo loop. One thread; read it when that thread has stopped.
struct ServoStatistics {
  TimeHistogram tick_time;  ///< work in a tick [ns]
  TimeHistogram jitter;     ///< |time between two ticks - nominal period| [ns]
  std::uint64_t ticks = 0;
  std::uint64_t overruns = 0;  ///< ticks whose work took longer than the period
  std::int64_t span = 0;       ///< begin of the first tick to begin of the last [ns]

  /// `period`: nominal; `since_last`: begin of the last tick to begin of this one, ignored in the first;
  /// `work`: begin to end of this one [ns].
  void add(std::int64_t period, std::int64_t since_last, std::int64_t work) noexcept {
    tick_time.add(work);
    if (work > period) ++overruns;
    if (ticks++ == 0) return;
    jitter.add(since_last > period ? since_last - period : period - since_last);
    span += since_last;
  }
  /// Ticks per second; 0 before the second tick.
  [[nodiscard]] double rate() const noexcept {
    return span > 0 ? 1e9 * static_cast<double>(ticks - 1) / static_cast<double>(span) : 0.0;
  }
};

}  // namespace palpate
