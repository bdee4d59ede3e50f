// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "doorforge/catalogue/catalogue.h"

namespace doorforge {

/// What a page to compose doors asks for, each answered from the request alone: nothing is
/// remembered between two but pictures, so that pages do not disturb one another. Safe to use from
/// several threads.
///
/// A request is {"body", "handle", "settings"}: ids of two parts that Parts() lists, and settings
/// as `doorforge compose --set` takes them, nested objects of which any may be left out. Throws
/// Error(kInvalidArgument or kInvalidConfig) that names what is wrong with it, and as
/// ComposeOneDoor().
class Composer {
 public:
  /// @param parts Folder of parts; empty: the catalogue.
  /// @throws Error(kMissing) if there is no such folder, or no catalogue.
  explicit Composer(std::filesystem::path parts);

  /// [{"id", "role", "category", "mechanism"}], sorted by id.
  nlohmann::ordered_json Parts() const;

  /// The page: viewer, list of parts, the settings with their defaults, formats of exports.
  std::string Page() const;

  /// A JPEG file of a part, 240 pixels wide. Throws Error(kMissing) on an unknown id.
  std::string Thumbnail(const std::string& id);

  /// Packed content (see PackRecord()) with the door, its findings, and beside them "command": what
  /// a shell runs to compose the same door.
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

  const Known& Find(const std::string& id) const;

  std::filesystem::path parts_;
  std::map<std::string, Known> known_;
  std::mutex mutex_;  // of what follows
  std::map<std::string, std::string> thumbnails_;
};

}  // namespace doorforge
