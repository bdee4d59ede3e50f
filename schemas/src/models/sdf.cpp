// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/sdf.h"

#include <array>
#include <functional>

#include "doorforge/core/committed_file.h"

#include "models/model_xml.h"

namespace doorforge {
namespace {

using internal::ModelSource;
using internal::TagOf;
using tinyxml2::XMLElement;

constexpr const char* kModelFrame = "__model__";

std::string TextOf(const XMLElement& parent, const char* name, const std::string& fallback = {}) {
  const XMLElement* child = parent.FirstChildElement(name);
  return child == nullptr || child->GetText() == nullptr ? fallback : child->GetText();
}

std::string TrimmedTextOf(const XMLElement& parent, const char* name) {
  const std::string text = TextOf(parent, name);
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

/// Where something is said to be: a pose in the frame of that name.
struct Said {
  std::string relative_to;
  RigidTransform pose = RigidTransform::Identity();
  const XMLElement* element = nullptr;
};

class SdfReader {
 public:
  SdfReader(const XMLElement& sdf, const ModelSource& source) : sdf_(sdf), source_(source) {}

  UrdfModel Read() {
    const XMLElement& model = OnlyModel();
    model_.name = internal::Text(model, "name", source_);
    RefuseParts(model);
    const std::vector<const XMLElement*> links = Named(model, "link");
    const std::vector<const XMLElement*> joints = Named(model, "joint");
    for (const XMLElement* e : Named(model, "frame")) {
      const char* attached = e->Attribute("attached_to");
      Say(*e, attached == nullptr || *attached == '\0' ? kModelFrame : attached);
    }
    if (links.empty()) source_.Stop(model.GetLineNum(), "<model>: no <link> in it");
    for (const XMLElement* e : links) Say(*e, kModelFrame);
    for (const XMLElement* e : joints) Say(*e, TrimmedTextOf(*e, "child"));
    PlaceLinks(links, joints);
    for (const XMLElement* e : links) ReadLink(*e);
    for (const XMLElement* e : joints) ReadJoint(*e);
    ReadWords(model);
    return std::move(model_);
  }

 private:
  const XMLElement& OnlyModel() const {
    const XMLElement* model = sdf_.FirstChildElement("model");
    if (model == nullptr) source_.Stop(sdf_.GetLineNum(), "<sdf>: no <model> in it");
    if (model->NextSiblingElement("model") != nullptr)
      source_.Stop(model->NextSiblingElement("model")->GetLineNum(),
                   "<model>: a second one; only one is read");
    return *model;
  }

  void RefuseParts(const XMLElement& model) const {
    for (const char* tag : {"include", "model"}) {
      if (const XMLElement* e = model.FirstChildElement(tag))
        source_.Fail(*e, "models within models are not read; merge them into one");
    }
  }

  std::vector<const XMLElement*> Named(const XMLElement& model, const char* kind) const {
    std::vector<const XMLElement*> elements;
    for (const XMLElement* e = model.FirstChildElement(kind); e != nullptr;
         e = e->NextSiblingElement(kind)) {
      elements.push_back(e);
      if (elements.size() > internal::kMaxModelElements)
        source_.Stop(e->GetLineNum(), TagOf(*e) + ": more than the 2000 allowed");
    }
    return elements;
  }

  RigidTransform PoseIn(const XMLElement& parent) const {
    const XMLElement* pose = parent.FirstChildElement("pose");
    if (pose == nullptr || pose->GetText() == nullptr) return RigidTransform::Identity();
    const auto numbers = internal::NumbersIn(*pose, "text", pose->GetText(), source_);
    if (!numbers) return RigidTransform::Identity();
    const bool quaternion =
        std::string_view(pose->Attribute("rotation_format") == nullptr
                             ? ""
                             : pose->Attribute("rotation_format")) == "quat_xyzw";
    const double degrees = pose->BoolAttribute("degrees", false) ? 3.14159265358979323846 / 180 : 1;
    if (numbers->size() != (quaternion ? 7U : 6U)) {
      source_.Fail(*pose, "has " + std::to_string(numbers->size()) + " numbers, expected " +
                              (quaternion ? "7" : "6"));
      return RigidTransform::Identity();
    }
    const std::vector<double>& n = *numbers;
    if (!quaternion)
      return FromXyzRpy({n[0], n[1], n[2]}, degrees * Eigen::Vector3d(n[3], n[4], n[5]));
    RigidTransform placed = Translation({n[0], n[1], n[2]});
    const Eigen::Quaterniond turn(n[6], n[3], n[4], n[5]);
    if (turn.norm() > 1e-9)
      placed.linear() = turn.normalized().toRotationMatrix();
    else
      source_.Fail(*pose, "its quaternion has no length");
    return placed;
  }

  // What a pose is relative to where it does not say.
  void Say(const XMLElement& element, const std::string& usual) {
    const std::string name = internal::Text(element, "name", source_);
    const XMLElement* pose = element.FirstChildElement("pose");
    const char* told = pose == nullptr ? nullptr : pose->Attribute("relative_to");
    const Said said{told == nullptr || *told == '\0' ? usual : told, PoseIn(element), &element};
    if (!said_.emplace(name, said).second)
      source_.Fail(element, "a second frame named \"" + name + "\"; names must differ");
  }

  // In the model's frame. Nothing, and one fault, where names lead nowhere or in a circle.
  RigidTransform PlaceOf(const std::string& name) {
    RigidTransform from = RigidTransform::Identity();
    std::string at = name;
    for (std::size_t steps = 0; at != kModelFrame; ++steps) {
      const auto said = said_.find(at);
      if (said == said_.end() || steps > said_.size()) {
        const auto asked = said_.find(name);
        const XMLElement& element = asked == said_.end() ? sdf_ : *asked->second.element;
        source_.Fail(element, said == said_.end()
                                  ? "is placed by \"" + at + "\", which does not exist"
                                  : "is placed by itself, in a circle");
        return RigidTransform::Identity();
      }
      from = said->second.pose * from;
      at = said->second.relative_to;
    }
    return from;
  }

  // A link's frame here is that of the joint that moves it.
  void PlaceLinks(const std::vector<const XMLElement*>& links,
                  const std::vector<const XMLElement*>& joints) {
    for (const XMLElement* e : links) {
      const std::string name = internal::Text(*e, "name", source_);
      stated_[name] = PlaceOf(name);
    }
    frames_ = stated_;
    for (const XMLElement* e : joints) {
      if (TrimmedTextOf(*e, "parent") == "world") continue;
      const auto child = frames_.find(TrimmedTextOf(*e, "child"));
      if (child != frames_.end()) child->second = PlaceOf(internal::Text(*e, "name", source_));
    }
  }

  double NumberIn(const XMLElement& parent, const char* name, double fallback) const {
    const XMLElement* child = parent.FirstChildElement(name);
    if (child == nullptr || child->GetText() == nullptr) return fallback;
    const auto numbers = internal::NumbersIn(*child, "text", child->GetText(), source_);
    return numbers && numbers->size() == 1 ? (*numbers)[0] : fallback;
  }

  Eigen::Vector3d VectorIn(const XMLElement& parent, const char* name,
                           const Eigen::Vector3d& fallback) const {
    const XMLElement* child = parent.FirstChildElement(name);
    if (child == nullptr || child->GetText() == nullptr) return fallback;
    const auto numbers = internal::NumbersIn(*child, "text", child->GetText(), source_);
    if (numbers && numbers->size() == 3) return {(*numbers)[0], (*numbers)[1], (*numbers)[2]};
    if (numbers)
      source_.Fail(*child, "has " + std::to_string(numbers->size()) + " numbers, expected 3");
    return fallback;
  }

  MassProperties InertialOf(const XMLElement& element,
                            const RigidTransform& frame_from_link) const {
    MassProperties mass;
    mass.mass_kg = NumberIn(element, "mass", 1);
    source_.RequireNotNegative(element, "mass", mass.mass_kg);
    const RigidTransform pose = frame_from_link * PoseIn(element);
    mass.center_of_mass_m = pose.translation();
    Eigen::Matrix3d inertia = Eigen::Matrix3d::Identity();
    if (const XMLElement* e = element.FirstChildElement("inertia")) {
      const auto at = [&](const char* name, double usual) { return NumberIn(*e, name, usual); };
      inertia << at("ixx", 1), at("ixy", 0), at("ixz", 0), 0, at("iyy", 1), at("iyz", 0), 0, 0,
          at("izz", 1);
      inertia.triangularView<Eigen::StrictlyLower>() = inertia.transpose();
    }
    mass.inertia_kg_m2 = pose.linear() * inertia * pose.linear().transpose();
    return mass;
  }

  std::optional<UrdfGeometry> GeometryOf(const XMLElement& shape) const {
    const XMLElement* geometry = internal::Child(shape, "geometry", source_);
    const XMLElement* e = geometry == nullptr ? nullptr : geometry->FirstChildElement();
    if (e == nullptr) return std::nullopt;
    const std::string_view kind = e->Name();
    if (kind == "mesh") {
      const std::string uri = TrimmedTextOf(*e, "uri");
      if (uri.empty()) source_.Fail(*e, "names no file (<uri>)");
      return UrdfMeshFile{uri, VectorIn(*e, "scale", {1, 1, 1}), e->GetLineNum()};
    }
    if (kind == "box") return UrdfBox{VectorIn(*e, "size", {1, 1, 1})};
    if (kind == "cylinder")
      return UrdfCylinder{NumberIn(*e, "radius", 1), NumberIn(*e, "length", 1)};
    if (kind == "sphere") return UrdfSphere{NumberIn(*e, "radius", 1)};
    source_.Add(UrdfFaultKind::kUnstated, *e, "a shape that is not read was left out");
    return std::nullopt;
  }

  void AddShape(const XMLElement& element, const RigidTransform& frame_from_link,
                std::vector<UrdfShape>& shapes) const {
    const std::optional<UrdfGeometry> geometry = GeometryOf(element);
    if (!geometry) return;
    UrdfShape shape;
    if (const char* name = element.Attribute("name")) shape.name = name;
    shape.link_from_shape = frame_from_link * PoseIn(element);
    shape.geometry = *geometry;
    const XMLElement* material = element.FirstChildElement("material");
    const XMLElement* color =
        material == nullptr ? nullptr : material->FirstChildElement("diffuse");
    if (color != nullptr && color->GetText() != nullptr) {
      const auto c = internal::NumbersIn(*color, "text", color->GetText(), source_);
      if (c && (c->size() == 3 || c->size() == 4))
        shape.color_rgba = Eigen::Vector4d((*c)[0], (*c)[1], (*c)[2], c->size() == 4 ? (*c)[3] : 1);
    }
    shapes.push_back(std::move(shape));
  }

  void ReadLink(const XMLElement& element) {
    UrdfLink link;
    link.name = internal::Text(element, "name", source_);
    const RigidTransform frame_from_link = frames_[link.name].inverse() * stated_[link.name];
    for (const XMLElement* e = element.FirstChildElement(); e != nullptr;
         e = e->NextSiblingElement()) {
      const std::string_view kind = e->Name();
      if (kind == "inertial") link.inertial = InertialOf(*e, frame_from_link);
      if (kind == "visual") AddShape(*e, frame_from_link, link.visuals);
      if (kind == "collision") AddShape(*e, frame_from_link, link.collisions);
    }
    model_.links.push_back(std::move(link));
  }

  UrdfJointType TypeOf(const XMLElement& element) const {
    static constexpr std::array<std::pair<const char*, UrdfJointType>, 4> kTypes = {
        {{"fixed", UrdfJointType::kFixed},
         {"revolute", UrdfJointType::kRevolute},
         {"continuous", UrdfJointType::kContinuous},
         {"prismatic", UrdfJointType::kPrismatic}}};
    const std::string name = internal::Text(element, "type", source_);
    for (const auto& [known, type] : kTypes) {
      if (name == known) return type;
    }
    source_.Fail(element, "type \"" + name +
                              "\" is not read; fixed, revolute, continuous and prismatic are");
    return UrdfJointType::kFixed;
  }

  void ReadJoint(const XMLElement& element) {
    UrdfJoint joint;
    joint.name = internal::Text(element, "name", source_);
    joint.type = TypeOf(element);
    joint.parent = TrimmedTextOf(element, "parent");
    joint.child = TrimmedTextOf(element, "child");
    if (joint.parent == "world") return;
    for (const std::string& link : {joint.parent, joint.child}) {
      if (!frames_.contains(link)) {
        source_.Fail(element, "names link \"" + link + "\", which does not exist");
        return;
      }
    }
    joint.parent_from_joint = frames_[joint.parent].inverse() * frames_[joint.child];
    if (const XMLElement* axis = element.FirstChildElement("axis")) ReadAxis(*axis, joint);
    model_.joints.push_back(std::move(joint));
  }

  void ReadAxis(const XMLElement& element, UrdfJoint& joint) {
    joint.axis = VectorIn(element, "xyz", {0, 0, 1});
    if (const XMLElement* xyz = element.FirstChildElement("xyz")) {
      const char* in = xyz->Attribute("expressed_in");
      if (in != nullptr && *in != '\0')
        joint.axis = frames_[joint.child].linear().transpose() * PlaceOf(in).linear() * joint.axis;
    }
    if (joint.axis.norm() < 1e-9 && joint.type != UrdfJointType::kFixed)
      source_.Fail(element, "xyz is an axis of zero length, allowed any direction");
    if (const XMLElement* limit = element.FirstChildElement("limit")) {
      joint.lower = NumberIn(*limit, "lower", -1e16);
      joint.upper = NumberIn(*limit, "upper", 1e16);
      const auto stated = [&](const char* name) {
        const double value = NumberIn(*limit, name, -1);
        return value < 0 ? std::optional<double>() : value;  // SDF: -1 means none
      };
      joint.effort = stated("effort");
      joint.velocity = stated("velocity");
      if (joint.lower > joint.upper)
        source_.Add(UrdfFaultKind::kWrong, *limit,
                    "lower is " + ModelSource::Shown(joint.lower) +
                        ", allowed at most upper, which is " + ModelSource::Shown(joint.upper));
    }
    if (joint.type == UrdfJointType::kRevolute && (joint.lower < -1e15 || joint.upper > 1e15)) {
      joint.type = UrdfJointType::kContinuous;
      joint.lower = joint.upper = 0;
    }
    if (const XMLElement* dynamics = element.FirstChildElement("dynamics")) {
      joint.damping = NumberIn(*dynamics, "damping", 0);
      joint.friction = NumberIn(*dynamics, "friction", 0);
    }
    if (const XMLElement* mimic = element.FirstChildElement("mimic"))
      joint.mimic = UrdfMimic{internal::Text(*mimic, "joint", source_),
                              NumberIn(*mimic, "multiplier", 1), NumberIn(*mimic, "offset", 0)};
  }

  void ReadWords(const XMLElement& model) {
    for (const auto& [tag, prefix] :
         {std::pair{"doorforge:latch", "latch_"}, {"doorforge:door", "door_"}}) {
      const XMLElement* words = model.FirstChildElement(tag);
      for (const XMLElement* e = words == nullptr ? nullptr : words->FirstChildElement();
           e != nullptr; e = e->NextSiblingElement())
        model_.words[std::string(prefix) + e->Name()] = e->GetText() == nullptr ? "" : e->GetText();
    }
  }

  const XMLElement& sdf_;
  const ModelSource& source_;
  std::map<std::string, Said> said_;
  std::map<std::string, RigidTransform> stated_;  // of links, in the model's frame
  std::map<std::string, RigidTransform> frames_;  // of links as joints place them
  UrdfModel model_;
};

}  // namespace

UrdfModel ParseSdf(const std::string& text, const std::string& name,
                   std::vector<UrdfFault>& faults) {
  const ModelSource source{name, faults};
  tinyxml2::XMLDocument document;
  return SdfReader(internal::ParseModelXml(text, "sdf", source, document), source).Read();
}

UrdfModel ReadSdf(const std::filesystem::path& path, std::vector<UrdfFault>& faults) {
  return ParseSdf(ReadFile(path, internal::kMaxModelBytes), path.string(), faults);
}

}  // namespace doorforge
