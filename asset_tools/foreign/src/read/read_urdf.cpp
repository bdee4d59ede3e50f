// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <limits>
#include <set>

#include "read/readers.h"
#include "read/xml_source.h"

namespace doorforge::foreign {
namespace {

// http://wiki.ros.org/urdf/XML
const std::vector<KnownElement>& UrdfElements() {
  static const std::vector<KnownElement> known = {
      {"robot",
       {"name", "version"},
       {"link", "joint", "material", "transmission", "gazebo", "sensor", "mujoco"}},
      {"link", {"name", "type"}, {"inertial", "visual", "collision", "origin", "contact"}},
      {"inertial", {}, {"origin", "mass", "inertia"}},
      {"mass", {"value"}, {}},
      {"inertia", {}, {}},
      {"origin", {"xyz", "rpy", "quat_xyzw"}, {}},
      {"visual", {"name"}, {"origin", "geometry", "material"}},
      {"collision", {"name"}, {"origin", "geometry", "verbose"}},
      {"geometry", {}, {"mesh", "box", "cylinder", "sphere", "capsule"}},
      {"mesh", {"filename", "scale"}, {}},
      {"box", {"size"}, {}},
      {"cylinder", {"radius", "length"}, {}},
      {"sphere", {"radius"}, {}},
      {"capsule", {"radius", "length"}, {}},
      {"joint",
       {"name", "type"},
       {"origin", "parent", "child", "axis", "limit", "dynamics", "mimic", "calibration",
        "safety_controller"}},
      {"parent", {"link"}, {}},
      {"child", {"link"}, {}},
      {"limit",
       {"lower", "upper", "effort", "velocity", "acceleration", "deceleration", "jerk"},
       {}},
      {"dynamics", {"damping", "friction"}, {}},
      {"mimic", {"joint", "multiplier", "offset"}, {}},
  };
  return known;
}

constexpr std::array<std::pair<std::string_view, ForeignJointType>, 6> kUrdfJointTypes = {
    {{"fixed", ForeignJointType::kFixed},
     {"revolute", ForeignJointType::kRevolute},
     {"continuous", ForeignJointType::kContinuous},
     {"prismatic", ForeignJointType::kPrismatic},
     {"floating", ForeignJointType::kOther},
     {"planar", ForeignJointType::kOther}}};

class UrdfReader {
 public:
  UrdfReader(const std::string& file, FaultList& faults) : source_(file, faults) {}

  ArticulatedObject Read(const XmlElement& robot) {
    ArticulatedObject object;
    object.traits = {
        .one_root = true, .needs_limits = true, .unit_axes = true, .needs_masses = true};
    object.place = source_.At(robot);
    object.name = source_.Text(robot, "name").value_or("");
    if (NeedsXacro(robot)) return object;
    source_.CheckSpelling(robot, UrdfElements());
    ReadMaterials(robot);
    for (const XmlElement* child : robot.children) {
      if (child->name == "link") object.links.push_back(Link(*child));
      if (child->name == "joint") object.joints.push_back(Joint(*child));
    }
    object.files = std::move(files_);
    return object;
  }

 private:
  // One finding for the file: nothing else in it means anything yet.
  bool NeedsXacro(const XmlElement& robot) {
    std::vector<const XmlElement*> pending{&robot};
    while (!pending.empty()) {
      const XmlElement& element = *pending.back();
      pending.pop_back();
      if (element.name.starts_with("xacro:")) return SayXacro(element, "<" + element.name + ">");
      for (const XmlAttribute& attribute : element.attributes) {
        const bool macro = attribute.value.find("${") != std::string::npos ||
                           attribute.value.find("$(") != std::string::npos;
        if (macro) return SayXacro(element, "\"" + attribute.value + "\"");
      }
      for (std::size_t i = element.children.size(); i-- > 0;)
        pending.push_back(element.children[i]);
    }
    return false;
  }

  bool SayXacro(const XmlElement& element, const std::string& what) {
    source_.faults().Add("FIL010", source_.At(element), what);
    return true;
  }

  void ReadMaterials(const XmlElement& robot) {
    for (const XmlElement* child : robot.children) {
      if (child->name == "material") DefineMaterial(*child);
    }
    // a material that a visual defines is known to all visuals
    for (const XmlElement* link : robot.children) {
      if (link->name != "link") continue;
      for (const XmlElement* visual : link->children) {
        const XmlElement* material = visual->name == "visual" ? visual->Child("material") : nullptr;
        if (material != nullptr && !material->children.empty()) {
          if (const XmlAttribute* name = material->Attribute("name"))
            materials_.insert(name->value);
        }
      }
    }
  }

  void DefineMaterial(const XmlElement& material) {
    const auto name = source_.Text(material, "name");
    if (name && !materials_.insert(*name).second)
      source_.faults().Add("TRE012", source_.At(material), "a second material \"" + *name + '"');
    ReadLook(material);
  }

  void ReadLook(const XmlElement& material) {
    if (const XmlElement* color = material.Child("color")) {
      if (source_.Text(*color, "rgba")) source_.Numbers(*color, "rgba", 4, 4);
    }
    const XmlElement* texture = material.Child("texture");
    if (texture == nullptr) return;
    if (const auto name = source_.Text(*texture, "filename"))
      files_.push_back({*name, source_.At(*texture, "filename"), true});
  }

  RigidTransform Origin(const XmlElement& element) {
    const XmlElement* origin = element.Child("origin");
    if (origin == nullptr) return RigidTransform::Identity();
    const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
    return FromXyzRpy(source_.Vector(*origin, "xyz").value_or(zero),
                      source_.Vector(*origin, "rpy").value_or(zero));
  }

  ForeignLink Link(const XmlElement& element) {
    ForeignLink link;
    link.place = source_.At(element);
    link.name = source_.Text(element, "name").value_or("");
    for (const XmlElement* child : element.children) {
      if (child->name == "inertial") link.inertial = Inertial(*child);
      if (child->name == "visual") link.shapes.push_back(Shape(*child, ShapeUse::kVisual));
      if (child->name == "collision") link.shapes.push_back(Shape(*child, ShapeUse::kCollision));
    }
    return link;
  }

  std::optional<ForeignInertial> Inertial(const XmlElement& element) {
    ForeignInertial inertial;
    inertial.place = source_.At(element);
    const RigidTransform link_from_center = Origin(element);
    inertial.center_m = link_from_center.translation();
    const XmlElement* mass = source_.Child(element, "mass");
    const auto value = mass == nullptr ? std::nullopt : source_.RequiredNumber(*mass, "value");
    const XmlElement* inertia = source_.Child(element, "inertia");
    if (inertia != nullptr) {
      inertial.inertia_place = source_.At(*inertia);
      if (const auto matrix = Inertia(*inertia))
        inertial.inertia_kg_m2 =
            link_from_center.linear() * *matrix * link_from_center.linear().transpose();
    }
    // what cannot be read is told already, and is no number that a rule judges
    inertial.mass_kg = value.value_or(std::numeric_limits<double>::quiet_NaN());
    inertial.mass_place = mass == nullptr ? inertial.place : source_.At(*mass, "value");
    return inertial;
  }

  std::optional<Eigen::Matrix3d> Inertia(const XmlElement& element) {
    std::array<std::optional<double>, 6> numbers;
    constexpr std::array<std::string_view, 6> kNames = {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"};
    for (std::size_t i = 0; i < 6; ++i)
      numbers.at(i) = source_.RequiredNumber(element, kNames.at(i));
    for (const auto& number : numbers) {
      if (!number) return std::nullopt;
    }
    const auto at = [&](std::size_t i) { return *numbers.at(i); };
    Eigen::Matrix3d matrix;
    matrix << at(0), at(1), at(2), at(1), at(3), at(4), at(2), at(4), at(5);
    return matrix;
  }

  ForeignShape Shape(const XmlElement& element, ShapeUse use) {
    ForeignShape shape;
    shape.use = use;
    shape.place = source_.At(element);
    shape.name = source_.Text(element, "name", false).value_or("");
    shape.link_from_shape = Origin(element);
    if (const XmlElement* geometry = source_.Child(element, "geometry"))
      shape.geometry = Geometry(*geometry, shape);
    const XmlElement* material = element.Child("material");
    if (use == ShapeUse::kVisual && material != nullptr) UseMaterial(*material);
    return shape;
  }

  void UseMaterial(const XmlElement& material) {
    const auto name = source_.Text(material, "name");
    if (material.children.empty() && name && !materials_.contains(*name))
      source_.faults().Add("TRE013", source_.At(material, "name"),
                           "material \"" + *name + "\" is nowhere defined");
    if (!material.children.empty()) ReadLook(material);
  }

  ForeignGeometry Geometry(const XmlElement& geometry, ForeignShape& shape) {
    if (geometry.children.empty()) {
      source_.faults().Add("FIL007", source_.At(geometry), "no shape in it");
      return {};
    }
    const XmlElement& element = *geometry.children.front();
    shape.place = source_.At(element);
    if (element.name == "mesh") return Mesh(element);
    if (element.name == "box") {
      if (!source_.Text(element, "size")) return {};
      if (const auto size = source_.Vector(element, "size")) return ForeignBox{*size};
      return {};
    }
    if (element.name == "sphere") {
      if (const auto radius = source_.RequiredNumber(element, "radius"))
        return ForeignSphere{*radius};
      return {};
    }
    if (element.name == "cylinder" || element.name == "capsule") {
      const auto radius = source_.RequiredNumber(element, "radius");
      const auto length = source_.RequiredNumber(element, "length");
      if (radius && length) return ForeignCylinder{*radius, *length};
      return {};
    }
    source_.faults().Add("FIL008", source_.At(element),
                         "<" + element.name + ">, expected mesh, box, cylinder, sphere or capsule");
    return {};
  }

  ForeignGeometry Mesh(const XmlElement& element) {
    const auto name = source_.Text(element, "filename");
    const auto scale = source_.Vector(element, "scale");
    if (!name) return {};
    return ForeignMeshFile{*name, scale.value_or(Eigen::Vector3d::Ones())};
  }

  ForeignJointType JointType(const XmlElement& element) {
    const auto word = source_.Text(element, "type");
    if (!word) return ForeignJointType::kOther;
    for (const auto& [name, type] : kUrdfJointTypes) {
      if (*word == name) return type;
    }
    source_.faults().Add("FIL008", source_.At(element, "type"),
                         "\"" + *word +
                             "\", expected fixed, revolute, continuous, prismatic, floating or "
                             "planar");
    return ForeignJointType::kOther;
  }

  ForeignJoint Joint(const XmlElement& element) {
    ForeignJoint joint;
    joint.place = source_.At(element);
    joint.axis_place = joint.dynamics_place = joint.place;
    joint.name = source_.Text(element, "name").value_or("");
    joint.type = JointType(element);
    const auto end = [&](const char* which) -> std::string {
      const XmlElement* child = source_.Child(element, which);
      return child == nullptr ? "" : source_.Text(*child, "link").value_or("");
    };
    joint.parent = end("parent");
    joint.child = end("child");
    joint.parent_from_joint = Origin(element);
    if (const XmlElement* axis = element.Child("axis")) {
      joint.axis_place = source_.At(*axis, "xyz");
      if (source_.Text(*axis, "xyz")) joint.axis = source_.Vector(*axis, "xyz");
    } else {
      joint.axis = Eigen::Vector3d::UnitX();  // what the format says
    }
    ReadLimit(element, joint);
    ReadDynamics(element, joint);
    ReadMimic(element, joint);
    return joint;
  }

  void ReadLimit(const XmlElement& element, ForeignJoint& joint) {
    const XmlElement* limit = element.Child("limit");
    if (limit == nullptr) return;
    const auto number = [&](const char* name) { return source_.Number(*limit, name); };
    joint.limit = {number("lower"), number("upper"), number("effort"), number("velocity"),
                   source_.At(*limit)};
    // absent, and not what cannot be read: that is told already
    if (limit->Attribute("lower") == nullptr) joint.limit->lower = 0;
    if (limit->Attribute("upper") == nullptr) joint.limit->upper = 0;
    const bool moves =
        joint.type == ForeignJointType::kRevolute || joint.type == ForeignJointType::kPrismatic;
    std::string missing;
    for (const char* wanted : {"effort", "velocity"}) {
      if (limit->Attribute(wanted) == nullptr)
        missing += (missing.empty() ? "no " : ", no ") + std::string(wanted);
    }
    if (moves && !missing.empty()) source_.faults().Add("JNT006", source_.At(*limit), missing);
  }

  void ReadDynamics(const XmlElement& element, ForeignJoint& joint) {
    const XmlElement* dynamics = element.Child("dynamics");
    if (dynamics == nullptr) return;
    joint.dynamics_place = source_.At(*dynamics);
    joint.damping = source_.Number(*dynamics, "damping");
    joint.friction = source_.Number(*dynamics, "friction");
    if (dynamics->attributes.empty())
      source_.faults().Add("FIL007", source_.At(*dynamics), "neither damping nor friction");
  }

  void ReadMimic(const XmlElement& element, ForeignJoint& joint) {
    const XmlElement* mimic = element.Child("mimic");
    if (mimic == nullptr) return;
    const double multiplier = source_.Number(*mimic, "multiplier").value_or(1);
    source_.Number(*mimic, "offset");
    if (const auto name = source_.Text(*mimic, "joint"))
      joint.mimic = {*name, multiplier, source_.At(*mimic)};
  }

  XmlSource source_;
  std::set<std::string> materials_;
  std::vector<ForeignFileName> files_;
};

}  // namespace

ArticulatedObject ReadForeignUrdf(const XmlDocument& document, const std::string& file,
                                  FaultList& faults) {
  return UrdfReader(file, faults).Read(*document.root);
}

}  // namespace doorforge::foreign
