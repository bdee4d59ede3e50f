// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <optional>
#include <string_view>

#include "doorforge/core/error.h"

#include "import/file_axes.h"
#include "import/hinged_object.h"
#include "import/import_format.h"
#include "inside_folder.h"
#include "subtask.h"

namespace doorforge::internal {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPackage = "package://";

bool IsUrdfFile(const fs::path& path) {
  std::error_code error;
  return path.extension() == ".urdf" && fs::is_regular_file(path, error);
}

// the folder's one URDF; nothing if it has none or several
std::optional<fs::path> OnlyUrdfIn(const fs::path& folder) {
  std::optional<fs::path> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (!IsUrdfFile(entry.path())) continue;
    if (found) return std::nullopt;
    found = entry.path();
  }
  return found;
}

bool IsUrdf(const fs::path& path) { return IsUrdfFile(path) || OnlyUrdfIn(path).has_value(); }

// The folder that a URDF's meshes may lie in: its own; of a URDF in a folder of that name, as ROS
// packages have, the one above.
fs::path RootOf(const fs::path& urdf) {
  const fs::path folder = fs::absolute(urdf).lexically_normal().parent_path();
  return folder.filename() == "urdf" ? folder.parent_path() : folder;
}

// the name relative to the root
std::string NameInRoot(const fs::path& root, const fs::path& urdf_folder, const std::string& name) {
  if (!name.starts_with(kPackage)) {
    const fs::path inside = fs::relative(urdf_folder, root);
    if (fs::path(name).is_absolute() || name.find("://") != std::string::npos) return name;
    return (inside / name).lexically_normal().string();
  }
  const std::string rest = name.substr(kPackage.size());
  std::error_code error;
  if (fs::exists(root / rest, error)) return rest;
  // package://name/path: the root is the package
  const std::size_t slash = rest.find('/');
  return slash == std::string::npos ? rest : rest.substr(slash + 1);
}

std::vector<ForeignObject> Read(const fs::path& path, const ReadConfig& config) {
  const fs::path urdf = IsUrdfFile(path) ? path : OnlyUrdfIn(path).value();
  if (config.category.empty())
    throw Error(ErrorCode::kInvalidArgument,
                urdf.string() + ": a URDF does not say what kind of door it is; pass --category");
  const fs::path root = RootOf(urdf);
  const std::string name = IsUrdfFile(path) ? urdf.stem().string() : ObjectNameOf(path);
  HingedObject object;
  object.name = "urdf/" + name;
  object.id = name;
  object.where = urdf.string();
  object.source = "URDF " + urdf.filename().string();
  object.license = config.mesh.license;
  object.model = ReadUrdf(urdf);
  object.upright_from_base = UprightFrom(config.mesh.up.empty() ? "z" : config.mesh.up);
  object.height_m = config.height_m;
  object.category = CategoryOr(config, Category::kInterior);
  object.folder = root;
  object.find_mesh = [root, folder = fs::absolute(urdf).lexically_normal().parent_path(),
                      where = object.where](const std::string& file) {
    return FileInside(root, NameInRoot(root, folder, file), where);
  };
  object.frame_may_miss = config.allow_missing == "frame";
  return ReadHingedObject(object);
}

}  // namespace

ImportFormat UrdfFormat() { return {"urdf", IsUrdf, Read}; }

}  // namespace doorforge::internal
