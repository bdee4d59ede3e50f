// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/view/gallery_page.h"

#include <algorithm>
#include <map>
#include <optional>

#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/mesh_transform.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/program.h"
#include "doorforge/core/progress.h"
#include "doorforge/physics/robot_model.h"

#include "html_page.h"
#include "record_view.h"
#include "robot_view.h"
#include "shared_meshes.h"
#include "thumbnail.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using internal::DoorOfShared;
using internal::FiledMesh;
using internal::PageContent;
using internal::Subject;
using Json = PageContent::Json;

constexpr std::size_t kAtOnce = 256;  // records in memory

struct Record {
  std::optional<DoorOfShared> door;
  std::optional<Part> part;
  std::string fault;
};

Record ReadRecord(const fs::path& folder, internal::SharedMeshes& meshes) {
  Record record;
  try {
    if (fs::exists(folder / "door.json"))
      record.door = meshes.Read(folder);
    else
      record.part = ReadPart(folder);
  } catch (const Error& error) {
    record.fault = error.what();
  }
  return record;
}

Subject SubjectOf(const DoorOfShared& read, bool handle) {
  Subject subject;
  subject.stands = !handle;
  const auto poses = DoorFromLinks(read.door, 0, 0);
  for (std::size_t i = 0; i < read.door.links.size(); ++i) {
    const auto& link = read.door.links[i];
    for (std::size_t k = 0; k < link.geometry.size(); ++k) {
      const DoorGeometry& geometry = link.geometry[k];
      if ((geometry.label == PointLabel::kHandle) != handle) continue;
      const Eigen::Vector3d color = geometry.color_rgba.head<3>();
      subject.key += read.meshes[i][k].sha256 + JsonText(Vector3ToJson(color));
      subject.meshes.push_back(
          {Transformed(geometry.mesh, poses[i]), 0, PointLabel::kOther, color});
    }
  }
  return subject;
}

/// Collects what a page says of the records, in their order.
class GalleryWriter {
 public:
  explicit GalleryWriter(const GalleryConfig& config) : config_(config) {}

  void Add(const Record& record) {
    if (record.door)
      AddDoor(*record.door);
    else
      AddPart(*record.part);
  }

  // The thumbnails of the subjects that were met since the last call.
  void DrawNew() {
    std::vector<std::string> drawn(new_.size());
    ParallelFor(new_.size(), config_.threads, [&](std::size_t i) {
      drawn[i] = internal::DrawSubject(new_[i], config_.thumbnail_px);
    });
    for (const std::string& picture : drawn) thumbnails_.push_back(content_.AddBytes(picture));
    new_.clear();
  }

  std::size_t size() const { return items_.size(); }

  std::string Page() {
    content_.document["kind"] = "gallery";
    content_.document["version"] = CodeVersion();
    content_.document["words"] = words_;
    content_.document["thumbnails"] = std::move(thumbnails_);
    content_.document["items"] = std::move(items_);
    return internal::HtmlPage("Doors and parts - doorforge", content_);
  }

 private:
  void AddDoor(const DoorOfShared& read) {
    const DoorAsset& door = read.door;
    Json record = internal::DoorForView(
        door,
        [&](const DoorGeometry&, std::size_t link, std::size_t index) {
          return MeshOf(read.meshes[link][index]);
        },
        content_);
    record["gripper"] = GripperOf(door.grasp_half_extent_m);
    Eigen::AlignedBox3d bounds;
    const auto poses = DoorFromLinks(door, 0, 0);
    for (const int link : {kBaseLink, kLeafLink}) {
      for (const DoorGeometry& geometry : door.links[static_cast<std::size_t>(link)].geometry)
        for (const Eigen::Vector3d& vertex : geometry.mesh.vertices)
          bounds.extend(poses[static_cast<std::size_t>(link)] * vertex);
    }
    const Json pictures = {ThumbnailOf(SubjectOf(read, false)), ThumbnailOf(SubjectOf(read, true))};
    AddItem("door", bounds, pictures, std::move(record));
  }

  void AddPart(Part part) {
    for (PartPiece& piece : part.pieces) {
      piece.hulls.clear();
      piece.visual = {};
    }
    Json record =
        internal::PartForView(part, [&](const DoorGeometry& geometry, std::size_t, std::size_t) {
          return Json{{"mesh", content_.AddMesh(geometry.mesh)}};
        });
    if (part.role == PartRole::kHandle) record["gripper"] = GripperOf(part.grasp_half_extent_m);
    Eigen::AlignedBox3d bounds;
    for (const PartPiece& piece : part.pieces) bounds.extend(BoundsOf(piece.mesh));
    const Json pictures = {ThumbnailOf(internal::SubjectOf(part))};
    AddItem(std::string(NameOf(part.role)), bounds, pictures, std::move(record));
  }

  // One a line of a table; numbers stand for words, which many have in common.
  void AddItem(const std::string& role, const Eigen::AlignedBox3d& bounds, const Json& pictures,
               Json record) {
    const Eigen::Vector3d size =
        bounds.isEmpty() ? Eigen::Vector3d::Zero() : Eigen::Vector3d(bounds.sizes());
    const auto mm = [](double metres) { return std::lround(1000 * metres); };
    const Json place = content_.AddBytes(JsonText(record));
    items_.push_back({record["id"],
                      WordOf(role),
                      WordOf(record["category"]),
                      WordOf(record["mechanism"]),
                      WordOf(record["license"]),
                      {mm(size.y()), mm(size.z()), mm(size.x())},
                      pictures,
                      {place["at"], place["bytes"]}});
  }

  std::size_t WordOf(const std::string& word) {
    const auto [entry, is_new] = word_numbers_.try_emplace(word, words_.size());
    if (is_new) words_.push_back(word);
    return entry->second;
  }

  std::size_t ThumbnailOf(Subject subject) {
    const auto [entry, is_new] =
        thumbnail_numbers_.try_emplace(subject.key, thumbnail_numbers_.size());
    if (is_new) new_.push_back(std::move(subject));
    return entry->second;
  }

  Json MeshOf(const FiledMesh& filed) {
    const auto [entry, is_new] = mesh_numbers_.try_emplace(filed.sha256, 0);
    if (is_new) entry->second = content_.AddMesh(*filed.mesh);
    Json shown = {{"mesh", entry->second}};
    if (!filed.link_from_mesh.isApprox(RigidTransform::Identity(), 0))
      shown["place"] = TransformToJson(filed.link_from_mesh);
    return shown;
  }

  Json GripperOf(const Eigen::Vector3d& half_extent_m) {
    const auto [entry, is_new] = grippers_.try_emplace(half_extent_m.y());
    if (is_new) entry->second = internal::GripperForView(robot_, half_extent_m, content_);
    return entry->second;
  }

  GalleryConfig config_;
  RobotModel robot_ = LoadMobileFranka();
  PageContent content_;
  Json words_ = Json::array();
  Json items_ = Json::array();
  Json thumbnails_ = Json::array();
  std::vector<Subject> new_;
  std::map<std::string, std::size_t> word_numbers_;
  std::map<std::string, std::size_t> thumbnail_numbers_;
  std::map<std::string, std::size_t> mesh_numbers_;  // by SHA-256 of the file
  std::map<double, Json> grippers_;                  // by the opening of the fingers
};

}  // namespace

ViewPage MakeGalleryPage(std::span<const fs::path> folders, const GalleryConfig& config) {
  Require(config.thumbnail_px >= 64 && config.thumbnail_px <= 640, ErrorCode::kInvalidArgument,
          "gallery: the width of a thumbnail must lie in 64..640");
  internal::SharedMeshes meshes;
  GalleryWriter writer(config);
  ViewPage page;
  Progress progress("reading", folders.size());
  for (std::size_t start = 0; start < folders.size(); start += kAtOnce) {
    const std::size_t count = std::min(kAtOnce, folders.size() - start);
    std::vector<Record> records(count);
    ParallelFor(count, config.threads, [&](std::size_t i) {
      records[i] = ReadRecord(folders[start + i], meshes);
      progress.Advance();
    });
    for (const Record& record : records) {
      if (record.fault.empty())
        writer.Add(record);
      else
        page.faults.push_back(record.fault);
    }
    writer.DrawNew();
  }
  if (writer.size() == 0)
    throw Error(ErrorCode::kFormat,
                page.faults.empty() ? "gallery: no doors or parts" : page.faults[0]);
  page.shown = writer.size();
  page.html = writer.Page();
  return page;
}

}  // namespace doorforge
