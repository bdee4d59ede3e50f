// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/composer/composer.h"

#include <cstdlib>
#include <functional>

#include "doorforge/authoring/compose_doors.h"
#include "doorforge/authoring/export_batch.h"
#include "doorforge/core/config_io.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/program.h"
#include "doorforge/validate/validate_door.h"
#include "doorforge/view/packed_content.h"

#include "zip_file.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// A folder of its own that goes when its time is over.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (fs::temp_directory_path() / "doorforge-composer-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr)
      throw Error(ErrorCode::kIo, name + ": a folder cannot be made");
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

ComposeRequest RequestOf(const std::string& text) {
  const Json json = ParseJson(text, "request");
  if (!json.is_object()) throw Error(ErrorCode::kInvalidArgument, "request: expected an object");
  for (const auto& [key, unused] : json.items()) {
    if (key != "body" && key != "handle" && key != "settings")
      throw Error(ErrorCode::kInvalidArgument, "request: unknown key \"" + key + "\"");
  }
  ComposeRequest request;
  request.body = ValueOf<std::string>(json, "body", "request");
  request.handle = ValueOf<std::string>(json, "handle", "request");
  if (json.contains("settings")) Assign(json["settings"], request.door, "settings");
  return request;
}

// For a POSIX shell.
std::string Quoted(const std::string& word) {
  const bool plain = word.find_first_not_of(
                         "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=") ==
                     std::string::npos;
  if (plain && !word.empty()) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

// What differs from the defaults, as --set takes it.
std::string CommandOf(const ComposeRequest& request, const fs::path& parts) {
  std::string command = "doorforge compose --body " + Quoted(request.body) + " --handle " +
                        Quoted(request.handle) + " --out doors/mine";
  if (!parts.empty()) command += " --parts " + Quoted(parts.string());
  const Json standard = ToJson(ComposeConfig{});
  const Json chosen = ToJson(request.door);
  for (const auto& [key, value] : chosen.items()) {
    if (value == standard[key]) continue;
    const std::string text = value.is_string() ? value.get<std::string>() : JsonText(value);
    command += " --set " + Quoted(key + "=" + text);
  }
  return command;
}

}  // namespace

Composer::Composer(fs::path parts) : parts_(std::move(parts)) {
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

namespace {

// A composed door in a folder of its own, and what `use` makes of it.
std::string WithDoor(const ComposeRequest& request, const fs::path& parts,
                     const std::function<std::string(const fs::path&)>& use) {
  const ScratchFolder scratch;
  const fs::path out = scratch.path() / "door";
  ComposeOneDoor({.out = out, .parts = parts, .threads = 1, .max_seconds = 60}, request);
  return use(out);
}

}  // namespace

std::string Composer::Compose(const std::string& text) const {
  const ComposeRequest request = RequestOf(text);
  Find(request.body);
  Find(request.handle);
  return WithDoor(request, parts_, [&](const fs::path& folder) {
    return PackRecord(folder, {{"command", CommandOf(request, parts_)}});
  });
}

std::string Composer::Open(const std::string& text) const {
  const ComposeRequest request = RequestOf(text);
  Find(request.body);
  Find(request.handle);
  return WithDoor(request, parts_,
                  [&](const fs::path& folder) { return PackExpertFilm(folder, 1); });
}

std::string Composer::Download(const std::string& text, const std::string& format) const {
  const ComposeRequest request = RequestOf(text);
  Find(request.body);
  Find(request.handle);
  const DoorFormat* chosen = format.empty() ? nullptr : DoorFormatNamed(format);
  if (!format.empty() && chosen == nullptr)
    throw Error(ErrorCode::kInvalidArgument, "there is no format \"" + format + "\"");
  return WithDoor(request, parts_, [&](const fs::path& folder) {
    if (chosen == nullptr) return internal::ZipOf(internal::MembersOf(folder, "door"));
    const fs::path out = folder.parent_path() / "exported";
    WriteExportedDoor(ReadDoor(folder), {chosen, 1}, out, Existing::kRefuse);
    return internal::ZipOf(internal::MembersOf(out, "door"));
  });
}

}  // namespace doorforge
