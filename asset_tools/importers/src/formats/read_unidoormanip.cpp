// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "formats/import_unidoormanip.h"
#include "import_format.h"

namespace doorforge::internal {
namespace {

namespace fs = std::filesystem;

ForeignPart PartOf(const std::shared_ptr<const UniDoorManipObject>& object, PartRole role) {
  const bool is_body = role == PartRole::kBody;
  ForeignPart part;
  part.id = "udm-" + (is_body ? object->body_name : object->handle_name);
  part.role = role;
  part.source_sha256 = is_body ? BodySourceHash(*object) : HandleSourceHash(*object);
  part.load = [object, is_body] {
    LoadedPart loaded;
    loaded.draft = is_body ? LoadBody(*object) : LoadHandle(*object);
    loaded.box_deviation_m = BoxDeviation(*object, loaded.draft);
    return loaded;
  };
  return part;
}

std::vector<ForeignObject> ReadUniDoorManipObject(const fs::path& folder,
                                                  const ReadConfig& config) {
  const auto object = std::make_shared<const UniDoorManipObject>(
      ReadUniDoorManip(folder, config.category, config.allow_missing == "frame"));
  ForeignObject read;
  read.name = object->name;
  read.category = NameOf(object->category);
  read.mechanism = NameOf(object->mechanism);
  read.parts = {PartOf(object, PartRole::kBody), PartOf(object, PartRole::kHandle)};
  read.hinge_to_handle_m = object->handle_joint.origin_m - object->hinge.origin_m;
  for (const std::string& mesh : object->left_out)
    read.notes.push_back("without " + mesh + ", which is missing");
  return {read};
}

}  // namespace

ImportFormat UniDoorManipFormat() {
  return {"unidoormanip", IsUniDoorManipObject, ReadUniDoorManipObject};
}

}  // namespace doorforge::internal
