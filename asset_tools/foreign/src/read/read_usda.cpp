// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "doorforge/schemas/usda_text.h"

#include "read/raw_mesh.h"
#include "read/readers.h"

namespace doorforge::foreign {
namespace {

constexpr std::array<std::pair<std::string_view, ForeignJointType>, 6> kUsdJointTypes = {
    {{"PhysicsFixedJoint", ForeignJointType::kFixed},
     {"PhysicsRevoluteJoint", ForeignJointType::kRevolute},
     {"PhysicsPrismaticJoint", ForeignJointType::kPrismatic},
     {"PhysicsSphericalJoint", ForeignJointType::kOther},
     {"PhysicsDistanceJoint", ForeignJointType::kOther},
     {"PhysicsJoint", ForeignJointType::kOther}}};

class UsdaReader {
 public:
  UsdaReader(const UsdaStage& stage, std::string file, FaultList& faults)
      : stage_(stage), file_(std::move(file)), faults_(faults) {}

  ArticulatedObject Read() {
    object_.place = {file_, 1, 1, "/"};
    object_.y_up = true;  // where the stage does not say
    Header();
    for (const UsdaPrim& prim : stage_.prims) {
      if (!paths_.insert(prim.path).second)
        faults_.Add("TRE012", At(prim), "a second prim \"" + prim.path + '"');
    }
    for (const UsdaPrim& prim : stage_.prims) {
      Arcs(prim);
      if (prim.HasApi("PhysicsRigidBodyAPI")) Body(prim);
      Facts(prim);
    }
    for (const UsdaPrim& prim : stage_.prims) {
      for (const auto& [name, type] : kUsdJointTypes) {
        if (prim.type == name) Joint(prim, type);
      }
      if (prim.type == "Mesh") Shape(prim, MeshOf(prim));
      if (prim.type == "Cube") Shape(prim, Cube(prim));
      if (prim.type == "Sphere") Shape(prim, ForeignSphere{Length(prim, "radius", 1)});
      if (prim.type == "Cylinder" || prim.type == "Capsule")
        Shape(prim, ForeignCylinder{Length(prim, "radius", 1), Length(prim, "height", 2)});
    }
    return std::move(object_);
  }

 private:
  SourcePlace At(const UsdaPrim& prim) const { return {file_, prim.line, prim.column, prim.path}; }
  SourcePlace At(const UsdaPrim& prim, std::string_view name) const {
    const UsdaProperty* property = prim.Property(name);
    if (property == nullptr) return At(prim);
    return {file_, property->line, property->column, prim.path + "." + std::string(name)};
  }

  void Header() {
    std::string missing;
    bool unit = false;
    bool up = false;
    for (const UsdaProperty& entry : stage_.metadata) {
      if (entry.name == "metersPerUnit" && entry.value.numbers.size() != 1)
        faults_.Add("FIL006", {file_, entry.line, entry.column, entry.name}, "no number");
      if (entry.name == "metersPerUnit" && !entry.value.numbers.empty()) {
        unit = true;
        unit_m_ = entry.value.numbers[0];
      }
      if (entry.name == "upAxis") {
        up = true;
        object_.y_up = entry.value.texts.empty() || entry.value.texts[0] != "Z";
      }
      if (entry.name == "defaultPrim" && !entry.value.texts.empty())
        object_.stage.default_prim = entry.value.texts[0];
      for (const std::string& asset : entry.value.assets)
        object_.files.push_back({asset, {file_, entry.line, entry.column, entry.name}, false});
    }
    if (!unit) missing = "no metersPerUnit";
    if (!up) missing += missing.empty() ? "no upAxis" : ", no upAxis";
    object_.stage.unit_m = unit_m_;
    if (!missing.empty()) faults_.Add("USD002", object_.place, missing);
    if (unit && !(unit_m_ > 0)) {
      faults_.Add("FIL006", object_.place, "metersPerUnit " + Digits(unit_m_));
      unit_m_ = 1;
    }
  }

  void Facts(const UsdaPrim& prim) {
    StageFacts& stage = object_.stage;
    stage.articulations += prim.HasApi("PhysicsArticulationRootAPI") ? 1 : 0;
    for (const UsdaProperty& property : prim.properties) {
      if (property.name.starts_with("semantics:labels")) stage.labelled.insert(prim.path);
      if (property.name == "extent" && property.value.numbers.size() == 6)
        stage.with_extent.insert(prim.path);
    }
  }

  void Arcs(const UsdaPrim& prim) {
    for (const UsdaProperty& entry : prim.metadata) {
      const bool arc = entry.name == "references" || entry.name == "payload";
      for (const std::string& asset : entry.value.assets) {
        composed_ = true;
        object_.files.push_back({asset, {file_, entry.line, entry.column, prim.path}, !arc});
      }
      for (const std::string& path : entry.value.paths) Target(path, prim, entry);
    }
  }

  void Target(const std::string& path, const UsdaPrim& prim, const UsdaProperty& by) {
    if (composed_ || path.empty() || path.front() != '/') return;
    if (paths_.contains(path.substr(0, path.find('.')))) return;
    faults_.Add("USD001", {file_, by.line, by.column, prim.path + "." + by.name}, "<" + path + ">");
  }

  std::optional<std::vector<double>> Numbers(const UsdaPrim& prim, std::string_view name,
                                             std::size_t count) {
    const UsdaProperty* property = prim.Property(name);
    if (property == nullptr) return std::nullopt;
    const std::vector<double>& numbers = property->value.numbers;
    for (const double number : numbers) {
      // an infinite limit means none
      if (std::abs(number) >= 1e300) return std::nullopt;
    }
    if (numbers.size() == count) return numbers;
    faults_.Add("FIL006", At(prim, name),
                property->value.texts.empty()
                    ? std::to_string(numbers.size()) + " numbers, expected " + std::to_string(count)
                    : "\"" + property->value.texts[0] + '"');
    return std::nullopt;
  }

  std::optional<double> Number(const UsdaPrim& prim, std::string_view name) {
    const auto numbers = Numbers(prim, name, 1);
    return numbers ? std::optional(numbers->front()) : std::nullopt;
  }
  double Length(const UsdaPrim& prim, std::string_view name, double fallback) {
    return unit_m_ * Number(prim, name).value_or(fallback);
  }
  Eigen::Vector3d Vector(const UsdaPrim& prim, std::string_view name,
                         const Eigen::Vector3d& fallback) {
    const auto numbers = Numbers(prim, name, 3);
    return numbers ? Eigen::Vector3d((*numbers)[0], (*numbers)[1], (*numbers)[2]) : fallback;
  }
  Eigen::Matrix3d Turn(const UsdaPrim& prim, std::string_view name) {
    const auto q = Numbers(prim, name, 4);
    if (!q) return Eigen::Matrix3d::Identity();
    const Eigen::Quaterniond turn((*q)[0], (*q)[1], (*q)[2], (*q)[3]);
    if (turn.norm() > 1e-9) return turn.normalized().toRotationMatrix();
    // (0, 0, 0, 0) is the schema's word for "not stated" of principal axes
    if (name != "physics:principalAxes")
      faults_.Add("FIL006", At(prim, name), "a quaternion of length 0");
    return Eigen::Matrix3d::Identity();
  }

  void Body(const UsdaPrim& prim) {
    ForeignLink link;
    link.name = prim.path;
    link.place = At(prim);
    link_of_[prim.path] = object_.links.size();
    const auto mass = Number(prim, "physics:mass");
    // 0 stands for "not stated"
    if (mass && *mass != 0) {
      ForeignInertial inertial;
      inertial.mass_kg = *mass;
      inertial.place = At(prim);
      inertial.mass_place = At(prim, "physics:mass");
      inertial.inertia_place = At(prim, "physics:diagonalInertia");
      inertial.center_m = unit_m_ * Vector(prim, "physics:centerOfMass", Eigen::Vector3d::Zero());
      const Eigen::Vector3d diagonal =
          Vector(prim, "physics:diagonalInertia", Eigen::Vector3d::Zero());
      const Eigen::Matrix3d turn = Turn(prim, "physics:principalAxes");
      if (!diagonal.isZero(0))
        inertial.inertia_kg_m2 =
            turn * diagonal.asDiagonal() * turn.transpose() * unit_m_ * unit_m_;
      link.inertial = inertial;
    }
    object_.links.push_back(std::move(link));
  }

  // The body that a relationship of a joint names; empty for the world.
  std::string End(const UsdaPrim& joint, std::string_view name) {
    const UsdaProperty* relation = joint.Property(name);
    if (relation == nullptr || relation->value.paths.empty()) return {};
    std::string path = relation->value.paths.front();
    if (!paths_.contains(path)) {
      if (!composed_) faults_.Add("USD001", At(joint, name), "<" + path + ">");
      return {};
    }
    while (!path.empty() && !link_of_.contains(path)) path = path.substr(0, path.rfind('/'));
    return path;
  }

  void Joint(const UsdaPrim& prim, ForeignJointType type) {
    ForeignJoint joint;
    joint.name = prim.path;
    joint.type = type;
    joint.place = joint.dynamics_place = At(prim);
    joint.axis_place = At(prim, "physics:axis");
    joint.parent = End(prim, "physics:body0");
    joint.child = End(prim, "physics:body1");
    if (prim.Property("physics:body0") == nullptr && prim.Property("physics:body1") == nullptr)
      faults_.Add("FIL007", At(prim), "neither physics:body0 nor physics:body1");
    const auto frame = [&](const char* position, const char* turn) {
      RigidTransform at = RigidTransform::Identity();
      at.translation() = unit_m_ * Vector(prim, position, Eigen::Vector3d::Zero());
      at.linear() = Turn(prim, turn);
      return at;
    };
    joint.parent_from_joint = frame("physics:localPos0", "physics:localRot0");
    joint.child_from_joint = frame("physics:localPos1", "physics:localRot1");
    ReadAxis(prim, joint);
    const bool turns = type == ForeignJointType::kRevolute;
    const double unit = turns ? std::numbers::pi / 180 : unit_m_;
    const auto lower = Number(prim, "physics:lowerLimit");
    const auto upper = Number(prim, "physics:upperLimit");
    if (lower && upper)
      joint.limit = {*lower * unit, *upper * unit, {}, {}, At(prim, "physics:lowerLimit")};
    // a joint of the world alone holds a body that is there before it
    if (joint.child.empty()) std::swap(joint.parent, joint.child);
    if (!joint.child.empty()) object_.joints.push_back(joint);
  }

  void ReadAxis(const UsdaPrim& prim, ForeignJoint& joint) {
    joint.axis = Eigen::Vector3d::UnitX();
    const UsdaProperty* axis = prim.Property("physics:axis");
    if (axis == nullptr || axis->value.texts.empty()) return;
    const std::string& word = axis->value.texts.front();
    if (word == "Y") joint.axis = Eigen::Vector3d::UnitY();
    if (word == "Z") joint.axis = Eigen::Vector3d::UnitZ();
    if (word != "X" && word != "Y" && word != "Z")
      faults_.Add("FIL008", joint.axis_place, "\"" + word + "\", expected X, Y or Z");
  }

  ForeignGeometry Cube(const UsdaPrim& prim) {
    return ForeignBox{Eigen::Vector3d::Constant(Length(prim, "size", 2))};
  }

  ForeignGeometry MeshOf(const UsdaPrim& prim) {
    const UsdaProperty* points = prim.Property("points");
    const UsdaProperty* counts = prim.Property("faceVertexCounts");
    const UsdaProperty* indices = prim.Property("faceVertexIndices");
    if (points == nullptr || counts == nullptr || indices == nullptr) {
      if (!composed_ && prim.defined)
        faults_.Add("FIL007", At(prim), "no points, faceVertexCounts or faceVertexIndices");
      return {};
    }
    const auto fail = [&](const char* name, const std::string& problem) {
      faults_.Add("USD003", At(prim, name), problem);
      return ForeignGeometry();
    };
    TriangleMesh mesh;
    const std::vector<double>& numbers = points->value.numbers;
    if (numbers.size() % 3 != 0 || !points->value.texts.empty())
      return fail("points", "something that is no point");
    for (std::size_t i = 0; i < numbers.size(); i += 3) {
      mesh.vertices.emplace_back(unit_m_ * numbers[i], unit_m_ * numbers[i + 1],
                                 unit_m_ * numbers[i + 2]);
      if (!(mesh.vertices.back().cwiseAbs().maxCoeff() < 1e100))
        return fail("points", "point " + std::to_string(i / 3) + " is not finite");
    }
    std::size_t at = 0;
    std::vector<int> corners;
    for (const double count : counts->value.numbers) {
      if (!(count >= 3) || count > 10'000)
        return fail("faceVertexCounts", Digits(count) + " corners");
      corners.clear();
      for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k, ++at) {
        if (at >= indices->value.numbers.size())
          return fail("faceVertexIndices", std::to_string(indices->value.numbers.size()) +
                                               " indices, the counts ask for more");
        const double index = indices->value.numbers[at];
        if (!(index >= 0 && index < static_cast<double>(mesh.vertices.size())))
          return fail("faceVertexIndices",
                      "vertex " + Digits(index) + " of " + std::to_string(mesh.vertices.size()));
        corners.push_back(static_cast<int>(index));
      }
      AddFace(corners, counts->line, mesh);
    }
    if (at != indices->value.numbers.size())
      return fail("faceVertexIndices", std::to_string(indices->value.numbers.size()) +
                                           " indices, the counts sum to " + std::to_string(at));
    if (mesh.triangles.empty()) return fail("faceVertexCounts", "no face");
    return mesh;
  }

  // On the nearest body above; what hangs on none is of the world and is measured as such.
  void Shape(const UsdaPrim& prim, ForeignGeometry geometry) {
    ForeignShape shape;
    shape.name = prim.path;
    shape.place = At(prim);
    shape.geometry = std::move(geometry);
    shape.use = prim.HasApi("PhysicsCollisionAPI") ? ShapeUse::kCollision : ShapeUse::kVisual;
    shape.as_hull = CollidesAsHull(prim);
    const UsdaPrim* at = &prim;
    while (at != nullptr && !link_of_.contains(at->path)) {
      shape.link_from_shape = Local(*at) * shape.link_from_shape;
      at = at->parent;
    }
    if (at != nullptr) {
      object_.links[link_of_[at->path]].shapes.push_back(std::move(shape));
      return;
    }
    if (!world_) {
      world_ = object_.links.size();
      object_.links.push_back({"world", {}, {}, object_.place});
    }
    object_.links[*world_].shapes.push_back(std::move(shape));
  }

  // What is replaced by its convex hull, or by several.
  static bool CollidesAsHull(const UsdaPrim& prim) {
    if (!prim.HasApi("PhysicsCollisionAPI")) return false;
    const UsdaProperty* how = prim.Property("physics:approximation");
    return how != nullptr && !how->value.texts.empty() && how->value.texts[0] != "none" &&
           how->value.texts[0] != "sdf";
  }

  RigidTransform Local(const UsdaPrim& prim) {
    RigidTransform local = RigidTransform::Identity();
    const UsdaProperty* order = prim.Property("xformOpOrder");
    if (order == nullptr) return local;
    for (const std::string& op : order->value.texts) {
      if (op.starts_with("xformOp:translate"))
        local.translate(unit_m_ * Vector(prim, op, Eigen::Vector3d::Zero()));
      if (op.starts_with("xformOp:orient")) local.rotate(Eigen::Matrix3d(Turn(prim, op)));
      if (op.starts_with("xformOp:rotateXYZ")) {
        const Eigen::Vector3d angles =
            Vector(prim, op, Eigen::Vector3d::Zero()) * std::numbers::pi / 180;
        local.rotate(FromXyzRpy(Eigen::Vector3d::Zero(), angles).linear());
      }
    }
    return local;
  }

  const UsdaStage& stage_;
  std::string file_;
  FaultList& faults_;
  double unit_m_ = 0.01;
  bool composed_ = false;
  std::set<std::string> paths_;
  std::map<std::string, std::size_t> link_of_;
  std::optional<std::size_t> world_;
  ArticulatedObject object_;
};

}  // namespace

ArticulatedObject ReadForeignUsda(std::string_view text, const std::string& file,
                                  FaultList& faults) {
  try {
    return UsdaReader(ParseUsda(text), file, faults).Read();
  } catch (const UsdaFault& fault) {
    faults.Add(fault.limit ? "FIL003" : "FIL002", {file, fault.line, fault.column, ""},
               fault.what());
    return {};
  }
}

}  // namespace doorforge::foreign
