// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cmath>
#include <cstring>

#include <nlohmann/json.hpp>

#include "doorforge/door/export_door.h"

#include "export_text.h"
#include "placed_mesh.h"

namespace doorforge {
namespace {

using Json = nlohmann::ordered_json;

// numbers of the glTF 2.0 specification
constexpr int kFloat = 5126;
constexpr int kUnsignedInt = 5125;
constexpr int kArrayBuffer = 34962;
constexpr int kElementArrayBuffer = 34963;
constexpr std::uint32_t kMagic = 0x46546C67;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;

static_assert(std::endian::native == std::endian::little, "glTF buffers are little-endian");

template <class Number>
void Append(Number number, std::string& bytes) {
  char raw[sizeof(Number)];
  std::memcpy(raw, &number, sizeof raw);
  bytes.append(raw, sizeof raw);
}

// The factor of glTF is linear, colours of parts are as seen on a screen (IEC 61966-2-1).
double Linear(double srgb) {
  return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

Json JointExtras(const DoorJoint& joint, const std::string& parent) {
  return {{"name", joint.name},
          {"type", internal::Turns(joint) ? "revolute" : "fixed"},
          {"parent", parent},
          {"axis", Vector3ToJson(joint.axis)},
          {"lower_rad", joint.lower_rad},
          {"upper_rad", joint.upper_rad},
          {"effort_limit_nm", joint.effort_limit_nm},
          {"velocity_limit_rad_s", joint.velocity_limit_rad_s},
          {"damping_nm_s", joint.damping_nm_s}};
}

Json MassExtras(const MassProperties& mass) {
  const Eigen::Matrix3d& i = mass.inertia_kg_m2;
  return {{"mass_kg", mass.mass_kg},
          {"center_of_mass_m", Vector3ToJson(mass.center_of_mass_m)},
          {"inertia_xx_yy_zz_kg_m2", Vector3ToJson(i.diagonal())},
          {"inertia_xy_xz_yz_kg_m2", {i(0, 1), i(0, 2), i(1, 2)}}};
}

class GlbWriter {
 public:
  explicit GlbWriter(const DoorAsset& door) : door_(door) {
    for (const char* list : {"nodes", "meshes", "materials", "accessors", "bufferViews"})
      gltf_[list] = Json::array();
  }

  std::string Write() {
    const int handle = AddLink(kHandleLink, {});
    const int leaf = AddLink(kLeafLink, {handle});
    const int base = AddLink(kBaseLink, {leaf});
    // z up to y up
    const double half = std::sqrt(0.5);
    const int root = AddNode({{"name", door_.id},
                              {"rotation", {-half, 0, 0, half}},
                              {"children", {base}},
                              {"extras", RootExtras()}});
    gltf_["scenes"] = {{{"name", door_.id}, {"nodes", {root}}}};
    gltf_["scene"] = 0;
    gltf_["asset"] = {{"version", "2.0"}, {"generator", "doorforge"}, {"copyright", door_.license}};
    gltf_["buffers"] = {{{"byteLength", buffer_.size()}}};
    return Packed();
  }

 private:
  int AddNode(Json node) {
    gltf_["nodes"].push_back(std::move(node));
    return static_cast<int>(gltf_["nodes"].size()) - 1;
  }

  Json RootExtras() const {
    const Latch& latch = door_.latch;
    return {{"category", NameOf(door_.category)},
            {"mechanism", NameOf(door_.mechanism)},
            {"latch",
             {{"type", NameOf(latch.type)},
              {"unlock_angle_rad", latch.unlock_angle_rad},
              {"handle_done_angle_rad", latch.handle_done_angle_rad},
              {"lock_effort_nm", latch.lock_effort_nm},
              {"hinge_spring_nm_per_rad", latch.hinge_spring_nm_per_rad},
              {"handle_spring_nm_per_rad", latch.handle_spring_nm_per_rad}}}};
  }

  int AddLink(DoorLinkIndex index, std::vector<int> children) {
    const DoorLink& link = door_.links[static_cast<std::size_t>(index)];
    for (const DoorGeometry& geometry : link.geometry) {
      const int mesh = AddMesh(geometry);
      children.push_back(AddNode({{"name", geometry.name}, {"mesh", mesh}}));
    }
    Json node = {{"name", link.name}, {"extras", {{"mass", MassExtras(link.mass)}}}};
    if (index != kBaseLink) {
      const DoorJoint& joint = index == kLeafLink ? door_.hinge : door_.handle_joint;
      const Eigen::Quaterniond turn(joint.parent_from_child_at_zero.linear());
      node["translation"] = Vector3ToJson(joint.parent_from_child_at_zero.translation());
      node["rotation"] = {turn.x(), turn.y(), turn.z(), turn.w()};
      node["extras"]["joint"] =
          JointExtras(joint, door_.links[static_cast<std::size_t>(index) - 1].name);
    }
    if (!children.empty()) node["children"] = children;
    return AddNode(std::move(node));
  }

  int AddMesh(const DoorGeometry& geometry) {
    const int positions = AddPositions(geometry.mesh);
    const int indices = AddIndices(geometry.mesh);
    // without normals a reader shades each triangle flat, as the specification says
    gltf_["meshes"].push_back({{"name", geometry.name},
                               {"primitives",
                                {{{"attributes", {{"POSITION", positions}}},
                                  {"indices", indices},
                                  {"material", AddMaterial(geometry)}}}}});
    return static_cast<int>(gltf_["meshes"].size()) - 1;
  }

  int AddMaterial(const DoorGeometry& geometry) {
    const Eigen::Vector4d& c = geometry.color_rgba;
    Json material = {{"name", geometry.name},
                     {"pbrMetallicRoughness",
                      {{"baseColorFactor", {Linear(c[0]), Linear(c[1]), Linear(c[2]), c[3]}},
                       {"metallicFactor", 0},
                       {"roughnessFactor", 0.6}}}};
    if (c[3] < 1) material["alphaMode"] = "BLEND";
    gltf_["materials"].push_back(std::move(material));
    return static_cast<int>(gltf_["materials"].size()) - 1;
  }

  int AddPositions(const TriangleMesh& mesh) {
    const std::size_t start = buffer_.size();
    for (const Eigen::Vector3d& vertex : mesh.vertices) {
      for (const double coordinate : vertex) Append(static_cast<float>(coordinate), buffer_);
    }
    const Eigen::AlignedBox3d bounds = internal::BoundsOf(mesh);
    return AddAccessor(start, kArrayBuffer,
                       {{"componentType", kFloat},
                        {"count", mesh.vertices.size()},
                        {"type", "VEC3"},
                        {"min", Vector3ToJson(bounds.min())},
                        {"max", Vector3ToJson(bounds.max())}});
  }

  int AddIndices(const TriangleMesh& mesh) {
    const std::size_t start = buffer_.size();
    for (const Eigen::Vector3i& triangle : mesh.triangles) {
      for (const int index : triangle) Append(static_cast<std::uint32_t>(index), buffer_);
    }
    return AddAccessor(start, kElementArrayBuffer,
                       {{"componentType", kUnsignedInt},
                        {"count", mesh.triangles.size() * 3},
                        {"type", "SCALAR"}});
  }

  // of the bytes from `start` to the buffer's end
  int AddAccessor(std::size_t start, int target, const Json& fields) {
    gltf_["bufferViews"].push_back({{"buffer", 0},
                                    {"byteOffset", start},
                                    {"byteLength", buffer_.size() - start},
                                    {"target", target}});
    Json accessor = {{"bufferView", gltf_["bufferViews"].size() - 1}};
    accessor.update(fields);
    gltf_["accessors"].push_back(std::move(accessor));
    return static_cast<int>(gltf_["accessors"].size()) - 1;
  }

  std::string Packed() const {
    std::string json = gltf_.dump();
    json.resize((json.size() + 3) / 4 * 4, ' ');
    std::string glb;
    Append(kMagic, glb);
    Append(std::uint32_t{2}, glb);
    Append(static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + buffer_.size()), glb);
    Append(static_cast<std::uint32_t>(json.size()), glb);
    Append(kJsonChunk, glb);
    glb += json;
    Append(static_cast<std::uint32_t>(buffer_.size()), glb);
    Append(kBinaryChunk, glb);
    return glb + buffer_;
  }

  const DoorAsset& door_;
  Json gltf_;
  std::string buffer_;  // of 4-byte numbers alone, so every view is aligned
};

}  // namespace

std::string ToGlb(const DoorAsset& door) { return GlbWriter(door).Write(); }

}  // namespace doorforge
