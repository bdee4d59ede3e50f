// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "doorforge/core/triangle_mesh.h"
#include "doorforge/schemas/mesh_file.h"

namespace doorforge {

/// A prism over a plane polygon with a given triangulation, extruded along the third axis. The
/// polygon lies in the plane of axes (u, v), counter-clockwise seen from the end of u x v.
struct Profile {
  std::vector<Eigen::Vector2d> points;
  std::vector<Eigen::Vector3i> triangles;
};

inline TriangleMesh Prism(const Profile& profile, int u, int v, double low, double high) {
  const int w = 3 - u - v;
  const bool right_handed = (u + 1) % 3 == v;
  const int count = static_cast<int>(profile.points.size());
  TriangleMesh mesh;
  for (const double at : {low, high}) {
    for (const Eigen::Vector2d& point : profile.points) {
      Eigen::Vector3d vertex;
      vertex[u] = point.x();
      vertex[v] = point.y();
      vertex[w] = at;
      mesh.vertices.push_back(vertex);
    }
  }
  const auto add = [&](int a, int b, int c) {
    if (right_handed)
      mesh.triangles.emplace_back(a, b, c);
    else
      mesh.triangles.emplace_back(a, c, b);
  };
  for (const Eigen::Vector3i& t : profile.triangles) {
    add(t[0], t[2], t[1]);
    add(t[0] + count, t[1] + count, t[2] + count);
  }
  for (int i = 0; i < count; ++i) {
    const int next = (i + 1) % count;
    add(i, next, next + count);
    add(i, next + count, i + count);
  }
  return mesh;
}

inline Profile Rectangle(double u0, double u1, double v0, double v1) {
  return {{{u0, v0}, {u1, v0}, {u1, v1}, {u0, v1}}, {{0, 1, 2}, {0, 2, 3}}};
}

// Raw meshes in the frame of the released files: x along the door, front at -y, z up.

/// Jambs and head around an opening of 1.04 x 2.02.
inline TriangleMesh RawFrame() {
  const Profile u{{{-0.56, -1},
                   {-0.52, -1},
                   {-0.52, 1.02},
                   {0.52, 1.02},
                   {0.52, -1},
                   {0.56, -1},
                   {0.56, 1.06},
                   {-0.56, 1.06}},
                  {{0, 1, 2}, {0, 2, 7}, {2, 3, 6}, {2, 6, 7}, {3, 4, 5}, {3, 5, 6}}};
  return Prism(u, 0, 2, -0.05, 0.05);
}

/// 1.0 x 0.05 x 2.0, centred.
inline TriangleMesh RawBoard() { return Prism(Rectangle(-0.5, 0.5, -0.025, 0.025), 0, 1, -1, 1); }

/// A lever: neck 2 cm wide and 4 cm long, bar 13 cm towards -x, 1.5 cm deep, 1.8 cm high.
inline TriangleMesh RawLever() {
  const Profile l{
      {{-0.12, -0.055}, {0.01, -0.055}, {0.01, 0}, {-0.01, 0}, {-0.01, -0.04}, {-0.12, -0.04}},
      {{0, 1, 4}, {0, 4, 5}, {1, 2, 4}, {2, 3, 4}}};
  return Prism(l, 0, 1, -0.009, 0.009);
}

/// Numbers of the object that WriteSmallObject() writes.
struct SmallObject {
  double body_scale = 0.8;
  double handle_scale = 1.25;
  std::string frame_file = "texture_dae/frame.obj";
  std::string extra = {};  ///< Goes into the URDF before </robot>.
  std::string hinge_type = "revolute";
};

inline std::string MeshElement(const std::string& file, double scale) {
  const std::string s = std::to_string(scale);
  return "<geometry><mesh filename=\"" + file + "\" scale=\"" + s + " " + s + " " + s +
         "\"/></geometry>";
}

inline std::string SmallUrdf(const SmallObject& object) {
  const double s = object.body_scale;
  const auto number = [](double x) { return std::to_string(x); };
  const std::string to_board = number(0.5 * s) + " " + number(-1 * s) + " 0";
  const std::string hinge = number(-0.5 * s) + " " + number(1 * s) + " 0";
  const std::string mount =
      number(1.0 * s - 0.08) + " " + number(-(2.0 * s - 0.8)) + " " + number(0.025 * s);
  return "<?xml version=\"1.0\"?>\n<robot name=\"right-pull-door\"><link name=\"base\"/>"
         "<link name=\"link_0\"><visual name=\"f\"><origin xyz=\"0 0 0\"/>" +
         MeshElement(object.frame_file, s) +
         "</visual></link><joint name=\"joint_0\" type=\"fixed\"><origin "
         "rpy=\"1.570796326794897 0 -1.570796326794897\" xyz=\"0 0 0\"/><child link=\"link_0\"/>"
         "<parent link=\"base\"/></joint><link name=\"link_1\"><visual name=\"b\"><origin xyz=\"" +
         to_board + "\"/>" + MeshElement("texture_dae/board.obj", s) +
         "</visual></link><joint name=\"joint_1\" type=\"" + object.hinge_type +
         "\"><origin xyz=\"" + hinge +
         "\"/><axis xyz=\"0 -1 0\"/><child link=\"link_1\"/><parent link=\"link_0\"/>"
         "<limit lower=\"0\" upper=\"1.5079644737231006\"/></joint><link name=\"link_2\">"
         "<visual name=\"h\"><origin xyz=\"0 0 0\"/>" +
         MeshElement("texture_dae/9960003.obj", object.handle_scale) +
         "</visual></link><joint name=\"joint_2\" type=\"revolute\"><origin xyz=\"" + mount +
         "\"/><child link=\"link_2\"/><parent link=\"link_1\"/><axis xyz=\"0 0 1\"/>"
         "<limit lower=\"0\" upper=\"1.5079644737231006\"/></joint>" +
         object.extra + "</robot>\n";
}

inline void WriteText(const std::filesystem::path& path, const std::string& text) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path) << text;
}

/// A lever door in the format of the release, built in code.
inline void WriteSmallObject(const std::filesystem::path& folder, const SmallObject& object = {}) {
  const double s = object.body_scale;
  const double h = object.handle_scale;
  const auto box = [](double x0, double y0, double z0) {
    return "[" + std::to_string(x0) + ", " + std::to_string(y0) + ", " + std::to_string(z0) + "]";
  };
  WriteText(folder / "mobility.urdf", SmallUrdf(object));
  WriteText(folder / "bounding_box.json", "{\"min\": " + box(-0.56 * s, -0.05 * s, -s) +
                                              ", \"max\": " + box(0.56 * s, 0.05 * s, 1.06 * s) +
                                              "}");
  WriteText(folder / "handle_bounding.json",
            "{\"handle_min\": " + box(-0.12 * h, -0.055 * h, -0.009 * h) +
                ", \"handle_max\": " + box(0.01 * h, 0, 0.009 * h) +
                ", \"goal_pos\": " + box(-0.06 * h, 0, 0.0475 * h) + "}");
  WriteText(folder / "texture_dae/frame.obj", ToObj(RawFrame()));
  WriteText(folder / "texture_dae/board.obj", ToObj(RawBoard()));
  WriteText(folder / "texture_dae/9960003.obj", ToObj(RawLever()));
}

/// A folder of its own for the running test, empty.
inline std::filesystem::path TestFolder(const std::string& name) {
  const std::filesystem::path folder =
      std::filesystem::path(DOORFORGE_BINARY_DIR) / "test_output/door" / name;
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

inline void ExpectNear(const Eigen::Vector3d& found, const Eigen::Vector3d& expected,
                       double tolerance) {
  EXPECT_LT((found - expected).norm(), tolerance)
      << "found " << found.transpose() << ", expected " << expected.transpose();
}

}  // namespace doorforge
