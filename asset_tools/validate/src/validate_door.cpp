// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/validate/validate_door.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <nlohmann/json.hpp>

#include "doorforge/core/closed_mesh.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/mesh_transform.h"
#include "doorforge/core/record_id.h"
#include "doorforge/mesh/work_budget.h"
#include "doorforge/schemas/door_with_files.h"

#include "findings.h"
#include "record_meshes.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using internal::Findings;
using internal::Found;
using internal::LeafLines;
using internal::MeshOnDisk;
using internal::RecordMeshes;
using internal::SharedMesh;
using internal::ValidationMemory;

void Append(Findings& findings, const Findings& more) {
  findings.insert(findings.end(), more.begin(), more.end());
}

Findings CheckNames(const DoorAsset& door) {
  Findings findings;
  std::map<std::string, int> links;
  std::map<std::string, int> geometry;
  for (const DoorLink& link : door.links) {
    ++links[link.name];
    for (const DoorGeometry& piece : link.geometry) ++geometry[piece.name];
  }
  for (const auto& [name, count] : links) {
    if (count > 1)
      findings.push_back(
          Found("REC002", "door.json: link \"" + name + "\"", std::to_string(count) + " times"));
  }
  for (const auto& [name, count] : geometry) {
    if (count > 1)
      findings.push_back(Found("REC002", "door.json: geometry \"" + name + "\"",
                               std::to_string(count) + " times"));
  }
  return findings;
}

// Every id in a record, with where it stands. A record that does not follow its schema has none
// where it does not: REC001 says so.
class IdCheck {
 public:
  explicit IdCheck(std::string record) : record_(std::move(record)) {}

  void Id(const nlohmann::ordered_json& json, const std::string& key, const std::string& where) {
    const auto id = json.find(key);
    if (!json.is_object() || id == json.end() || !id->is_string()) return;
    const std::string problem = IdProblem(id->get_ref<const std::string&>());
    if (!problem.empty())
      findings_.push_back(Found("REC004", record_ + ": " + where + key, problem));
  }

  void Names(const nlohmann::ordered_json& json, const std::string& key) {
    if (!json.is_object() || !json.contains(key) || !json[key].is_array()) return;
    for (std::size_t i = 0; i < json[key].size(); ++i) {
      const std::string where = key + "[" + std::to_string(i) + "].";
      Id(json[key][i], "name", where);
      Names(json[key][i], "geometry");
    }
  }

  Findings Take() { return std::move(findings_); }

 private:
  std::string record_;
  Findings findings_;
};

Findings CheckIds(const nlohmann::ordered_json& json, const std::string& record) {
  IdCheck check(record);
  check.Id(json, "id", "");
  for (const char* part : {"body", "handle"}) {
    if (json.is_object() && json.contains(part))
      check.Id(json[part], "id", part + std::string("."));
  }
  check.Names(json, "links");
  check.Names(json, "pieces");
  return check.Take();
}

/// A geometry of a door or a piece of a part, as its files hold it.
struct PieceOnDisk {
  std::string where;
  bool is_handle = false;
  SharedMesh mesh;
  std::vector<SharedMesh> hulls;

  // what could not be read is empty and has been reported: one fault, not three
  bool WasRead() const {
    return !mesh->mesh.triangles.empty() &&
           std::none_of(hulls.begin(), hulls.end(),
                        [](const SharedMesh& hull) { return hull->mesh.triangles.empty(); });
  }
};

bool WereRead(const std::vector<PieceOnDisk>& pieces) {
  return std::all_of(pieces.begin(), pieces.end(),
                     [](const PieceOnDisk& piece) { return !piece.mesh->mesh.triangles.empty(); });
}

/// Hands out what was read in the order of the record: each piece's mesh, then its hulls.
class ReadPieces {
 public:
  explicit ReadPieces(const RecordMeshes& meshes) : next_(meshes.read().begin()) {}

  PieceOnDisk Next(const std::string& where, bool is_handle, std::size_t hulls) {
    PieceOnDisk piece{where, is_handle, *next_++, {}};
    for (std::size_t i = 0; i < hulls; ++i) piece.hulls.push_back(*next_++);
    return piece;
  }

 private:
  std::vector<SharedMesh>::const_iterator next_;
};

std::size_t CountOf(const Findings& findings) { return findings.size() + 1; }

// Rigid motion changes nothing that is checked, so a piece is checked as its files hold it.
Findings CheckPieceOnce(const PieceOnDisk& piece, ValidationMemory& memory) {
  if (!piece.WasRead()) return {};
  std::string key = piece.is_handle ? "handle" : "body";
  std::vector<const TriangleMesh*> hulls;
  key += piece.mesh->sha256;
  for (const SharedMesh& hull : piece.hulls) {
    key += hull->sha256;
    hulls.push_back(&hull->mesh);
  }
  const auto check = [&] {
    return internal::CheckPiece({piece.mesh->mesh, hulls, piece.is_handle});
  };
  Findings findings = *memory.pieces.Get(key, check, CountOf);
  for (Finding& finding : findings) finding.where = piece.where + finding.where;
  return findings;
}

double VolumeOf(const MeshOnDisk& mesh, ValidationMemory& memory) {
  return *memory.volumes.Get(
      mesh.sha256, [&] { return MeasureTopology(mesh.mesh).volume_m3; },
      [](double) { return std::size_t{1}; });
}

/// One record while it is checked.
struct DoorOnDisk {
  DoorAsset door;
  DoorFiles files;
  std::array<std::vector<PieceOnDisk>, 3> pieces;  ///< They follow DoorAsset::links.
};

DoorOnDisk ReadDoorOnDisk(const nlohmann::ordered_json& record, const fs::path& folder,
                          RecordMeshes& meshes) {
  DoorWithFiles door = ReadDoorWithFiles(record, folder, meshes.Reader(), meshes.Visuals());
  DoorOnDisk on_disk{std::move(door.door), std::move(door.files), {}};
  ReadPieces read(meshes);
  for (std::size_t i = 0; i < on_disk.pieces.size(); ++i) {
    const DoorLink& link = on_disk.door.links[i];
    for (const DoorGeometry& geometry : link.geometry)
      on_disk.pieces[i].push_back(
          read.Next("door.json: link \"" + link.name + "\", \"" + geometry.name + "\"",
                    geometry.label == PointLabel::kHandle, geometry.hulls.size()));
  }
  return on_disk;
}

Findings CheckMasses(const DoorOnDisk& on_disk, ValidationMemory& memory) {
  Findings findings;
  for (std::size_t i = 0; i < on_disk.pieces.size(); ++i) {
    const DoorLink& link = on_disk.door.links[i];
    internal::CheckedMass checked{"door.json: link \"" + link.name + "\"", link.mass};
    for (std::size_t k = 0; WereRead(on_disk.pieces[i]) && k < link.geometry.size(); ++k) {
      checked.bounds.extend(BoundsOf(link.geometry[k].mesh));
      checked.volume_m3 += VolumeOf(*on_disk.pieces[i][k].mesh, memory);
    }
    Append(findings, internal::CheckMass(checked));
  }
  return findings;
}

// The leaf's own pieces, whatever handle is on it.
std::shared_ptr<const LeafLines> LinesOf(const DoorOnDisk& on_disk, ValidationMemory& memory) {
  std::string key;
  std::vector<TriangleMesh> leaf;
  const std::vector<DoorGeometry>& geometry = on_disk.door.links[kLeafLink].geometry;
  for (std::size_t i = 0; i < geometry.size(); ++i) {
    if (geometry[i].label == PointLabel::kHandle) continue;
    leaf.push_back(geometry[i].mesh);
    const RigidTransform& placed = on_disk.files[kLeafLink].at(i).link_from_files;
    key += on_disk.pieces[kLeafLink][i].mesh->sha256 + JsonText(TransformToJson(placed));
  }
  return memory.leaves.Get(
      key, [&] { return LeafLines(Merged(leaf)); },
      [&](const LeafLines&) {
        std::size_t triangles = 1;
        for (const TriangleMesh& mesh : leaf) triangles += mesh.triangles.size();
        return triangles;
      });
}

// To a nanometre, so that doors whose handle is the same share it although their frames are rounded
// otherwise.
RigidTransform Rounded(const RigidTransform& transform) {
  constexpr double kStep = 1e-9;
  RigidTransform rounded = transform;
  for (Eigen::Index i = 0; i < rounded.matrix().size(); ++i) {
    double& number = rounded.matrix().data()[i];
    number = std::round(number / kStep) * kStep;
  }
  return rounded;
}

/// The handle as its files hold it, placed about the door's grasp, whatever body it is on.
struct HandleAboutGrasp {
  struct Piece {
    SharedMesh mesh;
    RigidTransform grasp_from_files;
    bool turns;
  };
  std::vector<Piece> pieces;

  std::string Key() const {
    std::string key;
    for (const Piece& piece : pieces) {
      key += piece.turns ? 'g' : 'r';
      key += piece.mesh->sha256;
      const auto* numbers = reinterpret_cast<const char*>(piece.grasp_from_files.matrix().data());
      key.append(numbers, sizeof(double) * 16);
    }
    return key;
  }

  GraspFit Measure() const {
    std::vector<TriangleMesh> grip;
    std::vector<TriangleMesh> all;
    for (const Piece& piece : pieces) {
      all.push_back(Transformed(piece.mesh->mesh, piece.grasp_from_files));
      if (piece.turns) grip.push_back(all.back());
    }
    return MeasureGrasp(Merged(grip), Merged(all), RigidTransform::Identity());
  }
};

HandleAboutGrasp AboutGrasp(const DoorOnDisk& on_disk) {
  const DoorAsset& door = on_disk.door;
  const RigidTransform grasp_from_handle = door.handle_from_grasp.inverse();
  const RigidTransform grasp_from_leaf =
      grasp_from_handle * door.handle_joint.parent_from_child_at_zero.inverse();
  HandleAboutGrasp handle;
  for (const DoorLinkIndex link : {kLeafLink, kHandleLink}) {
    const bool turns = link == kHandleLink;
    for (std::size_t i = 0; i < on_disk.pieces[link].size(); ++i) {
      if (!turns && !on_disk.pieces[link][i].is_handle) continue;
      const RigidTransform& link_from_files = on_disk.files[link].at(i).link_from_files;
      handle.pieces.push_back(
          {on_disk.pieces[link][i].mesh,
           Rounded((turns ? grasp_from_handle : grasp_from_leaf) * link_from_files), turns});
    }
  }
  return handle;
}

GraspFit FitOf(const DoorOnDisk& on_disk, ValidationMemory& memory) {
  const HandleAboutGrasp handle = AboutGrasp(on_disk);
  return *memory.fits.Get(
      handle.Key(), [&] { return handle.Measure(); },
      [](const GraspFit&) { return std::size_t{1}; });
}

bool Counts(const Finding& finding, ValidationProfile profile) {
  if (profile != ValidationProfile::kUrdf) return true;
  const std::string family = finding.code.substr(0, 3);
  return family != "COL" && family != "MEC" && family != "HND";
}

ValidationReport Report(const fs::path& folder, ValidatedKind kind, const Findings& findings,
                        ValidationProfile profile) {
  ValidationReport report{.folder = folder, .findings = {}, .kind = kind};
  for (const ValidationRule& rule : ValidationRules()) {
    for (const Finding& finding : findings) {
      if (finding.code != rule.code || !Counts(finding, profile)) continue;
      report.findings.push_back(finding);
      report.errors += finding.severity == Severity::kError;
      report.warnings += finding.severity == Severity::kWarning;
    }
  }
  return report;
}

bool AnyError(const Findings& findings) {
  return std::any_of(findings.begin(), findings.end(),
                     [](const Finding& finding) { return finding.severity == Severity::kError; });
}

Findings CheckOpening(const DoorAsset& door, const Findings& others, const OpeningCheck& check) {
  if (!check) return {};
  if (AnyError(others)) return {Found("OPN007", "door.json", "errors of other families")};
  try {
    return check(door);
  } catch (const Error& error) {
    return {Found("OPN007", "door.json", error.what())};
  }
}

// A check that cannot be finished is a finding like any other: it costs neither what the other
// checks found nor the report of other folders.
template <class Check>
void Add(Findings& findings, const std::string& record, const Check& check) {
  std::string problem;
  try {
    CheckWork();
    Append(findings, check());
    return;
  } catch (const std::exception&) {
    problem = CurrentProblem(record);
  }
  const Finding given_up = Found("REC003", record, "could not be checked: " + problem);
  // time that is used up ends every check after it for the same reason
  if (findings.empty() || findings.back().measured != given_up.measured)
    findings.push_back(given_up);
}

// What is to be said of a record whose reading failed for `reason`.
Findings Unreadable(const RecordMeshes& meshes, const std::string& record,
                    const std::string& reason) {
  Findings findings = meshes.FindingsOfFiles();
  findings.push_back(Found("REC001", record, reason));
  return findings;
}

Findings DoorFindings(const fs::path& folder, const OpeningCheck& check, ValidationMemory& memory) {
  constexpr const char* kRecord = "door.json";
  RecordMeshes meshes(folder, kRecord, memory);
  std::optional<DoorOnDisk> read;
  try {
    const nlohmann::ordered_json record = ReadJsonFile(folder / kRecord);
    if (Findings ids = CheckIds(record, kRecord); !ids.empty()) return ids;
    read = ReadDoorOnDisk(record, folder, meshes);
  } catch (const Error& error) {
    return Unreadable(meshes, kRecord, error.what());
  }
  const DoorOnDisk& on_disk = *read;
  const DoorAsset& door = on_disk.door;
  Findings findings = meshes.FindingsOfFiles();
  const auto add = [&](const auto& one) { Add(findings, kRecord, one); };
  add([&] { return CheckNames(door); });
  for (const std::vector<PieceOnDisk>& pieces : on_disk.pieces) {
    for (const PieceOnDisk& piece : pieces) add([&] { return CheckPieceOnce(piece, memory); });
  }
  add([&] { return CheckMasses(on_disk, memory); });
  add([&] { return internal::CheckMechanics(door); });
  add([&] { return internal::CheckUrdf(door, on_disk.files, folder); });
  add([&] {
    return internal::CheckHandle(door, *LinesOf(on_disk, memory),
                                 [&] { return FitOf(on_disk, memory); });
  });
  add([&] { return internal::CheckLicense(door.license, "door.json: license"); });
  const Findings others = findings;
  add([&] { return CheckOpening(door, others, check); });
  return findings;
}

Findings CheckPartPiece(const PartPiece& piece, const PieceOnDisk& on_disk,
                        ValidationMemory& memory) {
  Findings findings = CheckPieceOnce(on_disk, memory);
  internal::CheckedMass mass{on_disk.where, piece.mass};
  if (on_disk.WasRead()) {
    mass.bounds = BoundsOf(piece.mesh);
    mass.volume_m3 = VolumeOf(*on_disk.mesh, memory);
  }
  Append(findings, internal::CheckMass(mass));
  return findings;
}

Findings PartFindings(const fs::path& folder, ValidationMemory& memory) {
  constexpr const char* kRecord = "part.json";
  RecordMeshes meshes(folder, kRecord, memory);
  std::optional<Part> read;
  try {
    const nlohmann::ordered_json record = ReadJsonFile(folder / kRecord);
    if (Findings ids = CheckIds(record, kRecord); !ids.empty()) return ids;
    read = ReadPart(folder, meshes.Reader(), meshes.Visuals());
  } catch (const Error& error) {
    return Unreadable(meshes, kRecord, error.what());
  }
  const Part& part = *read;
  Findings findings = meshes.FindingsOfFiles();
  const auto add = [&](const auto& one) { Add(findings, kRecord, one); };
  ReadPieces pieces(meshes);
  for (const PartPiece& piece : part.pieces) {
    const PieceOnDisk on_disk = pieces.Next("part.json: \"" + piece.name + "\"",
                                            part.role == PartRole::kHandle, piece.hulls.size());
    add([&] { return CheckPartPiece(piece, on_disk, memory); });
  }
  add([&] { return internal::CheckPartJoint(part); });
  if (part.role == PartRole::kHandle) add([&] { return internal::CheckPartGrasp(part); });
  add([&] { return internal::CheckLicense(part.license, "part.json: license"); });
  return findings;
}

// Whatever ends the work on a folder is a finding about that folder.
template <class Check>
Findings Contained(const fs::path& folder, const std::string& record, const Check& check) {
  const WorkBudget budget((folder / record).string());
  try {
    return check();
  } catch (const std::exception&) {
    return {Found("REC003", record, "could not be checked: " + CurrentProblem(folder.string()))};
  }
}

void RequireRecord(const fs::path& file) {
  if (!fs::is_regular_file(file))
    throw Error(ErrorCode::kMissing, file.string() +
                                         ": missing; validate reads folders that "
                                         "`doorforge compose` or `import` wrote");
}

}  // namespace

struct DoorValidator::Memory : ValidationMemory {};

DoorValidator::DoorValidator(ValidationProfile profile)
    : profile_(profile), memory_(std::make_unique<Memory>()) {}
DoorValidator::DoorValidator(OpeningCheck check) : DoorValidator(ValidationProfile::kOpenable) {
  opening_check_ = std::move(check);
}
DoorValidator::~DoorValidator() = default;

ValidationReport DoorValidator::Door(const fs::path& folder) const {
  RequireRecord(folder / "door.json");
  const Findings findings = Contained(
      folder, "door.json", [&] { return DoorFindings(folder, opening_check_, *memory_); });
  return Report(folder, ValidatedKind::kDoor, findings, profile_);
}

ValidationReport DoorValidator::Part(const fs::path& folder) const {
  RequireRecord(folder / "part.json");
  const Findings findings =
      Contained(folder, "part.json", [&] { return PartFindings(folder, *memory_); });
  return Report(folder, ValidatedKind::kPart, findings, profile_);
}

ValidationReport DoorValidator::Validate(const fs::path& folder) const {
  return fs::exists(folder / "door.json") ? Door(folder) : Part(folder);
}

ValidationReport ValidateDoor(const fs::path& folder, ValidationProfile profile) {
  return DoorValidator(profile).Door(folder);
}

ValidationReport ValidatePart(const fs::path& folder, ValidationProfile profile) {
  return DoorValidator(profile).Part(folder);
}

std::vector<fs::path> FindRecords(const fs::path& path) {
  // an entry that cannot be looked at, such as a link to itself, is no record
  std::error_code ignored;
  const auto holds_record = [&](const fs::path& folder) {
    return fs::is_regular_file(folder / "door.json", ignored) ||
           fs::is_regular_file(folder / "part.json", ignored);
  };
  if (!fs::exists(path, ignored))
    throw Error(ErrorCode::kMissing, path.string() + ": no such folder");
  if (!fs::is_directory(path, ignored))
    throw Error(ErrorCode::kMissing,
                path.string() +
                    ": not a folder; what is no door or part yet becomes one with "
                    "`doorforge import` and `doorforge compose`");
  if (holds_record(path)) return {path};
  std::vector<fs::path> folders;
  std::error_code error;
  auto entry = fs::recursive_directory_iterator(path, error);
  for (; !error && entry != fs::end(entry); entry.increment(error)) {
    if (!entry->is_directory(ignored)) continue;
    if (entry->path().filename().string().starts_with('.')) {
      entry.disable_recursion_pending();
      continue;
    }
    if (!holds_record(entry->path())) continue;
    folders.push_back(entry->path());
    entry.disable_recursion_pending();
  }
  if (error)
    throw Error(ErrorCode::kIo, path.string() + ": cannot be searched: " + error.message());
  if (folders.empty())
    throw Error(ErrorCode::kMissing,
                path.string() + ": no door.json or part.json in it or below it");
  std::sort(folders.begin(), folders.end());
  return folders;
}

std::vector<fs::path> FindRecords(const std::vector<std::string>& paths) {
  std::vector<fs::path> folders;
  for (const std::string& path : paths) {
    for (fs::path& folder : FindRecords(fs::path(path))) folders.push_back(std::move(folder));
  }
  return folders;
}

nlohmann::ordered_json ToJson(std::span<const ValidationReport> reports) {
  auto findings = nlohmann::ordered_json::array();
  int errors = 0;
  int warnings = 0;
  for (const ValidationReport& report : reports) {
    errors += report.errors;
    warnings += report.warnings;
    for (const Finding& finding : report.findings)
      findings.push_back({{"folder", report.folder.string()},
                          {"code", finding.code},
                          {"severity", NameOf(finding.severity)},
                          {"where", finding.where},
                          {"measured", finding.measured},
                          {"allowed", finding.allowed},
                          {"fix", finding.fix},
                          {"fixable", finding.fixable}});
  }
  const int infos = static_cast<int>(findings.size()) - errors - warnings;
  return {{"schema", "doorforge.validation"},
          {"schema_version", 1},
          {"findings", findings},
          {"counts",
           {{"folders", reports.size()},
            {"errors", errors},
            {"warnings", warnings},
            {"infos", infos}}}};
}

}  // namespace doorforge
