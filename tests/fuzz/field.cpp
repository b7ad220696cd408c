// SPDX-License-Identifier: MIT

/// @file Saved response fields with damaged bytes, their checksum made right again: refused, or what was
/// loaded answers with finite numbers. The good bytes are made once, at the start.

#include "bytes.hpp"

#include <palpate/response/response_contact.hpp>
#include <palpate/response/response_display.hpp>
#include <palpate/response/save.hpp>

#include <support/response_meshes.hpp>

namespace {
using namespace palpate;
using fuzz::Bytes;
using fuzz::require;

const MeshData<double>& mesh() {
  static const MeshData<double> made = test::ellipsoid_mesh(Vec3<double>(0.06, 0.04, 0.04), 3);
  return made;
}
const std::vector<std::byte>& good() {
  static const std::vector<std::byte> made =
      save_response_field(ResponseField(mesh(), [](const Vec3<double>& p) { return p.y() <= -0.02; },
                                        {.E = 1e5, .nu = 0.45, .mesh = {.vertices = 20}, .threads = 1}));
  return made;
}

/// Places at which edits begin: the heads of the lists, where a bit does most.
const std::vector<std::size_t>& heads() {
  static const std::vector<std::size_t> made = [] {
    std::vector<std::size_t> at{32, 40, 48};
    std::size_t next = 56;
    constexpr std::size_t item[] = {8,
                                    12,
                                    1,
                                    1,
                                    sizeof(detail::SavedNode),
                                    12,
                                    4,
                                    sizeof(LoadMesh::Share),
                                    sizeof(PatchTable::Own),
                                    sizeof(PatchTable::Second),
                                    sizeof(PatchTable::Moments),
                                    4,
                                    sizeof(LoadMesh::Share),
                                    sizeof(MidEdgeTable::Edges),
                                    4,
                                    sizeof(MidEdgeTable::Weight),
                                    4,
                                    sizeof(MidEdgeTable::Weight),
                                    4};
    for (const std::size_t bytes : item) {
      at.push_back(next);
      std::uint64_t count = 0;
      require(next + 8 <= good().size(), "lists are where save.hpp has them");
      std::memcpy(&count, good().data() + next, 8);
      next += 8 + std::size_t(count) * bytes;
    }
    require(next == good().size(), "lists are as long as save.hpp has them");
    return at;
  }();
  return made;
}

void use(const ResponseField& field, Bytes& in) {
  ResponseTick<2> tick(field);
  const ResponseDisplay display(field, mesh().vertices);
  std::vector<float> moved(3 * mesh().vertices.size());
  for (int k = 0; k < 4; ++k) {
    std::array<ResponseContact<double>, 2> contacts;
    for (auto& c : contacts) {
      const auto& v = mesh().vertices[in.byte() % mesh().vertices.size()];
      c.position = v;
      c.normal = v.normalized();
      c.radius = in.between(1e-4, 0.02);
      c.displacement = in.units<double>() * 0.004 - 0.002 * c.normal;
      if (k == 3) c.displacement = in.numbers<double>(), c.rotation = in.numbers<double>();
    }
    std::array<Vec3<double>, 2> forces, torques;
    {
      const fuzz::NoHeap none;
      tick.solve(contacts.data(), 2, forces.data(), torques.data());
      tick.displace(display, moved.data(), 3);
    }
    require(is_finite(forces[0]) && is_finite(forces[1]) && is_finite(torques[0]) && is_finite(torques[1]),
            "a field's force is finite");
    if (k < 3)
      for (const float u : moved) require(is_finite(u), "a displacement is finite");
  }
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes in(data, size);
  std::vector<std::byte> bytes = good();
  const std::uint8_t kind = in.byte();
  if (kind >= 240) {  // any bytes at all
    const auto rest = in.rest();
    bytes.assign(reinterpret_cast<const std::byte*>(rest.data()),
                 reinterpret_cast<const std::byte*>(rest.data()) + rest.size());
  } else {
    for (int edits = kind % 8; edits > 0; --edits) {
      const std::uint8_t where = in.byte();
      std::size_t at = heads()[where % heads().size()];
      if (where >= 64) at += in.raw<std::uint16_t>();
      if (where >= 192) at = in.raw<std::uint32_t>();
      at %= bytes.size() + 1;
      const std::uint8_t what = in.byte();
      const auto put = [&](auto value) {
        if (at + sizeof value <= bytes.size()) std::memcpy(bytes.data() + at, &value, sizeof value);
      };
      switch (what % 6) {
        case 0:
          put(in.raw<std::uint8_t>());
          break;
        case 1:
          put(in.raw<std::uint32_t>());
          break;
        case 2:
          put(in.number<double>());
          break;
        case 3:
          put(in.number<float>());
          break;
        case 4:
          put(in.raw<std::uint64_t>());
          break;
        default:
          if (what & 64)
            bytes.resize(at);
          else
            bytes.insert(bytes.begin() + std::ptrdiff_t(at), 1 + what % 16, std::byte{what});
      }
      if (bytes.empty()) break;
    }
    if (bytes.size() >= 32 && kind % 16 < 15) {
      const std::uint64_t length = bytes.size() - 32, sum = detail::checksum(std::span(bytes).subspan(32));
      std::memcpy(bytes.data() + 16, &length, 8);
      std::memcpy(bytes.data() + 24, &sum, 8);
    }
  }
  try {
    use(load_response_field(bytes), in);
  } catch (const SetupError&) {
  }
  return 0;
}
