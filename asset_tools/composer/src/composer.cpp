// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/composer/composer.h"

#include <set>
#include <span>

#include "doorforge/authoring/compose_doors.h"
#include "doorforge/authoring/export_batch.h"
#include "doorforge/core/committed_file.h"
#include "doorforge/core/config_io.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/program.h"
#include "doorforge/core/temporary_folder.h"
#include "doorforge/mesh/import_mesh.h"
#include "doorforge/openable/openable_check.h"
#include "doorforge/validate/validate_door.h"
#include "doorforge/view/packed_content.h"

#include "compose_command.h"
#include "dropped_files.h"
#include "zip_file.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kMostFiles = 16;               // of a request
constexpr std::uint64_t kMostTriangles = 1'000'000;  // of a dropped mesh
constexpr double kReadSeconds = 20;                  // for one
constexpr double kComposeSeconds = 60;

// What a request says: the door, and files that were dropped.
struct Asked {
  ComposeRequest door;
  internal::NamedFiles files;
};

internal::NamedFiles FilesOf(const Json& json) {
  if (!json.is_object() || json.size() > kMostFiles)
    throw Error(ErrorCode::kInvalidArgument, "request.files: expected an object of at most " +
                                                 std::to_string(kMostFiles) + " names");
  internal::NamedFiles files;
  for (const auto& [name, hash] : json.items()) {
    internal::CheckFileName(name);
    if (!hash.is_string())
      throw Error(ErrorCode::kInvalidArgument, "request.files: " + name + ": expected a hash");
    files[name] = hash.get<std::string>();
  }
  return files;
}

// Second meshes of a part are dropped as well.
LooseMeshConfig MeshOf(const Json& json, const std::string& key,
                       const internal::NamedFiles& files) {
  LooseMeshConfig mesh;
  if (!json.contains(key)) return mesh;
  Assign(json[key], mesh, key);
  for (const auto& [name, beside] : {std::pair("rose", &mesh.rose), {"frame", &mesh.frame}}) {
    if (!beside->empty() && !files.contains(*beside))
      throw Error(ErrorCode::kInvalidArgument,
                  key + "." + name + ": \"" + *beside + "\" is none of the dropped files");
  }
  return mesh;
}

Asked RequestOf(const std::string& text) {
  const Json json = ParseJson(text, "request");
  if (!json.is_object()) throw Error(ErrorCode::kInvalidArgument, "request: expected an object");
  static const std::set<std::string> kKeys = {"body",        "handle",   "settings", "body_mesh",
                                              "handle_mesh", "category", "files"};
  for (const auto& [key, unused] : json.items()) {
    if (!kKeys.contains(key))
      throw Error(ErrorCode::kInvalidArgument, "request: unknown key \"" + key + "\"");
  }
  Asked asked;
  ComposeRequest& door = asked.door;
  door.body = ValueOf<std::string>(json, "body", "request");
  door.handle = ValueOf<std::string>(json, "handle", "request");
  if (json.contains("settings")) Assign(json["settings"], door.door, "settings");
  if (json.contains("category")) door.category = ValueOf<std::string>(json, "category", "request");
  if (json.contains("files")) asked.files = FilesOf(json["files"]);
  door.body_mesh = MeshOf(json, "body_mesh", asked.files);
  door.handle_mesh = MeshOf(json, "handle_mesh", asked.files);
  return asked;
}

Json PresetsForPage() {
  const auto names = [](std::span<const ComposePreset> presets) {
    Json list = Json::array();
    for (const ComposePreset& preset : presets) list.push_back(preset.name);
    return list;
  };
  return {{"joints", names(JointPresets())}, {"masses", names(MassPresets())}};
}

// Folders of this server are no matter of the page.
std::string Without(std::string message, const fs::path& folder) {
  const std::string prefix = folder.string() + "/";
  for (std::size_t at = 0; (at = message.find(prefix, at)) != std::string::npos;)
    message.erase(at, prefix.size());
  return message;
}

// The confined process reads; its own folder is no matter of the page.
ImportedMesh ReadDropped(const std::string& name, const std::string& bytes) {
  const TemporaryFolder scratch;
  CommitFile(scratch.path() / name, bytes);
  try {
    return ImportMesh(scratch.path() / name, {.max_file_bytes = internal::kMostFileBytes,
                                              .max_triangles = kMostTriangles,
                                              .timeout_s = kReadSeconds});
  } catch (const Error& error) {
    throw Error(error.code(), Without(error.what(), scratch.path()));
  }
}

// What the verb writes beside a door of which a part was imported, with the verb's name of it.
void WriteValidation(const fs::path& folder) {
  ValidationReport report = DoorValidator(OpenableCheck()).Validate(folder);
  report.folder = internal::kCommandOut;
  WriteJsonFile(folder / "validation.json", ToJson(std::span<const ValidationReport>(&report, 1)));
}

}  // namespace

struct Composer::Made {
  fs::path folder;
  ComposeRequest request;
  Json notes;
  bool imported = false;
};

Composer::Composer(fs::path parts)
    : parts_(std::move(parts)), dropped_(std::make_unique<internal::DroppedFiles>()) {
  if (parts_.empty()) {
    for (CatalogueEntry& entry : ListCatalogue(DataFolder())) {
      Known& known = known_[entry.id];
      known = {entry.role, entry.category, entry.mechanism, {}, {}};
      known.entry = std::move(entry);
    }
    return;
  }
  for (const fs::path& folder : FindRecords(parts_)) {
    if (!fs::exists(folder / "part.json")) continue;
    const Part part = ReadPart(folder);
    known_[part.id] = {part.role, part.category, part.mechanism, {}, folder};
  }
}

Composer::~Composer() = default;

const Composer::Known& Composer::Find(const std::string& id) const {
  const auto found = known_.find(id);
  if (found == known_.end()) throw Error(ErrorCode::kMissing, "there is no part \"" + id + "\"");
  return found->second;
}

Json Composer::Parts() const {
  Json parts = Json::array();
  for (const auto& [id, known] : known_)
    parts.push_back({{"id", id},
                     {"role", NameOf(known.role)},
                     {"category", NameOf(known.category)},
                     {"mechanism", NameOf(known.mechanism)}});
  return parts;
}

std::string Composer::Page() const {
  return ServedPage("Compose a door - doorforge", {{"kind", "composer"},
                                                   {"version", CodeVersion()},
                                                   {"parts", Parts()},
                                                   {"settings", ToJson(ComposeConfig{})},
                                                   {"mesh_settings", ToJson(LooseMeshConfig{})},
                                                   {"presets", PresetsForPage()},
                                                   {"most_file_bytes", internal::kMostFileBytes},
                                                   {"formats", DoorFormatNames()}});
}

std::string Composer::Thumbnail(const std::string& id) {
  const Known& known = Find(id);
  const std::lock_guard lock(mutex_);
  std::string& picture = thumbnails_[id];
  if (picture.empty())
    picture = DrawThumbnail(
        known.folder.empty() ? BuildCataloguePart(known.entry) : ReadPart(known.folder), 240);
  return picture;
}

std::string Composer::Keep(const std::string& name, const std::string& bytes) {
  internal::CheckFileName(name);
  Require(!bytes.empty(), ErrorCode::kInvalidArgument, name + ": is empty");
  if (!internal::IsMeshName(name))
    return PackMeshes({}, {{"name", name}, {"file", dropped_->Keep(bytes)}});
  const ImportedMesh mesh = ReadDropped(name, bytes);
  std::vector<TriangleMesh> pieces;
  for (const ImportedPiece& piece : mesh.pieces) pieces.push_back(piece.mesh);
  return PackMeshes(pieces, {{"name", name},
                             {"file", dropped_->Keep(bytes)},
                             {"up", mesh.frame.up},
                             {"front", mesh.frame.front},
                             {"unit_m", mesh.frame.unit_m},
                             {"states_unit", mesh.frame.states_unit}});
}

// A composed door in a folder of its own, and what `use` makes of it.
std::string Composer::WithDoor(const std::string& text, const Use& use) const {
  const auto [door, files] = RequestOf(text);
  for (const std::string& name : {door.body, door.handle}) {
    if (!files.contains(name)) Find(name);
  }
  const TemporaryFolder scratch;
  try {
    dropped_->PutInto(scratch.path() / "files", files);
    Made made{.folder = scratch.path() / "door", .request = door, .notes = Json::array()};
    const ComposeRun run{.out = made.folder,
                         .parts = parts_,
                         .files = scratch.path() / "files",
                         .threads = 1,
                         .max_seconds = kComposeSeconds,
                         .note = [&](const std::string& note) { made.notes.push_back(note); }};
    made.imported = ComposeOneDoor(run, door).imported;
    return use(made);
  } catch (const Error& error) {
    throw Error(error.code(),
                Without(Without(error.what(), scratch.path() / "files"), scratch.path()));
  }
}

std::string Composer::Compose(const std::string& request) const {
  return WithDoor(request, [&](const Made& made) {
    return PackRecord(made.folder, {{"command", internal::CommandOf(made.request, parts_)},
                                    {"yaml", internal::YamlOf(made.request, parts_)},
                                    {"notes", made.notes}});
  });
}

std::string Composer::Open(const std::string& request) const {
  return WithDoor(request, [](const Made& made) { return PackExpertFilm(made.folder, 1); });
}

std::string Composer::Download(const std::string& request, const std::string& format) const {
  const DoorFormat* chosen = format.empty() ? nullptr : DoorFormatNamed(format);
  if (!format.empty() && chosen == nullptr)
    throw Error(ErrorCode::kInvalidArgument, "there is no format \"" + format + "\"");
  return WithDoor(request, [&](const Made& made) {
    if (chosen == nullptr) {
      if (made.imported) WriteValidation(made.folder);
      return internal::ZipOf(internal::MembersOf(made.folder, "door"));
    }
    const fs::path out = made.folder.parent_path() / "exported";
    WriteExportedDoor(ReadDoor(made.folder), {chosen, 1}, out, Existing::kRefuse);
    return internal::ZipOf(internal::MembersOf(out, "door"));
  });
}

}  // namespace doorforge
