// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/urdf.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <set>
#include <string_view>

#include <tinyxml2.h>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"

#include "models/model_xml.h"

namespace doorforge {
namespace {

using tinyxml2::XMLElement;

using internal::Child;
using internal::kMaxModelElements;
using internal::Number;
using internal::Numbers;
using internal::NumbersOfCount;
using internal::OptionalNumber;
using internal::TagOf;
using internal::Text;
using internal::Vector;
using Source = internal::ModelSource;

RigidTransform OriginOf(const XMLElement& element, const Source& source) {
  const XMLElement* origin = element.FirstChildElement("origin");
  if (origin == nullptr) return RigidTransform::Identity();
  return FromXyzRpy(Vector(*origin, "xyz", {0, 0, 0}, source),
                    Vector(*origin, "rpy", {0, 0, 0}, source));
}

double ReadMass(const XMLElement& inertial, const Source& source) {
  const XMLElement* mass = Child(inertial, "mass", source);
  if (mass == nullptr) return 0;
  const double value = Number(*mass, "value", source);
  source.RequireNotNegative(*mass, "value", value);
  return value;
}

Eigen::Matrix3d ReadInertia(const XMLElement& inertia, const Source& source) {
  const auto at = [&](const char* name) { return Number(inertia, name, source); };
  Eigen::Matrix3d matrix;
  matrix << at("ixx"), at("ixy"), at("ixz"), 0, at("iyy"), at("iyz"), 0, 0, at("izz");
  matrix.triangularView<Eigen::StrictlyLower>() = matrix.transpose();
  const std::array<const char*, 3> names = {"ixx", "iyy", "izz"};
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    source.RequireNotNegative(inertia, names.at(i), matrix(k, k));
  }
  return matrix;
}

MassProperties ReadInertial(const XMLElement& element, const Source& source) {
  MassProperties mass;
  mass.mass_kg = ReadMass(element, source);
  const RigidTransform link_from_center = OriginOf(element, source);
  mass.center_of_mass_m = link_from_center.translation();
  const XMLElement* inertia = element.FirstChildElement("inertia");
  if (inertia == nullptr) return mass;
  const Eigen::Matrix3d rotation = link_from_center.linear();
  mass.inertia_kg_m2 = rotation * ReadInertia(*inertia, source) * rotation.transpose();
  return mass;
}

double ReadLength(const XMLElement& shape, const char* attribute, const Source& source) {
  const std::size_t before = source.faults.size();
  const double length = Number(shape, attribute, source);
  if (source.faults.size() == before) source.RequirePositive(shape, attribute, length);
  return length;
}

UrdfMeshFile ReadMeshFile(const XMLElement& mesh, const Source& source) {
  UrdfMeshFile file{Text(mesh, "filename", source), Vector(mesh, "scale", {1, 1, 1}, source),
                    mesh.GetLineNum()};
  if ((file.scale.array() == 0).any())
    source.Add(UrdfFaultKind::kWrong, mesh,
               "scale=\"" + std::string(mesh.Attribute("scale")) +
                   "\", allowed three numbers other than 0");
  return file;
}

UrdfBox ReadBox(const XMLElement& box, const Source& source) {
  Text(box, "size", source);
  const std::size_t before = source.faults.size();
  const Eigen::Vector3d size = Vector(box, "size", {0, 0, 0}, source);
  if (source.faults.size() == before && box.Attribute("size") != nullptr)
    source.RequirePositive(box, "the least of size", size.minCoeff());
  return {size};
}

UrdfGeometry ReadGeometry(const XMLElement& element, const Source& source) {
  const XMLElement* shape = element.FirstChildElement();
  const std::string_view kind = shape == nullptr ? "" : shape->Name();
  if (kind == "mesh") return ReadMeshFile(*shape, source);
  if (kind == "box") return ReadBox(*shape, source);
  if (kind == "cylinder")
    return UrdfCylinder{ReadLength(*shape, "radius", source), ReadLength(*shape, "length", source)};
  if (kind == "sphere") return UrdfSphere{ReadLength(*shape, "radius", source)};
  if (shape == nullptr)
    source.Fail(element, "no shape in it");
  else
    source.Fail(*shape, "unknown shape; expected mesh, box, cylinder or sphere");
  return UrdfBox{Eigen::Vector3d::Ones()};
}

using Materials = std::map<std::string, Eigen::Vector4d>;

std::optional<Eigen::Vector4d> ColorOf(const XMLElement& material, const Source& source) {
  const XMLElement* color = material.FirstChildElement("color");
  if (color == nullptr || color->Attribute("rgba") == nullptr) return std::nullopt;
  const auto rgba = NumbersOfCount(*color, "rgba", 4, source);
  if (!rgba) return std::nullopt;
  return Eigen::Vector4d((*rgba)[0], (*rgba)[1], (*rgba)[2], (*rgba)[3]);
}

Materials ReadMaterials(const XMLElement& robot, const Source& source) {
  Materials materials;
  for (const XMLElement* element = robot.FirstChildElement("material"); element != nullptr;
       element = element->NextSiblingElement("material")) {
    if (const auto color = ColorOf(*element, source))
      materials[Text(*element, "name", source)] = *color;
  }
  return materials;
}

UrdfShape ReadShape(const XMLElement& element, const Materials& materials, const Source& source) {
  UrdfShape shape;
  if (const char* name = element.Attribute("name")) shape.name = name;
  shape.link_from_shape = OriginOf(element, source);
  if (const XMLElement* geometry = Child(element, "geometry", source))
    shape.geometry = ReadGeometry(*geometry, source);
  const XMLElement* material = element.FirstChildElement("material");
  if (material == nullptr) return shape;
  shape.color_rgba = ColorOf(*material, source);
  const char* name = material->Attribute("name");
  if (!shape.color_rgba && name != nullptr && materials.contains(name))
    shape.color_rgba = materials.at(name);
  return shape;
}

UrdfLink ReadLink(const XMLElement& element, const Materials& materials, const Source& source) {
  UrdfLink link;
  link.name = Text(element, "name", source);
  for (const XMLElement* child = element.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    const std::string_view kind = child->Name();
    if (kind == "inertial") link.inertial = ReadInertial(*child, source);
    if (kind == "visual") link.visuals.push_back(ReadShape(*child, materials, source));
    if (kind == "collision") link.collisions.push_back(ReadShape(*child, materials, source));
  }
  return link;
}

constexpr std::array<std::pair<const char*, UrdfJointType>, 4> kJointTypes = {
    {{"fixed", UrdfJointType::kFixed},
     {"revolute", UrdfJointType::kRevolute},
     {"continuous", UrdfJointType::kContinuous},
     {"prismatic", UrdfJointType::kPrismatic}}};

UrdfJointType ReadJointType(const XMLElement& element, const Source& source) {
  const std::string name = Text(element, "type", source);
  for (const auto& [known, type] : kJointTypes) {
    if (name == known) return type;
  }
  if (!name.empty())
    source.Fail(element,
                "unknown type \"" + name + "\"; expected fixed, revolute, continuous or prismatic");
  return UrdfJointType::kFixed;
}

// the joints that the format wants limits of
bool HasLimits(const UrdfJoint& joint) {
  return joint.type == UrdfJointType::kRevolute || joint.type == UrdfJointType::kPrismatic;
}

void ReadLimit(const XMLElement& element, const Source& source, UrdfJoint& joint) {
  joint.lower = OptionalNumber(element, "lower", source).value_or(0);
  joint.upper = OptionalNumber(element, "upper", source).value_or(0);
  joint.effort = OptionalNumber(element, "effort", source);
  joint.velocity = OptionalNumber(element, "velocity", source);
  source.RequireNotNegative(element, "effort", joint.effort);
  source.RequireNotNegative(element, "velocity", joint.velocity);
  if (!HasLimits(joint)) return;
  if (joint.lower > joint.upper)
    source.Add(UrdfFaultKind::kWrong, element,
               "lower is " + Source::Shown(joint.lower) + ", allowed at most upper, which is " +
                   Source::Shown(joint.upper));
  for (const char* wanted : {"effort", "velocity"}) {
    if (element.Attribute(wanted) == nullptr)
      source.Add(UrdfFaultKind::kUnstated, element,
                 std::string("no ") + wanted + ", which the format asks for");
  }
}

void ReadDynamics(const XMLElement& element, const Source& source, UrdfJoint& joint) {
  joint.damping = OptionalNumber(element, "damping", source).value_or(0);
  joint.friction = OptionalNumber(element, "friction", source).value_or(0);
  source.RequireNotNegative(element, "damping", joint.damping);
  source.RequireNotNegative(element, "friction", joint.friction);
}

std::string LinkIn(const XMLElement& joint, const char* end, const Source& source) {
  const XMLElement* child = Child(joint, end, source);
  return child == nullptr ? "" : Text(*child, "link", source);
}

void ReadAxis(const XMLElement& element, const Source& source, UrdfJoint& joint) {
  joint.axis = Vector(element, "xyz", joint.axis, source);
  if (joint.type != UrdfJointType::kFixed && joint.axis.norm() < 1e-9)
    source.Fail(element, "xyz=\"" + std::string(element.Attribute("xyz")) +
                             "\" is an axis of zero length, allowed any direction");
}

UrdfJoint ReadJoint(const XMLElement& element, const Source& source) {
  UrdfJoint joint;
  joint.name = Text(element, "name", source);
  joint.type = ReadJointType(element, source);
  joint.parent = LinkIn(element, "parent", source);
  joint.child = LinkIn(element, "child", source);
  joint.parent_from_joint = OriginOf(element, source);
  if (const XMLElement* axis = element.FirstChildElement("axis")) ReadAxis(*axis, source, joint);
  if (const XMLElement* limit = element.FirstChildElement("limit"))
    ReadLimit(*limit, source, joint);
  else if (HasLimits(joint))
    source.Add(UrdfFaultKind::kUnstated, element, "no <limit>, which the format asks for");
  if (const XMLElement* dynamics = element.FirstChildElement("dynamics"))
    ReadDynamics(*dynamics, source, joint);
  if (const XMLElement* mimic = element.FirstChildElement("mimic"))
    joint.mimic = UrdfMimic{Text(*mimic, "joint", source),
                            OptionalNumber(*mimic, "multiplier", source).value_or(1),
                            OptionalNumber(*mimic, "offset", source).value_or(0)};
  return joint;
}

// Elements of `robot` with this name, the first of those that share a `name`.
std::vector<const XMLElement*> NamedElements(const XMLElement& robot, const char* kind,
                                             const Source& source) {
  std::vector<const XMLElement*> elements;
  std::set<std::string> names;
  for (const XMLElement* element = robot.FirstChildElement(kind); element != nullptr;
       element = element->NextSiblingElement(kind)) {
    const char* name = element->Attribute("name");
    if (name != nullptr && !names.insert(name).second) {
      source.Fail(*element, "a second one named \"" + std::string(name) + "\"; names must differ");
      continue;
    }
    elements.push_back(element);
    if (elements.size() > kMaxModelElements)
      source.Stop(element->GetLineNum(), TagOf(*element) + ": more than the " +
                                             std::to_string(kMaxModelElements) +
                                             " allowed; leave out what the object does not need");
  }
  return elements;
}

void RefuseUnknownLinks(const UrdfModel& model, const std::vector<const XMLElement*>& joints,
                        const Source& source) {
  std::set<std::string> links;
  for (const UrdfLink& link : model.links) links.insert(link.name);
  for (std::size_t i = 0; i < joints.size(); ++i) {
    for (const std::string& name : {model.joints[i].parent, model.joints[i].child}) {
      // an empty one is a fault already
      if (!name.empty() && !links.contains(name))
        source.Fail(*joints[i], "names link \"" + name + "\", which does not exist");
    }
  }
}

// What exports say of a door beyond the format, see door_words.h.
void ReadWords(const XMLElement& element, UrdfModel& model) {
  const auto add = [&](const XMLElement& from, const std::string& prefix) {
    for (const tinyxml2::XMLAttribute* a = from.FirstAttribute(); a != nullptr; a = a->Next())
      model.words[prefix + a->Name()] = a->Value();
  };
  add(element, "door_");
  if (const XMLElement* latch = element.FirstChildElement("latch")) add(*latch, "latch_");
  if (const XMLElement* grasp = element.FirstChildElement("grasp")) add(*grasp, "grasp_");
}

// ---- writer -----------------------------------------------------------------------------------

std::string Decimal(double number) {
  char digits[40];
  // + 0.0 turns -0 into 0
  return {digits, std::to_chars(digits, digits + sizeof digits, number + 0.0).ptr};
}

std::string Decimals(const Eigen::Ref<const Eigen::VectorXd>& numbers) {
  std::string text;
  for (const double number : numbers) text += (text.empty() ? "" : " ") + Decimal(number);
  return text;
}

XMLElement& Add(XMLElement& parent, const char* name) {
  return *parent.InsertNewChildElement(name);
}

void Set(XMLElement& element, const char* attribute, const std::string& text) {
  element.SetAttribute(attribute, text.c_str());
}

void AddOrigin(XMLElement& parent, const RigidTransform& transform) {
  if (transform.isApprox(RigidTransform::Identity(), 0)) return;
  XMLElement& origin = Add(parent, "origin");
  Set(origin, "xyz", Decimals(transform.translation()));
  // angles recovered from a matrix are off by some 1e-16; rounding writes 0.1 as 0.1 again
  const Eigen::Vector3d rpy = (RpyOf(transform.linear()) * 1e14).array().round() / 1e14;
  if (!rpy.isZero(0)) Set(origin, "rpy", Decimals(rpy));
}

void AddInertial(XMLElement& parent, const MassProperties& mass) {
  XMLElement& inertial = Add(parent, "inertial");
  AddOrigin(inertial, Translation(mass.center_of_mass_m));
  Set(Add(inertial, "mass"), "value", Decimal(mass.mass_kg));
  XMLElement& inertia = Add(inertial, "inertia");
  const Eigen::Matrix3d& matrix = mass.inertia_kg_m2;
  Set(inertia, "ixx", Decimal(matrix(0, 0)));
  Set(inertia, "ixy", Decimal(matrix(0, 1)));
  Set(inertia, "ixz", Decimal(matrix(0, 2)));
  Set(inertia, "iyy", Decimal(matrix(1, 1)));
  Set(inertia, "iyz", Decimal(matrix(1, 2)));
  Set(inertia, "izz", Decimal(matrix(2, 2)));
}

struct GeometryWriter {
  XMLElement& geometry;

  void operator()(const UrdfMeshFile& mesh) const {
    XMLElement& element = Add(geometry, "mesh");
    Set(element, "filename", mesh.filename);
    if (mesh.scale != Eigen::Vector3d(1, 1, 1)) Set(element, "scale", Decimals(mesh.scale));
  }
  void operator()(const UrdfBox& box) const {
    Set(Add(geometry, "box"), "size", Decimals(box.size_m));
  }
  void operator()(const UrdfCylinder& cylinder) const {
    XMLElement& element = Add(geometry, "cylinder");
    Set(element, "radius", Decimal(cylinder.radius_m));
    Set(element, "length", Decimal(cylinder.length_m));
  }
  void operator()(const UrdfSphere& sphere) const {
    Set(Add(geometry, "sphere"), "radius", Decimal(sphere.radius_m));
  }
  void operator()(const UrdfTriangles&) const {
    throw Error(ErrorCode::kInvalidArgument, "a URDF holds no triangles; write them to a file");
  }
};

void AddShape(XMLElement& link, const char* kind, const UrdfShape& shape) {
  XMLElement& element = Add(link, kind);
  if (!shape.name.empty()) Set(element, "name", shape.name);
  AddOrigin(element, shape.link_from_shape);
  std::visit(GeometryWriter{Add(element, "geometry")}, shape.geometry);
  if (!shape.color_rgba) return;
  XMLElement& material = Add(element, "material");
  // URDF wants a name, and readers share one definition among equal names
  Set(material, "name", "rgba " + Decimals(*shape.color_rgba));
  Set(Add(material, "color"), "rgba", Decimals(*shape.color_rgba));
}

void AddLink(XMLElement& robot, const UrdfLink& link) {
  XMLElement& element = Add(robot, "link");
  Set(element, "name", link.name);
  if (link.inertial) AddInertial(element, *link.inertial);
  for (const UrdfShape& shape : link.visuals) AddShape(element, "visual", shape);
  for (const UrdfShape& shape : link.collisions) AddShape(element, "collision", shape);
}

// The format asks for effort and velocity; where the model has none, strict readers will say so.
void AddLimit(XMLElement& element, const UrdfJoint& joint) {
  XMLElement& limit = Add(element, "limit");
  if (joint.type != UrdfJointType::kContinuous) {
    Set(limit, "lower", Decimal(joint.lower));
    Set(limit, "upper", Decimal(joint.upper));
  }
  if (joint.effort) Set(limit, "effort", Decimal(*joint.effort));
  if (joint.velocity) Set(limit, "velocity", Decimal(*joint.velocity));
}

void AddJoint(XMLElement& robot, const UrdfJoint& joint) {
  XMLElement& element = Add(robot, "joint");
  Set(element, "name", joint.name);
  for (const auto& [name, type] : kJointTypes) {
    if (joint.type == type) Set(element, "type", name);
  }
  AddOrigin(element, joint.parent_from_joint);
  Set(Add(element, "parent"), "link", joint.parent);
  Set(Add(element, "child"), "link", joint.child);
  if (joint.type == UrdfJointType::kFixed) return;
  Set(Add(element, "axis"), "xyz", Decimals(joint.axis));
  const bool limited = joint.type != UrdfJointType::kContinuous || joint.effort || joint.velocity;
  if (limited) AddLimit(element, joint);
  if (joint.damping != 0 || joint.friction != 0) {
    XMLElement& dynamics = Add(element, "dynamics");
    Set(dynamics, "damping", Decimal(joint.damping));
    Set(dynamics, "friction", Decimal(joint.friction));
  }
  if (joint.mimic) {
    XMLElement& mimic = Add(element, "mimic");
    Set(mimic, "joint", joint.mimic->joint);
    Set(mimic, "multiplier", Decimal(joint.mimic->multiplier));
    Set(mimic, "offset", Decimal(joint.mimic->offset));
  }
}

}  // namespace

UrdfModel ReadUrdf(const std::filesystem::path& path) {
  return ParseUrdf(ReadFile(path, internal::kMaxModelBytes), path.string());
}

UrdfModel ReadUrdf(const std::filesystem::path& path, std::vector<UrdfFault>& faults) {
  return ParseUrdf(ReadFile(path, internal::kMaxModelBytes), path.string(), faults);
}

UrdfModel ParseUrdf(const std::string& text, const std::string& name) {
  std::vector<UrdfFault> faults;
  UrdfModel model = ParseUrdf(text, name, faults);
  const bool usable = std::none_of(faults.begin(), faults.end(), [](const UrdfFault& fault) {
    return fault.kind == UrdfFaultKind::kUnusable;
  });
  if (!usable) throw Error(ErrorCode::kFormat, UrdfFaultsText(name, faults));
  return model;
}

UrdfModel ParseUrdf(const std::string& text, const std::string& name,
                    std::vector<UrdfFault>& faults) {
  const Source source{name, faults};
  tinyxml2::XMLDocument document;
  const XMLElement* robot = &internal::ParseModelXml(text, "robot", source, document);

  const std::size_t known = faults.size();
  UrdfModel model;
  if (const char* robot_name = robot->Attribute("name")) model.name = robot_name;
  const Materials materials = ReadMaterials(*robot, source);
  for (const XMLElement* element : NamedElements(*robot, "link", source))
    model.links.push_back(ReadLink(*element, materials, source));
  const std::vector<const XMLElement*> joints = NamedElements(*robot, "joint", source);
  for (const XMLElement* element : joints) model.joints.push_back(ReadJoint(*element, source));
  if (model.links.empty()) source.Stop(robot->GetLineNum(), "<robot>: no <link> in it");
  RefuseUnknownLinks(model, joints, source);
  if (const XMLElement* words = robot->FirstChildElement("doorforge")) ReadWords(*words, model);
  std::stable_sort(faults.begin() + static_cast<std::ptrdiff_t>(known), faults.end(),
                   [](const UrdfFault& a, const UrdfFault& b) { return a.line < b.line; });
  return model;
}

std::string UrdfFaultsText(const std::string& name, const std::vector<UrdfFault>& faults) {
  constexpr std::size_t kShown = 50;
  const auto line = [&](const UrdfFault& fault) {
    return name + ":" + std::to_string(fault.line) + ": " + fault.text;
  };
  if (faults.size() == 1) return line(faults.front());
  std::string text = name + ": " + std::to_string(faults.size()) + " faults";
  for (std::size_t i = 0; i < std::min(faults.size(), kShown); ++i)
    text += "\n  " + line(faults[i]);
  if (faults.size() > kShown) text += "\n  and " + std::to_string(faults.size() - kShown) + " more";
  return text;
}

namespace {

std::string Printed(const UrdfModel& model, bool compact) {
  tinyxml2::XMLDocument document;
  document.InsertEndChild(document.NewDeclaration());
  XMLElement* robot = document.NewElement("robot");
  document.InsertEndChild(robot);
  Set(*robot, "name", model.name);
  // MuJoCo alone strips folders from mesh paths and drops visuals unless told otherwise
  XMLElement& compiler = Add(Add(*robot, "mujoco"), "compiler");
  Set(compiler, "strippath", "false");
  Set(compiler, "discardvisual", model.mujoco_reads_visuals ? "false" : "true");
  for (const UrdfLink& link : model.links) AddLink(*robot, link);
  for (const UrdfJoint& joint : model.joints) AddJoint(*robot, joint);
  tinyxml2::XMLPrinter printer(nullptr, compact);
  document.Print(&printer);
  return printer.CStr();
}

}  // namespace

std::string ToUrdf(const UrdfModel& model) { return Printed(model, false); }

std::string ToCompactUrdf(const UrdfModel& model) { return Printed(model, true); }

std::string RootLinkOf(const UrdfModel& model) {
  const auto fail = [&](const std::string& problem) {
    throw Error(ErrorCode::kFormat, "robot \"" + model.name + "\": " + problem);
  };
  std::map<std::string, std::string> parent_of;
  for (const UrdfJoint& joint : model.joints) {
    if (!parent_of.emplace(joint.child, joint.parent).second)
      fail("link \"" + joint.child + "\" is the child of two joints");
  }
  std::string root;
  for (const UrdfLink& link : model.links) {
    if (parent_of.contains(link.name)) continue;
    if (!root.empty()) fail("links \"" + root + "\" and \"" + link.name + "\" both have no parent");
    root = link.name;
  }
  if (root.empty()) fail("every link has a parent; one must be the root");
  // with one root and one parent each, a link off the tree lies on a cycle
  std::map<std::string, std::vector<std::string>> children_of;
  for (const UrdfJoint& joint : model.joints) children_of[joint.parent].push_back(joint.child);
  std::set<std::string> reached;
  std::vector<std::string> pending = {root};
  while (!pending.empty()) {
    const std::string at = std::move(pending.back());
    pending.pop_back();
    reached.insert(at);
    for (const std::string& child : children_of[at]) pending.push_back(child);
  }
  for (const UrdfLink& link : model.links) {
    if (!reached.contains(link.name)) fail("link \"" + link.name + "\" hangs on a cycle of joints");
  }
  return root;
}

}  // namespace doorforge
