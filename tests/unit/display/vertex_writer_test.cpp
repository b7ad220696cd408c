// SPDX-License-Identifier: MIT
#include <palpate/display/vertex_writer.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <random>
#include <vector>

namespace {

using namespace palpate;

/// Numbers of vertices: runs of one to nine in a row, in a random order.
std::vector<std::uint32_t> shuffled_runs(std::uint32_t count, std::mt19937_64& random) {
  std::vector<std::array<std::uint32_t, 2>> runs;
  for (std::uint32_t v = 0; v < count;) {
    const std::uint32_t end = (std::min)(count, v + 1 + static_cast<std::uint32_t>(random() % 9));
    runs.push_back({v, end});
    v = end;
  }
  std::shuffle(runs.begin(), runs.end(), random);
  std::vector<std::uint32_t> order;
  for (const auto& [begin, end] : runs)
    for (std::uint32_t v = begin; v < end; ++v) order.push_back(v);
  return order;
}

}  // namespace

TEST_CASE_TEMPLATE(
    "vertices in rows or not, packed or not, are where they belong, and nothing else is written", T, float,
    double) {
  std::mt19937_64 random(7);
  INFO("seed 7");
  constexpr std::uint32_t count = 500;
  const auto coordinate = [](std::uint32_t v, std::size_t k) { return static_cast<float>(10 * v + k); };
  for (const std::size_t stride : {3 * sizeof(T), 3 * sizeof(T) + sizeof(float)}) {
    const std::vector<std::uint32_t> order = shuffled_runs(count, random);
    std::array<std::vector<float>, 3> position;
    for (const std::uint32_t v : order)
      for (std::size_t k = 0; k < 3; ++k) position[k].push_back(coordinate(v, k));
    const auto vertex = [&order](std::size_t i) { return order[i]; };

    for (const int call : {1, 2, 3}) {  // put_four, put_apart, put_row
      constexpr unsigned char untouched = 0xa5;
      std::vector<unsigned char> bytes(count * stride + 16, untouched);
      const detail::VertexWriter<T> to(reinterpret_cast<T*>(bytes.data()), stride);
      for (std::size_t i = 0; i < count; i += 4) {
        const auto part = [&position, i](std::size_t k) {
          return detail::load<detail::Simd4>(&position[k][i]);
        };
        const auto four = [&](std::size_t k) { return vertex(i + k); };
        const auto in_order = [&](std::size_t k) {
          return detail::Simd4{coordinate(std::uint32_t(i), k), coordinate(std::uint32_t(i + 1), k),
                               coordinate(std::uint32_t(i + 2), k), coordinate(std::uint32_t(i + 3), k)};
        };
        if (call == 3)
          to.put_row(i, in_order(0), in_order(1), in_order(2));
        else if (call == 1)
          to.put_four(four, part(0), part(1), part(2));
        else
          to.put_apart(four, part(0), part(1), part(2));
      }
      std::size_t wrong = 0;
      for (std::uint32_t v = 0; v < count; ++v) {
        std::array<T, 3> at;
        std::memcpy(at.data(), &bytes[v * stride], sizeof at);
        for (std::size_t k = 0; k < 3; ++k) wrong += at[k] == T(coordinate(v, k)) ? 0 : 1;
        for (std::size_t b = v * stride + sizeof at; b < (v + 1) * stride; ++b)
          wrong += bytes[b] == untouched ? 0 : 1;
      }
      for (std::size_t b = count * stride; b < bytes.size(); ++b) wrong += bytes[b] == untouched ? 0 : 1;
      CHECK(wrong == 0);
    }
  }
}

TEST_CASE_TEMPLATE(
    "runs of vertices, packed or not, told whole or in part, leave the gaps between them alone", T, float,
    double) {
  std::mt19937_64 random(11);
  INFO("seed 11");
  std::vector<std::uint32_t>
      order;  // runs of up to 40, so that whole registers are met at every position in them
  std::uint32_t end = 0;
  while (order.size() < 2000) {
    end += 1 + static_cast<std::uint32_t>(random() % 3);
    for (std::uint32_t k = static_cast<std::uint32_t>(random() % 40); k > 0; --k) order.push_back(end++);
  }
  std::vector<std::uint8_t> whole(order.size(), 1);
  for (std::size_t i = order.size() - 1; i-- > 0;)
    if (order[i + 1] == order[i] + 1) whole[i] = static_cast<std::uint8_t>(whole[i + 1] + 1);
  std::vector<std::uint8_t> part = whole;
  for (std::uint8_t& length : part) length = static_cast<std::uint8_t>(1 + random() % length);
  const auto coordinate = [](std::uint32_t v, std::size_t k) { return static_cast<float>(10 * v + k); };
  std::array<std::vector<float>, 3> position;
  for (const std::uint32_t v : order)
    for (std::size_t k = 0; k < 3; ++k) position[k].push_back(coordinate(v, k));
  for (const std::size_t stride : {3 * sizeof(T), 3 * sizeof(T) + sizeof(float)}) {
    constexpr unsigned char untouched = 0xa5;
    std::vector<unsigned char> expected(end * stride, untouched);
    for (const std::uint32_t v : order) {
      const std::array<T, 3> at{T(coordinate(v, 0)), T(coordinate(v, 1)), T(coordinate(v, 2))};
      std::memcpy(&expected[v * stride], at.data(), sizeof at);
    }
    for (const auto& runs : {whole, part}) {
      std::vector<unsigned char> bytes(end * stride, untouched);
      detail::VertexWriter<T>(reinterpret_cast<T*>(bytes.data()), stride)
          .put_runs(order.size(), order.data(), runs.data(), position[0].data(), position[1].data(),
                    position[2].data());
      CHECK(bytes == expected);
    }
  }
}
