// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <iomanip>
#include <numbers>
#include <sstream>

#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/mesh/import_mesh.h"

#include "import/file_axes.h"
#include "import/handle_part.h"
#include "import/handle_place.h"
#include "import/import_format.h"
#include "import/leaf_motion.h"
#include "placed_mesh.h"

namespace doorforge::internal {
namespace {

namespace fs = std::filesystem;

constexpr double kOpening = 86.4 * std::numbers::pi / 180;  // [rad] as the doors of UniDoorManip
constexpr double kThickLeaf = 0.5;  // of its width: more is no leaf but a box

struct Unit {
  const char* name;
  double metres;
};
constexpr std::array<Unit, 5> kUnits = {
    {{"m", 1}, {"cm", 0.01}, {"mm", 0.001}, {"in", 0.0254}, {"ft", 0.3048}}};

bool IsMesh(const fs::path& path) {
  std::string ending = path.extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  static constexpr std::array<const char*, 9> kEndings = {".obj", ".stl", ".ply", ".dae", ".gltf",
                                                          ".glb", ".fbx", ".3ds", ".off"};
  std::error_code error;
  return std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end() &&
         fs::is_regular_file(path, error);
}

[[noreturn]] void Wrong(const std::string& message) {
  throw Error(ErrorCode::kInvalidArgument, message);
}

double MetresOf(const std::string& unit) {
  for (const Unit& known : kUnits) {
    if (unit == known.name) return known.metres;
  }
  Wrong("--unit: \"" + unit + "\" is no unit; allowed are m, cm, mm, in and ft");
}

Eigen::Vector3d ScaleOf(const LooseMeshConfig& config) {
  const std::vector<double>& scale = config.scale;
  if (scale.empty()) return Eigen::Vector3d::Ones();
  const bool positive =
      std::all_of(scale.begin(), scale.end(), [](double s) { return std::isfinite(s) && s > 0; });
  if (!positive || (scale.size() != 1 && scale.size() != 3))
    Wrong("--scale: expected one number or three, all above 0");
  return scale.size() == 1 ? Eigen::Vector3d::Constant(scale[0])
                           : Eigen::Vector3d(scale[0], scale[1], scale[2]);
}

Eigen::Affine3d PartAxesFromFile(const LooseMeshConfig& config) {
  const std::string up = config.up.empty() ? "z" : config.up;
  const bool along_x = up == "x" || up == "-x";
  const std::string front = !config.front.empty() ? config.front : along_x ? "y" : "x";
  return Eigen::Affine3d(PartAxesFrom(up, front)) *
         Eigen::Scaling(Eigen::Vector3d(MetresOf(config.unit) * ScaleOf(config)));
}

std::optional<Eigen::Vector3d> MountIn(const LooseMeshConfig& config) {
  if (config.mount.empty()) return std::nullopt;
  if (config.mount.size() != 3) Wrong("--mount: expected three numbers, x y z of the file");
  return PartAxesFromFile(config) *
         Eigen::Vector3d(config.mount[0], config.mount[1], config.mount[2]);
}

// how long things of a role are
struct UsualLength {
  const char* what;
  double low_m;
  double high_m;
};
constexpr UsualLength kHandleLength{"handle", 0.02, 0.6};
constexpr UsualLength kLeafLength{"leaf", 0.2, 3.5};

std::string Metres(double metres) {
  std::ostringstream text;
  text << std::setprecision(3) << metres << " m";
  return text.str();
}

double LongestSide(const fs::path& file) {
  return BoundsOf(MergedPieces(ImportMesh(file))).sizes().maxCoeff();
}

// A config with a unit, and what was assumed.
struct KnownUnit {
  LooseMeshConfig config;
  std::string note;
};

KnownUnit WithSize(LooseMeshConfig config, const fs::path& file) {
  if (!config.unit.empty() || !config.scale.empty())
    Wrong("--size: stands for --unit and --scale; give one of them");
  if (!(config.size_m > 0) || !std::isfinite(config.size_m))
    Wrong("--size: expected a length above 0 m");
  config.unit = "m";
  config.scale = {config.size_m / LongestSide(file)};
  return {config, ""};
}

KnownUnit GuessUnit(LooseMeshConfig config, const fs::path& file, const UsualLength& usual) {
  const double length = LongestSide(file);
  std::vector<std::string> fitting;
  std::string lengths;
  for (const char* unit : {"m", "cm", "mm"}) {
    const double metres = length * MetresOf(unit);
    if (metres < usual.low_m || metres > usual.high_m) continue;
    fitting.emplace_back(unit);
    lengths += (lengths.empty() ? "" : " or ") + Metres(metres) + " in " + unit;
  }
  if (fitting.size() > 1)
    Wrong(file.string() + ": its longest side would be " + lengths +
          "; pass --unit, or --size with its length in m");
  const std::string range = Metres(usual.low_m) + " to " + Metres(usual.high_m);
  config.unit = fitting.empty() ? "m" : fitting.front();
  if (fitting.empty())
    return {config, "read in m, " + Metres(length) + " long, where a " + usual.what + " is " +
                        range + "; pass --unit or --size"};
  if (config.unit == "m") return {config, ""};
  return {config, "read in " + config.unit + ", which makes it " +
                      Metres(length * MetresOf(config.unit)) + " long; --unit says otherwise"};
}

// what is off by more than this is a wrong unit, not an unusual thing
constexpr double kFarOff = 10;

void CheckLength(const LooseMeshConfig& config, const fs::path& file, const UsualLength& usual) {
  const double length = LongestSide(file) * MetresOf(config.unit) * ScaleOf(config).maxCoeff();
  if (length >= usual.low_m / kFarOff && length <= usual.high_m * kFarOff) return;
  Wrong(file.string() + ": would be " + Metres(length) + " long, where a " + usual.what + " is " +
        Metres(usual.low_m) + " to " + Metres(usual.high_m) +
        "; pass another --unit or --scale, or --size with its length in m");
}

KnownUnit FindUnit(const LooseMeshConfig& config, const fs::path& file, const UsualLength& usual) {
  if (config.size_m != 0) return WithSize(config, file);
  if (!config.unit.empty()) return {config, ""};
  if (config.scale.empty()) return GuessUnit(config, file, usual);
  KnownUnit known{config, ""};
  known.config.unit = "m";
  return known;
}

KnownUnit KnowUnit(const LooseMeshConfig& config, const fs::path& file, const UsualLength& usual) {
  KnownUnit known = FindUnit(config, file, usual);
  CheckLength(known.config, file, usual);
  return known;
}

SourceMesh MeshFrom(const fs::path& file, const std::string& piece, const LooseMeshConfig& config) {
  SourceMesh mesh;
  mesh.piece = piece;
  mesh.file = file;
  mesh.sha256 = Sha256OfFile(file);
  mesh.part_from_raw = PartAxesFromFile(config);
  return mesh;
}

Category CategoryFor(const fs::path& path, const ReadConfig& config) {
  if (config.category.empty())
    Wrong(path.string() + ": a mesh does not say what kind of door it belongs to; pass --category");
  return CategoryOr(config, Category::kInterior);
}

// the folder tells apart what data sets number afresh in each
std::string NameFor(const fs::path& path) {
  const std::string stem = path.stem().string();
  const bool only_digits =
      std::all_of(stem.begin(), stem.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
  const std::string folder = fs::absolute(path).lexically_normal().parent_path().filename();
  return only_digits && !folder.empty() ? folder + "-" + stem : stem;
}

ForeignObject ReadHandleMesh(const fs::path& path, const ReadConfig& config) {
  const auto [mesh, note] = KnowUnit(config.mesh, path, kHandleLength);
  HandleSource handle;
  handle.name = "mesh/" + NameFor(path);
  handle.id = NameFor(path);
  handle.source = "mesh";
  handle.license = mesh.license;
  handle.category = CategoryFor(path, config);
  const std::optional<Mechanism> mechanism = MechanismNamed(mesh.mechanism);
  if (!mechanism)
    Wrong("--mechanism: unknown mechanism \"" + mesh.mechanism +
          "\"; allowed are none, lever, round, key, valve, flap");
  handle.mechanism = *mechanism;
  handle.axis_point_m = MountIn(mesh);
  if (handle.axis_point_m) handle.leaf_plane_m = handle.axis_point_m->x();
  if (!mesh.rose.empty()) handle.meshes.push_back(MeshFrom(mesh.rose, "rose", mesh));
  handle.meshes.push_back(MeshFrom(path, "grip", mesh));
  ForeignObject object = ReadHandle(handle);
  object.scale = MetresOf(mesh.unit) * ScaleOf(mesh).x();
  if (!note.empty()) object.notes.push_back(note);
  return object;
}

class BodyMeshReader {
 public:
  BodyMeshReader(const fs::path& path, const ReadConfig& config) : path_(path), config_(config) {
    KnownUnit known = KnowUnit(config.mesh, path, kLeafLength);
    config_.mesh = std::move(known.config);
    if (!known.note.empty()) object_.notes.push_back(std::move(known.note));
  }

  ForeignObject Read() {
    const LooseMeshConfig& config = config_.mesh;
    if (config.hinge != "left" && config.hinge != "right")
      Wrong("--hinge: \"" + config.hinge + "\" is no side; allowed are left and right");
    object_.name = "mesh/" + NameFor(path_);
    object_.category = NameOf(CategoryFor(path_, config_));
    object_.scale = MetresOf(config.unit) * ScaleOf(config).x();
    object_.mirrored = config.hinge == "right";
    if (object_.mirrored) object_.notes.push_back("mirrored: the source's hinge is on the right");
    if (!config.frame.empty()) meshes_.push_back(MeshFrom(config.frame, "frame", config));
    meshes_.push_back(MeshFrom(path_, "leaf", config));
    if (object_.mirrored) {
      for (SourceMesh& mesh : meshes_)
        mesh.part_from_raw = Eigen::Scaling(1.0, -1.0, 1.0) * mesh.part_from_raw;
    }
    const TriangleMesh leaf = LoadMesh(meshes_.back());
    const Eigen::Vector3d size = BoundsOf(leaf).sizes();
    if (size.x() > kThickLeaf * std::min(size.y(), size.z())) return Refuse(size);
    AddPart(leaf);
    return object_;
  }

 private:
  ForeignObject Refuse(const Eigen::Vector3d& size) {
    const auto number = [](double metres) {
      return std::to_string(std::lround(metres * 1000)) + " mm";
    };
    object_.refusal = "no leaf of a door: " + number(size.x()) + " deep, " + number(size.y()) +
                      " wide and " + number(size.z()) +
                      " high, at most half as deep as wide and high is allowed; check --front, "
                      "--up and --scale";
    return object_;
  }

  void AddPart(const TriangleMesh& leaf) {
    const Eigen::AlignedBox3d bounds = BoundsOf(leaf);
    double lowest = bounds.min().z();
    if (meshes_.size() > 1)
      lowest = std::min(lowest, BoundsOf(LoadMesh(meshes_.front())).min().z());
    const Eigen::Translation3d up(0, 0, -lowest);
    Part part;
    part.id = PartIdFrom(NameFor(path_));
    part.category = CategoryFor(path_, config_);
    // the middle of the leaf's edge
    part.joint.origin_m = up * Eigen::Vector3d(bounds.center().x(), bounds.min().y(), lowest);
    part.joint.axis = -Eigen::Vector3d::UnitZ();
    part.joint.upper_rad = kOpening;
    part.part_from_mount = Translation(up * Mount(leaf));
    part.license = config_.mesh.license;
    part.source = "mesh: " + FileNamesOf(meshes_) + (object_.mirrored ? ", mirrored" : "");
    for (SourceMesh& mesh : meshes_) mesh.part_from_raw = up * mesh.part_from_raw;
    part.source_sha256 = SourceHashOf(meshes_, part);
    object_.parts.push_back({part.id, part.role, part.source_sha256, [part, meshes = meshes_] {
                               return LoadedPart{{part, LoadPieces(meshes)}, 0};
                             }});
    object_.mechanism = NameOf(Mechanism::kNone);
  }

  Eigen::Vector3d Mount(const TriangleMesh& leaf) const {
    std::optional<Eigen::Vector3d> mount = MountIn(config_.mesh);
    if (mount && object_.mirrored) mount->y() = -mount->y();
    return mount.value_or(DefaultMount(leaf, CategoryFor(path_, config_)));
  }

  fs::path path_;
  ReadConfig config_;
  std::vector<SourceMesh> meshes_;
  ForeignObject object_;
};

std::vector<ForeignObject> Read(const fs::path& path, const ReadConfig& config) {
  if (config.mesh.role == "handle") return {ReadHandleMesh(path, config)};
  if (config.mesh.role == "body") return {BodyMeshReader(path, config).Read()};
  Wrong(path.string() + ": a mesh does not say what it is; pass --role body or --role handle" +
        (config.mesh.role.empty() ? "" : ", not \"" + config.mesh.role + "\""));
}

}  // namespace

ImportFormat LooseMeshFormat() { return {"mesh", IsMesh, Read}; }

}  // namespace doorforge::internal
