// SPDX-License-Identifier: MIT
#pragma once

/// @file  The last ticks of a servo loop, kept for the time after a fault, and the same ticks again.

#include <palpate/core/error.hpp>
#include <palpate/core/status.hpp>
#include <palpate/device/servo_chain.hpp>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <span>
#include <string>
#include <vector>

namespace palpate {

/// What a tick was given and what came out. Contacts are not among it: replay() makes them again.
struct TickRecord {
  std::uint64_t tick = 0;    ///< its number
  double dt = 0;             ///< [s]
  Pose<double> tool{};       ///< at which the solver was asked
  bool begins_anew = false;  ///< the solver was reset just before
  Wrench<double> wrench{};   ///< the solver's
  Status status = Status::ok;
  Wrench<double> sent{};  ///< to the motors
  GateStatus gate = GateStatus::ok;
  double passivity = 1;  ///< scale of the passivity controller
};

/// A tick of a ServoChain.
template <class Output>
[[nodiscard]] TickRecord record_of(const Output& out, std::uint64_t tick, double dt,
                                   bool begins_anew) noexcept {
  return {.tick = tick,
          .dt = dt,
          .tool = out.tool,
          .begins_anew = begins_anew,
          .wrench = out.result.wrench,
          .status = out.result.status,
          .sent = out.wrench,
          .gate = out.gate,
          .passivity = out.passivity};
}

/// A ring of the last ticks. Heap at set-up only; add() is noexcept and copies one record. One thread; read
/// it when that thread has stopped.
class Recorder {
 public:
  /// Keeps this many ticks, >= 0.
  explicit Recorder(std::size_t capacity) : ring_(capacity) {}

  void add(const TickRecord& record) noexcept {
    if (ring_.empty()) return;
    ring_[static_cast<std::size_t>(count_ % ring_.size())] = record;
    ++count_;
  }

  [[nodiscard]] std::size_t size() const noexcept {
    return count_ < ring_.size() ? static_cast<std::size_t>(count_) : ring_.size();
  }
  /// In the order of time. Set-up and afterwards: takes heap.
  [[nodiscard]] std::vector<TickRecord> ticks() const {
    std::vector<TickRecord> all;
    for (std::uint64_t i = count_ - size(); i < count_; ++i)
      all.push_back(ring_[static_cast<std::size_t>(i % ring_.size())]);
    return all;
  }

 private:
  std::vector<TickRecord> ring_;
  std::uint64_t count_ = 0;
};

namespace detail {
/// Calls visit(number) for each real number of a record, in the order of the file.
template <class Record, class Visit>
void for_each_number(Record& r, const Visit& visit) {
  visit(r.dt);
  for (int i = 0; i < 9; ++i) visit(r.tool.rotation(i / 3, i % 3));
  for (int i = 0; i < 3; ++i) visit(r.tool.translation[i]);
  for (int i = 0; i < 3; ++i) visit(r.wrench.force[i]), visit(r.wrench.torque[i]);
  for (int i = 0; i < 3; ++i) visit(r.sent.force[i]), visit(r.sent.torque[i]);
  visit(r.passivity);
}
[[nodiscard]] inline bool same_bits(const Wrench<double>& a, const Wrench<double>& b) noexcept {
  for (int i = 0; i < 3; ++i) {
    if (std::bit_cast<std::uint64_t>(a.force[i]) != std::bit_cast<std::uint64_t>(b.force[i])) return false;
    if (std::bit_cast<std::uint64_t>(a.torque[i]) != std::bit_cast<std::uint64_t>(b.torque[i])) return false;
  }
  return true;
}
constexpr const char* ticks_title = "palpate ticks 1";
}  // namespace detail

/// Writes the ticks as text, a line each, with every bit of the numbers. `note`: one line of the caller's,
/// such as the scene's options. Not for the servo thread. Reports a file that cannot be written.
inline void save_ticks(std::span<const TickRecord> ticks, const std::string& file, const std::string& note) {
  std::FILE* const out = std::fopen(file.c_str(), "w");
  if (out == nullptr) fail("save_ticks", ("cannot write " + file).c_str());
  std::fprintf(out, "%s\n%s\n%zu\n", detail::ticks_title, note.c_str(), ticks.size());
  for (const TickRecord& r : ticks) {
    std::fprintf(out, "%llu %d %u %u", static_cast<unsigned long long>(r.tick), r.begins_anew ? 1 : 0,
                 static_cast<unsigned>(r.status), static_cast<unsigned>(r.gate));
    detail::for_each_number(r, [out](double x) {
      std::fprintf(out, " %llx", static_cast<unsigned long long>(std::bit_cast<std::uint64_t>(x)));
    });
    std::fputc('\n', out);
  }
  const bool failed = std::ferror(out) != 0;
  if (std::fclose(out) != 0 || failed) fail("save_ticks", ("cannot write all of " + file).c_str());
}

struct LoadedTicks {
  std::string note;
  std::vector<TickRecord> ticks;
};

/// What save_ticks() wrote. Reports a file that is none, or ends early.
[[nodiscard]] inline LoadedTicks load_ticks(const std::string& file) {
  std::FILE* const in = std::fopen(file.c_str(), "r");
  if (in == nullptr) fail("load_ticks", ("cannot read " + file).c_str());
  const auto line = [in] {
    std::string text;
    for (int c = std::fgetc(in); c != EOF && c != '\n'; c = std::fgetc(in))
      text.push_back(static_cast<char>(c));
    return text;
  };
  LoadedTicks loaded;
  std::size_t count = 0;
  bool good = line() == detail::ticks_title;
  loaded.note = line();
  good = good && std::fscanf(in, "%zu", &count) == 1;
  for (std::size_t i = 0; good && i < count; ++i) {
    TickRecord r;
    unsigned long long tick = 0;
    int anew = 0;
    unsigned status = 0, gate = 0;
    good = std::fscanf(in, "%llu %d %u %u", &tick, &anew, &status, &gate) == 4;
    r.tick = tick;
    r.begins_anew = anew != 0;
    r.status = static_cast<Status>(status);
    r.gate = static_cast<GateStatus>(gate);
    detail::for_each_number(r, [&](double& x) {
      unsigned long long bits = 0;
      good = good && std::fscanf(in, "%llx", &bits) == 1;
      x = std::bit_cast<double>(static_cast<std::uint64_t>(bits));
    });
    if (good) loaded.ticks.push_back(r);
  }
  std::fclose(in);
  if (!good) fail("load_ticks", (file + " is no record of ticks, or not all of one").c_str());
  return loaded;
}

/// How a replay went.
struct Replayed {
  std::size_t ticks = 0;    ///< that were played
  std::size_t skipped = 0;  ///< before the first one without contact
  bool same = true;         ///< wrench and status of all had the same bits
  TickRecord recorded{};    ///< the first tick that differs
  Wrench<double> wrench{};  ///< what came out of it now
  Status status = Status::ok;
};

/// Plays recorded ticks to a solver of the same parts. It begins anew, at the first tick without contact, so
/// that what came before the record does not matter; laws with memory need the record from the loop's first
/// tick on. Stops at the first tick whose wrench or status has other bits.
template <class Solver>
  requires HapticSolver<Solver, double> && requires(Solver& solver) {
    { solver.reset() } noexcept;
  }
[[nodiscard]] Replayed replay(Solver& solver, std::span<const TickRecord> ticks) noexcept {
  Replayed result;
  solver.reset();
  bool begun = false;
  for (const TickRecord& r : ticks) {
    begun = begun || !has(r.status, Status::contact) || r.tick == 1;
    if (!begun) {
      ++result.skipped;
      continue;
    }
    if (r.begins_anew) solver.reset();
    const auto now = solver.tick(r.tool, r.dt);
    ++result.ticks;
    if (now.status == r.status && detail::same_bits(now.wrench, r.wrench)) continue;
    result.same = false;
    result.recorded = r;
    result.wrench = now.wrench;
    result.status = now.status;
    break;
  }
  return result;
}

}  // namespace palpate
