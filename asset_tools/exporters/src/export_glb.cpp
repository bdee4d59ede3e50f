// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cmath>
#include <cstring>
#include <map>

#include <nlohmann/json.hpp>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/json_file.h"
#include "doorforge/exporters/export_door.h"
#include "doorforge/schemas/door_words.h"

#include "door_formats.h"
#include "export_text.h"

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
    Json extras;
    for (const auto& [name, text] : DoorWords(door_)) extras[name] = text;
    extras["latch"] = {{"type", NameOf(latch.type)},
                       {"unlock_angle_rad", latch.unlock_angle_rad},
                       {"handle_done_angle_rad", latch.handle_done_angle_rad},
                       {"lock_effort_nm", latch.lock_effort_nm},
                       {"hinge_spring_nm_per_rad", latch.hinge_spring_nm_per_rad},
                       {"handle_spring_nm_per_rad", latch.handle_spring_nm_per_rad},
                       {"relatch", latch.relatch},
                       {"unlocks_ajar", latch.unlocks_ajar},
                       {"bolt_throw_m", latch.bolt_throw_m}};
    return extras;
  }

  int AddLink(DoorLinkIndex index, std::vector<int> children) {
    const DoorLink& link = door_.links[static_cast<std::size_t>(index)];
    for (const DoorGeometry& geometry : link.geometry) {
      const int mesh = AddMesh(geometry);
      children.push_back(AddNode({{"name", geometry.name}, {"mesh", mesh}}));
    }
    if (index == kHandleLink) children.push_back(AddGrasp());
    Json node = {
        {"name", link.name},
        {"extras", {{"mass", MassExtras(link.mass)}, {"label", internal::LabelOf(index)}}}};
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

  // A frame with nothing drawn in it.
  int AddGrasp() {
    const Eigen::Quaterniond turn(door_.handle_from_grasp.linear());
    return AddNode({{"name", "grasp"},
                    {"translation", Vector3ToJson(door_.handle_from_grasp.translation())},
                    {"rotation", {turn.x(), turn.y(), turn.z(), turn.w()}},
                    {"extras", {{"half_extent_m", Vector3ToJson(door_.grasp_half_extent_m)}}}});
  }

  // without normals a reader shades each triangle flat, as the specification says
  int AddMesh(const DoorGeometry& geometry) {
    Json primitives = Json::array();
    if (geometry.visual.empty()) {
      primitives.push_back(
          {{"attributes", {{"POSITION", AddPositions(geometry.mesh.vertices)}}},
           {"indices", AddIndices(geometry.mesh.triangles)},
           {"material", AddMaterial({geometry.name, geometry.color_rgba, nullptr})}});
    }
    const bool from_behind = !internal::HasTwoSides(geometry.visual);
    for (const VisualSurface& surface : geometry.visual.surfaces) {
      primitives.push_back(Primitive(geometry.visual, surface));
      if (from_behind) gltf_["materials"].back()["doubleSided"] = true;
    }
    gltf_["meshes"].push_back({{"name", geometry.name}, {"primitives", primitives}});
    return static_cast<int>(gltf_["meshes"].size()) - 1;
  }

  // glTF has one index for position and texture coordinates
  Json Primitive(const VisualMesh& mesh, const VisualSurface& surface) {
    std::map<std::pair<int, int>, int> index_of;
    std::vector<Eigen::Vector3d> positions;
    std::vector<Eigen::Vector2d> texcoords;
    std::vector<Eigen::Vector3i> triangles = surface.triangles;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      for (int k = 0; k < 3; ++k) {
        const int at = surface.texcoords.empty() ? -1 : surface.texcoords[i][k];
        const auto [entry, is_new] =
            index_of.try_emplace({triangles[i][k], at}, static_cast<int>(positions.size()));
        if (is_new) positions.push_back(mesh.vertices[static_cast<std::size_t>(triangles[i][k])]);
        if (is_new && at >= 0) texcoords.push_back(mesh.texcoords[static_cast<std::size_t>(at)]);
        triangles[i][k] = entry->second;
      }
    }
    Json attributes = {{"POSITION", AddPositions(positions)}};
    if (!texcoords.empty()) attributes["TEXCOORD_0"] = AddTexcoords(texcoords);
    return {{"attributes", attributes},
            {"indices", AddIndices(triangles)},
            {"material", AddMaterial(surface.material)}};
  }

  // the factor of glTF is linear, colours of parts are as seen on a screen
  int AddMaterial(const VisualMaterial& stated) {
    const Eigen::Vector4d& c = stated.color_rgba;
    Json look = {{"baseColorFactor",
                  {internal::LinearLight(c[0]), internal::LinearLight(c[1]),
                   internal::LinearLight(c[2]), c[3]}},
                 {"metallicFactor", 0},
                 {"roughnessFactor", 0.6}};
    if (stated.texture != nullptr)
      look["baseColorTexture"] = {{"index", TextureNumber(*stated.texture)}};
    Json material = {{"name", stated.name}, {"pbrMetallicRoughness", look}};
    if (c[3] < 1) material["alphaMode"] = "BLEND";
    gltf_["materials"].push_back(std::move(material));
    return static_cast<int>(gltf_["materials"].size()) - 1;
  }

  int TextureNumber(const VisualTexture& texture) {
    const auto [entry, is_new] =
        texture_of_.try_emplace(texture.sha256, static_cast<int>(texture_of_.size()));
    if (!is_new) return entry->second;
    const std::size_t start = buffer_.size();
    buffer_ += texture.bytes;
    gltf_["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", start}, {"byteLength", texture.bytes.size()}});
    buffer_.resize((buffer_.size() + 3) / 4 * 4, '\0');
    gltf_["images"].push_back(
        {{"name", FileNameOf(texture)},
         {"mimeType", texture.format == TextureFormat::kPng ? "image/png" : "image/jpeg"},
         {"bufferView", gltf_["bufferViews"].size() - 1}});
    gltf_["textures"].push_back({{"source", entry->second}});
    return entry->second;
  }

  int AddPositions(const std::vector<Eigen::Vector3d>& positions) {
    const std::size_t start = buffer_.size();
    Eigen::AlignedBox3d bounds;
    for (const Eigen::Vector3d& position : positions) {
      bounds.extend(position);
      for (const double coordinate : position) Append(static_cast<float>(coordinate), buffer_);
    }
    return AddAccessor(start, kArrayBuffer,
                       {{"componentType", kFloat},
                        {"count", positions.size()},
                        {"type", "VEC3"},
                        {"min", Vector3ToJson(bounds.min())},
                        {"max", Vector3ToJson(bounds.max())}});
  }

  // glTF's origin is the upper left corner of the picture
  int AddTexcoords(const std::vector<Eigen::Vector2d>& texcoords) {
    const std::size_t start = buffer_.size();
    for (const Eigen::Vector2d& at : texcoords) {
      Append(static_cast<float>(at.x()), buffer_);
      Append(static_cast<float>(1 - at.y()), buffer_);
    }
    return AddAccessor(start, kArrayBuffer,
                       {{"componentType", kFloat}, {"count", texcoords.size()}, {"type", "VEC2"}});
  }

  int AddIndices(const std::vector<Eigen::Vector3i>& triangles) {
    const std::size_t start = buffer_.size();
    for (const Eigen::Vector3i& triangle : triangles) {
      for (const int index : triangle) Append(static_cast<std::uint32_t>(index), buffer_);
    }
    return AddAccessor(
        start, kElementArrayBuffer,
        {{"componentType", kUnsignedInt}, {"count", triangles.size() * 3}, {"type", "SCALAR"}});
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
    std::string json = JsonText(gltf_);
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
  std::string buffer_;  // of 4-byte numbers and padded pictures, so every view is aligned
  std::map<std::string, int> texture_of_;  // by SHA-256
};

}  // namespace

std::string ToGlb(const DoorAsset& door) { return GlbWriter(door).Write(); }

namespace internal {

void WriteGlb(const DoorAsset& door, const ExportSettings& /*settings*/,
              const std::filesystem::path& folder) {
  CommitFile(folder / "model.glb", ToGlb(door));
}

}  // namespace internal
}  // namespace doorforge
