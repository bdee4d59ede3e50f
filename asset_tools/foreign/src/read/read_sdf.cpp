// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>

#include "read/readers.h"
#include "read/xml_source.h"

namespace doorforge::foreign {
namespace {

// http://sdformat.org/spec, of models
const std::vector<KnownElement>& SdfElements() {
  static const std::vector<KnownElement> known = {
      {"sdf", {"version"}, {"world", "model", "actor", "light"}},
      {"world", {"name"}, {"model", "include", "light", "physics", "plugin", "scene", "gravity"}},
      {"model",
       {"name", "canonical_link", "placement_frame"},
       {"link", "joint", "pose", "static", "include", "model", "frame", "plugin", "self_collide",
        "allow_auto_disable", "enable_wind", "gripper"}},
      {"link",
       {"name"},
       {"inertial", "visual", "collision", "pose", "gravity", "self_collide", "kinematic", "sensor",
        "velocity_decay", "light", "must_be_base_link", "projector", "battery", "enable_wind"}},
      {"inertial", {"auto"}, {"mass", "pose", "inertia", "density"}},
      {"inertia", {}, {}},
      {"visual",
       {"name"},
       {"geometry", "pose", "material", "transparency", "cast_shadows", "plugin", "laser_retro",
        "visibility_flags"}},
      {"collision",
       {"name"},
       {"geometry", "pose", "surface", "max_contacts", "laser_retro", "density"}},
      {"geometry",
       {},
       {"mesh", "box", "cylinder", "sphere", "capsule", "ellipsoid", "plane", "heightmap",
        "polyline", "image", "empty"}},
      {"mesh", {}, {"uri", "scale", "submesh"}},
      {"box", {}, {"size"}},
      {"cylinder", {}, {"radius", "length"}},
      {"sphere", {}, {"radius"}},
      {"joint",
       {"name", "type"},
       {"parent", "child", "pose", "axis", "axis2", "physics", "sensor", "gearbox_ratio",
        "thread_pitch"}},
      {"axis",
       {},
       {"xyz", "limit", "dynamics", "mimic", "initial_position", "use_parent_model_frame"}},
      {"limit", {}, {"lower", "upper", "effort", "velocity", "stiffness", "dissipation"}},
      {"dynamics", {}, {"damping", "friction", "spring_reference", "spring_stiffness"}},
  };
  return known;
}

constexpr std::array<std::pair<std::string_view, ForeignJointType>, 9> kSdfJointTypes = {
    {{"fixed", ForeignJointType::kFixed},
     {"revolute", ForeignJointType::kRevolute},
     {"continuous", ForeignJointType::kContinuous},
     {"prismatic", ForeignJointType::kPrismatic},
     {"ball", ForeignJointType::kOther},
     {"universal", ForeignJointType::kOther},
     {"screw", ForeignJointType::kOther},
     {"gearbox", ForeignJointType::kOther},
     {"revolute2", ForeignJointType::kOther}}};

class SdfReader {
 public:
  SdfReader(const std::string& file, FaultList& faults) : source_(file, faults) {}

  ArticulatedObject Read(const XmlElement& sdf) {
    object_.place = source_.At(sdf);
    source_.Text(sdf, "version");
    source_.CheckSpelling(sdf, SdfElements());
    Models(sdf, "", 0);
    return std::move(object_);
  }

 private:
  struct Pose {
    RigidTransform transform = RigidTransform::Identity();
    std::string relative_to;
  };

  void Models(const XmlElement& element, const std::string& scope, int depth) {
    for (const XmlElement* child : element.children) {
      if (child->name == "world" && depth == 0) Models(*child, "", 1);
      if (child->name == "model") Model(*child, scope, depth + 1);
      if (child->name == "include") Include(*child);
    }
  }

  void Include(const XmlElement& include) {
    const XmlElement* uri = source_.Child(include, "uri");
    if (uri == nullptr) return;
    // what it holds is not looked at, so its links and joints are taken as there
    includes_ = true;
    if (uri->text.find("://") == std::string::npos)
      object_.files.push_back({uri->text, source_.At(*uri), true});
  }

  void Model(const XmlElement& model, const std::string& scope, int depth) {
    const std::string name = source_.Text(model, "name").value_or("");
    // names of the first model stand for themselves; those of others have its name before them
    const bool first = object_.name.empty();
    if (first) object_.name = name;
    const std::string prefix = first ? "" : scope + name + "::";
    Models(model, prefix, depth);
    ModelContent(model, prefix);
  }

  void ModelContent(const XmlElement& model, const std::string& prefix) {
    // another program's graph of frames takes minutes over ten thousand
    constexpr std::ptrdiff_t kMostFrames = 2000;
    const auto frames =
        std::count_if(model.children.begin(), model.children.end(),
                      [](const XmlElement* child) { return child->name == "frame"; });
    if (frames > kMostFrames)
      source_.faults().Add("FIL003", source_.At(model),
                           std::to_string(frames) + " frames, more than the 2000 allowed");
    std::map<std::string, Pose> poses;
    for (const XmlElement* child : model.children) {
      if (child->name == "link" || child->name == "frame" || child->name == "joint")
        if (const XmlAttribute* name = child->Attribute("name"))
          poses.emplace(name->value, PoseOf(*child));
    }
    // a joint's pose is that of its child unless it says otherwise
    for (const XmlElement* child : model.children) {
      if (child->name != "joint" || child->Attribute("name") == nullptr) continue;
      const XmlElement* end = child->Child("child");
      Pose& pose = poses[child->Attribute("name")->value];
      if (pose.relative_to.empty() && end != nullptr) pose.relative_to = end->text;
    }
    for (const XmlElement* child : model.children) {
      if (child->name == "link") object_.links.push_back(Link(*child, prefix));
      if (child->name == "joint") Joint(*child, prefix, poses);
    }
  }

  RigidTransform InModel(const std::map<std::string, Pose>& poses, const std::string& name) const {
    RigidTransform transform = RigidTransform::Identity();
    std::string at = name;
    for (int steps = 0; steps < 64; ++steps) {
      const auto pose = poses.find(at);
      if (pose == poses.end()) break;
      transform = pose->second.transform * transform;
      at = pose->second.relative_to;
    }
    return transform;
  }

  Pose PoseOf(const XmlElement& element) {
    Pose pose;
    const XmlElement* child = element.Child("pose");
    if (child == nullptr) return pose;
    if (const XmlAttribute* other = child->Attribute("relative_to"))
      pose.relative_to = other->value;
    const auto numbers = source_.Numbers(source_.At(*child), child->text, 6, 7);
    if (numbers && numbers->size() == 6)
      pose.transform = FromXyzRpy({(*numbers)[0], (*numbers)[1], (*numbers)[2]},
                                  {(*numbers)[3], (*numbers)[4], (*numbers)[5]});
    return pose;
  }

  std::optional<double> Value(const XmlElement& element, const char* name, bool required = false) {
    const XmlElement* child = required ? source_.Child(element, name) : element.Child(name);
    if (child == nullptr) return std::nullopt;
    const auto numbers = source_.Numbers(source_.At(*child), child->text, 1, 1);
    return numbers ? std::optional(numbers->front()) : std::nullopt;
  }

  std::optional<Eigen::Vector3d> Vector(const XmlElement& element, const char* name) {
    const XmlElement* child = element.Child(name);
    if (child == nullptr) return std::nullopt;
    const auto numbers = source_.Numbers(source_.At(*child), child->text, 3, 3);
    if (!numbers) return std::nullopt;
    return Eigen::Vector3d((*numbers)[0], (*numbers)[1], (*numbers)[2]);
  }

  ForeignLink Link(const XmlElement& element, const std::string& prefix) {
    ForeignLink link;
    link.place = source_.At(element);
    link.name = source_.Text(element, "name").value_or("");
    if (!link.name.empty()) link.name = prefix + link.name;
    std::set<std::string> names;
    for (const XmlElement* child : element.children) {
      if (child->name == "inertial") link.inertial = Inertial(*child);
      const bool visual = child->name == "visual";
      if (!visual && child->name != "collision") continue;
      link.shapes.push_back(Shape(*child, visual ? ShapeUse::kVisual : ShapeUse::kCollision));
      const std::string& name = link.shapes.back().name;
      if (!name.empty() && !names.insert(child->name + name).second)
        source_.faults().Add("TRE012", source_.At(*child),
                             "a second " + child->name + " \"" + name + '"');
    }
    return link;
  }

  std::optional<ForeignInertial> Inertial(const XmlElement& element) {
    ForeignInertial inertial;
    inertial.place = inertial.mass_place = inertial.inertia_place = source_.At(element);
    const RigidTransform link_from_center = PoseOf(element).transform;
    inertial.center_m = link_from_center.translation();
    const XmlElement* mass = element.Child("mass");
    if (mass != nullptr) inertial.mass_place = source_.At(*mass);
    const auto value = Value(element, "mass");
    if (const XmlElement* inertia = element.Child("inertia")) {
      inertial.inertia_place = source_.At(*inertia);
      const auto at = [&](const char* name, double fallback) {
        return Value(*inertia, name).value_or(fallback);
      };
      Eigen::Matrix3d matrix;
      matrix << at("ixx", 1), at("ixy", 0), at("ixz", 0), 0, at("iyy", 1), at("iyz", 0), 0, 0,
          at("izz", 1);
      matrix.triangularView<Eigen::StrictlyLower>() = matrix.transpose();
      const Eigen::Matrix3d rotation = link_from_center.linear();
      inertial.inertia_kg_m2 = rotation * matrix * rotation.transpose();
    }
    // 1 is what the format says; what cannot be read is told already
    inertial.mass_kg =
        value.value_or(mass == nullptr ? 1 : std::numeric_limits<double>::quiet_NaN());
    return inertial;
  }

  ForeignShape Shape(const XmlElement& element, ShapeUse use) {
    ForeignShape shape;
    shape.use = use;
    shape.place = source_.At(element);
    shape.name = source_.Text(element, "name").value_or("");
    shape.link_from_shape = PoseOf(element).transform;
    if (const XmlElement* geometry = source_.Child(element, "geometry"))
      shape.geometry = Geometry(*geometry, shape);
    return shape;
  }

  ForeignGeometry Geometry(const XmlElement& geometry, ForeignShape& shape) {
    if (geometry.children.empty()) {
      source_.faults().Add("FIL007", source_.At(geometry), "no shape in it");
      return {};
    }
    const XmlElement& element = *geometry.children.front();
    shape.place = source_.At(element);
    if (element.name == "mesh") return Mesh(element, shape);
    if (element.name == "box") {
      source_.Child(element, "size");
      const auto size = Vector(element, "size");
      return size ? ForeignGeometry(ForeignBox{*size}) : ForeignGeometry();
    }
    if (element.name == "sphere") {
      const auto radius = Value(element, "radius", true);
      return radius ? ForeignGeometry(ForeignSphere{*radius}) : ForeignGeometry();
    }
    if (element.name == "cylinder" || element.name == "capsule") {
      const auto radius = Value(element, "radius", true);
      const auto length = Value(element, "length", true);
      return radius && length ? ForeignGeometry(ForeignCylinder{*radius, *length})
                              : ForeignGeometry();
    }
    static const std::set<std::string> others = {"plane", "heightmap", "polyline", "image",
                                                 "empty", "ellipsoid", "cone"};
    if (!others.contains(element.name))
      source_.faults().Add("FIL008", source_.At(element),
                           "<" + element.name + ">, expected a shape of SDFormat");
    return {};
  }

  ForeignGeometry Mesh(const XmlElement& element, ForeignShape& shape) {
    const XmlElement* uri = source_.Child(element, "uri");
    if (uri == nullptr) return {};
    shape.place = source_.At(*uri);
    const std::size_t begin = uri->text.find_first_not_of(" \t\r\n");
    const std::size_t end = uri->text.find_last_not_of(" \t\r\n");
    if (begin == std::string::npos) return ForeignMeshFile{"", Eigen::Vector3d::Ones()};
    return ForeignMeshFile{uri->text.substr(begin, end - begin + 1),
                           Vector(element, "scale").value_or(Eigen::Vector3d::Ones())};
  }

  ForeignJointType JointType(const XmlElement& element) {
    const auto word = source_.Text(element, "type");
    if (!word) return ForeignJointType::kOther;
    for (const auto& [name, type] : kSdfJointTypes) {
      if (*word == name) return type;
    }
    source_.faults().Add("FIL008", source_.At(element, "type"),
                         "\"" + *word +
                             "\", expected revolute, prismatic, fixed, continuous, ball, "
                             "universal, screw, gearbox or revolute2");
    return ForeignJointType::kOther;
  }

  void Joint(const XmlElement& element, const std::string& prefix,
             const std::map<std::string, Pose>& poses) {
    ForeignJoint joint;
    joint.place = source_.At(element);
    joint.axis_place = joint.dynamics_place = joint.place;
    joint.name = source_.Text(element, "name").value_or("");
    joint.type = JointType(element);
    const auto end = [&](const char* which) -> std::string {
      const XmlElement* child = source_.Child(element, which);
      if (child == nullptr) return "";
      if (child->text.empty()) source_.faults().Add("FIL007", source_.At(*child), "no name in it");
      return child->text;
    };
    const std::string parent = end("parent");
    const std::string child = end("child");
    const RigidTransform model_from_joint = InModel(poses, joint.name);
    joint.parent_from_joint = InModel(poses, parent).inverse() * model_from_joint;
    joint.child_from_joint = InModel(poses, child).inverse() * model_from_joint;
    joint.parent = parent == "world" || parent.empty() ? "" : prefix + parent;
    joint.child = child.empty() ? "" : prefix + child;
    const bool moves =
        joint.type != ForeignJointType::kFixed && joint.type != ForeignJointType::kOther;
    const XmlElement* axis = moves ? source_.Child(element, "axis") : element.Child("axis");
    if (axis != nullptr) ReadAxis(*axis, joint);
    if (!joint.name.empty()) joint.name = prefix + joint.name;
    // ends in what is included, or that are frames, are not known here
    const bool outside = includes_ && (child.find("::") != std::string::npos ||
                                       parent.find("::") != std::string::npos);
    if (!outside) object_.joints.push_back(joint);
  }

  void ReadAxis(const XmlElement& axis, ForeignJoint& joint) {
    joint.axis_place = source_.At(axis);
    if (const XmlElement* xyz = axis.Child("xyz")) joint.axis_place = source_.At(*xyz);
    joint.axis = Vector(axis, "xyz").value_or(Eigen::Vector3d::UnitZ());
    if (const XmlElement* limit = axis.Child("limit")) {
      // -1 stands for no limit
      const auto drive = [&](const char* name) {
        const auto value = Value(*limit, name);
        return value && *value == -1 ? std::nullopt : value;
      };
      joint.limit = {Value(*limit, "lower"), Value(*limit, "upper"), drive("effort"),
                     drive("velocity"), source_.At(*limit)};
    }
    if (const XmlElement* dynamics = axis.Child("dynamics")) {
      joint.dynamics_place = source_.At(*dynamics);
      joint.damping = Value(*dynamics, "damping");
      joint.friction = Value(*dynamics, "friction");
    }
    const XmlElement* mimic = axis.Child("mimic");
    if (mimic == nullptr) return;
    if (const auto name = source_.Text(*mimic, "joint"))
      joint.mimic = {*name, Value(*mimic, "multiplier").value_or(1), source_.At(*mimic)};
  }

  XmlSource source_;
  ArticulatedObject object_;
  bool includes_ = false;
};

}  // namespace

ArticulatedObject ReadForeignSdf(const XmlDocument& document, const std::string& file,
                                 FaultList& faults) {
  return SdfReader(file, faults).Read(*document.root);
}

}  // namespace doorforge::foreign
