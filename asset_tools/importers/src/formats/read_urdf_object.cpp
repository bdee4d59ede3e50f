// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "doorforge/core/error.h"
#include "doorforge/core/inside_folder.h"
#include "doorforge/core/read_beginning.h"
#include "doorforge/parts/read_model.h"
#include "doorforge/schemas/door_words.h"
#include "doorforge/schemas/glb.h"

#include "guessed_category.h"
#include "import_format.h"
#include "subtask.h"
#include "urdf_objects/file_axes.h"
#include "urdf_objects/hinged_object.h"

namespace doorforge::internal {
namespace {

namespace fs = std::filesystem;

// The shortest decimals that read back to the same double.
std::string Digits(double number) {
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, number + 0.0).ptr};
}

constexpr std::array<std::string_view, 2> kPackages = {"package://", "model://"};

/// A format that describes an articulated object in one file.
struct ModelKind {
  const char* name;    ///< --format takes it.
  const char* called;  ///< Messages call it so.
  const char* extension;
  bool (*holds)(const fs::path& file);  ///< Null: the extension tells enough.
  ModelFormat format;
};

constexpr ModelKind kUrdf{"urdf", "URDF", ".urdf", nullptr, ModelFormat::kUrdf};
constexpr ModelKind kSdf{"sdf", "SDF", ".sdf", nullptr, ModelFormat::kSdf};
// Whether the file begins as one of this kind does, comments aside.
bool HoldsRoot(const fs::path& path, const char* root) {
  constexpr std::uint64_t kLooked = 4096;
  return ReadBeginning(path, kLooked).find(root) != std::string::npos;
}

constexpr ModelKind kMjcf{"mjcf", "MJCF", ".xml",
                          [](const fs::path& file) { return HoldsRoot(file, "<mujoco"); },
                          ModelFormat::kMjcf};
constexpr ModelKind kUsda{"usda", "USD", ".usda", nullptr, ModelFormat::kUsda};
constexpr ModelKind kGlb{"glb", "glTF", ".glb", HasLinks, ModelFormat::kGlb};

bool IsFileOf(const ModelKind& kind, const fs::path& path) {
  std::error_code error;
  return path.extension() == kind.extension && fs::is_regular_file(path, error) &&
         (kind.holds == nullptr || kind.holds(path));
}

// the folder's one file of the kind; nothing if it has none or several
std::optional<fs::path> OnlyFileIn(const fs::path& folder, const ModelKind& kind) {
  std::optional<fs::path> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (!IsFileOf(kind, entry.path())) continue;
    if (found) return std::nullopt;
    found = entry.path();
  }
  return found;
}

bool Knows(const ModelKind& kind, const fs::path& path) {
  return IsFileOf(kind, path) || OnlyFileIn(path, kind).has_value();
}

// The folder that a URDF's meshes may lie in: its own; of a URDF in a folder of that name, as ROS
// packages have, the one above.
fs::path RootOf(const fs::path& urdf) {
  const fs::path folder = fs::absolute(urdf).lexically_normal().parent_path();
  return folder.filename() == "urdf" ? folder.parent_path() : folder;
}

// the name relative to the root
std::string NameInRoot(const fs::path& root, const fs::path& urdf_folder, const std::string& name) {
  const auto package =
      std::find_if(kPackages.begin(), kPackages.end(),
                   [&](std::string_view prefix) { return name.starts_with(prefix); });
  if (package == kPackages.end()) {
    const fs::path inside = fs::relative(urdf_folder, root);
    if (fs::path(name).is_absolute() || name.find("://") != std::string::npos) return name;
    return (inside / name).lexically_normal().string();
  }
  const std::string rest = name.substr(package->size());
  std::error_code error;
  if (fs::exists(root / rest, error)) return rest;
  // package://name/path: the root is the package
  const std::size_t slash = rest.find('/');
  return slash == std::string::npos ? rest : rest.substr(slash + 1);
}

// What the file a mesh element names is; what is wrong with it where it cannot be used.
std::optional<UrdfFault> MeshFault(const HingedObject& object, const std::string& link,
                                   const UrdfMeshFile& mesh) {
  const std::string element = "<mesh> of link \"" + link + "\": ";
  try {
    object.find_mesh(mesh.filename);
    return std::nullopt;
  } catch (const Error& error) {
    std::string problem = error.what();
    if (problem.starts_with(object.where + ": ")) problem.erase(0, object.where.size() + 2);
    if (error.code() == ErrorCode::kMissing)
      problem = "filename=\"" + mesh.filename + "\" is missing; add the file";
    return UrdfFault{
        error.code() == ErrorCode::kMissing ? UrdfFaultKind::kUnstated : UrdfFaultKind::kUnusable,
        mesh.line, element + problem};
  }
}

// Finds the faults of the meshes that an import loads: of what is drawn, and of what touches where
// a link draws nothing.
std::vector<UrdfFault> MeshFaults(const HingedObject& object) {
  std::vector<UrdfFault> faults;
  for (const UrdfLink& link : object.model.links) {
    for (const UrdfShape& shape : link.visuals.empty() ? link.collisions : link.visuals) {
      const auto* mesh = std::get_if<UrdfMeshFile>(&shape.geometry);
      if (mesh == nullptr) continue;
      if (auto fault = MeshFault(object, link.name, *mesh)) faults.push_back(std::move(*fault));
    }
  }
  return faults;
}

bool Refuses(const UrdfFault& fault) { return fault.kind != UrdfFaultKind::kUnstated; }

bool AnyRefuses(const std::vector<UrdfFault>& faults) {
  return std::any_of(faults.begin(), faults.end(), Refuses);
}

// Links that are no tree, if all else of the model can be used.
void AddTreeFault(const UrdfModel& model, std::vector<UrdfFault>& faults) {
  try {
    if (!AnyRefuses(faults)) RootLinkOf(model);
  } catch (const Error& error) {
    faults.push_back({UrdfFaultKind::kUnusable, 1, error.what()});
  }
}

// Everything that is wrong with a file at once. What the format asks for and an import does
// without is left in `faults`.
void RefuseFaults(const HingedObject& object, std::vector<UrdfFault>& faults) {
  AddTreeFault(object.model, faults);
  const std::vector<UrdfFault> meshes = MeshFaults(object);
  const bool lacks = !meshes.empty() && !object.frame_may_miss;
  if (!AnyRefuses(faults) && !AnyRefuses(meshes) && !lacks) return;
  const bool only_lacks = !AnyRefuses(faults) && !AnyRefuses(meshes);
  faults.insert(faults.end(), meshes.begin(), meshes.end());
  std::stable_sort(faults.begin(), faults.end(),
                   [](const UrdfFault& a, const UrdfFault& b) { return a.line < b.line; });
  throw Error(only_lacks ? ErrorCode::kMissing : ErrorCode::kFormat,
              UrdfFaultsText(object.where, faults));
}

void AddNotes(const std::vector<UrdfFault>& faults, const std::string& file,
              std::vector<ForeignObject>& objects) {
  if (faults.empty()) return;
  for (ForeignObject& object : objects) object.notes.push_back(UrdfFaultsText(file, faults));
}

// Exports of this project say what kind of door they are; of others the names may tell, or else,
// where nothing is returned, the size.
std::optional<Category> CategoryOf(const UrdfModel& model, const std::string& name,
                                   const ReadConfig& config, std::vector<std::string>& notes) {
  if (!config.category.empty()) return CategoryOr(config, Category::kInterior);
  const auto told = model.words.find("door_category");
  if (told != model.words.end()) {
    if (const auto known = CategoryNamed(told->second)) return known;
  }
  std::vector<std::string> names = {name, model.name};
  for (const UrdfLink& link : model.links) names.push_back(link.name);
  const std::optional<GuessedCategory> guessed = CategoryByName(names);
  if (!guessed) return std::nullopt;
  notes.push_back(GuessText(*guessed));
  return guessed->category;
}

// Only exports of this project say so; of others' objects the front is where they open to.
bool IsPushed(const UrdfModel& model) {
  const auto told = model.words.find("door_opening");
  return told != model.words.end() && told->second == NameOf(Opening::kPush);
}

// What `doorforge compose` has to be told for the door to come back; empty for others' objects.
// Springs are the latch's, damping is the joints'.
std::map<std::string, std::string> SettingsOf(const UrdfModel& model, const std::string& where) {
  const std::optional<Latch> latch = LatchFromWords(model.words, where);
  if (!latch) return {};
  std::map<std::string, std::string> settings;
  for (const auto& [name, word] : LatchWords(*latch)) {
    if (name != "type") settings[name] = word;
  }
  settings["latch"] = NameOf(latch->type);
  if (latch->type != LatchType::kBolt) settings.erase("bolt_throw_m");
  if (latch->type == LatchType::kNone) {
    for (const char* name : {"unlock_angle_rad", "handle_done_angle_rad", "lock_effort_nm"})
      settings.erase(name);
  }
  const auto word = [&](const char* name) {
    const auto found = model.words.find(name);
    return found == model.words.end() ? std::string() : found->second;
  };
  settings["id"] = word("door_id");
  settings["hinge_side"] = word("door_hinge_side");
  if (IsPushed(model)) settings["opening"] = NameOf(Opening::kPush);
  for (const UrdfJoint& joint : model.joints) {
    if (joint.child == "leaf") settings["hinge_damping_nm_s"] = Digits(joint.damping);
    if (joint.child == "handle" && joint.type != UrdfJointType::kFixed)
      settings["handle_damping_nm_s"] = Digits(joint.damping);
  }
  std::erase_if(settings, [](const auto& one) { return one.second.empty(); });
  return settings;
}

// The bolt and its strike hold the door; they are no part of its leaf or frame.
void LeaveOutLatch(UrdfModel& model) {
  if (!model.words.contains("latch_type")) return;
  std::erase_if(model.links, [](const UrdfLink& link) { return link.name == "bolt"; });
  std::erase_if(model.joints, [](const UrdfJoint& joint) { return joint.child == "bolt"; });
}

std::vector<ForeignObject> ReadModelObject(const ModelKind& kind, const fs::path& path,
                                           const ReadConfig& config) {
  const bool is_file = IsFileOf(kind, path);
  const fs::path urdf = is_file ? path : OnlyFileIn(path, kind).value();
  const fs::path root = RootOf(urdf);
  const std::string name = is_file ? urdf.stem().string() : ObjectNameOf(path);
  HingedObject object;
  object.name = std::string(kind.name) + "/" + name;
  object.id = name;
  object.where = urdf.string();
  object.source = std::string(kind.called) + " " + urdf.filename().string();
  object.license = config.mesh.license;
  std::vector<UrdfFault> faults;
  object.model = ReadModelApart(urdf, kind.format, faults);
  std::vector<std::string> notes;
  const std::optional<Category> category = CategoryOf(object.model, name, config, notes);
  object.category = category.value_or(Category::kInterior);
  object.category_by_height = !category;
  const std::map<std::string, std::string> settings = AnyRefuses(faults)
                                                          ? std::map<std::string, std::string>()
                                                          : SettingsOf(object.model, urdf.string());
  const auto license = object.model.words.find("door_license");
  const bool stated = license != object.model.words.end() && !license->second.empty();
  if (stated && object.license == LooseMeshConfig{}.license) object.license = license->second;
  object.exported = object.model.words.contains("latch_type");
  object.pushed = object.exported && IsPushed(object.model);
  LeaveOutLatch(object.model);
  object.upright_from_base = UprightFrom(config.mesh.up.empty() ? "z" : config.mesh.up);
  object.height_m = config.height_m;
  object.folder = root;
  object.find_mesh = [root, folder = fs::absolute(urdf).lexically_normal().parent_path(),
                      where = object.where](const std::string& file) {
    return FileInside(root, NameInRoot(root, folder, file), where);
  };
  object.frame_may_miss = config.allow_missing == "frame";
  RefuseFaults(object, faults);
  std::vector<ForeignObject> objects = ReadHingedObject(object);
  AddNotes(faults, urdf.filename().string(), objects);
  for (ForeignObject& one : objects) {
    one.notes.insert(one.notes.end(), notes.begin(), notes.end());
    one.compose_settings = settings;
  }
  return objects;
}

template <const ModelKind& kind>
ImportFormat FormatOf() {
  return {kind.name, [](const fs::path& path) { return Knows(kind, path); },
          [](const fs::path& path, const ReadConfig& config) {
            return ReadModelObject(kind, path, config);
          }};
}

}  // namespace

ImportFormat UrdfFormat() { return FormatOf<kUrdf>(); }
ImportFormat SdfFormat() { return FormatOf<kSdf>(); }
ImportFormat MjcfFormat() { return FormatOf<kMjcf>(); }
ImportFormat UsdaFormat() { return FormatOf<kUsda>(); }
ImportFormat GlbFormat() { return FormatOf<kGlb>(); }

}  // namespace doorforge::internal
