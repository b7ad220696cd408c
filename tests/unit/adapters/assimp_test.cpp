// SPDX-License-Identifier: MIT

#include <palpate/adapters/assimp.hpp>
#include <palpate/geometry/triangle_mesh.hpp>

#include <support/check.hpp>
#include <support/response_meshes.hpp>

#include <doctest/doctest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

using namespace palpate;

namespace {
using V = Vec3<double>;

/// A file of the name's format with this text, for as long as it is there.
class TemporaryFile {
 public:
  TemporaryFile(const char* name, const std::string& text)
      : name_((std::filesystem::temp_directory_path() / name).string()) {
    std::ofstream(name_, std::ios::binary) << text;
  }
  ~TemporaryFile() { std::remove(name_.c_str()); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  [[nodiscard]] const std::string& name() const noexcept { return name_; }

 private:
  std::string name_;
};

// A cube of 2 cm on (0, 0, 0) of six squares, in two groups, with vertices of its own for the lid, as texture
// coordinates make them, and a line.
const std::string cube = R"(o base
v 0 0 0
v 2 0 0
v 2 2 0
v 0 2 0
v 0 0 2
v 2 0 2
v 2 2 2
v 0 2 2
v 0 0 2
v 2 0 2
v 2 2 2
v 0 2 2
f 4 3 2 1
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
l 1 3
o lid
f 9 10 11 12
)";

std::string error(const std::string& name, const ReadMeshParams& params = {}) {
  try {
    (void)read_mesh(name, params);
    return "";
  } catch (const SetupError& e) {
    return e.what();
  }
}
bool holds(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }
}  // namespace

TEST_CASE("read_mesh: groups, polygons and doubled vertices become one closed mesh, in metres and y up") {
  const TemporaryFile file("palpate_cube.obj", cube);
  const MeshData<double> mesh = read_mesh(file.name(), {.scale = 0.01, .up = 'z'});
  CHECK(mesh.vertices.size() == 8);
  CHECK(mesh.triangles.size() == 12);
  const TriangleMesh<double> checked(mesh);
  CHECK_RELATIVE(checked.volume(), 8e-6, 1e-12);
  CHECK(checked.lower() == V(0, 0, -0.02));  // the file's y went to -z
  CHECK(checked.upper() == V(0.02, 0.02, 0));
  CHECK(TriangleMesh<double>(read_mesh(file.name(), {.up = 'x'})).lower() == V(-2, 0, 0));
}

TEST_CASE("read_mesh: STL, which has no shared vertices at all") {
  const MeshData<double> box = test::box_mesh(V(1, 2, 3), 2);
  std::string text = "solid box\n";
  for (const auto& t : box.triangles) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const auto v : t) {
      char line[100];
      std::snprintf(line, sizeof line, "vertex %g %g %g\n", box.vertices[v].x(), box.vertices[v].y(),
                    box.vertices[v].z());
      text += line;
    }
    text += "endloop\nendfacet\n";
  }
  const TemporaryFile file("palpate_box.stl", text + "endsolid box\n");
  const MeshData<double> mesh = read_mesh(file.name());
  CHECK(mesh.vertices.size() == box.vertices.size());
  CHECK(mesh.triangles.size() == box.triangles.size());
  CHECK_RELATIVE(TriangleMesh<double>(mesh).volume(), 6.0, 1e-12);
}

TEST_CASE("read_mesh: what is wrong is said with the file's name and where") {
  CHECK(holds(error("/no/such/file.obj"), "read_mesh: /no/such/file.obj: "));
  CHECK(holds(error("palpate.obj", {.scale = 0}), "scale [m] must be > 0"));
  CHECK(holds(error("palpate.obj", {.up = 'w'}), "up must be"));
  const TemporaryFile open("palpate_open.obj", cube.substr(0, cube.find("f 4 1 5 8")));
  const std::string text = error(open.name(), {.scale = 0.01});
  INFO(text);
  CHECK(holds(text, "palpate_open.obj: not closed: "));
  CHECK(holds(text, "; near ("));
  const TemporaryFile none("palpate_none.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n");
  CHECK(!error(none.name()).empty());
}
