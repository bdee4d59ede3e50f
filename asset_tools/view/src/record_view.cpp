// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "record_view.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <string_view>
#include <utility>

#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/inside_folder.h"
#include "doorforge/core/mesh_transform.h"
#include "doorforge/schemas/bolt.h"
#include "doorforge/schemas/mesh_pool.h"

namespace doorforge::internal {
namespace {

namespace fs = std::filesystem;
using Json = PageContent::Json;

bool NamesPool(const std::string& relative) {
  return relative.starts_with(std::string(kMeshPoolPath) + "/");
}

// A file that says something else than what the record was written with is shown, and said.
TriangleMesh ReadOwn(const fs::path& file, const std::string& sha256,
                     std::vector<std::string>& faults) {
  TriangleMesh mesh = ReadObj(file);
  if (Sha256Hex(ToObj(mesh)) != sha256)
    faults.push_back(file.string() + ": is not the mesh that the record was written with");
  return mesh;
}

MeshReader ReaderOf(const fs::path& folder, const std::string& record,
                    std::vector<std::string>& faults) {
  return [&faults, folder, record](const std::string& relative, const std::string& sha256) {
    try {
      return NamesPool(relative) ? MeshPool(folder, record).ReadMesh(sha256)
                                 : ReadOwn(FileInside(folder, relative, record), sha256, faults);
    } catch (const Error& error) {
      faults.emplace_back(error.what());
      return TriangleMesh{};
    }
  };
}

VisualReader VisualReaderOf(const fs::path& folder, const std::string& record,
                            std::vector<std::string>& faults) {
  return [&faults, read = DoorVisualReader(folder, record)](const VisualFiles& files) {
    try {
      return read(files);
    } catch (const Error& error) {
      faults.emplace_back(error.what());
      return VisualMesh{};
    }
  };
}

bool IsOfName(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

// Whether `name` stands in the text, and is not a part of a longer word.
bool Tells(std::string_view text, std::string_view name) {
  for (std::size_t at = text.find(name); at != std::string_view::npos;
       at = text.find(name, at + 1)) {
    const std::size_t end = at + name.size();
    if ((at == 0 || !IsOfName(text[at - 1])) && (end == text.size() || !IsOfName(text[end])))
      return true;
  }
  return false;
}

// "leaf_12" of meshes/collision/leaf_12.obj is the geometry "leaf".
bool TellsHullOf(std::string_view text, const std::string& name) {
  const std::string file = "/" + name + "_";
  const std::size_t at = text.find("collision" + file);
  if (at == std::string_view::npos) return false;
  std::size_t end = at + 9 + file.size();
  const std::size_t digits = end;
  while (end < text.size() && std::isdigit(static_cast<unsigned char>(text[end])) != 0) ++end;
  return end > digits && text.substr(end).starts_with(".obj");
}

Json ColorJson(const Eigen::Vector4d& color) { return {color[0], color[1], color[2], color[3]}; }

Json VisualForView(const VisualMesh& visual, PageContent& content) {
  Json surfaces = Json::array();
  for (const VisualSurface& surface : visual.surfaces) {
    Json shown = {{"mesh", content.AddSurface(visual, surface)},
                  {"color", ColorJson(surface.material.color_rgba)}};
    if (const auto& texture = surface.material.texture) {
      shown["texture"] = content.AddBytes(texture->bytes);
      shown["texture"]["type"] =
          texture->format == TextureFormat::kPng ? "image/png" : "image/jpeg";
    }
    surfaces.push_back(std::move(shown));
  }
  return surfaces;
}

Json LinkForView(const DoorLink& link, std::size_t number, const MeshesForView& meshes) {
  Json pieces = Json::array();
  for (std::size_t i = 0; i < link.geometry.size(); ++i) {
    const DoorGeometry& geometry = link.geometry[i];
    Json piece = {{"name", geometry.name}, {"color", ColorJson(geometry.color_rgba)}};
    piece.update(meshes(geometry, number, i));
    pieces.push_back(std::move(piece));
  }
  return {{"name", link.name},
          {"mass_kg", link.mass.mass_kg},
          {"center_of_mass_m", Vector3ToJson(link.mass.center_of_mass_m)},
          {"geometry", std::move(pieces)}};
}

Json JointForView(const DoorJoint& joint) {
  return {{"name", joint.name},
          {"parent_from_child_at_zero", TransformToJson(joint.parent_from_child_at_zero)},
          {"axis", Vector3ToJson(joint.axis)},
          {"lower_rad", joint.lower_rad},
          {"upper_rad", joint.upper_rad},
          {"effort_limit_nm", joint.effort_limit_nm},
          {"velocity_limit_rad_s", joint.velocity_limit_rad_s},
          {"damping_nm_s", joint.damping_nm_s}};
}

Json LatchForView(const Latch& latch) {
  return {{"type", NameOf(latch.type)},
          {"unlock_angle_rad", latch.unlock_angle_rad},
          {"handle_done_angle_rad", latch.handle_done_angle_rad},
          {"lock_effort_nm", latch.lock_effort_nm},
          {"hinge_spring_nm_per_rad", latch.hinge_spring_nm_per_rad},
          {"handle_spring_nm_per_rad", latch.handle_spring_nm_per_rad},
          {"relatch", latch.relatch},
          {"unlocks_ajar", latch.unlocks_ajar},
          {"bolt_throw_m", latch.bolt_throw_m}};
}

// Null where the door has none, or its numbers and meshes allow none.
Json BoltForView(const DoorAsset& door, PageContent& content) {
  if (door.latch.type == LatchType::kNone) return nullptr;
  std::optional<Bolt> bolt;
  try {
    bolt = BoltOf(door);
  } catch (const Error&) {
    return nullptr;
  }
  return {{"throw_m", bolt->throw_m},
          {"travel_m", bolt->travel_m},
          {"play_m", bolt->play_m},
          {"travel_m_per_rad", bolt->travel_m_per_rad},
          {"strike_thickness_m", bolt->strike_thickness_m},
          {"tip_m", Vector3ToJson(bolt->tip_m)},
          {"leaf_from_bolt", TransformToJson(bolt->leaf_from_bolt)},
          {"bolt_hull", content.AddMesh(bolt->bolt_hull)},
          {"base_from_strike", TransformToJson(bolt->base_from_strike)},
          {"strike_hull", content.AddMesh(bolt->strike_hull)}};
}

std::vector<std::string> NamesIn(const Json& shown) {
  std::vector<std::string> names;
  for (const Json& joint : shown["joints"]) names.push_back(joint["name"]);
  for (const Json& link : shown["links"]) {
    for (const Json& geometry : link["geometry"]) names.push_back(geometry["name"]);
    names.push_back(link["name"]);
  }
  return names;
}

DoorLink LinkOfPiece(const PartPiece* piece, const std::string& name, const Eigen::Vector3d& at) {
  DoorLink link;
  link.name = name;
  if (piece == nullptr) return link;
  const RigidTransform link_from_part = Translation(-at);
  DoorGeometry geometry;
  geometry.name = piece->name;
  geometry.mesh = Transformed(piece->mesh, link_from_part);
  for (const TriangleMesh& hull : piece->hulls)
    geometry.hulls.push_back(Transformed(hull, link_from_part));
  geometry.color_rgba = piece->color_rgba;
  geometry.visual = piece->visual;
  for (Eigen::Vector3d& vertex : geometry.visual.vertices) vertex -= at;
  link.mass = Transformed(piece->mass, link_from_part);
  link.geometry.push_back(std::move(geometry));
  return link;
}

}  // namespace

ReadRecord<DoorAsset> ReadDoorForView(const fs::path& folder) {
  const std::string record = (folder / "door.json").string();
  ReadRecord<DoorAsset> read;
  read.record = ReadDoor(folder, ReaderOf(folder, record, read.faults),
                         VisualReaderOf(folder, record, read.faults));
  return read;
}

ReadRecord<Part> ReadPartForView(const fs::path& folder) {
  const std::string record = (folder / "part.json").string();
  ReadRecord<Part> read;
  read.record = ReadPart(folder, ReaderOf(folder, record, read.faults),
                         VisualReaderOf(folder, record, read.faults));
  return read;
}

std::vector<std::string> PlacesOf(const std::string& where, std::span<const std::string> names) {
  std::vector<std::string> places;
  for (const std::string& name : names) {
    const bool is_new = std::find(places.begin(), places.end(), name) == places.end();
    if (is_new && (Tells(where, name) || TellsHullOf(where, name))) places.push_back(name);
  }
  return places;
}

MeshesForView AllMeshes(PageContent& content) {
  return [&content](const DoorGeometry& geometry, std::size_t, std::size_t) {
    Json hulls = Json::array();
    for (const TriangleMesh& hull : geometry.hulls) hulls.push_back(content.AddMesh(hull));
    Json shown = {{"mesh", content.AddMesh(geometry.mesh)}, {"hulls", std::move(hulls)}};
    if (!geometry.visual.empty()) shown["visual"] = VisualForView(geometry.visual, content);
    return shown;
  };
}

Json DoorForView(const DoorAsset& door, const MeshesForView& meshes, PageContent& content) {
  Json links = Json::array();
  for (std::size_t i = 0; i < door.links.size(); ++i)
    links.push_back(LinkForView(door.links[i], i, meshes));
  return {{"kind", "door"},
          {"id", door.id},
          {"category", NameOf(door.category)},
          {"mechanism", NameOf(door.mechanism)},
          {"license", door.license},
          {"body", door.body.id},
          {"handle", door.handle.id},
          {"hinge_side", NameOf(door.hinge_side)},
          {"opening", NameOf(door.opening)},
          {"physics_source", door.physics_source},
          {"links", std::move(links)},
          {"joints", {JointForView(door.hinge), JointForView(door.handle_joint)}},
          {"latch", LatchForView(door.latch)},
          {"bolt", BoltForView(door, content)},
          {"grasp",
           {{"link", 2},
            {"link_from_grasp", TransformToJson(door.handle_from_grasp)},
            {"half_extent_m", Vector3ToJson(door.grasp_half_extent_m)}}}};
}

Json PartForView(const Part& part, const MeshesForView& meshes) {
  const bool is_body = part.role == PartRole::kBody;
  const Eigen::Vector3d& origin = part.joint.origin_m;
  DoorJoint joint;
  joint.name = is_body ? "hinge" : "handle_joint";
  joint.parent_from_child_at_zero = Translation(origin);
  joint.axis = part.joint.axis;
  joint.lower_rad = part.joint.lower_rad;
  joint.upper_rad = part.joint.upper_rad;
  const DoorLink fixed = LinkOfPiece(FindPiece(part, is_body ? "frame" : "rose"),
                                     is_body ? "base" : "mount", Eigen::Vector3d::Zero());
  const DoorLink moving =
      LinkOfPiece(FindPiece(part, is_body ? "leaf" : "grip"), is_body ? "leaf" : "handle", origin);
  Json shown = {{"kind", "part"},
                {"id", part.id},
                {"role", NameOf(part.role)},
                {"category", NameOf(part.category)},
                {"mechanism", NameOf(part.mechanism)},
                {"license", part.license},
                {"source", part.source},
                {"links", {LinkForView(fixed, 0, meshes), LinkForView(moving, 1, meshes)}},
                {"joints", {JointForView(joint)}},
                {"latch", LatchForView({})},
                {"bolt", nullptr}};
  if (is_body)
    shown["mount"] = TransformToJson(part.part_from_mount);
  else
    shown["grasp"] = {
        {"link", 1},
        {"link_from_grasp", TransformToJson(Translation(-origin) * part.part_from_grasp)},
        {"half_extent_m", Vector3ToJson(part.grasp_half_extent_m)}};
  return shown;
}

void AddFindings(std::span<const Finding> findings, Json& shown) {
  const std::vector<std::string> names = NamesIn(shown);
  Json list = Json::array();
  for (const Finding& finding : findings) {
    const auto rules = ValidationRules();
    const auto rule = std::ranges::find(rules, finding.code, &ValidationRule::code);
    list.push_back({{"code", finding.code},
                    {"severity", NameOf(finding.severity)},
                    {"rule", rule == rules.end() ? std::string_view{} : rule->text},
                    {"where", finding.where},
                    {"measured", finding.measured},
                    {"allowed", finding.allowed},
                    {"fix", finding.fix},
                    {"places", PlacesOf(finding.where, names)}});
  }
  shown["findings"] = std::move(list);
}

}  // namespace doorforge::internal
