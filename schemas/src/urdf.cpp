// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/urdf.h"

#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <set>
#include <string_view>

#include <tinyxml2.h>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"

namespace doorforge {
namespace {

using tinyxml2::XMLElement;

constexpr std::uint64_t kMaxBytes = 16ULL << 20;
constexpr int kMaxDepth = 64;
constexpr std::size_t kMaxElements = 2000;  // of links, and of joints; large objects have 200

// Where in which file: every message begins with it.
struct Source {
  std::string name;

  [[noreturn]] void Fail(int line, const std::string& problem) const {
    throw Error(ErrorCode::kFormat, name + ":" + std::to_string(line) + ": " + problem);
  }
  [[noreturn]] void Fail(const XMLElement& element, const std::string& problem) const {
    Fail(element.GetLineNum(), "<" + std::string(element.Name()) + ">: " + problem);
  }
};

int LineAt(std::string_view text, std::size_t offset) {
  int line = 1;
  for (const char c : text.substr(0, offset)) line += c == '\n' ? 1 : 0;
  return line;
}

// Declarations define entities and name other files; no URDF needs them.
void RefuseDeclarations(std::string_view text, const Source& source) {
  std::size_t at = 0;
  while ((at = text.find("<!", at)) != std::string_view::npos) {
    const std::string_view rest = text.substr(at);
    const bool comment = rest.starts_with("<!--");
    if (!comment && !rest.starts_with("<![CDATA["))
      source.Fail(LineAt(text, at), "a DOCTYPE or another declaration; remove it");
    const std::size_t end = text.find(comment ? "-->" : "]]>", at);
    if (end == std::string_view::npos) return;  // the parser reports it
    at = end + 3;
  }
}

void RefuseDepth(const XMLElement& element, int depth, const Source& source) {
  if (depth > kMaxDepth) source.Fail(element, "more than 64 levels of elements");
  for (const XMLElement* child = element.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement())
    RefuseDepth(*child, depth + 1, source);
}

std::vector<double> Numbers(const XMLElement& element, const char* attribute,
                            const Source& source) {
  const std::string_view text = element.Attribute(attribute);
  std::vector<double> numbers;
  std::size_t at = 0;
  while ((at = text.find_first_not_of(" \t\r\n", at)) != std::string_view::npos) {
    if (text[at] == '+') ++at;
    double number = 0;
    const auto [end, error] = std::from_chars(text.data() + at, text.data() + text.size(), number);
    if (error != std::errc{} || !std::isfinite(number))
      source.Fail(element, std::string(attribute) + "=\"" + std::string(text) +
                               "\" holds something that is not a finite number");
    numbers.push_back(number);
    at = static_cast<std::size_t>(end - text.data());
  }
  return numbers;
}

std::vector<double> NumbersOfCount(const XMLElement& element, const char* attribute,
                                   std::size_t count, const Source& source) {
  std::vector<double> numbers = Numbers(element, attribute, source);
  if (numbers.size() != count)
    source.Fail(element, std::string(attribute) + " has " + std::to_string(numbers.size()) +
                             " numbers, expected " + std::to_string(count));
  return numbers;
}

std::optional<double> OptionalNumber(const XMLElement& element, const char* attribute,
                                     const Source& source) {
  if (element.Attribute(attribute) == nullptr) return std::nullopt;
  return NumbersOfCount(element, attribute, 1, source)[0];
}

double Number(const XMLElement& element, const char* attribute, const Source& source) {
  const auto number = OptionalNumber(element, attribute, source);
  if (!number) source.Fail(element, std::string("missing attribute ") + attribute);
  return *number;
}

Eigen::Vector3d Vector(const XMLElement& element, const char* attribute,
                       const Eigen::Vector3d& fallback, const Source& source) {
  if (element.Attribute(attribute) == nullptr) return fallback;
  const auto numbers = NumbersOfCount(element, attribute, 3, source);
  return {numbers[0], numbers[1], numbers[2]};
}

std::string Text(const XMLElement& element, const char* attribute, const Source& source) {
  const char* text = element.Attribute(attribute);
  if (text == nullptr) source.Fail(element, std::string("missing attribute ") + attribute);
  return text;
}

const XMLElement& Child(const XMLElement& element, const char* name, const Source& source) {
  const XMLElement* child = element.FirstChildElement(name);
  if (child == nullptr) source.Fail(element, std::string("missing <") + name + ">");
  return *child;
}

RigidTransform OriginOf(const XMLElement& element, const Source& source) {
  const XMLElement* origin = element.FirstChildElement("origin");
  if (origin == nullptr) return RigidTransform::Identity();
  return FromXyzRpy(Vector(*origin, "xyz", {0, 0, 0}, source),
                    Vector(*origin, "rpy", {0, 0, 0}, source));
}

MassProperties ReadInertial(const XMLElement& element, const Source& source) {
  MassProperties mass;
  mass.mass_kg = Number(Child(element, "mass", source), "value", source);
  const RigidTransform link_from_center = OriginOf(element, source);
  mass.center_of_mass_m = link_from_center.translation();
  const XMLElement* inertia = element.FirstChildElement("inertia");
  if (inertia == nullptr) return mass;
  const auto at = [&](const char* name) { return Number(*inertia, name, source); };
  Eigen::Matrix3d matrix;
  matrix << at("ixx"), at("ixy"), at("ixz"), at("ixy"), at("iyy"), at("iyz"), at("ixz"), at("iyz"),
      at("izz");
  const Eigen::Matrix3d rotation = link_from_center.linear();
  mass.inertia_kg_m2 = rotation * matrix * rotation.transpose();
  return mass;
}

UrdfGeometry ReadGeometry(const XMLElement& element, const Source& source) {
  const XMLElement* shape = element.FirstChildElement();
  if (shape == nullptr) source.Fail(element, "no shape in it");
  const std::string_view kind = shape->Name();
  if (kind == "mesh")
    return UrdfMeshFile{Text(*shape, "filename", source),
                        Vector(*shape, "scale", {1, 1, 1}, source)};
  if (kind == "box") {
    Text(*shape, "size", source);
    return UrdfBox{Vector(*shape, "size", {0, 0, 0}, source)};
  }
  if (kind == "cylinder")
    return UrdfCylinder{Number(*shape, "radius", source), Number(*shape, "length", source)};
  if (kind == "sphere") return UrdfSphere{Number(*shape, "radius", source)};
  source.Fail(*shape, "unknown shape; expected mesh, box, cylinder or sphere");
}

using Materials = std::map<std::string, Eigen::Vector4d>;

std::optional<Eigen::Vector4d> ColorOf(const XMLElement& material, const Source& source) {
  const XMLElement* color = material.FirstChildElement("color");
  if (color == nullptr || color->Attribute("rgba") == nullptr) return std::nullopt;
  const auto rgba = NumbersOfCount(*color, "rgba", 4, source);
  return Eigen::Vector4d(rgba[0], rgba[1], rgba[2], rgba[3]);
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
  shape.geometry = ReadGeometry(Child(element, "geometry", source), source);
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
  source.Fail(element,
              "unknown type \"" + name + "\"; expected fixed, revolute, continuous or prismatic");
}

void ReadLimit(const XMLElement& element, const Source& source, UrdfJoint& joint) {
  joint.lower = OptionalNumber(element, "lower", source).value_or(0);
  joint.upper = OptionalNumber(element, "upper", source).value_or(0);
  joint.effort = OptionalNumber(element, "effort", source);
  joint.velocity = OptionalNumber(element, "velocity", source);
}

UrdfJoint ReadJoint(const XMLElement& element, const Source& source) {
  UrdfJoint joint;
  joint.name = Text(element, "name", source);
  joint.type = ReadJointType(element, source);
  joint.parent = Text(Child(element, "parent", source), "link", source);
  joint.child = Text(Child(element, "child", source), "link", source);
  joint.parent_from_joint = OriginOf(element, source);
  if (const XMLElement* axis = element.FirstChildElement("axis"))
    joint.axis = Vector(*axis, "xyz", joint.axis, source);
  if (joint.type != UrdfJointType::kFixed && joint.axis.norm() < 1e-9)
    source.Fail(element, "axis of zero length");
  if (const XMLElement* limit = element.FirstChildElement("limit"))
    ReadLimit(*limit, source, joint);
  if (const XMLElement* dynamics = element.FirstChildElement("dynamics")) {
    joint.damping = OptionalNumber(*dynamics, "damping", source).value_or(0);
    joint.friction = OptionalNumber(*dynamics, "friction", source).value_or(0);
  }
  if (const XMLElement* mimic = element.FirstChildElement("mimic"))
    joint.mimic = UrdfMimic{Text(*mimic, "joint", source),
                            OptionalNumber(*mimic, "multiplier", source).value_or(1),
                            OptionalNumber(*mimic, "offset", source).value_or(0)};
  return joint;
}

// Elements of `robot` with this name; refuses two of the same `name`.
std::vector<const XMLElement*> NamedElements(const XMLElement& robot, const char* kind,
                                             const Source& source) {
  std::vector<const XMLElement*> elements;
  std::set<std::string> names;
  for (const XMLElement* element = robot.FirstChildElement(kind); element != nullptr;
       element = element->NextSiblingElement(kind)) {
    const std::string name = Text(*element, "name", source);
    if (!names.insert(name).second)
      source.Fail(*element, "a second one named \"" + name + "\"; names must differ");
    elements.push_back(element);
    if (elements.size() > kMaxElements)
      source.Fail(*element, "more than the " + std::to_string(kMaxElements) +
                                " allowed; leave out "
                                "what the object does not need");
  }
  return elements;
}

void RefuseUnknownLinks(const UrdfModel& model, const XMLElement& robot, const Source& source) {
  std::set<std::string> links;
  for (const UrdfLink& link : model.links) links.insert(link.name);
  for (const UrdfJoint& joint : model.joints) {
    for (const std::string& name : {joint.parent, joint.child}) {
      if (!links.contains(name))
        source.Fail(robot, "joint \"" + joint.name + "\" names link \"" + name +
                               "\", which does not exist");
    }
  }
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
  return ParseUrdf(ReadFile(path, kMaxBytes), path.string());
}

UrdfModel ParseUrdf(const std::string& text, const std::string& name) {
  const Source source{name};
  if (text.size() > kMaxBytes)
    throw Error(ErrorCode::kFormat, name + ": larger than the 16 MiB that a URDF may have");
  RefuseDeclarations(text, source);
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS)
    source.Fail(document.ErrorLineNum(),
                "not well-formed XML; each tag needs its end, each value its quotes");
  const XMLElement* robot = document.RootElement();
  if (robot == nullptr || std::string_view(robot->Name()) != "robot")
    source.Fail(robot == nullptr ? 1 : robot->GetLineNum(), "the root element is not <robot>");
  RefuseDepth(*robot, 1, source);

  UrdfModel model;
  if (const char* robot_name = robot->Attribute("name")) model.name = robot_name;
  const Materials materials = ReadMaterials(*robot, source);
  for (const XMLElement* element : NamedElements(*robot, "link", source))
    model.links.push_back(ReadLink(*element, materials, source));
  for (const XMLElement* element : NamedElements(*robot, "joint", source))
    model.joints.push_back(ReadJoint(*element, source));
  if (model.links.empty()) source.Fail(*robot, "no <link> in it");
  RefuseUnknownLinks(model, *robot, source);
  return model;
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
