// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "mend_record.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <nlohmann/json.hpp>

#include "doorforge/core/closed_mesh.h"
#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/inside_folder.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/mass_properties.h"
#include "doorforge/core/mesh_transform.h"
#include "doorforge/exporters/expected_urdf.h"
#include "doorforge/exporters/export_urdf.h"
#include "doorforge/mesh/convex_parts.h"
#include "doorforge/parts/joint_limits.h"
#include "doorforge/parts/piece_density.h"
#include "doorforge/schemas/mesh_file.h"
#include "doorforge/schemas/mesh_pool.h"
#include "doorforge/schemas/part.h"
#include "doorforge/schemas/urdf.h"

namespace doorforge::internal {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// The finding of a rule at a place, if there is one.
const Finding* FindingAt(const Findings& findings, std::string_view code,
                         const std::string& where) {
  const auto found = std::find_if(findings.begin(), findings.end(), [&](const Finding& finding) {
    return finding.code == code && finding.where == where;
  });
  return found == findings.end() ? nullptr : &*found;
}

bool Any(const Findings& findings, std::string_view family) {
  return std::any_of(findings.begin(), findings.end(),
                     [&](const Finding& finding) { return finding.code.starts_with(family); });
}

// ---- meshes -------------------------------------------------------------------------------------

// Gives the same triangles turned, if they enclose a volume then.
std::optional<TriangleMesh> Turned(TriangleMesh mesh) {
  for (Eigen::Vector3i& triangle : mesh.triangles) std::swap(triangle[0], triangle[1]);
  if (!ClosedMesh::From(mesh)) return std::nullopt;
  return mesh;
}

bool HasArea(const TriangleMesh& mesh, const Eigen::Vector3i& t) {
  const Eigen::Vector3d& a = mesh.vertices[static_cast<std::size_t>(t[0])];
  const Eigen::Vector3d& b = mesh.vertices[static_cast<std::size_t>(t[1])];
  const Eigen::Vector3d& c = mesh.vertices[static_cast<std::size_t>(t[2])];
  return (b - a).cross(c - a).norm() > 0;
}

// Without the triangles that have no area, if no hole is left.
std::optional<TriangleMesh> WithoutDegenerate(TriangleMesh mesh) {
  const auto open = [](const MeshTopology& topology) {
    return topology.boundary_edges + topology.non_manifold_edges + topology.inconsistent_edges;
  };
  const int open_before = open(MeasureTopology(mesh));
  std::erase_if(mesh.triangles, [&](const Eigen::Vector3i& t) { return !HasArea(mesh, t); });
  if (open(MeasureTopology(mesh)) > open_before) return std::nullopt;
  return mesh;
}

// The convex hull of a collision shape, if it is nearly the same body.
std::optional<TriangleMesh> Convex(const TriangleMesh& hull) {
  constexpr double kMostAdded = 1.05;
  const TriangleMesh convex = RoundedToFloat(ConvexHull(hull.vertices));
  const double volume = std::abs(MeasureTopology(hull).volume_m3);
  if (!ClosedMesh::From(convex) || MeasureTopology(convex).volume_m3 > kMostAdded * volume)
    return std::nullopt;
  return convex;
}

/// The meshes of a piece, wherever they are kept, and what was done to them.
struct MendedPiece {
  std::string where;
  TriangleMesh mesh;
  std::vector<TriangleMesh> hulls;
  bool mesh_changed = false;
  std::vector<std::size_t> changed_hulls = {};
  std::vector<Fix> fixes = {};
};

void MendMesh(const Findings& findings, MendedPiece& piece) {
  if (const Finding* found = FindingAt(findings, "MSH007", piece.where)) {
    if (auto mesh = WithoutDegenerate(piece.mesh)) {
      piece.mesh = std::move(*mesh);
      piece.mesh_changed = true;
      piece.fixes.push_back({found->code, found->where, found->measured + " dropped"});
    }
  }
  if (const Finding* found = FindingAt(findings, "MSH006", piece.where)) {
    if (auto mesh = Turned(piece.mesh)) {
      piece.mesh = std::move(*mesh);
      piece.mesh_changed = true;
      piece.fixes.push_back({found->code, found->where, "all triangles turned"});
    }
  }
}

void MendHulls(const Findings& findings, MendedPiece& piece) {
  for (std::size_t i = 0; i < piece.hulls.size(); ++i) {
    const std::string where = piece.where + ", collision shape " + std::to_string(i);
    const Finding* found = FindingAt(findings, "COL002", where);
    if (found == nullptr) continue;
    const auto hull = Convex(piece.hulls[i]);
    if (!hull) continue;
    piece.hulls[i] = *hull;
    piece.changed_hulls.push_back(i);
    piece.fixes.push_back({found->code, where, "replaced by its convex hull"});
  }
}

// ---- masses -------------------------------------------------------------------------------------

struct WeighedPiece {
  std::string name;
  TriangleMesh mesh;  // in the link's frame
};

/// A link of a door or a piece of a part.
struct WeighedLink {
  std::string where;
  MassProperties mass;
  Category category;
  std::vector<WeighedPiece> pieces;
};

MassProperties UsualMass(Category category, const std::string& piece, const ClosedMesh& mesh) {
  const PieceDensity usual = DensityOf(category, piece);
  MassProperties mass = MassPropertiesOf(mesh, usual.density_kg_m3);
  const double limited = std::clamp(mass.mass_kg, usual.min_mass_kg, usual.max_mass_kg);
  mass.inertia_kg_m2 *= limited / mass.mass_kg;
  mass.mass_kg = limited;
  return mass;
}

// Adds up the pieces' volume; there is none unless all of them are closed.
std::optional<MassProperties> MassOf(const WeighedLink& link) {
  std::vector<MassProperties> masses;
  double volume = 0;
  for (const WeighedPiece& piece : link.pieces) volume += MeasureTopology(piece.mesh).volume_m3;
  for (const WeighedPiece& piece : link.pieces) {
    const auto closed = ClosedMesh::From(piece.mesh);
    if (!closed) return std::nullopt;
    masses.push_back(link.mass.mass_kg > 0 ? MassPropertiesOf(*closed, link.mass.mass_kg / volume)
                                           : UsualMass(link.category, piece.name, *closed));
  }
  if (masses.empty()) return std::nullopt;
  return Combined(masses);
}

std::vector<Fix> MendMass(const Findings& findings, WeighedLink& link) {
  std::vector<Fix> fixes;
  for (const char* code : {"INR001", "INR002", "INR003", "INR004"}) {
    if (FindingAt(findings, code, link.where) != nullptr) fixes.push_back({code, link.where, {}});
  }
  if (fixes.empty()) return {};
  const bool weighed = link.mass.mass_kg > 0;
  const std::optional<MassProperties> mass = MassOf(link);
  if (!mass) return {};
  link.mass = *mass;
  for (Fix& fix : fixes)
    fix.done = "centre and inertia from the meshes, " + Number(mass->mass_kg) +
               (weighed ? " kg as before" : " kg of the usual construction");
  return fixes;
}

Json MassJson(const MassProperties& mass) {
  const Eigen::Matrix3d& i = mass.inertia_kg_m2;
  return {{"mass_kg", mass.mass_kg},
          {"center_of_mass_m", Vector3ToJson(mass.center_of_mass_m)},
          {"inertia_xx_yy_zz_kg_m2", Vector3ToJson(i.diagonal())},
          {"inertia_xy_xz_yz_kg_m2", {i(0, 1), i(0, 2), i(1, 2)}}};
}

// ---- joints -------------------------------------------------------------------------------------

std::optional<Fix> MendAxis(const Findings& findings, const std::string& where,
                            Eigen::Vector3d& axis) {
  const Finding* found = FindingAt(findings, "MEC001", where);
  if (found == nullptr || !(axis.norm() > 1e-6) || !axis.allFinite()) return std::nullopt;
  axis.normalize();
  return Fix{found->code, where, "normalised from " + found->measured};
}

std::optional<Fix> MendLimits(const Findings& findings, const std::string& where,
                              const JointLimits& usual, Json& joint) {
  const Finding* found = FindingAt(findings, "MEC005", where);
  if (found == nullptr) return std::nullopt;
  std::string done;
  const auto set = [&](const char* key, double value, const std::string& text) {
    if (joint[key].get<double>() > 0) return;
    joint[key] = value;
    done += (done.empty() ? "" : ", ") + text + " set to " + Number(value);
  };
  set("effort_limit_nm", usual.effort_nm, "effort");
  set("velocity_limit_rad_s", usual.velocity_rad_s, "velocity");
  return Fix{found->code, where, done};
}

// ---- doors --------------------------------------------------------------------------------------

/// A door's record as text, patched where something was mended: whatever else it says stays.
class DoorRecord {
 public:
  DoorRecord(const fs::path& folder, const Findings& findings)
      : folder_(folder), findings_(findings), text_(ReadFile(folder / "door.json")) {
    json_ = ReadJsonFile(folder / "door.json");
  }

  std::vector<Fix> Mend() {
    const bool readable =
        !Any(findings_, "MSH001") && !Any(findings_, "MSH002") && !Any(findings_, "MSH003");
    if (readable) MendMeshes();
    if (readable) MendMasses();
    MendJoints();
    if (changed_) Write();
    return std::move(fixes_);
  }

 private:
  void Keep(const Fix& fix) {
    fixes_.push_back(fix);
    changed_ = true;
  }

  void MendMeshes() {
    if (!Any(findings_, "MSH00") && !Any(findings_, "COL002")) return;
    const DoorAsset door = ReadDoor(folder_);
    for (std::size_t i = 0; i < door.links.size(); ++i) {
      const DoorLink& link = door.links[i];
      for (std::size_t k = 0; k < link.geometry.size(); ++k) {
        Json& geometry = json_["links"][i]["geometry"][k];
        if (geometry.contains("shape")) continue;  // other doors share it
        MendedPiece piece{
            "door.json: link \"" + link.name + "\", \"" + link.geometry[k].name + "\"",
            link.geometry[k].mesh, link.geometry[k].hulls};
        MendMesh(findings_, piece);
        MendHulls(findings_, piece);
        if (piece.mesh_changed) WriteMesh(piece.mesh, geometry["mesh"]);
        for (const std::size_t hull : piece.changed_hulls)
          WriteMesh(piece.hulls[hull], geometry["hulls"][hull]);
        for (const Fix& fix : piece.fixes) Keep(fix);
      }
    }
  }

  void WriteMesh(const TriangleMesh& mesh, Json& reference) const {
    const std::string text = ToObj(mesh);
    CommitFile(FileInside(folder_, reference["path"].get<std::string>(), "door.json"), text);
    reference["sha256"] = Sha256Hex(text);
  }

  void MendMasses() {
    if (!Any(findings_, "INR00")) return;
    const DoorAsset door = ReadDoor(folder_);
    for (std::size_t i = 0; i < door.links.size(); ++i) {
      const DoorLink& link = door.links[i];
      WeighedLink weighed{"door.json: link \"" + link.name + "\"", link.mass, door.category, {}};
      for (const DoorGeometry& geometry : link.geometry)
        weighed.pieces.push_back({geometry.name, geometry.mesh});
      const std::vector<Fix> fixes = MendMass(findings_, weighed);
      if (!fixes.empty()) json_["links"][i]["mass"] = MassJson(weighed.mass);
      for (const Fix& fix : fixes) Keep(fix);
    }
  }

  void MendJoints() {
    for (const auto& [key, usual] :
         {std::pair{"hinge", kHingeLimits}, std::pair{"handle_joint", kHandleLimits}}) {
      if (!json_.contains(key)) continue;
      Json& joint = json_[key];
      const std::string where = "door.json: " + ValueOf<std::string>(joint, "name", key);
      Eigen::Vector3d axis = Vector3FromJson(MemberOf(joint, "axis", key), key);
      if (const auto fix = MendAxis(findings_, where, axis)) {
        joint["axis"] = Vector3ToJson(axis);
        Keep(*fix);
      }
      if (const auto fix = MendLimits(findings_, where, usual, joint)) Keep(*fix);
    }
  }

  // doors of a pool have their record on one line
  void Write() const {
    const bool one_line = text_.find('\n') + 1 >= text_.size();
    CommitFile(folder_ / "door.json", JsonText(json_, one_line ? -1 : 2) + "\n");
  }

  const fs::path& folder_;
  const Findings& findings_;
  std::string text_;
  Json json_;
  std::vector<Fix> fixes_;
  bool changed_ = false;
};

std::vector<Fix> MendUrdf(const fs::path& folder, const Findings& findings) {
  const MeshReader no_meshes = [](const std::string&, const std::string&) {
    return TriangleMesh{};
  };
  const DoorAsset door = ReadDoor(folder, no_meshes);
  const DoorFiles files = ReadDoorFiles(folder);
  const UrdfModel model = ExpectedUrdf(door, files);
  // doors of a pool have both of their files on one line
  const bool shares = !files[kLeafLink].empty() &&
                      files[kLeafLink].front().mesh.starts_with(std::string(kMeshPoolPath) + "/");
  CommitFile(folder / "model.urdf", shares ? ToCompactUrdf(model) : ToUrdf(model));
  std::vector<Fix> fixes;
  for (const Finding& finding : findings) {
    if (finding.code.starts_with("URD"))
      fixes.push_back({finding.code, finding.where, "model.urdf written again from door.json"});
  }
  return fixes;
}

}  // namespace

std::vector<Fix> MendDoor(const fs::path& folder, const Findings& findings) {
  if (Any(findings, "REC001")) return {};
  std::vector<Fix> fixes = DoorRecord(folder, findings).Mend();
  if (fixes.empty() && !Any(findings, "URD")) return fixes;
  const std::vector<Fix> more = MendUrdf(folder, findings);
  fixes.insert(fixes.end(), more.begin(), more.end());
  return fixes;
}

std::vector<Fix> MendPart(const fs::path& folder, const Findings& findings) {
  if (Any(findings, "REC001")) return {};
  Part part = ReadPart(folder);
  std::vector<Fix> fixes;
  const auto keep = [&](const std::vector<Fix>& more) {
    fixes.insert(fixes.end(), more.begin(), more.end());
  };
  for (PartPiece& piece : part.pieces) {
    MendedPiece mended{"part.json: \"" + piece.name + "\"", piece.mesh, piece.hulls};
    MendMesh(findings, mended);
    MendHulls(findings, mended);
    piece.mesh = mended.mesh;
    piece.hulls = mended.hulls;
    keep(mended.fixes);
    WeighedLink weighed{mended.where, piece.mass, part.category, {{piece.name, piece.mesh}}};
    keep(MendMass(findings, weighed));
    piece.mass = weighed.mass;
  }
  if (const auto fix = MendAxis(findings, "part.json: joint", part.joint.axis)) keep({*fix});
  if (!fixes.empty()) WritePart(part, folder);
  return fixes;
}

}  // namespace doorforge::internal
