// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "doorforge/core/triangle_mesh.h"
#include "doorforge/schemas/mesh_file.h"

#include "small_object.h"

// Tiny objects in the formats of other data sets, written by the tests.

namespace doorforge {

inline TriangleMesh Box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  return Prism(Rectangle(low.x(), high.x(), low.y(), high.y()), 0, 1, low.z(), high.z());
}

inline std::string Numbers(const Eigen::Vector3d& v) {
  std::ostringstream text;
  text.precision(17);
  text << v.x() << ' ' << v.y() << ' ' << v.z();
  return text.str();
}

/// A link with one mesh at `offset`, its visual named `visual`.
inline std::string LinkText(const std::string& link, const std::string& visual,
                            const std::string& mesh, const Eigen::Vector3d& offset) {
  return "<link name=\"" + link + "\"><visual name=\"" + visual + "\"><origin xyz=\"" +
         Numbers(offset) + "\"/><geometry><mesh filename=\"" + mesh +
         "\"/></geometry></visual></link>\n";
}

struct JointText {
  std::string name;
  std::string type = "revolute";
  std::string parent;
  std::string child;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  std::string limit = {};  ///< Attributes, such as lower="0" upper="1".
  std::string rpy = {};
};

inline std::string TextOf(const JointText& joint) {
  std::string text = "<joint name=\"" + joint.name + "\" type=\"" + joint.type +
                     "\"><parent link=\"" + joint.parent + "\"/><child link=\"" + joint.child +
                     "\"/><origin xyz=\"" + Numbers(joint.origin) + "\"" +
                     (joint.rpy.empty() ? "" : " rpy=\"" + joint.rpy + "\"") + "/>";
  if (joint.axis.norm() > 0) text += "<axis xyz=\"" + Numbers(joint.axis) + "\"/>";
  if (!joint.limit.empty()) text += "<limit " + joint.limit + "/>";
  return text + "</joint>\n";
}

/// A cabinet in the layout of PartNet-Mobility: 1.0 wide, 2.0 high, 0.5 deep; link axes x along the
/// door, y up, z out. The leaf is 0.9 x 1.8 x 0.05 with its front at z = 0.25.
struct SmallCabinet {
  bool hinge_right = false;
  double ajar_rad = 0;           ///< Authored open by this much.
  std::string handle = "fixed";  ///< "fixed" (a visual), "knob" (a link), "none".
  std::string knob_type = "continuous";
  bool lid = false;  ///< The hinge's axis runs along the leaf's back: opening lifts it.
  std::string model_kind = "StorageFurniture";
};

inline std::string CabinetUrdf(const SmallCabinet& cabinet, const std::string& handle_link = "") {
  const double side = cabinet.hinge_right ? 1 : -1;
  const Eigen::Vector3d hinge =
      cabinet.lid ? Eigen::Vector3d(0, 1, -0.25) : Eigen::Vector3d(side * 0.45, 0, 0.225);
  const Eigen::Vector3d axis =
      cabinet.lid ? Eigen::Vector3d(-1, 0, 0) : Eigen::Vector3d(0, side, 0);
  std::ostringstream limit;
  limit.precision(17);
  limit << "lower=\"" << -cabinet.ajar_rad << "\" upper=\"" << 1.5 - cabinet.ajar_rad << "\"";
  std::string text = "<?xml version=\"1.0\"?>\n<robot name=\"partnet_x\">\n<link name=\"base\"/>\n";
  text += LinkText("link_1", "frame-1", "textured_objs/frame.obj", {0, 0, 0});
  text += TextOf({.name = "joint_1",
                  .type = "fixed",
                  .parent = "base",
                  .child = "link_1",
                  .rpy = "1.570796326794897 0 -1.570796326794897"});
  std::string leaf = LinkText("link_0", "door-2", "textured_objs/leaf.obj", -hinge);
  if (cabinet.handle == "fixed" && handle_link.empty())
    leaf.insert(leaf.find("</link>"),
                "<visual name=\"handle-3\"><origin xyz=\"" + Numbers(-hinge) +
                    "\"/><geometry><mesh filename=\"textured_objs/handle.obj\"/></geometry>"
                    "</visual>");
  text += leaf;
  text += TextOf({.name = "joint_0",
                  .parent = "link_1",
                  .child = "link_0",
                  .origin = hinge,
                  .axis = axis,
                  .limit = limit.str()});
  const Eigen::Vector3d knob = Eigen::Vector3d(-side * 0.38, 0.1, 0.25);
  if (cabinet.handle == "knob") {
    text += LinkText("link_2", "switch-4", "textured_objs/knob.obj", -knob);
    text += TextOf({.name = "joint_2",
                    .type = cabinet.knob_type,
                    .parent = "link_0",
                    .child = "link_2",
                    .origin = knob - hinge,
                    .axis = {0, 0, 1}});
  }
  if (!handle_link.empty()) {
    text += LinkText(handle_link, "handle-1", "textured_objs/handle.obj", -hinge);
    text += TextOf({.name = "joint_9", .type = "fixed", .parent = "link_0", .child = handle_link});
  }
  return text + "</robot>\n";
}

/// Turns a mesh about an upright (y) line through `point`.
inline TriangleMesh TurnedAboutY(TriangleMesh mesh, const Eigen::Vector3d& point, double angle) {
  const Eigen::AngleAxisd turn(angle, Eigen::Vector3d::UnitY());
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex = turn * (vertex - point) + point;
  return mesh;
}

inline void WriteSmallCabinet(const std::filesystem::path& folder,
                              const SmallCabinet& cabinet = {}) {
  const double side = cabinet.hinge_right ? 1 : -1;
  const Eigen::Vector3d hinge(side * 0.45, 0, 0.225);
  const auto write = [&](const std::string& name, const TriangleMesh& mesh, bool moves) {
    WriteText(folder / "textured_objs" / name,
              ToObj(moves ? TurnedAboutY(mesh, hinge, side * cabinet.ajar_rad) : mesh));
  };
  write("frame.obj", Box({-0.5, -1, -0.25}, {0.5, 1, 0.19}), false);
  if (cabinet.lid)
    write("leaf.obj", Box({-0.5, 1, -0.25}, {0.5, 1.05, 0.25}), false);
  else
    write("leaf.obj", Box({-0.45, -0.9, 0.2}, {0.45, 0.9, 0.25}), true);
  const double x = -side * 0.38;
  write("handle.obj", Box({x - 0.01, -0.2, 0.25}, {x + 0.01, 0.2, 0.3}), true);
  write("knob.obj", Box({x - 0.03, 0.07, 0.25}, {x + 0.03, 0.13, 0.32}), true);
  WriteText(folder / "mobility.urdf", CabinetUrdf(cabinet));
  WriteText(folder / "semantics.txt",
            "link_0 hinge rotation_door\nlink_1 heavy furniture_body\n" +
                std::string(cabinet.handle == "knob" ? "link_2 hinge knob\n" : ""));
  WriteText(folder / "meta.json", "{\"model_cat\": \"" + cabinet.model_kind + "\"}");
  WriteText(folder / "mobility_v2.json",
            "[{\"id\": 2, \"jointData\": {\"limit\": {\"a\": 0, \"b\": 0, \"noLimit\": true}}}]");
}

/// ASCII STL.
inline std::string ToStl(const TriangleMesh& mesh) {
  std::string text = "solid x\n";
  for (const Eigen::Vector3i& t : mesh.triangles) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (int k = 0; k < 3; ++k)
      text += "vertex " + Numbers(mesh.vertices[static_cast<std::size_t>(t[k])]) + "\n";
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid x\n";
}

/// Little-endian bytes of a number.
template <class T>
std::string Bytes(T number) {
  return std::string(reinterpret_cast<const char*>(&number), sizeof(number));
}

struct ZipEntry {
  std::string name;
  std::string content;
};

/// A ZIP archive of stored members, checksums left zero (no reader here looks at them).
inline std::string Zip(const std::vector<ZipEntry>& entries) {
  std::string bytes;
  std::string directory;
  for (const ZipEntry& entry : entries) {
    const auto size = static_cast<std::uint32_t>(entry.content.size());
    const std::string common = Bytes<std::uint16_t>(0) + Bytes<std::uint16_t>(0) +
                               Bytes<std::uint32_t>(0) + Bytes<std::uint32_t>(0) + Bytes(size) +
                               Bytes(size) + Bytes(static_cast<std::uint16_t>(entry.name.size())) +
                               Bytes<std::uint16_t>(0);
    const auto at = static_cast<std::uint32_t>(bytes.size());
    bytes += std::string("PK\x03\x04", 4) + Bytes<std::uint16_t>(0) + common + entry.name +
             entry.content;
    directory += std::string("PK\x01\x02", 4) + Bytes<std::uint16_t>(0) + Bytes<std::uint16_t>(0) +
                 common + Bytes<std::uint16_t>(0) + Bytes<std::uint16_t>(0) +
                 Bytes<std::uint16_t>(0) + Bytes<std::uint32_t>(0) + Bytes(at) + entry.name;
  }
  const auto start = static_cast<std::uint32_t>(bytes.size());
  const auto count = static_cast<std::uint16_t>(entries.size());
  return bytes + directory + std::string("PK\x05\x06", 4) + Bytes<std::uint16_t>(0) +
         Bytes<std::uint16_t>(0) + Bytes(count) + Bytes(count) +
         Bytes(static_cast<std::uint32_t>(directory.size())) + Bytes(start) +
         Bytes<std::uint16_t>(0);
}

/// What torch.save() writes for a float tensor of three elements: the pickle, opcode by opcode, is
/// that of PyTorch 1.13.
inline std::string TorchFile(float a, float b, float c) {
  using namespace std::string_literals;
  const std::string pickle = "\x80\x02"s + "ctorch._utils\n_rebuild_tensor_v2\nq\x00"s + "(("s +
                             "X\x07\x00\x00\x00storageq\x01"s + "ctorch\nFloatStorage\nq\x02"s +
                             "X\x01\x00\x00\x00"s + "0q\x03"s + "X\x03\x00\x00\x00"s + "cpuq\x04" +
                             "K\x03tq\x05Q"s + "K\x00K\x03\x85q\x06K\x01\x85q\x07\x89"s +
                             "ccollections\nOrderedDict\nq\x08)Rq\x09tq\x0aRq\x0b."s;
  return Zip({{"goal_pos/data.pkl", pickle},
              {"goal_pos/data/0", Bytes(a) + Bytes(b) + Bytes(c)},
              {"goal_pos/version", "3\n"}});
}

}  // namespace doorforge
