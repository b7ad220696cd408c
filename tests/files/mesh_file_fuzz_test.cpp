// SPDX-License-Identifier: MIT

/// @file Mutated mesh files through the example's reader: it never crashes, hangs or fills the memory, and
/// what it passes is a sound mesh by an independent check. The reader's parser is Assimp's, which is not
/// ours: cases run in child processes, so that one that kills its process is counted, its file kept in the
/// working folder, and the rest goes on. 10,000 cases; PALPATE_FUZZ_CASES=1000000 in a build with sanitizers.

#include "touch/mesh_file.hpp"

#include <palpate/geometry/mesh_surface.hpp>

#include <support/meshes.hpp>

#include <doctest/doctest.h>

#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <new>
#include <stdexcept>
#include <string>

using namespace palpate;

namespace {

using Mesh = MeshData<double>;

constexpr std::uint64_t seed = 20261121;
constexpr unsigned patience = 20;  // s for one file of a few kB, which takes below a millisecond
constexpr long batch = 2000;

// Polygons: lists of vertices.
struct Body {
  std::vector<Vec3<double>> vertices;
  std::vector<std::vector<std::uint32_t>> polygons;
};

template <class T>
void put(std::string& out, T value, bool big_endian = false) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  if (big_endian) std::reverse(bytes, bytes + sizeof value);
  out.append(bytes, sizeof value);
}

std::string three(const Vec3<double>& v) {
  char text[100];
  std::snprintf(text, sizeof text, "%.6g %.6g %.6g\n", v.x(), v.y(), v.z());
  return text;
}

std::string obj(const Body& body, bool normals) {
  std::string out = "# a mesh\nmtllib none.mtl\no body\n";
  for (const auto& v : body.vertices) out += "v " + three(v);
  if (normals)
    for (const auto& v : body.vertices) out += "vn " + three(v.normalized());
  out += "g all\nusemtl grey\ns 1\n";
  for (const auto& p : body.polygons) {
    out += "f";
    for (const std::uint32_t i : p) {
      const std::string number = std::to_string(i + 1);
      out += " " + number + (normals ? "//" + number : "");
    }
    out += "\n";
  }
  return out;
}

std::string ply(const Body& body, const std::string& format) {
  std::string out = "ply\nformat " + format + " 1.0\ncomment a mesh\nelement vertex " +
                    std::to_string(body.vertices.size()) +
                    "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                    std::to_string(body.polygons.size()) +
                    "\nproperty list uchar int vertex_indices\nend_header\n";
  const bool ascii = format == "ascii", big = format == "binary_big_endian";
  for (const auto& v : body.vertices) {
    if (ascii)
      out += three(v);
    else
      for (int k = 0; k < 3; ++k) put(out, static_cast<float>(v[k]), big);
  }
  for (const auto& p : body.polygons) {
    if (ascii) {
      out += std::to_string(p.size());
      for (const std::uint32_t i : p) out += " " + std::to_string(i);
      out += "\n";
    } else {
      put(out, static_cast<unsigned char>(p.size()));
      for (const std::uint32_t i : p) put(out, i, big);
    }
  }
  return out;
}

std::string stl(const Body& body, bool ascii) {
  std::string out = ascii ? "solid body\n" : std::string(84, ' ');
  std::uint32_t count = 0;
  for (const auto& p : body.polygons) {
    for (std::size_t k = 1; k + 1 < p.size(); ++k, ++count) {
      std::array<Vec3<double>, 4> rows;  // normal and corners
      for (std::size_t i = 1; i < 4; ++i) {
        const std::uint32_t v = p[i == 1 ? 0 : k + i - 2];
        rows[i] = v < body.vertices.size() ? body.vertices[v] : Vec3<double>::Zero();
      }
      rows[0] = (rows[2] - rows[1]).cross(rows[3] - rows[1]).normalized();
      if (ascii) {
        out += "facet normal " + three(rows[0]) + "outer loop\n";
        for (std::size_t i = 1; i < 4; ++i) out += "vertex " + three(rows[i]);
        out += "endloop\nendfacet\n";
      } else {
        for (const auto& row : rows)
          for (int i = 0; i < 3; ++i) put(out, static_cast<float>(row[i]));
        put(out, std::uint16_t(0));
      }
    }
  }
  if (!ascii) std::memcpy(&out[80], &count, sizeof count);
  return ascii ? out + "endsolid body\n" : out;
}

struct Format {
  const char* ending;
  std::string (*write)(const Body&);
};
const Format formats[] = {{"obj", [](const Body& b) { return obj(b, false); }},
                          {"obj", [](const Body& b) { return obj(b, true); }},
                          {"ply", [](const Body& b) { return ply(b, "ascii"); }},
                          {"ply", [](const Body& b) { return ply(b, "binary_little_endian"); }},
                          {"ply", [](const Body& b) { return ply(b, "binary_big_endian"); }},
                          {"stl", [](const Body& b) { return stl(b, true); }},
                          {"stl", [](const Body& b) { return stl(b, false); }}};

std::vector<Body> bodies() {
  std::vector<Body> all{
      {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}},
       {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}}};
  for (const Mesh& mesh : {Sphere<double>({.radius = 1}).mesh(26), test::torus<double>(3, 1, 4, 4)}) {
    all.push_back({mesh.vertices, {}});
    for (const auto& t : mesh.triangles) all.back().polygons.push_back({t[0], t[1], t[2]});
  }
  return all;
}

// What goes wrong before a file is written.
void mutate(Body& b, std::mt19937_64& random) {
  const std::size_t at = random() % b.polygons.size();
  std::vector<std::uint32_t>& p = b.polygons[at];
  Vec3<double>& v = b.vertices[random() % b.vertices.size()];
  switch (random() % 9) {
    case 0:
      std::reverse(p.begin(), p.end());
      break;
    case 1:
      p[random() % p.size()] = static_cast<std::uint32_t>(random() % (b.vertices.size() + 1));
      break;
    case 2:
      b.polygons.push_back(p);
      break;
    case 3:
      if (b.polygons.size() > 1) b.polygons.erase(b.polygons.begin() + static_cast<std::ptrdiff_t>(at));
      break;
    case 4:
      v = b.vertices[random() % b.vertices.size()];
      break;
    case 5:
      v *= random() % 2 == 0 ? -1 : 1e5;
      break;
    case 6:
      v[static_cast<int>(random() % 3)] = std::numeric_limits<double>::quiet_NaN();
      break;
    case 7:
      b.vertices.push_back(0.5 * v);
      break;
    default:
      if (p.size() > 3) p.pop_back();
  }
}

const char* const nasty[] = {"nan",
                             "-nan",
                             "inf",
                             "-inf",
                             "1e400",
                             "-1e400",
                             "1e-400",
                             "1e38",
                             "3e5",
                             "-1",
                             "0",
                             "-0",
                             "1",
                             "2",
                             "7",
                             "255",
                             "256",
                             "65536",
                             "2147483647",
                             "2147483648",
                             "4294967295",
                             "4294967296",
                             "1000000000",
                             "99999999999999999999",
                             "-99999999999999999999",
                             "0.5",
                             "1/1/1",
                             "1//",
                             "//",
                             "1/2/3/4",
                             "x",
                             "",
                             "-",
                             ".",
                             "e",
                             "0x10",
                             "1,5",
                             "\"",
                             "#",
                             "\\",
                             "123456789012345678901234567890.1234567890123456789"};
const char* const words[] = {"v 0 0 0\n",
                             "f 1 2 3\n",
                             "f 1 2 3 4 5 6 7 8\n",
                             "f -1 -2 -3\n",
                             "f\n",
                             "v\n",
                             "l 1 2\n",
                             "p 1\n",
                             "vt 0\n",
                             "f 1/1 2/2 3/3\n",
                             "o x\n",
                             "g\n",
                             "usemtl a\n",
                             "mtllib /dev/stdin\n",
                             "call x\n",
                             "curv 0 1 1 2\n",
                             "\\\n",
                             "element face 3\n",
                             "element vertex 4000000000\n",
                             "element vertex 5\n",
                             "property list uint int vertex_indices\n",
                             "property list uchar int vertex_indices\n",
                             "property float x\n",
                             "property double nx\n",
                             "property list float float y\n",
                             "comment\n",
                             "end_header\n",
                             "format ascii 1.0\n",
                             "format binary_little_endian 1.0\n",
                             "element tristrips 1\n",
                             "solid\n",
                             "endsolid\n",
                             "facet normal 0 0 1\n",
                             "outer loop\n",
                             "vertex 0 0 0\n",
                             "endloop\n",
                             "endfacet\n",
                             "COLOR="};

// [begin, end) of a random line, its end included; or of a random word.
using Range = std::pair<std::size_t, std::size_t>;
Range random_piece(const std::string& text, std::mt19937_64& random, const char* ends) {
  const std::size_t at = random() % text.size();
  std::size_t begin = at == 0 ? 0 : text.find_last_of(ends, at - 1);
  begin = begin == std::string::npos || at == 0 ? 0 : begin + 1;
  const std::size_t end = text.find_first_of(ends, at);
  return {begin, end == std::string::npos ? text.size() : end};
}

void mutate(std::string& s, std::mt19937_64& random) {
  if (s.empty()) {
    s = words[random() % std::size(words)];
    return;
  }
  const std::size_t at = random() % s.size();
  const auto line = random_piece(s, random, "\n"), word = random_piece(s, random, " \n\t/");
  const std::string whole = s.substr(line.first, line.second - line.first) + "\n";
  const auto any_byte = [&] { return static_cast<char>(random()); };
  switch (random() % 20) {
    case 0:
      s[at] = static_cast<char>(s[at] ^ (1 << random() % 8));
      break;
    case 1:
      s[at] = any_byte();
      break;
    case 2:
      s.erase(line.first, whole.size());
      break;
    case 3:
      s.insert(line.first, whole);
      break;
    case 4:
      s.insert(random_piece(s, random, "\n").first, whole);
      break;
    case 5:
    case 6:
    case 7:
      s.replace(word.first, word.second - word.first, nasty[random() % std::size(nasty)]);
      break;
    case 8:
      s.resize(at);
      break;
    case 9:
      s.insert(at, 1 + random() % 9, any_byte());
      break;
    case 10:
      s.insert(random_piece(s, random, "\n").first, words[random() % std::size(words)]);
      break;
    case 11:
      s.insert(at, words[random() % std::size(words)]);
      break;
    case 12:
      s.erase(at, 1 + random() % 100);
      break;
    case 13:
      s.insert(at, s.substr(random() % s.size(), random() % 300));
      break;
    case 14: {  // a number of a binary file, or four letters
      const std::uint32_t values[] = {
          0,           1,           0x7fffffffu, 0x80000000u, 0xffffffffu,
          0x7fc00000u, 0x7f800000u, 0x7f7fffffu, 1000000000u, static_cast<std::uint32_t>(random())};
      const std::uint32_t value = values[random() % std::size(values)];
      if (s.size() >= 4) std::memcpy(&s[random() % (s.size() - 3)], &value, 4);
      break;
    }
    case 15:  // triangles of a binary STL file: 50 bytes times 2^31 more of them are 0 in 32 bits
      if (s.size() > 83) s[83] = static_cast<char>(s[83] ^ 0x80);
      break;
    case 16:
      s.append(1 + random() % 200, any_byte());
      break;
    case 17:
      for (char& c : s)
        if (c == '\n' && random() % 2 == 0) c = '\r';
      break;
    case 18: {  // a polygon of many corners
      std::string f = "f";
      for (std::uint64_t n = random() % 400; n > 0; --n) f += " " + std::to_string(1 + random() % 30);
      s.insert(line.first, f + "\n");
      break;
    }
    default:
      if (random() % 8 == 0)
        s.assign(random() % 200, any_byte());
      else if (random() % 8 == 0)
        s.clear();
      else
        std::swap(s[at], s[random() % s.size()]);
  }
}

struct Case {
  touch::MeshFile file;
  std::string content;
};

// Depends on the number alone, so that a case can be made again.
Case make_case(long number) {
  static const std::vector<Body> good = bodies();
  std::mt19937_64 random(seed + static_cast<std::uint64_t>(number));
  const auto any_format = [&]() -> const Format& { return formats[random() % std::size(formats)]; };
  const Format& format = any_format();
  Body body = good[random() % good.size()];
  const bool well_written = random() % 3 == 0;
  if (well_written)
    for (std::uint64_t n = random() % 4; n > 0; --n) mutate(body, random);
  Case c{{.name = std::string("mesh_fuzz_") + std::to_string(number) + "." +
                  (random() % 50 == 0 ? any_format() : format).ending,
          .scale = random() % 8 == 0 ? 1e-3 : 1.0,
          .up = "yzx"[random() % 3],
          .repair = random() % 4 == 0},
         format.write(body)};
  if (well_written) return c;
  if (random() % 64 == 0) c.content += any_format().write(body);
  for (std::uint64_t n = 1 + random() % 4; n > 0; --n) mutate(c.content, random);
  return c;
}

// What the children count, in memory that all of them share.
struct Counts {
  long next;  // the case that runs, or the one after the last
  long refused_by_parser, refused_by_check, valid, unsound, without_message, not_finite;
};

void run_case(const Case& c, Counts& counts) {
  const auto says_what = [&](const std::exception& e) {
    const std::string what = e.what();
    counts.without_message +=
        what.size() < c.file.name.size() + 6 || what.compare(0, c.file.name.size(), c.file.name) != 0;
  };
  Mesh mesh;
  try {
    mesh = touch::parse_mesh(c.file, c.content);
  } catch (const std::runtime_error& e) {
    ++counts.refused_by_parser;
    return says_what(e);
  }
  try {
    touch::check_mesh(c.file, mesh);
  } catch (const std::runtime_error& e) {
    ++counts.refused_by_check;
    return says_what(e);
  }
  ++counts.valid;
  counts.unsound += !test::is_sound(mesh);
  if (counts.valid % 16 != 0) return;
  const MeshSurface<double> body{TriangleMesh<double>(mesh)};
  const auto in = body.penetration(0.9 * mesh.vertices[0]);
  counts.not_finite += !is_finite(in.depth) || !is_finite(in.gradient);
}

}  // namespace

TEST_CASE("stress: mutated mesh files never crash the reader or get through as valid") {
  for (const Format& format : formats) {
    for (const Body& body : bodies()) {
      const touch::MeshFile file{.name = std::string("good.") + format.ending};
      CHECK_NOTHROW(touch::check_mesh(file, touch::parse_mesh(file, format.write(body))));
    }
  }
  const char* asked = std::getenv("PALPATE_FUZZ_CASES");
  const long cases = asked ? std::atol(asked) : 10000;
  MESSAGE("seed ", seed);
  void* const shared =
      mmap(nullptr, sizeof(Counts), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  REQUIRE(shared != MAP_FAILED);
  Counts& counts = *new (shared) Counts{};
  long died = 0, most_memory = 0;
  while (counts.next < cases) {
    std::fflush(nullptr);
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
      if (std::freopen("/dev/null", "w", stdout) == nullptr) _exit(2);  // what was repaired
      for (const long end = (std::min)(cases, counts.next + batch); counts.next < end; ++counts.next) {
        alarm(patience);
        run_case(make_case(counts.next), counts);
      }
      _exit(0);
    }
    int status = 0;
    rusage used{};
    REQUIRE(wait4(child, &status, 0, &used) == child);
    most_memory = (std::max)(most_memory, used.ru_maxrss);
    if (asked && counts.next % 50000 < batch)
      std::printf("%ld so far: %ld, %ld, %ld; %ld\n", counts.next, counts.refused_by_parser,
                  counts.refused_by_check, counts.valid, died);
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) continue;
    ++died;
    const Case c = make_case(counts.next++);
    std::ofstream(c.file.name, std::ios::binary) << c.content;
    std::printf("%s: %s %d\n", c.file.name.c_str(), WIFSIGNALED(status) ? "signal" : "exit",
                WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status));
  }
  std::printf(
      "%ld files: %ld refused by the parser, %ld by the check, %ld valid; %ld killed the reader; %ld MB at "
      "most\n",
      cases, counts.refused_by_parser, counts.refused_by_check, counts.valid, died, most_memory / 1024);
  CHECK(died == 0);
  CHECK(counts.unsound == 0);
  CHECK(counts.without_message == 0);
  CHECK(counts.not_finite == 0);
  // A few kB each. The sanitizers keep 256 MB of what was freed, and the test's own code is 100 MB with them.
  CHECK(most_memory / 1024 < 512);
  // Each stage has its work.
  CHECK(counts.refused_by_parser > cases / 20);
  CHECK(counts.refused_by_check > cases / 20);
  CHECK(counts.valid > cases / 20);
  munmap(shared, sizeof(Counts));
}
