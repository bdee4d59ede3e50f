// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/mjcf.h"

#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "doorforge/core/committed_file.h"

#include "models/model_xml.h"

namespace doorforge {
namespace {

using internal::ModelSource;
using internal::TagOf;
using tinyxml2::XMLElement;
using Attributes = std::map<std::string, std::string>;

/// What a class says of each kind of element.
using DefaultClass = std::map<std::string, Attributes>;

/// The settings of <compiler> and <default>.
struct Settings {
  bool degrees = true;
  bool automatic_limits = true;
  std::string euler = "xyz";
  std::string mesh_folder;
  std::map<std::string, DefaultClass> classes;
};

/// Attributes of an element with those that its class gives it.
class Given {
 public:
  Given(const XMLElement& element, const Settings& settings, const std::string& body_class,
        const ModelSource& source)
      : element_(element), source_(source) {
    const char* named = element.Attribute("class");
    auto known = settings.classes.find(named != nullptr ? named : body_class);
    if (named != nullptr && known == settings.classes.end())
      source.Fail(element, "class \"" + std::string(named) + "\" does not exist");
    // a childclass that there is not gives nothing
    if (known == settings.classes.end()) return;
    const auto kind = known->second.find(element.Name());
    if (kind != known->second.end()) defaults_ = &kind->second;
  }

  const char* Text(const char* attribute) const {
    if (const char* own = element_.Attribute(attribute)) return own;
    if (defaults_ == nullptr) return nullptr;
    const auto given = defaults_->find(attribute);
    return given == defaults_->end() ? nullptr : given->second.c_str();
  }

  std::vector<double> Numbers(const char* attribute) const {
    const char* text = Text(attribute);
    if (text == nullptr) return {};
    return internal::NumbersIn(element_, attribute, text, source_).value_or(std::vector<double>());
  }

  double Number(const char* attribute, double fallback) const {
    const std::vector<double> numbers = Numbers(attribute);
    return numbers.empty() ? fallback : numbers[0];
  }

  Eigen::Vector3d Vector(const char* attribute, const Eigen::Vector3d& fallback) const {
    const std::vector<double> numbers = Numbers(attribute);
    if (numbers.empty()) return fallback;
    if (numbers.size() == 3) return {numbers[0], numbers[1], numbers[2]};
    source_.Fail(element_, std::string(attribute) + " has " + std::to_string(numbers.size()) +
                               " numbers, expected 3");
    return fallback;
  }

  const XMLElement& element() const { return element_; }

 private:
  const XMLElement& element_;
  const ModelSource& source_;
  const Attributes* defaults_ = nullptr;
};

Eigen::Matrix3d TurnAlong(char axis, double angle) {
  const std::array<Eigen::Vector3d, 3> axes = {Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(),
                                               Eigen::Vector3d::UnitZ()};
  return Eigen::AngleAxisd(angle, axes.at(static_cast<std::size_t>(std::tolower(axis) - 'x')))
      .toRotationMatrix();
}

class MjcfReader {
 public:
  MjcfReader(const XMLElement& root, const ModelSource& source) : root_(root), source_(source) {}

  UrdfModel Read() {
    if (const char* name = root_.Attribute("model")) model_.name = name;
    RefuseParts(root_);
    ReadSettings();
    ReadMeshes();
    ReadWorld();
    ReadEqualities();
    ReadWords();
    return std::move(model_);
  }

 private:
  // What brings in more than the file holds, or makes copies.
  void RefuseParts(const XMLElement& element) {
    for (const XMLElement* child = element.FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement()) {
      const std::string_view tag = child->Name();
      if (tag == "include" || tag == "attach" || tag == "replicate" || tag == "composite" ||
          tag == "flexcomp" || tag == "frame")
        source_.Fail(*child, "is not read; save the model from MuJoCo, which writes it out");
      RefuseParts(*child);
    }
  }

  void ReadSettings() {
    for (const XMLElement* e = root_.FirstChildElement("compiler"); e != nullptr;
         e = e->NextSiblingElement("compiler")) {
      const auto text = [&](const char* attribute, const std::string& before) {
        const char* given = e->Attribute(attribute);
        return given == nullptr ? before : std::string(given);
      };
      settings_.degrees = text("angle", settings_.degrees ? "degree" : "radian") == "degree";
      settings_.automatic_limits = text("autolimits", "true") == "true";
      settings_.euler = text("eulerseq", settings_.euler);
      settings_.mesh_folder = text("meshdir", text("assetdir", settings_.mesh_folder));
      if (settings_.euler.size() != 3 ||
          settings_.euler.find_first_not_of("xyzXYZ") != std::string::npos) {
        source_.Fail(*e, "eulerseq=\"" + settings_.euler + "\", expected three of x, y and z");
        settings_.euler = "xyz";
      }
    }
    settings_.classes["main"] = {};
    for (const XMLElement* e = root_.FirstChildElement("default"); e != nullptr;
         e = e->NextSiblingElement("default"))
      ReadDefaults(*e, "main", settings_.classes["main"]);
  }

  // A class begins as the one around it.
  void ReadDefaults(const XMLElement& element, const std::string& name, DefaultClass made) {
    for (const XMLElement* e = element.FirstChildElement(); e != nullptr;
         e = e->NextSiblingElement()) {
      if (std::string_view(e->Name()) == "default") continue;
      for (const tinyxml2::XMLAttribute* a = e->FirstAttribute(); a != nullptr; a = a->Next())
        made[e->Name()][a->Name()] = a->Value();
    }
    settings_.classes[name] = made;
    // each class holds what those around it say, so that their product counts
    for (const auto& [tag, attributes] : made) of_classes_ += attributes.size();
    if (of_classes_ > kMostOfClasses)
      source_.Stop(element.GetLineNum(),
                   "more than 100000 attributes of classes and of those around them");
    if (settings_.classes.size() > internal::kMaxModelElements)
      source_.Stop(element.GetLineNum(), "more than 2000 classes");
    for (const XMLElement* e = element.FirstChildElement("default"); e != nullptr;
         e = e->NextSiblingElement("default"))
      ReadDefaults(*e, internal::Text(*e, "class", source_), made);
  }

  void ReadMeshes() {
    for (const XMLElement* asset = root_.FirstChildElement("asset"); asset != nullptr;
         asset = asset->NextSiblingElement("asset")) {
      for (const XMLElement* e = asset->FirstChildElement("mesh"); e != nullptr;
           e = e->NextSiblingElement("mesh"))
        ReadMesh(*e);
    }
  }

  void ReadMesh(const XMLElement& element) {
    const Given given(element, settings_, "main", source_);
    UrdfMeshFile mesh;
    mesh.line = element.GetLineNum();
    mesh.scale = given.Vector("scale", {1, 1, 1});
    const char* file = given.Text("file");
    const std::string name =
        given.Text("name") != nullptr
            ? given.Text("name")
            : std::filesystem::path(file != nullptr ? file : "").stem().string();
    if (given.Text("refpos") != nullptr || given.Text("refquat") != nullptr)
      source_.Fail(element, "moves its own frame (refpos, refquat), which is not read");
    if (file != nullptr)
      mesh.filename = (std::filesystem::path(settings_.mesh_folder) / file).string();
    meshes_[name] = mesh;  // without a file: its points are in the model
  }

  Eigen::Matrix3d Orientation(const Given& given) const {
    // MuJoCo refuses two of these together; here the first of them holds
    const double unit = settings_.degrees ? std::numbers::pi / 180 : 1;
    const auto count = [&](const char* attribute, std::size_t wanted) {
      const std::vector<double> numbers = given.Numbers(attribute);
      if (!numbers.empty() && numbers.size() != wanted)
        source_.Fail(given.element(), std::string(attribute) + " has " +
                                          std::to_string(numbers.size()) + " numbers, expected " +
                                          std::to_string(wanted));
      return numbers.size() == wanted ? numbers : std::vector<double>();
    };
    if (const auto q = count("quat", 4); !q.empty()) {
      const Eigen::Quaterniond quaternion(q[0], q[1], q[2], q[3]);
      if (quaternion.norm() > 1e-9) return quaternion.normalized().toRotationMatrix();
      source_.Fail(given.element(), "quat has no length");
    }
    if (const auto e = count("euler", 3); !e.empty())
      return EulerTurn({e[0] * unit, e[1] * unit, e[2] * unit});
    if (const auto a = count("axisangle", 4); !a.empty()) {
      const Eigen::Vector3d axis(a[0], a[1], a[2]);
      if (axis.norm() > 1e-9)
        return Eigen::AngleAxisd(a[3] * unit, axis.normalized()).toRotationMatrix();
      source_.Fail(given.element(), "axisangle has an axis of no length");
    }
    if (const auto v = count("xyaxes", 6); !v.empty())
      return FromAxes(given, {v[0], v[1], v[2]}, {v[3], v[4], v[5]});
    if (const auto z = count("zaxis", 3); !z.empty()) {
      const Eigen::Vector3d axis(z[0], z[1], z[2]);
      if (axis.norm() > 1e-9)
        return Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis)
            .toRotationMatrix();
      source_.Fail(given.element(), "zaxis has no length");
    }
    return Eigen::Matrix3d::Identity();
  }

  // Small letters turn about axes that turn along, capital ones about axes that stand.
  Eigen::Matrix3d EulerTurn(const Eigen::Vector3d& angles) const {
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    for (int i = 0; i < 3; ++i) {
      const char axis = settings_.euler[static_cast<std::size_t>(i)];
      const Eigen::Matrix3d step = TurnAlong(axis, angles[i]);
      turn = std::islower(static_cast<unsigned char>(axis)) != 0 ? turn * step : step * turn;
    }
    return turn;
  }

  Eigen::Matrix3d FromAxes(const Given& given, const Eigen::Vector3d& x,
                           const Eigen::Vector3d& y) const {
    const Eigen::Vector3d z = x.cross(y);
    if (z.norm() < 1e-9) {
      source_.Fail(given.element(), "xyaxes are parallel");
      return Eigen::Matrix3d::Identity();
    }
    Eigen::Matrix3d turn;
    turn.col(0) = x.normalized();
    turn.col(2) = z.normalized();
    turn.col(1) = turn.col(2).cross(turn.col(0));
    return turn;
  }

  RigidTransform PoseOf(const Given& given) const {
    RigidTransform pose = Translation(given.Vector("pos", {0, 0, 0}));
    pose.linear() = Orientation(given);
    return pose;
  }

  void ReadWorld() {
    const XMLElement* world = root_.FirstChildElement("worldbody");
    if (world == nullptr) source_.Stop(root_.GetLineNum(), "<mujoco>: no <worldbody> in it");
    const XMLElement* body = world->FirstChildElement("body");
    // one body that stands still is the base itself; else the world is, and holds what stands in it
    const bool alone = body != nullptr && body->NextSiblingElement("body") == nullptr &&
                       world->FirstChildElement("geom") == nullptr &&
                       body->FirstChildElement("joint") == nullptr;
    if (alone) {
      AddLink(*body, BodyName(*body), RigidTransform::Identity(), ClassOf(*body, "main"));
      ReadBodies(*body, model_.links.back().name, RigidTransform::Identity(),
                 ClassOf(*body, "main"));
      return;
    }
    AddLink(*world, "world", RigidTransform::Identity(), "main");
    ReadBodies(*world, "world", RigidTransform::Identity(), "main");
  }

  std::string ClassOf(const XMLElement& body, const std::string& around) const {
    const char* given = body.Attribute("childclass");
    return given == nullptr ? around : given;
  }

  std::string BodyName(const XMLElement& body) {
    const char* given = body.Attribute("name");
    std::string name = given == nullptr ? "body_" + std::to_string(++unnamed_) : given;
    if (!names_.insert(name).second)
      source_.Fail(body, "a second one named \"" + name + "\"; names must differ");
    return name;
  }

  void ReadBodies(const XMLElement& parent, const std::string& parent_link,
                  const RigidTransform& link_from_parent, const std::string& around) {
    for (const XMLElement* body = parent.FirstChildElement("body"); body != nullptr;
         body = body->NextSiblingElement("body"))
      ReadBody(*body, parent_link, link_from_parent, ClassOf(*body, around));
  }

  void ReadBody(const XMLElement& body, std::string parent_link,
                const RigidTransform& link_from_parent, const std::string& around) {
    const std::string name = BodyName(body);
    RigidTransform link_from_body =
        link_from_parent * PoseOf(Given(body, settings_, around, source_));
    // a URDF link has one joint above it, so a body of several hangs on links without shape; a
    // joint's place in the body is the origin of its link
    std::vector<const XMLElement*> joints;
    for (const XMLElement* e = body.FirstChildElement("joint"); e != nullptr;
         e = e->NextSiblingElement("joint"))
      joints.push_back(e);
    if (joints.empty()) {
      UrdfJoint fixed;
      fixed.name = name + "_fixed";
      fixed.parent = parent_link;
      fixed.child = name;
      fixed.parent_from_joint = link_from_body;
      AddJoint(std::move(fixed), body);
      link_from_body = RigidTransform::Identity();
    }
    for (std::size_t k = 0; k < joints.size(); ++k) {
      const Given given(*joints[k], settings_, around, source_);
      const Eigen::Vector3d anchor = given.Vector("pos", {0, 0, 0});
      UrdfJoint joint = JointOf(given, name, k);
      joint.parent = parent_link;
      joint.child = k + 1 == joints.size() ? name : name + "_after_" + joint.name;
      joint.parent_from_joint = link_from_body * Translation(anchor);
      if (k + 1 < joints.size()) model_.links.emplace_back().name = joint.child;
      parent_link = joint.child;
      link_from_body = Translation(-anchor);
      AddJoint(std::move(joint), *joints[k]);
    }
    AddLink(body, name, link_from_body, around);
    ReadBodies(body, name, link_from_body, around);
  }

  void AddJoint(UrdfJoint joint, const XMLElement& element) {
    model_.joints.push_back(std::move(joint));
    if (model_.joints.size() > internal::kMaxModelElements)
      source_.Stop(element.GetLineNum(), TagOf(element) + ": more than the 2000 joints allowed");
  }

  UrdfJoint JointOf(const Given& given, const std::string& body, std::size_t k) {
    UrdfJoint joint;
    const char* name = given.Text("name");
    joint.name = name != nullptr ? name : body + "_joint_" + std::to_string(k);
    const std::string type = given.Text("type") != nullptr ? given.Text("type") : "hinge";
    const bool slides = type == "slide";
    if (type != "hinge" && !slides)
      source_.Fail(given.element(), "type \"" + type + "\" is not read; hinge and slide are");
    joint.axis = given.Vector("axis", {0, 0, 1});
    if (joint.axis.norm() < 1e-9) source_.Fail(given.element(), "axis has no length");
    const std::vector<double> range = given.Numbers("range");
    const char* limited = given.Text("limited");
    const bool limits = limited != nullptr && std::string_view(limited) != "auto"
                            ? std::string_view(limited) == "true"
                            : settings_.automatic_limits && range.size() == 2;
    joint.type = slides ? UrdfJointType::kPrismatic
                        : (limits ? UrdfJointType::kRevolute : UrdfJointType::kContinuous);
    if (limits && range.size() == 2) {
      const double unit = !slides && settings_.degrees ? std::numbers::pi / 180 : 1;
      joint.lower = range[0] * unit;
      joint.upper = range[1] * unit;
    }
    joint.damping = given.Number("damping", 0);
    joint.friction = given.Number("frictionloss", 0);
    return joint;
  }

  // `link_from_body` moves what the body holds into the link's frame.
  void AddLink(const XMLElement& body, const std::string& name,
               const RigidTransform& link_from_body, const std::string& around) {
    UrdfLink link;
    link.name = name;
    if (const XMLElement* inertial = body.FirstChildElement("inertial"))
      link.inertial = InertialOf(*inertial, link_from_body, around);
    for (const XMLElement* e = body.FirstChildElement("geom"); e != nullptr;
         e = e->NextSiblingElement("geom"))
      AddGeom(Given(*e, settings_, around, source_), link_from_body, link);
    if (body.FirstChildElement("freejoint") != nullptr && model_.links.size() > 0)
      source_.Fail(body, "moves freely, which is not read");
    model_.links.push_back(std::move(link));
    if (model_.links.size() > internal::kMaxModelElements)
      source_.Stop(body.GetLineNum(), TagOf(body) + ": more than the 2000 bodies allowed");
  }

  MassProperties InertialOf(const XMLElement& element, const RigidTransform& link_from_body,
                            const std::string& around) const {
    const Given given(element, settings_, around, source_);
    const RigidTransform pose = link_from_body * PoseOf(given);
    MassProperties mass;
    mass.mass_kg = given.Number("mass", 0);
    source_.RequireNotNegative(element, "mass", mass.mass_kg);
    mass.center_of_mass_m = pose.translation();
    Eigen::Matrix3d inertia = given.Vector("diaginertia", {0, 0, 0}).asDiagonal();
    if (const std::vector<double> full = given.Numbers("fullinertia"); full.size() == 6)
      inertia << full[0], full[3], full[4], full[3], full[1], full[5], full[4], full[5], full[2];
    mass.inertia_kg_m2 = pose.linear() * inertia * pose.linear().transpose();
    return mass;
  }

  std::optional<UrdfGeometry> GeometryOf(const Given& given) const {
    const char* mesh = given.Text("mesh");
    const char* named = given.Text("type");
    const std::string type = named != nullptr ? named : (mesh != nullptr ? "mesh" : "sphere");
    if (type == "mesh") {
      const auto known = meshes_.find(mesh != nullptr ? mesh : "");
      if (known == meshes_.end()) {
        source_.Fail(given.element(), "names mesh \"" + std::string(mesh != nullptr ? mesh : "") +
                                          "\", which does not exist");
        return std::nullopt;
      }
      if (!known->second.filename.empty()) return known->second;
      source_.Add(UrdfFaultKind::kUnstated, given.element(),
                  "its mesh has no file and was left out");
      return std::nullopt;
    }
    const std::vector<double> size = given.Numbers("size");
    const auto at = [&](std::size_t i) { return i < size.size() ? size[i] : 0.0; };
    if (type == "box") return UrdfBox{2 * Eigen::Vector3d(at(0), at(1), at(2))};
    if (type == "sphere") return UrdfSphere{at(0)};
    if (type == "cylinder" && given.Text("fromto") == nullptr)
      return UrdfCylinder{at(0), 2 * at(1)};
    source_.Add(UrdfFaultKind::kUnstated, given.element(),
                "a shape that is not read was left out: " + type);
    return std::nullopt;
  }

  void AddGeom(const Given& given, const RigidTransform& link_from_body, UrdfLink& link) const {
    const std::optional<UrdfGeometry> geometry = GeometryOf(given);
    if (!geometry) return;
    UrdfShape shape;
    if (const char* name = given.Text("name")) shape.name = name;
    shape.link_from_shape = link_from_body * PoseOf(given);
    shape.geometry = *geometry;
    if (const auto rgba = given.Numbers("rgba"); rgba.size() == 4)
      shape.color_rgba = Eigen::Vector4d(rgba[0], rgba[1], rgba[2], rgba[3]);
    const bool touches = given.Number("contype", 1) != 0 || given.Number("conaffinity", 1) != 0;
    (touches ? link.collisions : link.visuals).push_back(std::move(shape));
  }

  void ReadEqualities() {
    const XMLElement* equality = root_.FirstChildElement("equality");
    for (const XMLElement* e = equality == nullptr ? nullptr : equality->FirstChildElement("joint");
         e != nullptr; e = e->NextSiblingElement("joint")) {
      const Given given(*e, settings_, "main", source_);
      const char* follower = given.Text("joint1");
      const char* leader = given.Text("joint2");
      const std::vector<double> polynomial = given.Numbers("polycoef");
      for (UrdfJoint& joint : model_.joints) {
        if (follower == nullptr || leader == nullptr || joint.name != follower) continue;
        joint.mimic = UrdfMimic{leader, polynomial.size() > 1 ? polynomial[1] : 1,
                                polynomial.empty() ? 0 : polynomial[0]};
      }
    }
  }

  void ReadWords() {
    for (const XMLElement* custom = root_.FirstChildElement("custom"); custom != nullptr;
         custom = custom->NextSiblingElement("custom")) {
      for (const XMLElement* e = custom->FirstChildElement(); e != nullptr;
           e = e->NextSiblingElement()) {
        const char* name = e->Attribute("name");
        const char* data = e->Attribute("data");
        if (name != nullptr && data != nullptr) model_.words[name] = data;
      }
    }
  }

  const XMLElement& root_;
  const ModelSource& source_;
  static constexpr std::size_t kMostOfClasses = 100'000;
  std::size_t of_classes_ = 0;  // attributes of classes, with those of the ones around them
  Settings settings_;
  std::map<std::string, UrdfMeshFile> meshes_;
  std::set<std::string> names_;
  int unnamed_ = 0;
  UrdfModel model_;
};

}  // namespace

UrdfModel ParseMjcf(const std::string& text, const std::string& name,
                    std::vector<UrdfFault>& faults) {
  const ModelSource source{name, faults};
  tinyxml2::XMLDocument document;
  return MjcfReader(internal::ParseModelXml(text, "mujoco", source, document), source).Read();
}

UrdfModel ReadMjcf(const std::filesystem::path& path, std::vector<UrdfFault>& faults) {
  return ParseMjcf(ReadFile(path, internal::kMaxModelBytes), path.string(), faults);
}

}  // namespace doorforge
