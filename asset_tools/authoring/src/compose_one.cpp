// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "doorforge/authoring/compose_doors.h"
#include "doorforge/core/config_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/exporters/export_urdf.h"
#include "doorforge/importers/author_place.h"

#include "own_part.h"
#include "part_store.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

// nothing for parts of different objects
std::optional<RigidTransform> PlaceOf(const Part& handle, const AuthorPlaces& places) {
  const auto found = places.find(handle.source_sha256);
  return found == places.end() ? std::nullopt : std::optional(found->second);
}

/// One door on its way, with what was imported for it.
class OneDoor {
 public:
  OneDoor(const ComposeRun& run, ComposeRequest request)
      : run_(run), request_(std::move(request)), store_(run.parts) {}

  ComposedDoors Run() {
    // refuses what is there already before anything is imported
    { const StagedFolder probe(run_.out, kDoorFolder, run_.existing); }
    LoadParts();
    const fs::path body_folder = store_.FolderOf(request_.body);
    const std::optional<RigidTransform> authored =
        body_folder.empty() ? std::nullopt : PlaceOf(*handle_, ReadAuthorPlaces(body_folder));
    // who says where the leaf lies in the file is believed
    if (own_handle_ && !request_.handle_mesh.mount.empty() &&
        request_.door.place == HandlePlace::kAuto)
      request_.door.place = HandlePlace::kPlane;
    const WorkBudget budget(run_.out.string(), run_.max_seconds);
    const DoorAsset door = ComposeDoor(*body_, *handle_, request_.door, authored);
    WriteDoorFolder(door, run_.out, run_.existing);
    WriteJsonFile(run_.out / "compose.json", ToJson(request_));
    // beside the door, for other doors
    if (own_body_) own_body_->MoveTo(run_.out / "body");
    if (own_handle_) own_handle_->MoveTo(run_.out / "handle");
    return {.doors = {{door.id, "", false}}, .imported = own_body_ || own_handle_};
  }

 private:
  void LoadParts() {
    const bool own_body = store_.IsToImport(request_.body);
    const bool own_handle = store_.IsToImport(request_.handle);
    const auto load_body = [&] { return store_.Load(request_.body); };
    const auto load_handle = [&] { return store_.Load(request_.handle); };
    const auto import_body = [&] {
      return ImportOwn({FileNamed(request_.body), PartRole::kBody, CategoryFor(handle_),
                        WithFiles(request_.body_mesh)},
                       own_body_);
    };
    const auto import_handle = [&] {
      return ImportOwn({FileNamed(request_.handle), PartRole::kHandle, CategoryFor(body_),
                        WithFiles(request_.handle_mesh)},
                       own_handle_);
    };
    // what is imported takes its category from the other half
    if (!own_body) body_ = Named(run_.body_named_by, load_body);
    if (!own_handle) handle_ = Named(run_.handle_named_by, load_handle);
    if (own_body) body_ = Named(run_.body_named_by, import_body);
    if (own_handle) handle_ = Named(run_.handle_named_by, import_handle);
  }

  fs::path FileNamed(const std::string& name) const {
    return run_.files.empty() ? fs::path(name) : run_.files / name;
  }

  LooseMeshConfig WithFiles(LooseMeshConfig mesh) const {
    for (std::string* name : {&mesh.rose, &mesh.frame}) {
      if (!name->empty()) *name = FileNamed(*name).string();
    }
    return mesh;
  }

  // a name that stands in a settings file is looked for there, and so is what is wrong with it
  template <class Make>
  static Part Named(const std::string& named_by, Make&& make) {
    try {
      return make();
    } catch (const Error& error) {
      if (named_by.empty()) throw;
      throw Error(error.code(), named_by + ": " + error.what());
    }
  }

  // that of the other half
  Category CategoryFor(const std::optional<Part>& other) const {
    if (other) return other->category;
    if (const std::optional<Category> category = CategoryNamed(request_.category)) return *category;
    throw Error(ErrorCode::kInvalidArgument,
                "--category is required where body and handle are both to be imported");
  }

  Part ImportOwn(const OwnPartRequest& request, std::optional<OwnPart>& own) const {
    own.emplace(request, run_.out, run_.max_seconds);
    for (const std::string& note : own->notes()) run_.note(own->part().id + ": " + note);
    return own->part();
  }

  const ComposeRun& run_;
  ComposeRequest request_;
  PartStore store_;
  std::optional<Part> body_;
  std::optional<Part> handle_;
  std::optional<OwnPart> own_body_;
  std::optional<OwnPart> own_handle_;
};

}  // namespace

ComposedDoors ComposeOneDoor(const ComposeRun& run, const ComposeRequest& request) {
  return OneDoor(run, request).Run();
}

}  // namespace doorforge
