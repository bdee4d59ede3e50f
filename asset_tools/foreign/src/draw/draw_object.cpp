// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "doorforge/core/error.h"
#include "doorforge/foreign/drawn_object.h"
#include "doorforge/mesh/work_budget.h"

#include "check/object_tree.h"
#include "draw/faulty_edges.h"
#include "draw/primitive_mesh.h"
#include "read/raw_mesh.h"
#include "run/read_object.h"

namespace doorforge::foreign {
namespace {

namespace fs = std::filesystem;

// The z axis up, of what stands on y.
RigidTransform UpFromFile(bool y_up) {
  RigidTransform up = RigidTransform::Identity();
  if (y_up)
    up.linear() =
        Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitX()).toRotationMatrix();
  return up;
}

TriangleMesh Scaled(TriangleMesh mesh, const Eigen::Vector3d& scale) {
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex = vertex.cwiseProduct(scale);
  if (scale.prod() < 0) {
    for (Eigen::Vector3i& t : mesh.triangles) std::swap(t[1], t[2]);
  }
  return mesh;
}

bool IsFinite(const TriangleMesh& mesh) {
  return std::all_of(mesh.vertices.begin(), mesh.vertices.end(),
                     [](const Eigen::Vector3d& vertex) { return vertex.allFinite(); });
}

/// The triangles of an object's shapes; each mesh file is read once.
class ShapeMeshes {
 public:
  ShapeMeshes(const MeshFiles::Places& places, std::vector<std::string>& left_out)
      : places_(places), left_out_(left_out) {}

  /// Empty, and said, where there are none.
  TriangleMesh Of(const ForeignShape& shape) {
    return std::visit([&](const auto& geometry) { return Of(shape, geometry); }, shape.geometry);
  }

 private:
  TriangleMesh Of(const ForeignShape& shape, const std::monostate&) {
    return LeaveOut(shape, "a kind of shape that is not drawn");
  }
  TriangleMesh Of(const ForeignShape&, const ForeignBox& box) { return BoxMesh(box.size_m); }
  TriangleMesh Of(const ForeignShape&, const ForeignSphere& sphere) {
    return SphereMesh(sphere.radius_m);
  }
  TriangleMesh Of(const ForeignShape&, const ForeignCylinder& cylinder) {
    return CylinderMesh(cylinder.radius_m, cylinder.length_m);
  }
  TriangleMesh Of(const ForeignShape& shape, const TriangleMesh& mesh) {
    return IsFinite(mesh) ? mesh : LeaveOut(shape, "coordinates that are not finite");
  }
  TriangleMesh Of(const ForeignShape& shape, const ForeignMeshFile& file) {
    const auto entry = known_.find(file.name);
    if (entry != known_.end()) return Scaled(entry->second, file.scale);
    TriangleMesh mesh = Read(shape, file.name);
    known_.emplace(file.name, mesh);
    return Scaled(std::move(mesh), file.scale);
  }

  TriangleMesh Read(const ForeignShape& shape, const std::string& name) {
    FaultList faults;
    const auto path = MeshFiles(places_, memory_).Find({name, shape.place, false}, faults);
    if (!path) return LeaveOut(shape, "the file \"" + name + "\" cannot be found");
    try {
      std::vector<ForeignFileName> others;
      TriangleMesh mesh = TrianglesOf(*path, places_.root, others);
      return IsFinite(mesh) ? mesh : LeaveOut(shape, "coordinates that are not finite");
    } catch (const RawMeshFault& fault) {
      return LeaveOut(shape, "\"" + name + "\": " + fault.what());
    } catch (const Error& error) {
      return LeaveOut(shape, error.what());
    }
  }

  TriangleMesh LeaveOut(const ForeignShape& shape, const std::string& why) {
    left_out_.push_back(WhereOf(shape.place) + ": not drawn: " + why);
    return {};
  }

  const MeshFiles::Places& places_;
  std::vector<std::string>& left_out_;
  MeshMemory memory_;
  std::map<std::string, TriangleMesh> known_;
};

/// Something of an object that a finding may be about, with the element that it was read from.
struct Placed {
  const SourcePlace* place = nullptr;
  std::optional<std::size_t> link = {};
  std::optional<std::size_t> joint = {};
  std::optional<std::size_t> shape = {};
  std::optional<Eigen::Vector3d> point_m = {};
};

bool IsAtOrBelow(const std::string& element, const std::string& above) {
  if (above.empty() || !element.starts_with(above)) return false;
  if (element.size() == above.size()) return true;
  const char next = element[above.size()];
  return next == '/' || next == '.' || next == '[';
}

class Drawing {
 public:
  Drawing(const ReadObject& read, const DrawSettings& settings)
      : read_(read), object_(read.object), tree_(object_), settings_(settings) {}

  DrawnObject Draw(std::span<const Finding> findings) {
    Links();
    Joints();
    Shapes();
    for (const Finding& finding : findings) drawn_.marks.push_back(MarkOf(finding));
    Coarsen();
    return std::move(drawn_);
  }

 private:
  void Links() {
    const RigidTransform up = UpFromFile(object_.y_up);
    for (std::size_t i = 0; i < object_.links.size(); ++i) {
      const ForeignLink& link = object_.links[i];
      RigidTransform world = up * tree_.world_from_link[i];
      if (!world.matrix().allFinite()) world = up;
      drawn_.links.push_back({link.name, world});
      Add({&link.place, i});
      if (!link.inertial) continue;
      const ForeignInertial& inertial = *link.inertial;
      std::optional<Eigen::Vector3d> center;
      if (inertial.center_m.allFinite()) center = inertial.center_m;
      for (const SourcePlace* place :
           {&inertial.place, &inertial.mass_place, &inertial.inertia_place}) {
        if (!(place->element == link.place.element && place->line == link.place.line))
          Add({place, i, {}, {}, center});
      }
    }
  }

  std::optional<std::size_t> NumberOf(const std::string& link) const {
    const auto found = tree_.link_of.find(link);
    return found == tree_.link_of.end() ? std::nullopt : std::optional(found->second);
  }

  void Joints() {
    for (const ForeignJoint& joint : object_.joints) {
      const auto child = NumberOf(joint.child);
      const auto parent = NumberOf(joint.parent);
      const bool drawable = child && joint.parent_from_joint.matrix().allFinite() &&
                            joint.child_from_joint.matrix().allFinite();
      if (!drawable) {
        Add({&joint.place, child ? child : parent});
        continue;
      }
      DrawnJoint shown{joint.name,
                       joint.type,
                       parent,
                       *child,
                       joint.parent_from_joint,
                       joint.child_from_joint,
                       joint.axis.value_or(Eigen::Vector3d::UnitX())};
      if (shown.axis.allFinite() && shown.axis.norm() > 1e-9)
        shown.axis.normalize();
      else
        shown.axis.setZero();
      Limits(joint, shown);
      const std::size_t number = drawn_.joints.size();
      drawn_.joints.push_back(shown);
      for (const SourcePlace* place : {&joint.place, &joint.axis_place, &joint.dynamics_place})
        Add({place, child, number});
      if (joint.limit) Add({&joint.limit->place, child, number});
    }
  }

  static void Limits(const ForeignJoint& joint, DrawnJoint& shown) {
    if (shown.axis.isZero(0)) return;
    const bool turns =
        joint.type == ForeignJointType::kRevolute || joint.type == ForeignJointType::kContinuous;
    if (!turns && joint.type != ForeignJointType::kPrismatic) return;
    if (turns) {
      shown.lower = -std::numbers::pi;
      shown.upper = std::numbers::pi;
    }
    if (!joint.limit || !joint.limit->lower || !joint.limit->upper) return;
    const double lower = *joint.limit->lower;
    const double upper = *joint.limit->upper;
    if (!std::isfinite(lower) || !std::isfinite(upper) || lower > upper) return;
    shown.lower = lower;
    shown.upper = upper;
  }

  void Shapes() {
    ShapeMeshes meshes(read_.places, drawn_.left_out);
    for (std::size_t i = 0; i < object_.links.size(); ++i) {
      for (const ForeignShape& shape : object_.links[i].shapes) {
        TriangleMesh mesh = meshes.Of(shape);
        const bool drawable = !mesh.triangles.empty() && shape.link_from_shape.matrix().allFinite();
        if (!drawable) {
          Add({&shape.place, i});
          continue;
        }
        Add({&shape.place, i, {}, drawn_.shapes.size()});
        drawn_.shapes.push_back({shape.name.empty() ? shape.place.element : shape.name, i,
                                 shape.use, shape.link_from_shape, std::move(mesh)});
      }
    }
  }

  void Add(const Placed& placed) { placed_.push_back(placed); }

  // The innermost element that the finding's lies in, of equal ones the nearest line above.
  const Placed* NearestTo(const FindingPlace& place) const {
    const Placed* best = nullptr;
    const auto better = [&](const Placed& one) {
      if (best == nullptr) return true;
      const std::size_t length = one.place->element.size();
      if (length != best->place->element.size()) return length > best->place->element.size();
      const bool above = one.place->line <= place.line;
      const bool best_above = best->place->line <= place.line;
      return above != best_above ? above : one.place->line > best->place->line;
    };
    for (const Placed& one : placed_) {
      if (one.place->file == place.file && IsAtOrBelow(place.element, one.place->element) &&
          better(one))
        best = &one;
    }
    return best;
  }

  FindingMark MarkOf(const Finding& finding) const {
    FindingMark mark;
    const Placed* placed = NearestTo(finding.place);
    // a mesh has one shape, which all is about
    const bool whole = placed == nullptr && object_.links.size() == 1 &&
                       drawn_.shapes.size() == 1 && object_.joints.empty();
    if (placed != nullptr) {
      mark.link = placed->link;
      mark.joint = placed->joint;
      mark.shape = placed->shape;
      mark.point_m = placed->point_m;
    } else if (whole) {
      mark.shape = 0;
      mark.link = 0;
    }
    if (mark.shape)
      mark.edges = FaultyEdges(drawn_.shapes[*mark.shape].mesh, finding.code, settings_.most_edges);
    return mark;
  }

  // Shares what may be drawn by how many triangles each shape has.
  void Coarsen() {
    std::size_t all = 0;
    for (const DrawnShape& shape : drawn_.shapes) all += shape.mesh.triangles.size();
    if (all <= settings_.most_triangles) return;
    const double share = static_cast<double>(settings_.most_triangles) / static_cast<double>(all);
    std::size_t kept = 0;
    for (DrawnShape& shape : drawn_.shapes) {
      const auto wanted =
          static_cast<std::size_t>(share * static_cast<double>(shape.mesh.triangles.size()));
      shape.mesh = Coarser(shape.mesh, std::max<std::size_t>(wanted, 12));
      kept += shape.mesh.triangles.size();
    }
    drawn_.left_out.push_back("drawn coarser: " + std::to_string(kept) + " of " +
                              std::to_string(all) + " triangles");
  }

  const ReadObject& read_;
  const ArticulatedObject& object_;
  ObjectTree tree_;
  DrawSettings settings_;
  std::vector<Placed> placed_;
  DrawnObject drawn_;
};

}  // namespace
}  // namespace doorforge::foreign

namespace doorforge {

DrawnObject DrawForeignFile(const ValidationReport& report, const ForeignChecks& checks,
                            const std::filesystem::path& searched, const DrawSettings& settings) {
  const WorkBudget budget(report.folder.string());
  DrawnObject nothing;
  nothing.marks.resize(report.findings.size());
  try {
    const foreign::ReadObject read = foreign::ReadObjectOf(report.folder, searched, checks);
    return foreign::Drawing(read, settings).Draw(report.findings);
  } catch (const std::exception&) {
    nothing.left_out.push_back(CurrentProblem(report.folder.string()));
    return nothing;
  }
}

}  // namespace doorforge
