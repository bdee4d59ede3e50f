// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "doorforge/core/mass_properties.h"
#include "doorforge/core/rigid_transform.h"
#include "doorforge/core/triangle_mesh.h"

namespace doorforge {

struct UrdfMeshFile {
  std::string filename;  ///< It is as written; prefixes "package://" and "file://" are kept.
  Eigen::Vector3d scale{1, 1, 1};
  int line = 0;  ///< Where the file names it, from 1; 0 in a model that was not read from one.
};
struct UrdfBox {
  Eigen::Vector3d size_m;
};
struct UrdfCylinder {
  double radius_m;
  double length_m;  ///< Along z, centred.
};
struct UrdfSphere {
  double radius_m;
};
/// Triangles that lie in the model's own file, as USD and glTF have them; no URDF holds any.
struct UrdfTriangles {
  TriangleMesh mesh;
};
using UrdfGeometry = std::variant<UrdfMeshFile, UrdfBox, UrdfCylinder, UrdfSphere, UrdfTriangles>;

/// A `visual` or `collision` element.
struct UrdfShape {
  std::string name;
  RigidTransform link_from_shape = RigidTransform::Identity();
  UrdfGeometry geometry;
  std::optional<Eigen::Vector4d> color_rgba;
};

struct UrdfLink {
  std::string name;
  std::optional<MassProperties> inertial = std::nullopt;  ///< In the link's frame.
  std::vector<UrdfShape> visuals = {};
  std::vector<UrdfShape> collisions = {};
};

enum class UrdfJointType { kFixed, kRevolute, kContinuous, kPrismatic };

struct UrdfMimic {
  std::string joint;
  double multiplier = 1;
  double offset = 0;
};

struct UrdfJoint {
  std::string name;
  UrdfJointType type = UrdfJointType::kFixed;
  std::string parent;
  std::string child;
  RigidTransform parent_from_joint = RigidTransform::Identity();
  Eigen::Vector3d axis =
      Eigen::Vector3d::UnitX();  ///< It is as written and may have another length than 1.
  double lower = 0;              ///< [rad] or [m]
  double upper = 0;
  std::optional<double> effort;    ///< [N m] or [N]; absent where the file omits it.
  std::optional<double> velocity;  ///< [rad/s] or [m/s]
  double damping = 0;
  double friction = 0;
  std::optional<UrdfMimic> mimic;
};

/// A URDF robot description (http://wiki.ros.org/urdf/XML), links and joints in file order.
struct UrdfModel {
  std::string name;
  std::vector<UrdfLink> links;
  std::vector<UrdfJoint> joints;
  /// Whether MuJoCo is told to load the visuals, too. It takes no mesh whose faces disagree about
  /// what is outside.
  bool mujoco_reads_visuals = true;
  /// What an export of this project says of the door beyond the format: "latch_...", "door_...",
  /// "grasp_...", see door_words.h. ToUrdf() does not write it.
  std::map<std::string, std::string> words = {};
};

enum class UrdfFaultKind {
  kUnusable,  ///< What is there cannot be read: an attribute is missing or no finite number.
  kWrong,     ///< It can be read and cannot be meant: a negative mass, limits the wrong way round.
  kUnstated,  ///< The format asks for it and some readers do without: the effort of a limit.
};

/// One fault of a URDF.
struct UrdfFault {
  UrdfFaultKind kind = UrdfFaultKind::kUnusable;
  int line = 0;      ///< From 1.
  std::string text;  ///< The element and whose it is, what is there and what is allowed.
};

/// Parses a URDF. Lenient where the released data sets are (missing inertia, effort, velocity),
/// strict: a DOCTYPE, more than 64 levels, 16 MiB, 2000 links or 2000 joints, numbers that are not
/// finite, joints that name no link. Throws Error(kMissing, kIo or kFormat) with file and line; if
/// anything is kUnusable the message holds every fault of every kind.
UrdfModel ReadUrdf(const std::filesystem::path& path);
UrdfModel ParseUrdf(const std::string& text, const std::string& name);

/// Reads it likewise, with every fault added to `faults` in the order of the file's lines in place
/// of an error. The model is what could be read, and no more than that while anything is kUnusable.
/// Throws where nothing can be: no well-formed XML, no <robot>, more than the limits above.
UrdfModel ReadUrdf(const std::filesystem::path& path, std::vector<UrdfFault>& faults);
UrdfModel ParseUrdf(const std::string& text, const std::string& name,
                    std::vector<UrdfFault>& faults);

/// "FILE:LINE: TEXT" for one; for several a count and a line each, fifty at most.
std::string UrdfFaultsText(const std::string& name, const std::vector<UrdfFault>& faults);

/// Writes numbers with the shortest decimals that read back to the same double. Throws
/// Error(kInvalidArgument) on UrdfTriangles. The text carries
/// the `<mujoco>` element that lets MuJoCo find meshes in subfolders.
std::string ToUrdf(const UrdfModel& model);
/// Writes it without line breaks and indentation: a third smaller.
std::string ToCompactUrdf(const UrdfModel& model);

/// The one link that is no joint's child. Throws Error(kFormat) if there is none or more than one,
/// or if a link is reached twice.
std::string RootLinkOf(const UrdfModel& model);

}  // namespace doorforge
