// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/door/validate_door.h"

#include <algorithm>
#include <map>

#include <nlohmann/json.hpp>

#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/schemas/mesh_file.h"
#include "doorforge/schemas/mesh_pool.h"

#include "findings.h"
#include "inside_folder.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using internal::Findings;
using internal::Found;

void Append(Findings& findings, const Findings& more) {
  findings.insert(findings.end(), more.begin(), more.end());
}

bool IsPooled(const std::string& relative) {
  return relative.starts_with(std::string(kMeshPoolPath) + "/") &&
         relative.find("..", 2) == std::string::npos;
}

/// Reads the meshes of one record. What cannot be read becomes a finding and an empty mesh, so that
/// the rest of the record is still checked.
class MeshFindings {
 public:
  MeshFindings(const fs::path& folder, std::string record)
      : folder_(folder), record_(std::move(record)) {}

  TriangleMesh Read(const std::string& relative, const std::string& sha256) {
    const std::string where = record_ + ": " + relative;
    try {
      const TriangleMesh mesh = ReadObj(FileOf(relative, sha256));
      const std::string found = Sha256Hex(ToObj(mesh));
      if (found != sha256)
        findings_.push_back(Found(
            "MSH004", where,
            "SHA-256 " + found.substr(0, 12) + "..., recorded " + sha256.substr(0, 12) + "..."));
      if (mesh.triangles.empty()) findings_.push_back(Found("MSH002", where, "no triangles"));
      return mesh;
    } catch (const Error& error) {
      findings_.push_back(Found(CodeOf(relative, error), where, error.what()));
      return {};
    }
  }

  MeshReader Reader() {
    return [this](const std::string& relative, const std::string& sha256) {
      return Read(relative, sha256);
    };
  }

  const Findings& findings() const { return findings_; }

 private:
  // in the folder, or in the pool that it shares with its neighbours
  fs::path FileOf(const std::string& relative, const std::string& sha256) const {
    if (IsPooled(relative)) return MeshPool(folder_, record_).MeshFile(sha256);
    return internal::FileInside(folder_, relative, record_);
  }

  const char* CodeOf(const std::string& relative, const Error& error) const {
    if (error.code() == ErrorCode::kMissing) return "MSH001";
    if (IsPooled(relative)) return "MSH002";
    std::error_code ignored;
    const bool inside = fs::is_regular_file(folder_ / relative, ignored) &&
                        relative.find("..") == std::string::npos &&
                        !fs::path(relative).is_absolute() && !LinksOut(relative);
    return inside ? "MSH002" : "MSH003";
  }

  bool LinksOut(const std::string& relative) const {
    std::error_code ignored;
    const fs::path real = fs::weakly_canonical(folder_ / relative, ignored);
    const fs::path inside = real.lexically_relative(fs::weakly_canonical(folder_, ignored));
    return inside.empty() || *inside.begin() == "..";
  }

  fs::path folder_;
  std::string record_;
  Findings findings_;
};

// What could not be read is empty and has been reported: one fault, not three.
bool WasRead(const TriangleMesh& mesh, const std::vector<TriangleMesh>& hulls) {
  return !mesh.triangles.empty() &&
         std::none_of(hulls.begin(), hulls.end(),
                      [](const TriangleMesh& hull) { return hull.triangles.empty(); });
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

Findings CheckPieces(const DoorAsset& door) {
  Findings findings;
  for (const DoorLink& link : door.links) {
    for (const DoorGeometry& geometry : link.geometry) {
      if (!WasRead(geometry.mesh, geometry.hulls)) continue;
      Append(findings, internal::CheckPiece(
                           {"door.json: link \"" + link.name + "\", \"" + geometry.name + "\"",
                            geometry.mesh, geometry.hulls, geometry.label == PointLabel::kHandle}));
    }
  }
  return findings;
}

Findings CheckMasses(const DoorAsset& door) {
  Findings findings;
  for (const DoorLink& link : door.links) {
    internal::CheckedMass checked{"door.json: link \"" + link.name + "\"", link.mass, {}};
    for (const DoorGeometry& geometry : link.geometry) {
      if (!geometry.mesh.triangles.empty()) checked.meshes.push_back(&geometry.mesh);
    }
    Append(findings, internal::CheckMass(checked));
  }
  return findings;
}

bool Counts(const Finding& finding, ValidationProfile profile) {
  if (profile == ValidationProfile::kPhysics) return true;
  const std::string family = finding.code.substr(0, 3);
  return family != "COL" && family != "MEC" && family != "HND";
}

ValidationReport Report(const fs::path& folder, const Findings& findings,
                        ValidationProfile profile) {
  ValidationReport report{folder, {}};
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

Findings DoorFindings(const fs::path& folder) {
  MeshFindings meshes(folder, "door.json");
  try {
    const DoorAsset door = ReadDoor(folder, meshes.Reader());
    Findings findings = meshes.findings();
    Append(findings, CheckNames(door));
    Append(findings, CheckPieces(door));
    Append(findings, CheckMasses(door));
    Append(findings, internal::CheckMechanics(door));
    Append(findings, internal::CheckUrdf(door, folder));
    Append(findings, internal::CheckHandle(door));
    Append(findings, internal::CheckLicense(door.license, "door.json: license"));
    return findings;
  } catch (const Error& error) {
    Findings findings = meshes.findings();
    findings.push_back(Found("REC001", "door.json", error.what()));
    return findings;
  }
}

Findings PartFindings(const fs::path& folder) {
  MeshFindings meshes(folder, "part.json");
  try {
    const Part part = ReadPart(folder, meshes.Reader());
    Findings findings = meshes.findings();
    for (const PartPiece& piece : part.pieces) {
      const std::string where = "part.json: \"" + piece.name + "\"";
      const bool read = WasRead(piece.mesh, piece.hulls);
      if (read)
        Append(findings, internal::CheckPiece(
                             {where, piece.mesh, piece.hulls, part.role == PartRole::kHandle}));
      internal::CheckedMass mass{where, piece.mass, {}};
      if (read) mass.meshes.push_back(&piece.mesh);
      Append(findings, internal::CheckMass(mass));
    }
    Append(findings, internal::CheckPartJoint(part));
    if (part.role == PartRole::kHandle) Append(findings, internal::CheckPartGrasp(part));
    Append(findings, internal::CheckLicense(part.license, "part.json: license"));
    return findings;
  } catch (const Error& error) {
    Findings findings = meshes.findings();
    findings.push_back(Found("REC001", "part.json", error.what()));
    return findings;
  }
}

void RequireRecord(const fs::path& file) {
  if (!fs::is_regular_file(file))
    throw Error(ErrorCode::kMissing, file.string() +
                                         ": missing; validate reads folders that "
                                         "`doorforge compose` or `import` wrote");
}

}  // namespace

ValidationReport ValidateDoor(const fs::path& folder, ValidationProfile profile) {
  RequireRecord(folder / "door.json");
  return Report(folder, DoorFindings(folder), profile);
}

ValidationReport ValidatePart(const fs::path& folder, ValidationProfile profile) {
  RequireRecord(folder / "part.json");
  return Report(folder, PartFindings(folder), profile);
}

ValidationReport Validate(const fs::path& folder, ValidationProfile profile) {
  return fs::exists(folder / "door.json") ? ValidateDoor(folder, profile)
                                          : ValidatePart(folder, profile);
}

std::vector<fs::path> FindRecords(const fs::path& path) {
  const auto holds_record = [](const fs::path& folder) {
    return fs::is_regular_file(folder / "door.json") || fs::is_regular_file(folder / "part.json");
  };
  if (!fs::is_directory(path)) throw Error(ErrorCode::kMissing, path.string() + ": not a folder");
  if (holds_record(path)) return {path};
  std::vector<fs::path> folders;
  for (auto entry = fs::recursive_directory_iterator(path); entry != fs::end(entry); ++entry) {
    if (!entry->is_directory() || !holds_record(entry->path())) continue;
    folders.push_back(entry->path());
    entry.disable_recursion_pending();
  }
  if (folders.empty())
    throw Error(ErrorCode::kMissing,
                path.string() + ": no door.json or part.json in it or below it");
  std::sort(folders.begin(), folders.end());
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
                          {"fix", finding.fix}});
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
