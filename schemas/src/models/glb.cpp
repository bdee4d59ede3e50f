// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/glb.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <set>

#include <nlohmann/json.hpp>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/read_beginning.h"

namespace doorforge {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint64_t kMostBytes = 512ULL << 20U;
constexpr std::size_t kMostJsonBytes = 64ULL << 20U;
constexpr std::size_t kMostLinks = 2000;
constexpr int kDeepestNode = 64;
constexpr std::uint64_t kMostTriangles = 5'000'000;
constexpr std::uint32_t kGlbMagic = 0x46546C67;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;
constexpr std::size_t kHeaderBytes = 12;
constexpr std::size_t kChunkHeaderBytes = 8;

std::uint32_t NumberAt(std::string_view bytes, std::size_t at) {
  std::uint32_t number = 0;
  std::memcpy(&number, bytes.data() + at, sizeof number);
  return number;
}

/// The two chunks of a binary glTF.
struct Chunks {
  std::string_view json;
  std::string_view binary;
};

[[noreturn]] void RefuseGlb(const std::string& name, const std::string& problem) {
  throw Error(ErrorCode::kFormat, name + ": " + problem);
}

Chunks ChunksOf(std::string_view bytes, const std::string& name) {
  if (bytes.size() < kHeaderBytes + kChunkHeaderBytes || NumberAt(bytes, 0) != kGlbMagic)
    RefuseGlb(name, "is no binary glTF");
  if (NumberAt(bytes, 4) != 2)
    RefuseGlb(name, "glTF version " + std::to_string(NumberAt(bytes, 4)) + ", read is version 2");
  Chunks chunks;
  std::size_t at = kHeaderBytes;
  while (at + kChunkHeaderBytes <= bytes.size()) {
    const std::size_t length = NumberAt(bytes, at);
    const std::uint32_t type = NumberAt(bytes, at + 4);
    at += kChunkHeaderBytes;
    if (length > bytes.size() - at) RefuseGlb(name, "a chunk is longer than the file");
    const std::string_view chunk = bytes.substr(at, length);
    if (type == kJsonChunk && chunks.json.empty()) chunks.json = chunk;
    if (type == kBinaryChunk && chunks.binary.empty()) chunks.binary = chunk;
    at += length;
  }
  if (chunks.json.empty()) RefuseGlb(name, "has no chunk of JSON");
  if (chunks.json.size() > kMostJsonBytes) RefuseGlb(name, "has more than 64 MiB of JSON");
  return chunks;
}

bool IsLink(const Json& node) {
  const auto extras = node.find("extras");
  return extras != node.end() && extras->is_object() &&
         (extras->contains("mass") || extras->contains("joint"));
}

/// Reads by JSON pointers in messages.
class GlbModel {
 public:
  GlbModel(std::string_view bytes, const std::string& name) : name_(name) {
    const Chunks chunks = ChunksOf(bytes, name);
    binary_ = chunks.binary;
    document_ = ParseJson(std::string(chunks.json), name);
  }

  UrdfModel Read() {
    const Json& nodes = List("nodes");
    const Json& scenes = List("scenes");
    const std::size_t scene =
        document_.contains("scene") ? Index(document_["scene"], scenes, "/scene") : 0;
    if (scenes.empty()) Fail("/scenes", "no scene");
    const Json roots = scenes[scene].value("nodes", Json::array());
    for (const Json& root : roots)
      Walk({Index(root, nodes, "/scenes/nodes"), 0, {}, RigidTransform::Identity()});
    if (model_.links.empty()) Fail("/nodes", "no node has a mass or a joint among its extras");
    CheckParents();
    return std::move(model_);
  }

 private:
  /// A node on its way: its number, the link that it hangs on, and its place there.
  struct Step {
    std::size_t node;
    int depth;
    std::optional<std::size_t> link;
    RigidTransform link_from_node;
  };

  [[noreturn]] void Fail(const std::string& pointer, const std::string& problem) const {
    RefuseGlb(name_, pointer + ": " + problem);
  }

  const Json& List(const char* key) const {
    static const Json kNone = Json::array();
    const auto list = document_.find(key);
    if (list == document_.end()) return kNone;
    if (!list->is_array()) Fail(std::string("/") + key, "is no list");
    return *list;
  }

  std::size_t Index(const Json& value, const Json& list, const std::string& pointer) const {
    if (!value.is_number_unsigned() || value.get<std::uint64_t>() >= list.size())
      Fail(pointer, "names nothing that is there");
    return value.get<std::size_t>();
  }

  std::vector<double> Numbers(const Json& of, const char* key, std::size_t count,
                              const std::string& pointer) const {
    const auto value = of.find(key);
    if (value == of.end()) return {};
    const bool fits = value->is_array() && value->size() == count &&
                      std::all_of(value->begin(), value->end(), [](const Json& n) {
                        return n.is_number() && std::isfinite(n.get<double>());
                      });
    if (!fits) Fail(pointer + "/" + key, "expected " + std::to_string(count) + " numbers");
    return value->get<std::vector<double>>();
  }

  RigidTransform PoseOf(const Json& node, const std::string& pointer) const {
    if (node.contains("matrix") || node.contains("scale"))
      Fail(pointer, "a node with a matrix or a scale, which exports do not write");
    RigidTransform pose = RigidTransform::Identity();
    if (const auto t = Numbers(node, "translation", 3, pointer); !t.empty())
      pose.translation() = Eigen::Vector3d(t[0], t[1], t[2]);
    if (const auto q = Numbers(node, "rotation", 4, pointer); !q.empty()) {
      const Eigen::Quaterniond turn(q[3], q[0], q[1], q[2]);
      if (std::abs(turn.norm() - 1) > 1e-3) Fail(pointer + "/rotation", "is no unit quaternion");
      pose.linear() = turn.normalized().toRotationMatrix();
    }
    return pose;
  }

  void Walk(const Step& step) {
    const std::string pointer = "/nodes/" + std::to_string(step.node);
    if (step.depth > kDeepestNode || !visited_.insert(step.node).second)
      Fail(pointer, "is reached twice, or lies deeper than 64 levels");
    const Json& node = List("nodes")[step.node];
    if (!node.is_object()) Fail(pointer, "is no object");
    const RigidTransform pose = PoseOf(node, pointer);
    Step below{0, step.depth + 1, step.link, step.link_from_node * pose};
    if (IsLink(node)) {
      below.link = AddLink(node, step.link_from_node * pose, pointer);
      below.link_from_node = RigidTransform::Identity();
    } else if (!step.link) {
      AddWords(node, pointer);
    }
    if (node.contains("mesh") && below.link) AddShapes(node, below, pointer);
    const Json children = node.value("children", Json::array());
    for (const Json& child : children) {
      below.node = Index(child, List("nodes"), pointer + "/children");
      Walk(below);
    }
  }

  double Number(const Json& of, const char* key, const std::string& pointer) const {
    const auto value = of.find(key);
    if (value == of.end() || !value->is_number() || !std::isfinite(value->get<double>()))
      Fail(pointer + "/" + key, "expected a number");
    return value->get<double>();
  }

  std::string Text(const Json& of, const char* key, const std::string& pointer) const {
    const auto value = of.find(key);
    if (value == of.end() || !value->is_string()) Fail(pointer + "/" + key, "expected a text");
    return value->get<std::string>();
  }

  std::size_t AddLink(const Json& node, const RigidTransform& pose, const std::string& pointer) {
    if (model_.links.size() >= kMostLinks) Fail(pointer, "more than the 2000 links allowed");
    const Json& extras = node["extras"];
    UrdfLink link;
    link.name = Text(node, "name", pointer);
    if (extras.contains("mass")) link.inertial = MassOf(extras["mass"], pointer + "/extras/mass");
    if (extras.contains("joint"))
      AddJoint(extras["joint"], link.name, pose, pointer + "/extras/joint");
    model_.links.push_back(std::move(link));
    return model_.links.size() - 1;
  }

  MassProperties MassOf(const Json& mass, const std::string& pointer) const {
    if (!mass.is_object()) Fail(pointer, "is no object");
    const auto required = [&](const char* key) {
      const std::vector<double> n = Numbers(mass, key, 3, pointer);
      if (n.empty()) Fail(pointer + "/" + key, "is missing");
      return Eigen::Vector3d(n[0], n[1], n[2]);
    };
    MassProperties read;
    read.mass_kg = Number(mass, "mass_kg", pointer);
    read.center_of_mass_m = required("center_of_mass_m");
    const Eigen::Vector3d d = required("inertia_xx_yy_zz_kg_m2");
    const Eigen::Vector3d o = required("inertia_xy_xz_yz_kg_m2");
    read.inertia_kg_m2 << d[0], o[0], o[1], o[0], d[1], o[2], o[1], o[2], d[2];
    return read;
  }

  void AddJoint(const Json& joint, const std::string& child, const RigidTransform& pose,
                const std::string& pointer) {
    if (!joint.is_object()) Fail(pointer, "is no object");
    UrdfJoint read;
    read.name = Text(joint, "name", pointer);
    read.parent = Text(joint, "parent", pointer);
    read.child = child;
    read.parent_from_joint = pose;
    const std::string type = Text(joint, "type", pointer);
    if (type != "revolute" && type != "fixed")
      Fail(pointer + "/type", "\"" + type + "\", expected revolute or fixed");
    read.type = type == "fixed" ? UrdfJointType::kFixed : UrdfJointType::kRevolute;
    const std::vector<double> axis = Numbers(joint, "axis", 3, pointer);
    if (axis.empty()) Fail(pointer + "/axis", "is missing");
    read.axis = Eigen::Vector3d(axis[0], axis[1], axis[2]);
    read.lower = Number(joint, "lower_rad", pointer);
    read.upper = Number(joint, "upper_rad", pointer);
    read.effort = Number(joint, "effort_limit_nm", pointer);
    read.velocity = Number(joint, "velocity_limit_rad_s", pointer);
    read.damping = Number(joint, "damping_nm_s", pointer);
    model_.joints.push_back(std::move(read));
  }

  // A number as DoorWords() writes it.
  std::string WordOf(const Json& value, const std::string& pointer) const {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_boolean()) return value.get<bool>() ? "true" : "false";
    if (!value.is_number()) Fail(pointer, "expected a text, a number or a truth");
    char digits[32];
    return {digits, std::to_chars(digits, digits + sizeof digits, value.get<double>() + 0.0).ptr};
  }

  // The node above all links is the door.
  void AddWords(const Json& node, const std::string& pointer) {
    const auto extras = node.find("extras");
    if (model_.name.empty() && node.contains("name")) model_.name = Text(node, "name", pointer);
    if (extras == node.end() || !extras->is_object()) return;
    for (const auto& [key, value] : extras->items()) {
      if (!value.is_object()) {
        model_.words["door_" + key] = WordOf(value, pointer + "/extras/" + key);
        continue;
      }
      for (const auto& [name, word] : value.items())
        model_.words[key + "_" + name] = WordOf(word, pointer + "/extras/" + key + "/" + name);
    }
  }

  void AddShapes(const Json& node, const Step& at, const std::string& pointer) {
    const std::size_t number = Index(node["mesh"], List("meshes"), pointer + "/mesh");
    const std::string mesh_pointer = "/meshes/" + std::to_string(number);
    const Json primitives = List("meshes")[number].value("primitives", Json::array());
    for (std::size_t i = 0; i < primitives.size(); ++i) {
      UrdfShape shape;
      shape.name = node.value("name", "");
      shape.link_from_shape = at.link_from_node;
      shape.geometry =
          TrianglesOf(primitives[i], mesh_pointer + "/primitives/" + std::to_string(i));
      shape.color_rgba = ColorOf(primitives[i]);
      model_.links[*at.link].visuals.push_back(std::move(shape));
    }
  }

  /// The bytes of an accessor: `stride` apart, `count` of them.
  struct Elements {
    std::string_view bytes;
    std::uint64_t count = 0;
    std::uint64_t stride = 0;
    std::uint64_t component = 0;
  };

  std::uint64_t Unsigned(const Json& of, const char* key, std::uint64_t fallback,
                         const std::string& pointer) const {
    const auto value = of.find(key);
    if (value == of.end()) return fallback;
    if (!value->is_number_unsigned()) Fail(pointer + "/" + key, "expected a whole number");
    return value->get<std::uint64_t>();
  }

  // `most` keeps sums and products below far from where they would wrap.
  Elements ElementsOf(const Json& index, std::uint64_t element_bytes,
                      const std::string& pointer) const {
    const std::size_t number = Index(index, List("accessors"), pointer);
    const std::string at = "/accessors/" + std::to_string(number);
    const Json& accessor = List("accessors")[number];
    if (!accessor.contains("bufferView") || accessor.contains("sparse"))
      Fail(at, "has no bufferView, or is sparse");
    const std::size_t view_number = Index(accessor["bufferView"], List("bufferViews"), at);
    const Json& view = List("bufferViews")[view_number];
    const std::string view_at = "/bufferViews/" + std::to_string(view_number);
    if (Unsigned(view, "buffer", 0, view_at) != 0) Fail(view_at, "is of another buffer");
    const std::uint64_t begin = Unsigned(view, "byteOffset", 0, view_at);
    const std::uint64_t length = Unsigned(view, "byteLength", 0, view_at);
    if (begin > binary_.size() || length > binary_.size() - begin)
      Fail(view_at, "leads out of the buffer");
    Elements elements;
    elements.component = Unsigned(accessor, "componentType", 0, at);
    elements.count = Unsigned(accessor, "count", 0, at);
    elements.stride = Unsigned(view, "byteStride", element_bytes, view_at);
    const std::uint64_t offset = Unsigned(accessor, "byteOffset", 0, at);
    constexpr std::uint64_t kMostElements = 3 * kMostTriangles;
    if (elements.count > kMostElements || elements.stride < element_bytes || elements.stride > 252)
      Fail(at, "count or stride is out of range");
    const std::uint64_t needed =
        elements.count == 0 ? 0 : (elements.count - 1) * elements.stride + element_bytes;
    if (offset > length || needed > length - offset) Fail(at, "leads out of its view");
    elements.bytes = binary_.substr(begin + offset, needed);
    return elements;
  }

  static std::uint64_t BytesOf(std::uint64_t component) {
    return component == 5121 ? 1 : component == 5123 ? 2 : component == 5125 ? 4 : 0;
  }

  UrdfTriangles TrianglesOf(const Json& primitive, const std::string& pointer) {
    if (primitive.value("mode", 4) != 4) Fail(pointer, "no triangles");
    const auto attributes = primitive.find("attributes");
    if (attributes == primitive.end() || !attributes->contains("POSITION"))
      Fail(pointer + "/attributes", "no POSITION");
    constexpr std::uint64_t kPointBytes = 12;
    const Elements points = ElementsOf((*attributes)["POSITION"], kPointBytes, pointer);
    if (points.component != 5126) Fail(pointer, "positions that are no floats");
    UrdfTriangles read;
    for (std::uint64_t i = 0; i < points.count; ++i) {
      float at[3];
      std::memcpy(at, points.bytes.data() + i * points.stride, sizeof at);
      read.mesh.vertices.emplace_back(at[0], at[1], at[2]);
      if (!read.mesh.vertices.back().allFinite()) Fail(pointer, "a position is not finite");
    }
    AddIndices(primitive, pointer, read.mesh);
    triangles_ += read.mesh.triangles.size();
    if (triangles_ > kMostTriangles) Fail(pointer, "more than the 5000000 triangles allowed");
    return read;
  }

  void AddIndices(const Json& primitive, const std::string& pointer, TriangleMesh& mesh) const {
    if (!primitive.contains("indices")) Fail(pointer, "no indices");
    const Json& index = primitive["indices"];
    const std::size_t number = Index(index, List("accessors"), pointer + "/indices");
    const std::uint64_t bytes =
        BytesOf(Unsigned(List("accessors")[number], "componentType", 0, pointer + "/indices"));
    if (bytes == 0) Fail(pointer + "/indices", "are no unsigned whole numbers");
    const Elements order = ElementsOf(index, bytes, pointer + "/indices");
    const auto vertex = [&](std::uint64_t i) {
      std::uint32_t at = 0;
      std::memcpy(&at, order.bytes.data() + i * order.stride, bytes);
      if (at >= mesh.vertices.size()) Fail(pointer + "/indices", "name a vertex that is not there");
      return static_cast<int>(at);
    };
    for (std::uint64_t i = 0; i + 2 < order.count; i += 3)
      mesh.triangles.emplace_back(vertex(i), vertex(i + 1), vertex(i + 2));
  }

  // A channel as a screen shows it (IEC 61966-2-1).
  static double ScreenLight(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
  }

  std::optional<Eigen::Vector4d> ColorOf(const Json& primitive) const {
    if (!primitive.contains("material")) return std::nullopt;
    const std::size_t number = Index(primitive["material"], List("materials"), "/materials");
    const std::string pointer = "/materials/" + std::to_string(number);
    const auto look = List("materials")[number].find("pbrMetallicRoughness");
    if (look == List("materials")[number].end() || !look->is_object()) return std::nullopt;
    const std::vector<double> c = Numbers(*look, "baseColorFactor", 4, pointer);
    if (c.empty()) return std::nullopt;
    const auto light = [&](std::size_t k) { return ScreenLight(std::clamp(c[k], 0.0, 1.0)); };
    return Eigen::Vector4d(light(0), light(1), light(2), std::clamp(c[3], 0.0, 1.0));
  }

  void CheckParents() const {
    std::set<std::string> links;
    for (const UrdfLink& link : model_.links) links.insert(link.name);
    for (const UrdfJoint& joint : model_.joints) {
      if (!links.contains(joint.parent))
        Fail("joint \"" + joint.name + "\"", "link \"" + joint.parent + "\" does not exist");
    }
  }

  std::string name_;
  std::string_view binary_;
  Json document_;
  std::set<std::size_t> visited_;
  std::uint64_t triangles_ = 0;
  UrdfModel model_;
};

}  // namespace

bool HasLinks(const std::filesystem::path& path) {
  constexpr std::size_t kHeadBytes = kHeaderBytes + kChunkHeaderBytes;
  const std::string head = ReadBeginning(path, kHeadBytes);
  if (head.size() < kHeadBytes) return false;
  if (NumberAt(head, 0) != kGlbMagic || NumberAt(head, kHeaderBytes + 4) != kJsonChunk)
    return false;
  const std::size_t length = NumberAt(head, kHeaderBytes);
  if (length > kMostJsonBytes) return false;
  const std::string json = ReadBeginning(path, kHeadBytes + length).erase(0, kHeadBytes);
  // looked at as text, since files are searched by the thousand
  return json.find("\"mass_kg\"") != std::string::npos &&
         json.find("\"joint\"") != std::string::npos;
}

UrdfModel ParseGlb(std::string_view bytes, const std::string& name) {
  try {
    return GlbModel(bytes, name).Read();
  } catch (const nlohmann::json::exception& error) {
    RefuseGlb(name, error.what());
  }
}

UrdfModel ReadGlb(const std::filesystem::path& path, std::vector<UrdfFault>& /*faults*/) {
  return ParseGlb(ReadFile(path, kMostBytes), path.string());
}

}  // namespace doorforge
