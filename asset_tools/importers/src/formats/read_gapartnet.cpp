// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"

#include "formats/read_partnet_mobility.h"
#include "import_format.h"

namespace doorforge::internal {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kAnnotatedUrdf = "mobility_annotation_gapartnet.urdf";
constexpr const char* kAnnotation = "link_annotation_gapartnet.json";

bool IsGaPartNet(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path / kAnnotatedUrdf, error);
}

// eight corners in the base's frame, joints at zero
Eigen::AlignedBox3d BoxOf(const Json& corners, const std::string& path) {
  if (!corners.is_array() || corners.size() != 8)
    throw Error(ErrorCode::kFormat, path + ": expected eight corners");
  Eigen::AlignedBox3d box;
  for (const Json& corner : corners) box.extend(Vector3FromJson(corner, path));
  return box;
}

// what each link is, and where: the annotation's classes say more than the names
void ReadAnnotation(const fs::path& file, HingedObject& object) {
  const Json json = ReadJsonFile(file);
  const std::string path = file.string();
  if (!json.is_array()) throw Error(ErrorCode::kFormat, path + ": expected a list of links");
  for (const Json& entry : json) {
    const auto link = ValueOf<std::string>(entry, "link_name", path);
    if (!ValueOf<bool>(entry, "is_gapart", path)) continue;
    object.words[link] = ValueOf<std::string>(entry, "category", path);
    object.stated_boxes[link] = BoxOf(MemberOf(entry, "bbox", path), path + ": " + link + ".bbox");
  }
}

std::vector<ForeignObject> ReadGaPartNet(const fs::path& folder, const ReadConfig& config) {
  PartNetFiles files;
  files.urdf = kAnnotatedUrdf;
  files.semantics = "semantics_gapartnet.txt";
  files.name = "gapartnet";
  files.id_prefix = "gap-";
  files.source = "GAPartNet";
  files.describe = [file = folder / kAnnotation](HingedObject& object) {
    std::error_code error;
    if (fs::exists(file, error)) ReadAnnotation(file, object);
  };
  return ReadPartNetObject(folder, files, config);
}

}  // namespace

ImportFormat GaPartNetFormat() { return {"gapartnet", IsGaPartNet, ReadGaPartNet}; }

}  // namespace doorforge::internal
