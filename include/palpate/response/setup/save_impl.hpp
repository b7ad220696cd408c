// SPDX-License-Identifier: MIT
#pragma once

/// @file Definitions of save.hpp. Set-up only.

#include <palpate/core/error.hpp>
#include <palpate/response/save.hpp>

#include <algorithm>
#include <bit>
#include <cstring>
#include <string_view>
#include <type_traits>
#include <utility>

namespace palpate {

namespace detail {

PALPATE_COMPILED_INLINE std::uint64_t checksum(std::span<const std::byte> bytes) noexcept {
  constexpr std::uint64_t prime = 0x100000001b3;
  std::uint64_t part[4] = {0xcbf29ce484222325, 0x84222325cbf29ce4, 0x9e3779b97f4a7c15, 0xc2b2ae3d27d4eb4f};
  std::size_t i = 0;
  for (; i + 32 <= bytes.size(); i += 32) {
    std::uint64_t word[4];
    std::memcpy(word, bytes.data() + i, 32);
    for (int k = 0; k < 4; ++k) {
      part[k] = (part[k] ^ word[k]) * prime;
      part[k] ^= part[k] >> 29;  // the high half reaches the low one
    }
  }
  for (; i < bytes.size(); ++i) part[0] = (part[0] ^ std::to_integer<std::uint64_t>(bytes[i])) * prime;
  std::uint64_t all = bytes.size();
  for (auto l : part) all = (all ^ l) * prime;
  return all;
}

inline constexpr std::size_t saved_head = 32;

struct SavedNode {  // LoadNode without padding
  double normal[3], source[3], size, spacing;
  float part[3];
  std::uint32_t triangle, crease, unused;
};

class ByteWriter {
 public:
  std::vector<std::byte> bytes;
  template <class T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    const std::size_t at = bytes.size();
    bytes.resize(at + sizeof(T));
    std::memcpy(bytes.data() + at, &value, sizeof(T));
  }
  template <class T>
  void put_list(const std::vector<T>& list) {
    put(std::uint64_t{list.size()});
    const std::size_t at = bytes.size();
    bytes.resize(at + list.size() * sizeof(T));
    if (!list.empty())
      std::memcpy(bytes.data() + at, static_cast<const void*>(list.data()), list.size() * sizeof(T));
  }
};

class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) noexcept : bytes_(bytes) {}
  template <class T>
  [[nodiscard]] T get() {
    if (bytes_.size() - at_ < sizeof(T)) short_of();
    T value;
    std::memcpy(&value, bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return value;
  }
  template <class T>
  [[nodiscard]] std::vector<T> get_list() {
    const auto count = get<std::uint64_t>();
    if (count > (bytes_.size() - at_) / sizeof(T)) short_of();
    std::vector<T> list(static_cast<std::size_t>(count));
    if (count > 0) std::memcpy(static_cast<void*>(list.data()), bytes_.data() + at_, list.size() * sizeof(T));
    at_ += list.size() * sizeof(T);
    return list;
  }
  [[nodiscard]] bool at_end() const noexcept { return at_ == bytes_.size(); }

 private:
  [[noreturn]] static void short_of() {
    fail("load_response_field", "the lists' lengths do not fit the number of bytes");
  }
  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
};
}  // namespace detail

PALPATE_COMPILED_INLINE std::vector<std::byte> save_response_field(const ResponseField& field) {
  const ResponseParts parts = field.parts();
  detail::ByteWriter body;
  body.bytes.reserve(field.memory() + (std::size_t{1} << 20));
  body.bytes.resize(detail::saved_head);
  body.put(parts.E);
  body.put(parts.nu);
  body.put(parts.mesh.length);
  std::vector<double> vertices;
  for (const auto& v : parts.mesh.vertices) vertices.insert(vertices.end(), {v.x(), v.y(), v.z()});
  body.put_list(vertices);
  body.put_list(parts.mesh.triangles);
  body.put_list(parts.mesh.fixed_vertex);
  body.put_list(parts.mesh.fixed_triangle);
  std::vector<detail::SavedNode> nodes;
  for (const auto& n : parts.nodes)
    nodes.push_back({{n.normal.x(), n.normal.y(), n.normal.z()},
                     {n.source.x(), n.source.y(), n.source.z()},
                     n.size,
                     n.spacing,
                     {n.part.x(), n.part.y(), n.part.z()},
                     n.triangle,
                     n.crease ? 1u : 0u,
                     0});
  body.put_list(nodes);
  body.put_list(parts.triangles);
  body.put_list(parts.share_begin);
  body.put_list(parts.shares);
  body.put_list(parts.own);
  body.put_list(parts.second);
  body.put_list(parts.moments);
  body.put_list(parts.spread_begin);
  body.put_list(parts.spread);
  body.put_list(parts.edges);
  for (const MidEdgeTable::Rows* rows : {&parts.edge_rows, &parts.vertex_rows}) {
    body.put_list(rows->begin);
    body.put_list(rows->weights);
  }
  body.put_list(parts.influence);
  const std::span<const std::byte> content =
      std::span<const std::byte>(body.bytes).subspan(detail::saved_head);
  const std::uint32_t version = saved_field_version, order = 0x01020304;
  const std::uint64_t size = content.size(), sum = detail::checksum(content);
  std::memcpy(body.bytes.data(), "palpateR", 8);
  std::memcpy(body.bytes.data() + 8, &version, 4);
  std::memcpy(body.bytes.data() + 12, &order, 4);
  std::memcpy(body.bytes.data() + 16, &size, 8);
  std::memcpy(body.bytes.data() + 24, &sum, 8);
  return std::move(body.bytes);
}

PALPATE_COMPILED_INLINE ResponseField load_response_field(std::span<const std::byte> bytes) {
  const char* where = "load_response_field";
  if (bytes.size() < detail::saved_head) fail(where, "at least 32 bytes are needed", double(bytes.size()));
  if (std::memcmp(bytes.data(), "palpateR", 8) != 0)
    fail(where, "these bytes are not a saved response field");
  std::uint32_t version = 0, order = 0;
  std::uint64_t size = 0, sum = 0;
  std::memcpy(&version, bytes.data() + 8, 4);
  std::memcpy(&order, bytes.data() + 12, 4);
  std::memcpy(&size, bytes.data() + 16, 8);
  std::memcpy(&sum, bytes.data() + 24, 8);
  if (order != 0x01020304) fail(where, "saved on a machine with the other byte order");
  if (version != saved_field_version)
    fail(where, "the format's version is not the one this library reads", version);
  const std::span<const std::byte> content = bytes.subspan(detail::saved_head);
  if (content.size() != size)
    fail(where, "cut short or too long: bytes missing (more than there should be: < 0)",
         double(size) - double(content.size()));
  if (detail::checksum(content) != sum) fail(where, "the checksum does not match: the bytes were changed");
  detail::ByteReader in(content);
  ResponseParts parts;
  parts.E = in.get<double>();
  parts.nu = in.get<double>();
  parts.mesh.length = in.get<double>();
  const auto vertices = in.get_list<double>();
  parts.mesh.triangles = in.get_list<std::array<std::uint32_t, 3>>();
  parts.mesh.fixed_vertex = in.get_list<std::uint8_t>();
  parts.mesh.fixed_triangle = in.get_list<std::uint8_t>();
  const auto nodes = in.get_list<detail::SavedNode>();
  parts.triangles = in.get_list<std::array<std::uint32_t, 3>>();
  parts.share_begin = in.get_list<std::uint32_t>();
  parts.shares = in.get_list<LoadMesh::Share>();
  parts.own = in.get_list<PatchTable::Own>();
  parts.second = in.get_list<PatchTable::Second>();
  parts.moments = in.get_list<PatchTable::Moments>();
  parts.spread_begin = in.get_list<std::uint32_t>();
  parts.spread = in.get_list<LoadMesh::Share>();
  parts.edges = in.get_list<MidEdgeTable::Edges>();
  for (MidEdgeTable::Rows* rows : {&parts.edge_rows, &parts.vertex_rows}) {
    rows->begin = in.get_list<std::uint32_t>();
    rows->weights = in.get_list<MidEdgeTable::Weight>();
  }
  parts.influence = in.get_list<float>();
  // Contents: a bad number here would be read out of bounds in a tick.
  const auto require = [where](bool holds, const char* rule) {
    if (!holds) fail(where, rule);
  };
  // Of a body of 1e-6 m numbers in 1/m^2 reach 1e17; what is larger by far leaves float's range in a sum.
  const auto is_moderate = [](double e) { return is_within(e, 0x1p60); };
  const auto is_length = [&](double e) { return e >= 0x1p-60 && is_moderate(e); };  // squares are divided by
  const char* too_large = "a table is not finite, or too large";
  const std::size_t n = vertices.size() / 3, k = nodes.size();
  require(in.at_end() && vertices.size() == 3 * n && n >= 4 && k >= 1 && !parts.triangles.empty(),
          "the lists' lengths are not a field's");
  require(is_within(parts.E, 0x1p100) && parts.E >= 0x1p-100 && parts.nu >= 0 && parts.nu <= 0.5 &&
              is_length(parts.mesh.length) &&
              parts.mesh.length < 1e6,  // as contacts are; a longer reach gets to what stands for no edge
          "E, nu or length is out of range");
  require(
      parts.mesh.fixed_vertex.size() == n && parts.mesh.fixed_triangle.size() == parts.mesh.triangles.size(),
      "the fixed lists' lengths are not the mesh's");
  const auto require_shares = [&](const std::vector<std::uint32_t>& begin,
                                  const std::vector<LoadMesh::Share>& shares, std::size_t lists,
                                  std::size_t most, std::size_t solved) {
    bool good = begin.size() == lists + 1 && begin.front() == 0 && begin.back() == shares.size();
    for (std::size_t i = 0; good && i < lists; ++i)
      good = begin[i] <= begin[i + 1] && begin[i + 1] - begin[i] <= most;
    for (std::size_t i = 0; good && i < shares.size(); ++i)
      good = shares[i].node < solved && shares[i].weight >= 0 && shares[i].weight <= 1;
    require(good, "the shares are not the nodes'");
  };
  const std::size_t unsolved = parts.share_begin.size() - 1, solved = k - unsolved;  // checked next
  require(!parts.share_begin.empty() && unsolved < k, "the shares are not the nodes'");
  require_shares(parts.share_begin, parts.shares, unsolved, LoadMesh::most_parts, solved);
  require(parts.influence.size() == ResponseField::loads * 3 * ResponseField::padded(n) * solved,
          "the influence functions' length is not the mesh's");
  const std::size_t levels = parts.second.size() / k;
  require(parts.second.size() == levels * k && parts.moments.size() == levels * k && levels >= 2 &&
              levels < 64 && parts.own.size() == levels * parts.triangles.size(),
          "the tables' lengths are not the nodes'");
  require_shares(parts.spread_begin, parts.spread, levels * k, k, solved);
  bool fits = parts.edges.size() == parts.mesh.triangles.size();
  for (const MidEdgeTable::Rows* rows : {&parts.edge_rows, &parts.vertex_rows}) {
    const auto& begin = rows->begin;
    fits = fits && !begin.empty() && begin.front() == 0 && begin.back() == rows->weights.size() &&
           std::is_sorted(begin.begin(), begin.end());
    for (const auto& w : rows->weights) fits = fits && w.vertex < n && is_moderate(w.weight);
  }
  fits = fits && parts.vertex_rows.size() == n;
  for (const auto& t : parts.edges)
    for (auto e : t) fits = fits && e < parts.edge_rows.size();
  require(fits, "the mid-edge corrections are not those of the mesh");
  for (const auto& t : parts.mesh.triangles)
    for (auto v : t) require(v < n, "a triangle's corner is not a vertex");
  for (const auto& t : parts.triangles)
    for (auto v : t) require(v < k, "a triangle's corner is not a node");
  for (std::size_t v = 0; v < n; ++v) {
    parts.mesh.vertices.push_back({vertices[3 * v], vertices[3 * v + 1], vertices[3 * v + 2]});
    require(is_moderate(parts.mesh.vertices.back().norm()), "a vertex is not finite, or too far away");
  }
  for (const auto& s : nodes) {
    const LoadNode node{{s.normal[0], s.normal[1], s.normal[2]},
                        {s.source[0], s.source[1], s.source[2]},
                        s.size,
                        s.spacing,
                        s.triangle,
                        {s.part[0], s.part[1], s.part[2]},
                        s.crease != 0};
    require(s.triangle < parts.mesh.triangles.size() && is_moderate(node.normal.norm()) &&
                is_moderate(node.source.norm()) && is_length(s.size) && is_length(s.spacing) &&
                is_moderate(node.part.norm()),
            "a node is not a triangle's");
    parts.nodes.push_back(node);
  }
  // In 1/m and 1/m^2, a body of 1e-6 m has up to 1e17; from 2^64 on sums leave float's range. Top bit: some
  // exponent is that large; without a branch for each of millions.
  std::uint32_t beyond = 0;
  for (float c : parts.influence) beyond |= (std::bit_cast<std::uint32_t>(c) & 0x7fffffffu) + 0x20800000u;
  require((beyond & 0x80000000u) == 0, "an influence function is not finite, or too large");
  for (const auto& row : parts.own)
    for (const auto& pair : row.pair)
      for (float e : pair) require(is_moderate(e), too_large);
  for (const auto& row : parts.second)
    for (float e : row.mean) require(is_moderate(e), too_large);
  for (const auto& row : parts.moments) {
    bool good = is_moderate(row.sagitta) && is_moderate(row.mean_sagitta);
    for (const auto& mean : row.mean)
      for (float e : mean) good = good && is_moderate(e);
    for (float e : row.own) good = good && is_within(e, 0x1p90f);  // 1/m^3
    require(good, too_large);
  }
  return ResponseField(std::move(parts));
}

}  // namespace palpate
