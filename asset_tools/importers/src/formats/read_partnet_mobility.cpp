// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "formats/read_partnet_mobility.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <sstream>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/inside_folder.h"
#include "doorforge/core/json_file.h"
#include "doorforge/parts/read_model.h"

#include "import_format.h"
#include "subtask.h"

namespace doorforge::internal {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::uint64_t kMaxSmallFile = 1 << 20;

// what an object of the data set is for us, and how high such a thing usually is
struct ModelCategory {
  const char* name;  // meta.json's model_cat
  Category category;
  double height_m;
};
// appliances are boxes with a hinged door, as cabinets are
constexpr std::array<ModelCategory, 10> kModelCategories = {
    {{"Door", Category::kInterior, 2.1},
     {"Window", Category::kWindow, 1.1},
     {"Safe", Category::kSafe, 0.8},
     {"StorageFurniture", Category::kStorageFurniture, 1.0},
     {"Table", Category::kStorageFurniture, 0.75},
     {"Refrigerator", Category::kRefrigerator, 1.5},
     {"Microwave", Category::kStorageFurniture, 0.32},
     {"Oven", Category::kStorageFurniture, 0.9},
     {"Dishwasher", Category::kStorageFurniture, 0.85},
     {"WashingMachine", Category::kStorageFurniture, 0.95}}};
constexpr double kUsualHeight = 0.5;  // of anything else

std::string KindOfModel(const fs::path& folder) {
  const fs::path file = folder / "meta.json";
  std::error_code error;
  if (!fs::exists(file, error)) return "";
  return ValueOf<std::string>(ReadJsonFile(file), "model_cat", file.string());
}

const ModelCategory* KindNamed(const std::string& name) {
  const auto kind = std::find_if(kModelCategories.begin(), kModelCategories.end(),
                                 [&](const ModelCategory& k) { return name == k.name; });
  return kind == kModelCategories.end() ? nullptr : &*kind;
}

// one line of semantics.txt
struct LinkSemantics {
  std::string link;
  std::string joint;  // hinge, slider, static, ...
  std::string word;
};

std::vector<LinkSemantics> ReadSemantics(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error)) return {};
  std::istringstream lines(ReadFile(file, kMaxSmallFile));
  std::vector<LinkSemantics> semantics;
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    std::istringstream words(line);
    LinkSemantics read;
    if (!(words >> read.link)) continue;
    if (!(words >> read.joint >> read.word))
      throw Error(ErrorCode::kFormat, file.string() + ":" + std::to_string(number) + ": \"" + line +
                                          "\" is not a link, a joint and a name");
    semantics.push_back(std::move(read));
  }
  return semantics;
}

// a joint that was fixed by others, with the limits that mobility_v2.json still has
struct JointLimit {
  bool limited = false;
  double lower_rad = 0;
  double upper_rad = 0;
};

JointLimit LimitOfRecord(const Json& entry) {
  const auto data = entry.find("jointData");
  if (data == entry.end() || !data->is_object() || !data->contains("limit")) return {};
  const Json& limit = (*data)["limit"];
  const bool usable = limit.is_object() && limit.contains("a") && limit.contains("b") &&
                      limit["a"].is_number() && limit["b"].is_number() &&
                      !(limit.contains("noLimit") && limit["noLimit"] == true);
  if (!usable) return {};
  const double to_rad = std::numbers::pi / 180;
  const double a = limit["a"].get<double>() * to_rad;
  const double b = limit["b"].get<double>() * to_rad;
  if (!std::isfinite(a) || !std::isfinite(b) || a == b) return {};
  return {true, std::min(a, b), std::max(a, b)};
}

JointLimit LimitInMobility(const fs::path& folder, const std::string& link) {
  const fs::path file = folder / "mobility_v2.json";
  std::error_code error;
  if (!fs::exists(file, error)) return {};
  const Json json = ReadJsonFile(file);
  if (!json.is_array())
    throw Error(ErrorCode::kFormat, file.string() + ": expected a list of links");
  for (const Json& entry : json) {
    const bool found = entry.is_object() && entry.contains("id") &&
                       entry["id"].is_number_integer() &&
                       "link_" + std::to_string(entry["id"].get<std::int64_t>()) == link;
    if (found) return LimitOfRecord(entry);
  }
  return {};
}

void RestoreHinge(const fs::path& folder, UrdfJoint& joint) {
  joint.type = UrdfJointType::kRevolute;
  if (joint.lower < joint.upper) return;
  const JointLimit limit = LimitInMobility(folder, joint.child);
  joint.lower = limit.lower_rad;
  joint.upper = limit.upper_rad;
  if (!limit.limited) joint.type = UrdfJointType::kContinuous;
}

void RestoreJoints(const fs::path& folder, const std::vector<LinkSemantics>& semantics,
                   UrdfModel& model) {
  for (UrdfJoint& joint : model.joints) {
    const auto known = std::find_if(semantics.begin(), semantics.end(),
                                    [&](const LinkSemantics& s) { return s.link == joint.child; });
    if (known != semantics.end() && known->joint == "hinge" &&
        joint.type == UrdfJointType::kFixed && joint.axis.norm() > 1e-9)
      RestoreHinge(folder, joint);
  }
}

// base -> world of the release: x to the robot; link y is up, link z out
Eigen::Matrix3d UprightFromBase() {
  return (Eigen::Matrix3d() << -1, 0, 0, 0, -1, 0, 0, 0, 1).finished();
}

bool IsPartNet(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path / "mobility.urdf", error) &&
         (fs::is_regular_file(path / "mobility_v2.json", error) ||
          fs::is_regular_file(path / "semantics.txt", error));
}

std::vector<ForeignObject> ReadPartNet(const fs::path& path, const ReadConfig& config) {
  return ReadPartNetObject(path, {}, config);
}

}  // namespace

HingedObject ReadPartNetFiles(const fs::path& folder, const PartNetFiles& files,
                              const ReadConfig& config) {
  HingedObject object;
  const std::string folder_name = ObjectNameOf(folder);
  object.name = files.name + "/" + folder_name;
  object.id = files.id_prefix + folder_name;
  object.where = (folder / files.urdf).string();
  object.source = files.source + " " + folder_name;
  object.license = "LicenseRef-PartNet-Mobility";
  object.model = ReadUrdfApart(folder / files.urdf);
  object.upright_from_base = UprightFromBase();
  const std::vector<LinkSemantics> semantics = ReadSemantics(folder / files.semantics);
  for (const LinkSemantics& link : semantics) object.words[link.link] = link.word;
  RestoreJoints(folder, semantics, object.model);
  const ModelCategory* kind = KindNamed(KindOfModel(folder));
  object.category = CategoryOr(config, kind ? kind->category : Category::kStorageFurniture);
  object.height_m = config.height_m > 0 ? config.height_m : kind ? kind->height_m : kUsualHeight;
  object.folder = folder;
  object.find_mesh = [folder, urdf = object.where](const std::string& name) {
    return FileInside(folder, name, urdf);
  };
  object.frame_may_miss = config.allow_missing == "frame";
  if (files.describe) files.describe(object);
  return object;
}

std::vector<ForeignObject> ReadPartNetObject(const fs::path& folder, const PartNetFiles& files,
                                             const ReadConfig& config) {
  std::vector<ForeignObject> objects = ReadHingedObject(ReadPartNetFiles(folder, files, config));
  const std::string kind = KindOfModel(folder);
  if (!config.category.empty() || KindNamed(kind) != nullptr) return objects;
  // it has a hinge that swings, but is it a door?
  for (ForeignObject& object : objects) {
    if (!object.refusal.empty()) continue;
    object.parts.clear();
    object.category.clear();
    object.refusal = "meta.json calls it \"" + kind +
                     "\", which is no kind of door; pass --category to import it all the same";
  }
  return objects;
}

ImportFormat PartNetMobilityFormat() { return {"partnet-mobility", IsPartNet, ReadPartNet}; }

}  // namespace doorforge::internal
