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
#include "doorforge/core/mesh_transform.h"
#include "doorforge/mesh/import_mesh.h"

#include "import_format.h"
#include "urdf_objects/file_axes.h"
#include "urdf_objects/handle_part.h"
#include "urdf_objects/handle_place.h"
#include "urdf_objects/leaf_motion.h"

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

// how one file is read, and where it says otherwise than what the user does
struct FileReading {
  std::string up;
  std::string front;
  double read_m = 1;  ///< Metres a unit that the reader applied already.
  double unit_m = 1;  ///< Metres a unit that are to be applied.
};

constexpr double kAlong = 0.9;  // cosine above which a direction lies along an axis

// What the user says comes first, then what the file does.
FileReading ReadingOf(const LooseMeshConfig& config, const FileFrame& frame) {
  FileReading reading;
  reading.up = !config.up.empty() ? config.up : !frame.up.empty() ? frame.up : "z";
  const Eigen::Vector3d up = DirectionNamed(reading.up, "--up");
  const bool along_x = std::abs(up.x()) > kAlong;
  const bool fits =
      !frame.front.empty() && std::abs(up.dot(AxisNamed(frame.front, "--front"))) < kAlong;
  const std::string front = fits ? frame.front : along_x ? "y" : "x";
  reading.front = config.front.empty() ? front : config.front;
  reading.read_m = frame.unit_m;
  reading.unit_m = config.unit.empty() ? frame.unit_m : MetresOf(config.unit);
  return reading;
}

Eigen::Matrix3d TurnOf(const FileReading& reading) {
  return PartAxesFrom(reading.up, reading.front);
}

// of the file as it was read, whose lengths are in metres by its own unit
Eigen::Affine3d PartFromRead(const LooseMeshConfig& config, const FileReading& reading) {
  return Eigen::Affine3d(TurnOf(reading)) *
         Eigen::Scaling(Eigen::Vector3d(reading.unit_m / reading.read_m * ScaleOf(config)));
}

std::optional<Eigen::Vector3d> MountIn(const LooseMeshConfig& config, const FileReading& reading) {
  if (config.mount.empty()) return std::nullopt;
  if (config.mount.size() != 3) Wrong("--mount: expected three numbers, x y z of the file");
  const Eigen::Vector3d mount(config.mount[0], config.mount[1], config.mount[2]);
  return TurnOf(reading) * (reading.unit_m * ScaleOf(config)).cwiseProduct(mount);
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

// What a file says, and how long it would be by that.
struct FileFacts {
  fs::path file;
  FileFrame frame;
  double longest_m = 0;
};

// Its sides are those that it has in the axes of the part.
FileFacts FactsOf(const fs::path& file, const LooseMeshConfig& config) {
  const ImportedMesh mesh = ImportMesh(file);
  const Eigen::Matrix3d turn = TurnOf(ReadingOf(config, mesh.frame));
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& vertex : MergedPieces(mesh).vertices) bounds.extend(turn * vertex);
  return {file, mesh.frame, bounds.sizes().maxCoeff()};
}

// A config with a unit or a size, and what was assumed.
struct KnownUnit {
  LooseMeshConfig config;
  std::string note;
};

KnownUnit WithSize(LooseMeshConfig config, const FileFacts& facts) {
  if (!config.unit.empty() || !config.scale.empty())
    Wrong("--size: stands for --unit and --scale; give one of them");
  if (!(config.size_m > 0) || !std::isfinite(config.size_m))
    Wrong("--size: expected a length above 0 m");
  config.scale = {config.size_m / facts.longest_m};
  return {config, ""};
}

// CAD programs write millimetres into formats that are in metres.
std::string AgainstTheFile(const FileFacts& facts) {
  if (!facts.frame.states_unit) return "";
  return "the file's own unit would make it " + Metres(facts.longest_m) + " long; ";
}

// How long it would be if its numbers were in another unit than the one they were read in.
double LengthIn(const FileFacts& facts, const std::string& unit) {
  return facts.longest_m / facts.frame.unit_m * MetresOf(unit);
}

bool IsUsual(double length_m, const UsualLength& usual) {
  return length_m >= usual.low_m && length_m <= usual.high_m;
}

KnownUnit GuessUnit(LooseMeshConfig config, const FileFacts& facts, const UsualLength& usual) {
  if (IsUsual(facts.longest_m, usual)) return {config, ""};
  std::vector<std::string> fitting;
  std::string lengths;
  for (const char* unit : {"m", "cm", "mm"}) {
    const double metres = LengthIn(facts, unit);
    if (!IsUsual(metres, usual)) continue;
    fitting.emplace_back(unit);
    lengths += (lengths.empty() ? "" : " or ") + Metres(metres) + " in " + unit;
  }
  if (fitting.size() > 1)
    Wrong(facts.file.string() + ": " + AgainstTheFile(facts) + "its longest side would be " +
          lengths + "; pass --unit, or --size with its length in m");
  const std::string range = Metres(usual.low_m) + " to " + Metres(usual.high_m);
  const std::string own = facts.frame.states_unit ? "its own unit" : "m";
  if (fitting.empty())
    return {config, "read in " + own + ", " + Metres(facts.longest_m) + " long, where a " +
                        usual.what + " is " + range + "; pass --unit or --size"};
  config.unit = fitting.front();
  return {config, AgainstTheFile(facts) + "read in " + config.unit + ", which makes it " +
                      Metres(LengthIn(facts, config.unit)) + " long; --unit says otherwise"};
}

// what is off by more than this is a wrong unit, not an unusual thing
constexpr double kFarOff = 10;

void CheckLength(const LooseMeshConfig& config, const FileFacts& facts, const UsualLength& usual) {
  const double factor = ReadingOf(config, facts.frame).unit_m / facts.frame.unit_m;
  const double length = facts.longest_m * factor * ScaleOf(config).maxCoeff();
  if (length >= usual.low_m / kFarOff && length <= usual.high_m * kFarOff) return;
  Wrong(facts.file.string() + ": would be " + Metres(length) + " long, where a " + usual.what +
        " is " + Metres(usual.low_m) + " to " + Metres(usual.high_m) +
        "; pass another --unit or --scale, or --size with its length in m");
}

KnownUnit FindUnit(const LooseMeshConfig& config, const FileFacts& facts,
                   const UsualLength& usual) {
  if (config.size_m != 0) return WithSize(config, facts);
  if (config.unit.empty() && config.scale.empty()) return GuessUnit(config, facts, usual);
  return {config, ""};
}

KnownUnit KnowUnit(const LooseMeshConfig& config, const FileFacts& facts,
                   const UsualLength& usual) {
  KnownUnit known = FindUnit(config, facts, usual);
  CheckLength(known.config, facts, usual);
  return known;
}

// Which axes were taken, of those that the user did not name.
std::string AxesNote(const LooseMeshConfig& config, const FileFacts& facts) {
  const FileReading reading = ReadingOf(config, facts.frame);
  std::string axes;
  std::string options;
  const auto add = [&](const std::string& axis, const std::string& option) {
    axes += (axes.empty() ? "" : ", ") + axis;
    options += (options.empty() ? "" : " and ") + option;
  };
  if (config.up.empty()) add(reading.up + " up", "--up");
  if (config.front.empty()) add(reading.front + " out of the door", "--front");
  if (axes.empty()) return "";
  const bool told = !facts.frame.up.empty();
  return (told ? "axes from the file: " : "axes assumed, for the file states none: ") + axes +
         "; " + options + (config.up.empty() && config.front.empty() ? " say" : " says") +
         " otherwise";
}

std::string UnitNote(const KnownUnit& known, const FileFacts& facts) {
  if (!known.note.empty() || !facts.frame.states_unit) return known.note;
  const LooseMeshConfig& config = known.config;
  if (!config.unit.empty() || config.size_m != 0) return "";
  const double metres = facts.frame.unit_m;
  return "unit from the file: " + (metres == 1 ? "m" : Metres(metres)) + "; --unit says otherwise";
}

void AddNotes(const KnownUnit& known, const FileFacts& facts, ForeignObject& object) {
  for (const std::string& note : {UnitNote(known, facts), AxesNote(known.config, facts)}) {
    if (!note.empty()) object.notes.push_back(note);
  }
}

SourceMesh MeshFrom(const FileFacts& facts, const std::string& piece,
                    const LooseMeshConfig& config) {
  SourceMesh mesh;
  mesh.piece = piece;
  mesh.file = facts.file;
  mesh.sha256 = HashOfMeshFile(facts.file);
  mesh.part_from_raw = PartFromRead(config, ReadingOf(config, facts.frame));
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
  const FileFacts facts = FactsOf(path, config.mesh);
  const KnownUnit known = KnowUnit(config.mesh, facts, kHandleLength);
  const LooseMeshConfig& mesh = known.config;
  const FileReading reading = ReadingOf(mesh, facts.frame);
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
  handle.axis_point_m = MountIn(mesh, reading);
  if (handle.axis_point_m) handle.leaf_plane_m = handle.axis_point_m->x();
  if (!mesh.rose.empty()) handle.meshes.push_back(MeshFrom(FactsOf(mesh.rose, mesh), "rose", mesh));
  handle.meshes.push_back(MeshFrom(facts, "grip", mesh));
  ForeignObject object = ReadHandle(handle);
  object.scale = reading.unit_m * ScaleOf(mesh).x();
  AddNotes(known, facts, object);
  return object;
}

class BodyMeshReader {
 public:
  BodyMeshReader(const fs::path& path, const ReadConfig& config)
      : path_(path), config_(config), facts_(FactsOf(path, config.mesh)) {
    const KnownUnit known = KnowUnit(config.mesh, facts_, kLeafLength);
    AddNotes(known, facts_, object_);
    config_.mesh = known.config;
    reading_ = ReadingOf(config_.mesh, facts_.frame);
  }

  ForeignObject Read() {
    const LooseMeshConfig& config = config_.mesh;
    if (config.hinge != "left" && config.hinge != "right")
      Wrong("--hinge: \"" + config.hinge + "\" is no side; allowed are left and right");
    object_.name = "mesh/" + NameFor(path_);
    object_.category = NameOf(CategoryFor(path_, config_));
    object_.scale = reading_.unit_m * ScaleOf(config).x();
    object_.mirrored = config.hinge == "right";
    if (object_.mirrored) object_.notes.push_back("mirrored: the source's hinge is on the right");
    if (!config.frame.empty())
      meshes_.push_back(MeshFrom(FactsOf(config.frame, config), "frame", config));
    meshes_.push_back(MeshFrom(facts_, "leaf", config));
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
    std::optional<Eigen::Vector3d> mount = MountIn(config_.mesh, reading_);
    if (mount && object_.mirrored) mount->y() = -mount->y();
    return mount.value_or(DefaultMount(leaf, CategoryFor(path_, config_)));
  }

  fs::path path_;
  ReadConfig config_;
  FileFacts facts_;
  FileReading reading_;
  std::vector<SourceMesh> meshes_;
  ForeignObject object_;
};

std::vector<ForeignObject> ReadLooseMesh(const fs::path& path, const ReadConfig& config) {
  if (config.mesh.role == "handle") return {ReadHandleMesh(path, config)};
  if (config.mesh.role == "body") return {BodyMeshReader(path, config).Read()};
  Wrong(path.string() + ": a mesh does not say what it is; pass --role body or --role handle" +
        (config.mesh.role.empty() ? "" : ", not \"" + config.mesh.role + "\""));
}

}  // namespace

ImportFormat LooseMeshFormat() { return {"mesh", IsMesh, ReadLooseMesh}; }

}  // namespace doorforge::internal
