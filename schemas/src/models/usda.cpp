// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/usda.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <deque>
#include <map>
#include <numbers>
#include <set>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/schemas/usda_text.h"

#include "models/model_xml.h"

namespace doorforge {
namespace {

constexpr std::uint64_t kMostUsdaBytes = 64ULL << 20U;  // meshes lie in the text
constexpr double kDegree = std::numbers::pi / 180;
constexpr double kUnlimited = 1e30;
constexpr const char* kWorld = "world";

std::string UsdaWordOf(double number) {
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, number + 0.0).ptr};
}

// unlockAngleRad is unlock_angle_rad.
std::string SnakeCase(const std::string& name) {
  std::string words;
  for (const char c : name) {
    if (std::isupper(static_cast<unsigned char>(c)) != 0) words += '_';
    words += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return words;
}

bool IsRigid(const Eigen::Affine3d& transform) {
  const Eigen::Matrix3d& m = transform.linear();
  return transform.matrix().allFinite() &&
         (m * m.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < 1e-5 &&
         m.determinant() > 0;
}

RigidTransform RigidOf(const Eigen::Affine3d& transform) {
  RigidTransform rigid = RigidTransform::Identity();
  rigid.linear() = Eigen::Quaterniond(transform.linear()).normalized().toRotationMatrix();
  rigid.translation() = transform.translation();
  return rigid;
}

TriangleMesh CubeOf(double size) {
  TriangleMesh mesh;
  for (int corner = 0; corner < 8; ++corner)
    mesh.vertices.emplace_back((corner & 1 ? 0.5 : -0.5) * size, (corner & 2 ? 0.5 : -0.5) * size,
                               (corner & 4 ? 0.5 : -0.5) * size);
  const int quads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                           {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& q : quads) {
    mesh.triangles.emplace_back(q[0], q[1], q[2]);
    mesh.triangles.emplace_back(q[0], q[2], q[3]);
  }
  return mesh;
}

/// A body on its way to a link: what it is called, where it stands, and by how much its frame moves
/// to lie on the axis of the joint that carries it.
struct UsdBody {
  const UsdaPrim* prim = nullptr;
  std::string name;
  RigidTransform world_from_body = RigidTransform::Identity();
  RigidTransform body_from_link = RigidTransform::Identity();
  UrdfLink link;
  bool is_child = false;
};

/// The end of a joint: a body, or the world where there is none.
struct UsdEnd {
  UsdBody* body = nullptr;
  RigidTransform body_from_joint = RigidTransform::Identity();
};

class UsdaModelReader {
 public:
  UsdaModelReader(const UsdaStage& stage, std::vector<UrdfFault>& faults)
      : stage_(stage), faults_(faults) {}

  UrdfModel Read() {
    Header();
    for (const UsdaPrim& prim : stage_.prims) {
      prim_of_.emplace(prim.path, &prim);
      RefuseArcs(prim);
    }
    FindBodies();
    for (const UsdaPrim& prim : stage_.prims) {
      if (IsJoint(prim)) AddJoint(prim);
    }
    for (const UsdaPrim& prim : stage_.prims) AddShape(prim);
    return Assembled();
  }

 private:
  void Fail(const UsdaPrim& prim, const std::string& problem,
            UrdfFaultKind kind = UrdfFaultKind::kUnusable) {
    faults_.push_back({kind, prim.line, "<" + prim.path + ">: " + problem});
  }

  void Header() {
    for (const UsdaProperty& entry : stage_.metadata) {
      if (entry.name == "metersPerUnit" && entry.value.numbers.size() == 1)
        unit_m_ = entry.value.numbers[0];
      if (entry.name == "upAxis" && entry.value.texts.size() == 1)
        y_up_ = entry.value.texts[0] != "Z";
      if (entry.name == "defaultPrim" && entry.value.texts.size() == 1)
        model_.name = entry.value.texts[0];
      if (entry.name == "subLayers")
        faults_.push_back({UrdfFaultKind::kUnusable, entry.line,
                           "subLayers: other layers are not read; "
                           "flatten the stage (usdcat --flatten)"});
    }
    if (!(unit_m_ > 0) || !(unit_m_ < 1e6)) {
      faults_.push_back(
          {UrdfFaultKind::kUnusable, 1, "metersPerUnit: allowed are numbers above 0"});
      unit_m_ = 1;
    }
  }

  void RefuseArcs(const UsdaPrim& prim) {
    for (const UsdaProperty& entry : prim.metadata) {
      const bool arc = entry.name == "references" || entry.name == "payload" ||
                       entry.name == "inherits" || entry.name == "specializes";
      if (arc)
        Fail(prim, entry.name +
                       ": what it brings is not read; flatten the stage (usdcat "
                       "--flatten)");
    }
  }

  std::optional<std::vector<double>> Numbers(const UsdaPrim& prim, std::string_view name,
                                             std::size_t count) {
    const UsdaProperty* property = prim.Property(name);
    if (property == nullptr || property->value.numbers.empty()) return std::nullopt;
    bool finite = true;
    for (const double number : property->value.numbers) finite = finite && std::isfinite(number);
    if (property->value.numbers.size() == count && finite) return property->value.numbers;
    Fail(prim, std::string(name) + ": expected " + std::to_string(count) + " finite numbers");
    return std::nullopt;
  }
  std::optional<double> Number(const UsdaPrim& prim, std::string_view name) {
    const UsdaProperty* property = prim.Property(name);
    // an infinite limit means none
    if (property != nullptr && property->value.numbers.size() == 1 &&
        !(std::abs(property->value.numbers[0]) < kUnlimited))
      return std::nullopt;
    const auto numbers = Numbers(prim, name, 1);
    return numbers ? std::optional(numbers->front()) : std::nullopt;
  }
  Eigen::Vector3d Vector(const UsdaPrim& prim, std::string_view name,
                         const Eigen::Vector3d& fallback) {
    const auto n = Numbers(prim, name, 3);
    return n ? Eigen::Vector3d((*n)[0], (*n)[1], (*n)[2]) : fallback;
  }
  Eigen::Matrix3d Turn(const UsdaPrim& prim, std::string_view name) {
    const auto q = Numbers(prim, name, 4);
    if (!q) return Eigen::Matrix3d::Identity();
    const Eigen::Quaterniond turn((*q)[0], (*q)[1], (*q)[2], (*q)[3]);
    // (0, 0, 0, 0) is the schema's word for "not stated" of principal axes
    if (!(turn.norm() > 1e-9)) return Eigen::Matrix3d::Identity();
    return turn.normalized().toRotationMatrix();
  }

  Eigen::Affine3d MatrixOf(const UsdaPrim& prim, const std::string& op) {
    Eigen::Affine3d matrix = Eigen::Affine3d::Identity();
    const auto n = Numbers(prim, op, 16);
    if (!n) return matrix;
    // rows of USD are columns here
    matrix.matrix() = Eigen::Map<const Eigen::Matrix4d>(n->data());
    matrix.translation() *= unit_m_;
    return matrix;
  }

  Eigen::Affine3d OpOf(const UsdaPrim& prim, const std::string& op) {
    const auto about = [&](const Eigen::Vector3d& axis) {
      return Eigen::Affine3d(Eigen::AngleAxisd(Number(prim, op).value_or(0) * kDegree, axis));
    };
    const Eigen::Vector3d none = Eigen::Vector3d::Zero();
    if (op.starts_with("xformOp:translate"))
      return Eigen::Affine3d(Eigen::Translation3d(unit_m_ * Vector(prim, op, none)));
    if (op.starts_with("xformOp:orient")) return Eigen::Affine3d(Turn(prim, op));
    if (op.starts_with("xformOp:scale"))
      return Eigen::Affine3d(Eigen::Scaling(Vector(prim, op, Eigen::Vector3d::Ones())));
    if (op.starts_with("xformOp:transform")) return MatrixOf(prim, op);
    if (op.starts_with("xformOp:rotateXYZ"))
      return Eigen::Affine3d(FromXyzRpy(none, Vector(prim, op, none) * kDegree).matrix());
    if (op == "xformOp:rotateX") return about(Eigen::Vector3d::UnitX());
    if (op == "xformOp:rotateY") return about(Eigen::Vector3d::UnitY());
    if (op == "xformOp:rotateZ") return about(Eigen::Vector3d::UnitZ());
    Fail(prim, "\"" + op + "\" in xformOpOrder is not read");
    return Eigen::Affine3d::Identity();
  }

  Eigen::Affine3d LocalOf(const UsdaPrim& prim) {
    Eigen::Affine3d local = Eigen::Affine3d::Identity();
    const UsdaProperty* order = prim.Property("xformOpOrder");
    if (order == nullptr) return local;
    for (const std::string& op : order->value.texts) local = local * OpOf(prim, op);
    return local;
  }

  // Each prim once, parents first.
  const Eigen::Affine3d& WorldOf(const UsdaPrim& prim) {
    const auto known = worlds_.find(&prim);
    if (known != worlds_.end()) return known->second;
    Eigen::Affine3d above = Eigen::Affine3d::Identity();
    if (prim.parent != nullptr) above = WorldOf(*prim.parent);
    return worlds_.emplace(&prim, above * LocalOf(prim)).first->second;
  }

  // ---- bodies
  void FindBodies() {
    std::map<std::string, int> names;
    for (const UsdaPrim& prim : stage_.prims) {
      if (prim.defined && prim.HasApi("PhysicsRigidBodyAPI")) ++names[prim.name];
    }
    for (const UsdaPrim& prim : stage_.prims) {
      if (!prim.defined || !prim.HasApi("PhysicsRigidBodyAPI")) continue;
      if (bodies_.size() >= internal::kMaxModelElements)
        throw Error(ErrorCode::kFormat, "more than the 2000 bodies allowed");
      UsdBody& body = bodies_.emplace_back();
      body.prim = &prim;
      body.name = body.link.name =
          names[prim.name] > 1 || prim.name == kWorld ? prim.path : prim.name;
      if (!IsRigid(WorldOf(prim)))
        Fail(prim, "a body with a scale; apply the scale to its meshes");
      else
        body.world_from_body = RigidOf(WorldOf(prim));
      body.link.inertial = InertialOf(prim);
      body_of_[prim.path] = &body;
    }
    if (bodies_.empty())
      throw Error(ErrorCode::kFormat, "no prim has PhysicsRigidBodyAPI, so nothing of it moves");
  }

  std::optional<MassProperties> InertialOf(const UsdaPrim& prim) {
    const auto mass = Number(prim, "physics:mass");
    if (!mass || *mass == 0) return std::nullopt;  // 0 stands for "not stated"
    const Eigen::Vector3d moments =
        Vector(prim, "physics:diagonalInertia", Eigen::Vector3d::Zero());
    if (moments.isZero(0)) return std::nullopt;
    if (*mass < 0)
      Fail(prim, "physics:mass " + UsdaWordOf(*mass) + ", allowed are masses above 0",
           UrdfFaultKind::kWrong);
    MassProperties read;
    read.mass_kg = *mass;
    read.center_of_mass_m = unit_m_ * Vector(prim, "physics:centerOfMass", Eigen::Vector3d::Zero());
    const Eigen::Matrix3d axes = Turn(prim, "physics:principalAxes");
    read.inertia_kg_m2 = unit_m_ * unit_m_ * axes * moments.asDiagonal() * axes.transpose();
    return read;
  }

  // The body at or above a path, with where the prim itself stands on it; in the world without one.
  UsdEnd EndAt(const UsdaPrim& joint, const char* relation, const RigidTransform& local) {
    const UsdaProperty* property = joint.Property(relation);
    UsdEnd end;
    end.body_from_joint = local;
    if (property == nullptr || property->value.paths.empty()) return end;
    std::string path = property->value.paths.front();
    const auto prim = prim_of_.find(path);
    if (prim == prim_of_.end()) {
      Fail(joint, std::string(relation) + " names <" + path + ">, which does not exist");
      return end;
    }
    const RigidTransform world_from_prim = RigidOf(WorldOf(*prim->second));
    while (!path.empty() && !body_of_.contains(path)) path = path.substr(0, path.rfind('/'));
    if (!path.empty()) end.body = body_of_[path];
    const RigidTransform world_from_end =
        end.body == nullptr ? RigidTransform::Identity() : end.body->world_from_body;
    end.body_from_joint = world_from_end.inverse() * world_from_prim * local;
    return end;
  }

  // ---- joints
  static bool IsJoint(const UsdaPrim& prim) {
    static const std::set<std::string> kTypes = {"PhysicsFixedJoint",     "PhysicsRevoluteJoint",
                                                 "PhysicsPrismaticJoint", "PhysicsSphericalJoint",
                                                 "PhysicsDistanceJoint",  "PhysicsJoint"};
    return prim.defined && kTypes.contains(prim.type);
  }

  RigidTransform FrameOf(const UsdaPrim& prim, const char* position, const char* turn) {
    RigidTransform frame = RigidTransform::Identity();
    frame.translation() = unit_m_ * Vector(prim, position, Eigen::Vector3d::Zero());
    frame.linear() = Turn(prim, turn);
    return frame;
  }

  Eigen::Vector3d AxisOf(const UsdaPrim& prim) {
    const UsdaProperty* axis = prim.Property("physics:axis");
    const std::string word =
        axis == nullptr || axis->value.texts.empty() ? "X" : axis->value.texts[0];
    if (word == "Y") return Eigen::Vector3d::UnitY();
    if (word == "Z") return Eigen::Vector3d::UnitZ();
    if (word != "X") Fail(prim, "physics:axis \"" + word + "\", expected X, Y or Z");
    return Eigen::Vector3d::UnitX();
  }

  void AddJoint(const UsdaPrim& prim) {
    UsdEnd parent =
        EndAt(prim, "physics:body0", FrameOf(prim, "physics:localPos0", "physics:localRot0"));
    UsdEnd child =
        EndAt(prim, "physics:body1", FrameOf(prim, "physics:localPos1", "physics:localRot1"));
    const bool fixed = prim.type == "PhysicsFixedJoint";
    // a joint of the world alone holds a body that is there before it
    if (child.body == nullptr) std::swap(parent, child);
    if (child.body == nullptr || child.body == parent.body) return;
    if (fixed && parent.body == nullptr) return;
    if (!fixed && prim.type != "PhysicsRevoluteJoint" && prim.type != "PhysicsPrismaticJoint")
      return Fail(prim, prim.type + " is not read; joints are fixed, revolute or prismatic");
    if (child.body->is_child) return Fail(prim, "a second joint carries " + child.body->name);
    child.body->is_child = true;
    if (joints_.size() >= internal::kMaxModelElements)
      throw Error(ErrorCode::kFormat, "more than the 2000 joints allowed");
    joints_.push_back({&prim, parent, child, Moving(prim, fixed, child)});
    // the link's frame moves onto the joint, and keeps its axes
    child.body->body_from_link.translation() = child.body_from_joint.translation();
  }

  UrdfJoint Moving(const UsdaPrim& prim, bool fixed, const UsdEnd& child) {
    UrdfJoint joint;
    joint.name = prim.name;
    joint.child = child.body->name;
    if (fixed) return joint;
    const bool turns = prim.type == "PhysicsRevoluteJoint";
    joint.axis = child.body_from_joint.linear() * AxisOf(prim);
    const double unit = turns ? kDegree : unit_m_;
    const auto lower = Number(prim, "physics:lowerLimit");
    const auto upper = Number(prim, "physics:upperLimit");
    joint.type = turns ? UrdfJointType::kRevolute : UrdfJointType::kPrismatic;
    if (turns && (!lower || !upper)) joint.type = UrdfJointType::kContinuous;
    joint.lower = lower.value_or(0) * unit;
    joint.upper = upper.value_or(0) * unit;
    const char* drive = turns ? "drive:angular:physics:damping" : "drive:linear:physics:damping";
    joint.damping = Number(prim, drive).value_or(0) / (turns ? kDegree : 1);
    const UsdaProperty* leader = prim.Property("newton:mimicJoint");
    const auto multiplier = Number(prim, "newton:mimicCoef1");
    if (leader != nullptr && !leader->value.paths.empty() && multiplier) {
      const std::string& path = leader->value.paths.front();
      joint.mimic = UrdfMimic{path.substr(path.rfind('/') + 1), *multiplier,
                              Number(prim, "newton:mimicCoef0").value_or(0)};
    }
    return joint;
  }

  // ---- shapes
  std::optional<UrdfTriangles> MeshOf(const UsdaPrim& prim) {
    const UsdaProperty* points = prim.Property("points");
    const UsdaProperty* counts = prim.Property("faceVertexCounts");
    const UsdaProperty* indices = prim.Property("faceVertexIndices");
    const auto refuse = [&](const std::string& problem) {
      Fail(prim, problem);
      return std::nullopt;
    };
    if (points == nullptr || counts == nullptr || indices == nullptr)
      return refuse("no points, faceVertexCounts or faceVertexIndices");
    const std::vector<double>& numbers = points->value.numbers;
    if (numbers.size() % 3 != 0) return refuse("points that are no triples");
    UrdfTriangles read;
    for (std::size_t i = 0; i < numbers.size(); i += 3) {
      read.mesh.vertices.emplace_back(unit_m_ * numbers[i], unit_m_ * numbers[i + 1],
                                      unit_m_ * numbers[i + 2]);
      if (!(read.mesh.vertices.back().cwiseAbs().maxCoeff() < 1e9))
        return refuse("a point is not finite");
    }
    std::size_t at = 0;
    for (const double count : counts->value.numbers) {
      const auto corners = static_cast<std::size_t>(count >= 3 && count < 1e5 ? count : 0);
      if (corners == 0 || at + corners > indices->value.numbers.size())
        return refuse("faceVertexCounts and faceVertexIndices do not agree");
      std::vector<int> fan;
      for (std::size_t k = 0; k < corners; ++k, ++at) {
        const double index = indices->value.numbers[at];
        if (!(index >= 0 && index < static_cast<double>(read.mesh.vertices.size())))
          return refuse("faceVertexIndices name a point that is not there");
        fan.push_back(static_cast<int>(index));
      }
      for (std::size_t k = 1; k + 1 < fan.size(); ++k)
        read.mesh.triangles.emplace_back(fan[0], fan[k], fan[k + 1]);
    }
    return read;
  }

  // A sphere or cylinder, which a scale would make another shape.
  std::optional<UrdfGeometry> RoundOf(const UsdaPrim& prim, bool rigid) {
    const double radius = unit_m_ * Number(prim, "radius").value_or(1);
    const double height = unit_m_ * Number(prim, "height").value_or(2);
    if (!rigid) {
      Fail(prim, "a " + prim.type + " with a scale; write it as a Mesh");
      return std::nullopt;
    }
    if (prim.type == "Sphere") return UrdfSphere{radius};
    return UrdfCylinder{radius, height};
  }

  std::optional<UrdfGeometry> GeometryOf(const UsdaPrim& prim, const Eigen::Affine3d& place) {
    if (prim.type == "Mesh" || prim.type == "Cube") {
      std::optional<UrdfTriangles> triangles;
      if (prim.type == "Mesh") triangles = MeshOf(prim);
      if (prim.type == "Cube")
        triangles = UrdfTriangles{CubeOf(unit_m_ * Number(prim, "size").value_or(2))};
      if (!triangles) return std::nullopt;
      for (Eigen::Vector3d& vertex : triangles->mesh.vertices) vertex = place * vertex;
      if (place.linear().determinant() < 0) {
        for (Eigen::Vector3i& t : triangles->mesh.triangles) std::swap(t[1], t[2]);
      }
      return *triangles;
    }
    if (prim.type == "Sphere" || prim.type == "Cylinder") return RoundOf(prim, IsRigid(place));
    if (prim.type == "Capsule" || prim.type == "Cone" || prim.type == "Plane")
      Fail(prim, "a shape that is not read was left out: " + prim.type, UrdfFaultKind::kUnstated);
    return std::nullopt;
  }

  void AddShape(const UsdaPrim& prim) {
    if (!prim.defined) return;
    UsdBody* body = nullptr;
    for (const UsdaPrim* at = &prim; at != nullptr && body == nullptr; at = at->parent) {
      const auto found = body_of_.find(at->path);
      if (found != body_of_.end()) body = found->second;
    }
    const Eigen::Affine3d world_from_link(
        body == nullptr ? RigidTransform::Identity().matrix()
                        : (body->world_from_body * body->body_from_link).matrix());
    const Eigen::Affine3d place = world_from_link.inverse() * WorldOf(prim);
    if (!place.matrix().allFinite()) return;
    const auto geometry = GeometryOf(prim, place);
    if (!geometry) return;
    UrdfShape shape;
    shape.name = prim.name;
    shape.geometry = *geometry;
    const bool triangles = std::holds_alternative<UrdfTriangles>(shape.geometry);
    if (!triangles) shape.link_from_shape = RigidOf(place);
    if (const UsdaProperty* color = prim.Property("primvars:displayColor"))
      ReadColor(*color, shape);
    UrdfLink& link = body == nullptr ? world_ : body->link;
    const UsdaProperty* purpose = prim.Property("purpose");
    const bool guide = purpose != nullptr && !purpose->value.texts.empty() &&
                       (purpose->value.texts[0] == "guide" || purpose->value.texts[0] == "proxy");
    if (prim.HasApi("PhysicsCollisionAPI")) link.collisions.push_back(shape);
    if (!guide) link.visuals.push_back(std::move(shape));
  }

  static void ReadColor(const UsdaProperty& color, UrdfShape& shape) {
    const std::vector<double>& c = color.value.numbers;
    if (c.size() < 3) return;
    shape.color_rgba = Eigen::Vector4d(c[0], c[1], c[2], 1).cwiseMax(0).cwiseMin(1);
  }

  // ---- the model
  UrdfModel Assembled() {
    for (const JointOf& joint : joints_) {
      UrdfJoint made = joint.made;
      made.parent = joint.parent.body == nullptr ? kWorld : joint.parent.body->name;
      needs_world_ = needs_world_ || joint.parent.body == nullptr;
      const RigidTransform parent_from_body = joint.parent.body == nullptr
                                                  ? UpFromWorld()
                                                  : joint.parent.body->body_from_link.inverse();
      RigidTransform straight = joint.child.body_from_joint;
      straight.translation().setZero();
      made.parent_from_joint = parent_from_body * joint.parent.body_from_joint * straight.inverse();
      if (!made.parent_from_joint.matrix().allFinite())
        Fail(*joint.prim, "its place is not finite; a prim above it has a scale of 0");
      model_.joints.push_back(std::move(made));
    }
    AddWorld();
    for (UsdBody& body : bodies_) {
      if (body.link.inertial)
        body.link.inertial = Transformed(*body.link.inertial, body.body_from_link.inverse());
      model_.links.push_back(std::move(body.link));
    }
    ReadWords();
    return std::move(model_);
  }

  RigidTransform UpFromWorld() const {
    RigidTransform up = RigidTransform::Identity();
    if (y_up_)
      up.linear() =
          Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitX()).toRotationMatrix();
    return up;
  }

  // Holds what stands on no body, and what nothing carries, where that is more than one root.
  void AddWorld() {
    std::size_t roots = 0;
    for (const UsdBody& body : bodies_) roots += body.is_child ? 0 : 1;
    const bool shapes = !world_.visuals.empty() || !world_.collisions.empty();
    if (!needs_world_ && roots == 1 && !shapes && !y_up_) return;
    world_.name = kWorld;
    for (auto* list : {&world_.visuals, &world_.collisions}) {
      for (UrdfShape& shape : *list) shape.link_from_shape = UpFromWorld() * shape.link_from_shape;
    }
    model_.links.push_back(std::move(world_));
    for (const UsdBody& body : bodies_) {
      if (body.is_child) continue;
      UrdfJoint joint;
      joint.name = body.name + "_to_world";
      joint.parent = kWorld;
      joint.child = body.name;
      joint.parent_from_joint = UpFromWorld() * body.world_from_body;
      model_.joints.push_back(std::move(joint));
    }
  }

  // What exports say of a door beyond the format, see door_words.h.
  void ReadWords() {
    constexpr std::string_view kSpace = "doorforge:";
    for (const UsdaPrim& prim : stage_.prims) {
      if (prim.parent != nullptr) continue;
      for (const UsdaProperty& property : prim.properties) {
        if (!property.name.starts_with(kSpace)) continue;
        std::string name = property.name.substr(kSpace.size());
        const bool latch = name.starts_with("latch:");
        if (latch) name = name.substr(6);
        const UsdaValue& value = property.value;
        std::string word;
        if (!value.texts.empty()) word = value.texts[0];
        if (!value.numbers.empty()) word = UsdaWordOf(value.numbers[0]);
        model_.words[(latch ? "latch_" : "door_") + SnakeCase(name)] = word;
      }
    }
    const auto id = model_.words.find("door_id");
    if (id != model_.words.end()) model_.name = id->second;
  }

  struct JointOf {
    const UsdaPrim* prim;
    UsdEnd parent;
    UsdEnd child;
    UrdfJoint made;
  };

  const UsdaStage& stage_;
  std::vector<UrdfFault>& faults_;
  double unit_m_ = 0.01;
  bool y_up_ = true;  // where the stage does not say
  bool needs_world_ = false;
  std::deque<UsdBody> bodies_;
  std::map<std::string, UsdBody*> body_of_;         // by path
  std::map<std::string, const UsdaPrim*> prim_of_;  // by path
  std::map<const UsdaPrim*, Eigen::Affine3d> worlds_;
  std::vector<JointOf> joints_;
  UrdfLink world_;
  UrdfModel model_;
};

}  // namespace

UrdfModel ParseUsdaModel(const std::string& text, const std::string& name,
                         std::vector<UrdfFault>& faults) {
  try {
    const UsdaStage stage = ParseUsda(text);
    return UsdaModelReader(stage, faults).Read();
  } catch (const UsdaFault& fault) {
    throw Error(ErrorCode::kFormat, name + ":" + std::to_string(fault.line) + ": " + fault.what());
  } catch (const Error& error) {
    throw Error(error.code(), name + ": " + error.what());
  }
}

UrdfModel ReadUsda(const std::filesystem::path& path, std::vector<UrdfFault>& faults) {
  return ParseUsdaModel(ReadFile(path, kMostUsdaBytes), path.string(), faults);
}

}  // namespace doorforge
