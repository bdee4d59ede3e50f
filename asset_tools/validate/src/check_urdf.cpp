// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <set>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/inside_folder.h"
#include "doorforge/exporters/expected_urdf.h"
#include "doorforge/exporters/export_urdf.h"
#include "doorforge/parts/read_model.h"
#include "doorforge/schemas/mesh_pool.h"
#include "doorforge/schemas/urdf.h"

#include "findings.h"

namespace doorforge::internal {
namespace {

const char* const kFile = "model.urdf";

std::string LinkPath(const std::string& name) {
  return std::string(kFile) + ": /robot/link[@name=\"" + name + "\"]";
}

std::string JointPath(const std::string& name) {
  return std::string(kFile) + ": /robot/joint[@name=\"" + name + "\"]";
}

const char* TypeName(UrdfJointType type) {
  switch (type) {
    case UrdfJointType::kFixed:
      return "fixed";
    case UrdfJointType::kRevolute:
      return "revolute";
    case UrdfJointType::kContinuous:
      return "continuous";
    default:
      return "prismatic";
  }
}

template <class Element>
const Element* Named(const std::vector<Element>& elements, const std::string& name) {
  const auto found = std::find_if(elements.begin(), elements.end(),
                                  [&](const Element& element) { return element.name == name; });
  return found == elements.end() ? nullptr : &*found;
}

// Meshes of a link, visual ones marked.
std::set<std::string> MeshesOf(const UrdfLink& link) {
  std::set<std::string> files;
  const auto add = [&](const std::vector<UrdfShape>& shapes, const char* kind) {
    for (const UrdfShape& shape : shapes) {
      if (const auto* mesh = std::get_if<UrdfMeshFile>(&shape.geometry))
        files.insert(kind + mesh->filename);
      else
        files.insert(std::string(kind) + "a primitive");
    }
  };
  add(link.visuals, "visual ");
  add(link.collisions, "collision ");
  return files;
}

std::string Difference(const std::set<std::string>& has, const std::set<std::string>& lacks) {
  std::string text;
  for (const std::string& file : has) {
    if (!lacks.contains(file)) text += (text.empty() ? "" : ", ") + file;
  }
  return text;
}

std::set<std::string> FilesOf(const UrdfLink& link) {
  std::set<std::string> files;
  for (const auto* shapes : {&link.visuals, &link.collisions}) {
    for (const UrdfShape& shape : *shapes) {
      if (const auto* mesh = std::get_if<UrdfMeshFile>(&shape.geometry))
        files.insert(mesh->filename);
    }
  }
  return files;
}

Findings CheckMeshFiles(const UrdfLink& link, const UrdfLink& expected,
                        const std::filesystem::path& folder) {
  const std::set<std::string> recorded = FilesOf(expected);
  Findings findings;
  const auto check = [&](const std::vector<UrdfShape>& shapes, const char* kind) {
    for (const UrdfShape& shape : shapes) {
      const auto* mesh = std::get_if<UrdfMeshFile>(&shape.geometry);
      if (mesh == nullptr) continue;
      const std::string where = LinkPath(link.name) + "/" + kind + "/geometry/mesh";
      try {
        // the files of the record are checked by MSH: one fault, one finding
        if (!recorded.contains(mesh->filename)) FileInside(folder, mesh->filename, kFile);
      } catch (const Error&) {
        findings.push_back(Found("URD009", where, "\"" + mesh->filename + "\""));
      }
      if ((mesh->scale - Eigen::Vector3d::Ones()).cwiseAbs().maxCoeff() > 1e-9)
        findings.push_back(Found("URD010", where,
                                 Number(mesh->scale.x()) + " " + Number(mesh->scale.y()) + " " +
                                     Number(mesh->scale.z())));
    }
  };
  check(link.visuals, "visual");
  check(link.collisions, "collision");
  return findings;
}

double RelativeDifference(double a, double b) {
  const double scale = std::max({std::abs(a), std::abs(b), 1e-9});
  return std::abs(a - b) / scale;
}

Findings CheckInertial(const UrdfLink& link, const UrdfLink& expected) {
  const std::string where = LinkPath(link.name) + "/inertial";
  if (!link.inertial) return {Found("URD008", where, "absent")};
  const MassProperties& has = *link.inertial;
  const MassProperties& wants = *expected.inertial;
  const double mass = RelativeDifference(has.mass_kg, wants.mass_kg);
  const double inertia =
      (has.inertia_kg_m2 - wants.inertia_kg_m2).norm() / std::max(wants.inertia_kg_m2.norm(), 1e-9);
  const double center = (has.center_of_mass_m - wants.center_of_mass_m).norm();
  if (std::max({mass, inertia, center}) <= LimitOf("URD008")) return {};
  return {Found("URD008", where,
                "mass off by " + Number(mass) + ", inertia by " + Number(inertia) + ", centre by " +
                    Number(center) + " m")};
}

// True where a finding of CheckMeshFiles() is about the path of this file.
bool NamedBy(const Findings& findings, const std::string& file) {
  const std::string path = "\"" + file.substr(file.find(' ') + 1) + "\"";
  return std::any_of(findings.begin(), findings.end(), [&](const Finding& finding) {
    return finding.code == "URD009" && finding.measured == path;
  });
}

Findings CheckLink(const UrdfLink& link, const UrdfLink& expected,
                   const std::filesystem::path& folder) {
  Findings findings = CheckInertial(link, expected);
  const Findings files = CheckMeshFiles(link, expected, folder);
  findings.insert(findings.end(), files.begin(), files.end());
  std::set<std::string> has = MeshesOf(link);
  const std::set<std::string> wants = MeshesOf(expected);
  // URD009 has said so
  std::erase_if(has, [&](const std::string& file) { return NamedBy(files, file); });
  if (has != wants) {
    const std::string more = Difference(has, wants);
    const std::string less = Difference(wants, has);
    findings.push_back(Found("URD011", LinkPath(link.name),
                             (more.empty() ? "" : "has " + more) +
                                 (more.empty() || less.empty() ? "" : "; ") +
                                 (less.empty() ? "" : "lacks " + less)));
  }
  return findings;
}

Findings CheckMoving(const UrdfJoint& joint) {
  Findings findings;
  const std::string where = JointPath(joint.name);
  const double length = joint.axis.norm();
  if (std::abs(length - 1) > LimitOf("URD006"))
    findings.push_back(Found("URD006", where + "/axis", "length " + Number(length)));
  const bool limits =
      joint.lower <= joint.upper && joint.effort.value_or(0) > 0 && joint.velocity.value_or(0) > 0;
  if (!limits)
    findings.push_back(Found("URD007", where + "/limit",
                             Number(joint.lower) + " to " + Number(joint.upper) + ", effort " +
                                 (joint.effort ? Number(*joint.effort) : "absent") + ", velocity " +
                                 (joint.velocity ? Number(*joint.velocity) : "absent")));
  return findings;
}

// Largest difference of origin, axis and limits.
double Disagreement(const UrdfJoint& joint, const UrdfJoint& expected) {
  double worst = (joint.parent_from_joint.matrix() - expected.parent_from_joint.matrix()).norm();
  if (expected.type == UrdfJointType::kFixed) return worst;
  if (joint.axis.norm() > 0)
    worst = std::max(worst, (joint.axis.normalized() - expected.axis.normalized()).norm());
  worst = std::max(worst, std::abs(joint.lower - expected.lower));
  return std::max(worst, std::abs(joint.upper - expected.upper));
}

Findings CheckJoint(const UrdfJoint& joint, const UrdfJoint& expected) {
  const std::string where = JointPath(joint.name);
  if (joint.type != expected.type || joint.parent != expected.parent ||
      joint.child != expected.child)
    return {Found("URD004", where,
                  std::string(TypeName(joint.type)) + " from " + joint.parent + " to " +
                      joint.child + ", door.json says " + TypeName(expected.type) + " from " +
                      expected.parent + " to " + expected.child)};
  Findings findings;
  if (joint.type != UrdfJointType::kFixed) findings = CheckMoving(joint);
  const double disagreement = Disagreement(joint, expected);
  if (disagreement > LimitOf("URD005"))
    findings.push_back(Found("URD005", where, "differs by " + Number(disagreement)));
  return findings;
}

Findings CheckModel(const UrdfModel& model, const UrdfModel& expected,
                    const std::filesystem::path& folder) {
  Findings findings;
  const auto add = [&](const Findings& more) {
    findings.insert(findings.end(), more.begin(), more.end());
  };
  for (const UrdfLink& link : expected.links) {
    const UrdfLink* found = Named(model.links, link.name);
    add(found == nullptr ? Findings{Found("URD002", LinkPath(link.name), "absent")}
                         : CheckLink(*found, link, folder));
  }
  for (const UrdfLink& link : model.links) {
    if (Named(expected.links, link.name) == nullptr)
      add({Found("URD002", LinkPath(link.name), "not in door.json")});
  }
  try {
    RootLinkOf(model);
  } catch (const Error& error) {
    add({Found("URD003", std::string(kFile) + ": /robot", error.what())});
  }
  for (const UrdfJoint& joint : expected.joints) {
    const UrdfJoint* found = Named(model.joints, joint.name);
    add(found == nullptr ? Findings{Found("URD004", JointPath(joint.name), "absent")}
                         : CheckJoint(*found, joint));
  }
  return findings;
}

bool SharesMeshes(const DoorFiles& files) {
  return std::any_of(files.begin(), files.end(), [](const auto& link) {
    return !link.empty() && link.front().mesh.starts_with(std::string(kMeshPoolPath) + "/");
  });
}

// Whether the file has the bytes that `doorforge compose` writes for the door.
bool IsAsWritten(const std::filesystem::path& file, const UrdfModel& expected, bool shares) {
  constexpr std::uint64_t kMostBytes = 16ULL << 20U;
  return ReadFile(file, kMostBytes) == (shares ? ToCompactUrdf(expected) : ToUrdf(expected));
}

}  // namespace

UrdfModel ExpectedUrdf(const DoorAsset& door, const DoorFiles& files) {
  return SharesMeshes(files) ? ToUrdfModel(door, files) : ToUrdfModel(door);
}

Findings CheckUrdf(const DoorAsset& door, const DoorFiles& files,
                   const std::filesystem::path& folder) {
  try {
    const UrdfModel expected = ExpectedUrdf(door, files);
    // what this program would write itself needs no reading, and is what most folders have
    if (IsAsWritten(folder / kFile, expected, SharesMeshes(files)))
      return CheckModel(expected, expected, folder);
    std::vector<UrdfFault> faults;
    const UrdfModel model = ReadModelApart(folder / kFile, ModelFormat::kUrdf, faults);
    Findings unusable;
    for (const UrdfFault& fault : faults) {
      if (fault.kind == UrdfFaultKind::kUnusable)
        unusable.push_back(
            Found("URD001", std::string(kFile) + ":" + std::to_string(fault.line), fault.text));
    }
    if (!unusable.empty()) return unusable;
    return CheckModel(model, expected, folder);
  } catch (const Error& error) {
    return {Found("URD001", kFile, error.what())};
  }
}

}  // namespace doorforge::internal
