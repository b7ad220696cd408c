// SPDX-License-Identifier: MIT

// Mesh files that are wrong in one way each: the example's reader names what, where and how many; --repair
// mends the harmless ones.

#include "touch/mesh_file.hpp"

#include <support/meshes.hpp>

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <string>

using namespace palpate;

namespace {

const std::string corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n";
const std::string five = "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\n";
const std::string last = "f 4 1 5 8\n";

// What the reader says of a file, "" if it is sound.
std::string said(const std::string& content, bool repair = false, const std::string& name = "cube.obj") {
  const touch::MeshFile file{.name = name, .scale = 0.1, .up = 'z', .repair = repair};
  try {
    const MeshData<double> mesh = touch::parse_mesh(file, content);
    touch::check_mesh(file, mesh);
    CHECK(test::is_sound(mesh));
    return "";
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

void check_says(const std::string& content, std::initializer_list<const char*> what, bool mended,
                const std::string& name = "cube.obj") {
  const std::string text = said(content, false, name);
  INFO(text);
  CHECK(text.compare(0, name.size() + 2, name + ": ") == 0);
  for (const char* part : what) CHECK(text.find(part) != std::string::npos);
  CHECK((said(content, true, name).empty()) == mended);
}

std::string ply(const std::string& header, const std::string& body) {
  return "ply\nformat ascii 1.0\n" + header + "end_header\n" + body;
}
const std::string xyz = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
const std::string faces = "element face 4\nproperty list uchar int vertex_indices\n";
const std::string four = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n", sides = "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

}  // namespace

TEST_CASE("mesh files: a sound one is read, in metres and y up") {
  CHECK(said(corners + five + last) == "");
  const auto mesh = touch::parse_mesh({.name = "cube.obj", .scale = 0.1, .up = 'z'}, corners + five + last);
  CHECK(mesh.vertices.size() == 8);
  CHECK(mesh.triangles.size() == 12);
  Vec3<double> low = mesh.vertices[0], high = low;
  for (const auto& v : mesh.vertices) low = low.cwiseMin(v), high = high.cwiseMax(v);
  CHECK((low - Vec3<double>(0, 0, -0.1)).norm() < 1e-8);  // 0.1 times floats
  CHECK((high - Vec3<double>(0.1, 0.1, 0)).norm() < 1e-8);
}

TEST_CASE("mesh files: defects are named with number, place in the file's units and remedy") {
  check_says(corners + five, {"4 boundary edges", "fill the hole", "near (", "--repair"}, false);
  check_says(corners + five + "f 8 5 1 4\n", {"4 edges join triangles of opposite orientation", "turn"},
             true);
  check_says(corners + five + last + "v 2 0.5 0\nf 1 4 9\n",
             {"1 edges have more than two triangles", "near (0,"}, false);
  check_says(corners + five + last + "f 1 1 2\n", {"1 triangles name a vertex twice", "drop"}, true);
  check_says(corners + "v 0 0 1e-8\n" + five + "f 4 9 5 8\n", {"4 boundary edges"}, true);  // nearly doubled
  check_says(
      corners + "v 0.5 0 0\n" + five.substr(0, 20) + "f 1 9 6 5\nf 1 2 9\nf 9 2 6\n" + five.substr(30) + last,
      {"1 triangles have no area"}, false);
}

TEST_CASE("mesh files: what cannot be read says why") {
  check_says("", {"is empty"}, false);
  check_says(corners, {"has no triangles"}, false);
  check_says("v nan 0 0\n" + corners + "f 1 2 3\n", {"not finite: (nan, 0, 0)"}, false);
  check_says(corners + five + "f 4 1 5 80\n", {"out of range"}, false);
  // A U: no corner of it sees both ends.
  check_says("v 0 0 0\nv 3 0 0\nv 3 3 0\nv 2 3 0\nv 2 1 0\nv 1 1 0\nv 1 3 0\nv 0 3 0\nf 1 2 3 4 5 6 7 8\n",
             {"face 0 is not convex"}, false);
  check_says("x", {"must be .obj, .ply or .stl"}, false, "cube.fbx");
  CHECK_THROWS_WITH((void)touch::read_mesh({.name = "none.obj"}), "none.obj: there is no such file");
  const std::string folder = (std::filesystem::temp_directory_path() / "palpate_folder.obj").string();
  std::filesystem::create_directory(folder);
  CHECK_THROWS_WITH((void)touch::read_mesh({.name = folder}), (folder + ": is a folder").c_str());
  std::filesystem::remove(folder);
}

TEST_CASE("mesh files: PLY as its header says, and nothing else") {
  const auto check = [](const std::string& content, const char* what) {
    const std::string text = said(content, false, "body.ply");
    INFO(text);
    CHECK((what == std::string() ? text.empty() : text.find(what) != std::string::npos));
  };
  check(ply(xyz + faces, four + sides), "");
  check(ply("comment x\n" + xyz + "property uchar red\nelement edge 1\nproperty int v\n" + faces +
                "property int8 flag\n",
            "0 0 0 9\n1 0 0 9\n0 1 0 9\n0 0 1 9\n7\n3 0 2 1 0\n3 0 1 3 0\n3 0 3 2 0\n3 1 2 3 0\n"),
        "");
  std::string windows;
  for (const char c : ply(xyz + faces, four + sides))
    windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  check(windows, "");
  check(ply(xyz + faces, four + "3 0 2 1\n3 0 1 3\n3 0 3 2\n"), "face 3 of 4 has a number that is missing");
  check(ply(xyz + faces, four + "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 4\n"), "names vertex 4 of 4");
  check(ply(xyz + faces, four + "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 -3\n"), "face 3 of 4 has an index");
  check(ply(xyz + faces, "0 0 0 0\n" + sides), "vertex 0 of 4 has more on its line");
  check(ply("element vertex 4000000000\nproperty float x\n" + faces, ""),
        "declares 4000000000 of element vertex");
  check(ply(xyz + "element face 1\nproperty list uint int vertex_indices\n", four + "4000000000 0 1 2\n"),
        "is missing");
  check(ply(faces, sides), "no element vertex");
  check(ply("element vertex 4\nproperty float x\n" + faces, "0\n1\n2\n3\n" + sides), "without x, y and z");
}
