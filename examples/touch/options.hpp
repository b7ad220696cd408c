// SPDX-License-Identifier: MIT
#pragma once

/// @file  Command line of the main example.

#include <cstdio>
#include <cstdlib>
#include <string>

#if __has_include(<unistd.h>)
#include <unistd.h>
#endif

#include "mesh_file.hpp"

namespace touch {

using S = double;
using V = palpate::Vec3<S>;

struct Options {
  std::string object = "ellipsoid";
  std::string tool = "mallet";
  std::string script = "figure10";
  std::string out = "out";
  std::string scene;          ///< empty: none; "all": one after the other
  std::string replay;         ///< a record of ticks to play again; empty: none
  std::string given;          ///< the options that make the scene, as they were given
  std::string shape;          ///< none, skeleton, half-space or response; empty: the default
  bool paper = false;         ///< the model as the paper has it
  double scale = 1;           ///< of mesh files
  char up = 'y';              ///< of mesh files
  bool deformed = false;      ///< contact is looked for on the shape as it is now, not on the undeformed one
  double sweep = 0;           ///< how deep a point may get on its way [m]; 0: as deep as it is taken
  double at_x = 0, at_z = 0;  ///< where the scripts work [m]
  double rate = 1000;         ///< [Hz]
  bool stepped = false;
  bool real_time = false;  ///< of a scene
  bool help = false;

  /// How to read the mesh file of this name.
  [[nodiscard]] MeshFile file(const std::string& name) const { return {name, scale, up}; }
};

inline constexpr const char* usage =
    R"(palpate_touch: a tool, held by a haptic device, presses and slides on an elastic object.

  (no option)     a mallet moves along an ellipsoid of silicone rubber; its response field gives the force
                  and the shape
  --paper         the model of the paper: its force law, and a beam skeleton for the shape. Alone, to
                  examples/run: --scene all

  --object NAME   ellipsoid (default), sphere, box, cube, cylinder, superellipsoid, heart, or FILE.obj, .ply,
                  .stl
  --tool NAME     mallet (default), head, tail, sphere, pin, block, compass, or FILE.obj, .ply, .stl
  --scale S       metres per unit of the files (default 1)
  --up AXIS       the files' axis that points up: x, y (default) or z
  --script NAME   figure10 (default), press, slide, both: press with both pins of the compass
  --at X Z        where press, slide and both work, in metres from the object's middle (default 0 0)
  --shape MODEL   how the object deforms: response (default; of files half-space), half-space, skeleton (with
                  --paper), or none. With response the force is the field's too; else the law of the paper
  --detect WHERE  undeformed (default): contact is found on the object's shape at rest; deformed: on the
                  shape of the last tick, worked out in the servo loop
  --sweep DEPTH   a fast tool is stopped where a point of it would get deeper than DEPTH, in metres, so that
                  it does not pass through thin parts: at most 0.4 of the thinnest. Stopped, it does not
                  slide. Default: not stopped
  --rate HZ       servo rate asked of the device (default 1000)
  --stepped       simulated time instead of real time: same bits in every run (stand-in device only)
  --out FOLDER    where the results go (default out)
  --replay FILE   plays the ticks of FILE, which a run with the same options has left in its folder, to the
                  same solver, and says whether all wrenches have the same bits (see examples/replay)

  --scene NAME    a preset of object, tool and script in out/NAME, with --paper out/paper/NAME, in simulated
                  time: ellipsoid (Fig. 10), cube-head and cube-tail (Fig. 11), heart (Fig. 12), or all
  --real-time     the scene at the device's own pace
)";

[[noreturn]] inline void refuse(const std::string& why) {
  std::fprintf(stderr, "palpate_touch: %s; --help lists the options\n", why.c_str());
  std::exit(2);
}

inline Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    const int first = i;
    const auto value = [&]() -> std::string {
      if (i + 1 >= argc) refuse(name + " needs a value");
      return argv[++i];
    };
    const auto number = [&] {
      const std::string text = value();
      char* end = nullptr;
      const double x = std::strtod(text.c_str(), &end);
      if (end == text.c_str() || *end != '\0' || !(x > 0)) refuse(name + " needs a number > 0, got " + text);
      return x;
    };
    const auto position = [&] {
      const std::string text = value();
      char* end = nullptr;
      const double x = std::strtod(text.c_str(), &end);
      if (end == text.c_str() || *end != '\0' || !(x > -1e3 && x < 1e3))
        refuse(name + " needs two numbers, got " + text);
      return x;
    };
    const auto where = [&](const std::string& text) {
      if (text != "deformed" && text != "undeformed")
        refuse(name + " needs deformed or undeformed, got " + text);
      return text == "deformed";
    };
    const auto axis = [&](const std::string& text) {
      if (text != "x" && text != "y" && text != "z") refuse(name + " needs x, y or z, got " + text);
      return text.front();
    };
    if (name == "--object")
      options.object = value();
    else if (name == "--tool")
      options.tool = value();
    else if (name == "--shape")
      options.shape = value();
    else if (name == "--up")
      options.up = axis(value());
    else if (name == "--detect")
      options.deformed = where(value());
    else if (name == "--sweep")
      options.sweep = number();
    else if (name == "--script")
      options.script = value();
    else if (name == "--at")
      options.at_x = position(), options.at_z = position();
    else if (name == "--out")
      options.out = value();
    else if (name == "--replay")
      options.replay = value();
    else if (name == "--scale")
      options.scale = number();
    else if (name == "--rate")
      options.rate = number();
    else if (name == "--paper")
      options.paper = true;
    else if (name == "--scene")
      options.scene = value();
    else if (name == "--stepped")
      options.stepped = true;
    else if (name == "--real-time")
      options.real_time = true;
    else if (name == "--help" || name == "-h")
      options.help = true;
    else
      refuse("unknown option " + name);
    if (name == "--out" || name == "--replay" || name == "--scene") continue;
    for (int k = first; k <= i; ++k) options.given += std::string(argv[k]) + ' ';
  }
  return options;
}

/// Is the output a terminal, so that a progress line can be written over and over?
[[nodiscard]] inline bool is_terminal() {
#if __has_include(<unistd.h>)
  return isatty(STDOUT_FILENO) != 0;
#else
  return false;
#endif
}

}  // namespace touch
