// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "doorforge/catalogue/catalogue.h"

namespace doorforge {

namespace internal {
class DroppedFiles;
}

/// What a page to compose doors asks for, each answered from the request alone: nothing is
/// remembered between two but pictures and dropped files, these by the hash of their bytes, so that
/// pages do not disturb one another. Safe to use from several threads.
///
/// A request is {"body", "handle", "settings", "files", "body_mesh", "handle_mesh", "category"}:
/// ids of two parts that Parts() lists, and settings as `doorforge compose --set` takes them,
/// nested objects of which any may be left out. "files" holds the SHA-256 of dropped files by their
/// names; body or handle, or both, may be one of these, to be read as the settings "body_mesh" and
/// "handle_mesh" say (see LooseMeshConfig; rose and frame are dropped files too). Throws
/// Error(kInvalidArgument or kInvalidConfig) that names what is wrong with it, Error(kMissing) for
/// a part or file that is not there, and as ComposeOneDoor().
class Composer {
 public:
  /// @param parts Folder of parts; empty: the catalogue.
  /// @throws Error(kMissing) if there is no such folder, or no catalogue.
  explicit Composer(std::filesystem::path parts);
  ~Composer();

  /// [{"id", "role", "category", "mechanism"}], sorted by id.
  nlohmann::ordered_json Parts() const;

  /// The page: viewer, list of parts, the settings with their defaults, formats of exports.
  std::string Page() const;

  /// A JPEG file of a part, 240 pixels wide. Throws Error(kMissing) on an unknown id.
  std::string Thumbnail(const std::string& id);

  /// Keeps a file that was dropped, of at most 64 MiB, and 256 MiB of all of them. Gives packed
  /// content {"name", "file"}, the SHA-256, and of a mesh (STL, OBJ, GLB) its pieces in the file's
  /// own axes with "up", "front", "unit_m" and "states_unit" of FileFrame. Meshes are read in the
  /// confined process of ImportMesh(), of at most 1,000,000 triangles within 20 s.
  ///
  /// @throws Error(kInvalidArgument) on a name that is none or of another kind, or on too many
  /// bytes;
  ///     else as ImportMesh().
  std::string Keep(const std::string& name, const std::string& bytes);

  /// Packed content (see PackRecord()) with the door, its findings, and beside them "command", what
  /// a shell runs to compose the same door, "yaml", a settings file that does so, and "notes", what
  /// was assumed of a dropped mesh.
  std::string Compose(const std::string& request) const;

  /// Packed content with the rule-based expert at the door (see PackExpertFilm()).
  std::string Open(const std::string& request) const;

  /// A ZIP file with the folder that `doorforge compose` writes, byte for byte; or, where `format`
  /// is one of DoorFormats(), with what `doorforge export` writes. Throws Error(kInvalidArgument)
  /// on another format.
  std::string Download(const std::string& request, const std::string& format) const;

 private:
  struct Known {
    PartRole role = PartRole::kBody;
    Category category = Category::kInterior;
    Mechanism mechanism = Mechanism::kNone;
    CatalogueEntry entry;          // of the catalogue
    std::filesystem::path folder;  // of a part in files
  };

  struct Made;
  using Use = std::function<std::string(const Made&)>;

  const Known& Find(const std::string& id) const;
  std::string WithDoor(const std::string& request, const Use& use) const;

  std::filesystem::path parts_;
  std::map<std::string, Known> known_;
  std::unique_ptr<internal::DroppedFiles> dropped_;
  std::mutex mutex_;  // of what follows
  std::map<std::string, std::string> thumbnails_;
};

}  // namespace doorforge
