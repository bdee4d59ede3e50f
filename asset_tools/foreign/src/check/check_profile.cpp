// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "check/check_profile.h"

#include <algorithm>
#include <cctype>
#include <set>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/foreign/foreign_rules.h"
#include "doorforge/mesh/convex_parts.h"

#include "read/raw_mesh.h"

namespace doorforge::foreign {
namespace {

namespace fs = std::filesystem;

/// What a target reads.
struct Target {
  TargetProfile profile;
  std::set<ValidatedKind> kinds;
  std::set<std::string> meshes;  ///< Endings of mesh files.
};

const Target& TargetOf(TargetProfile profile) {
  static const std::vector<Target> targets = {
      {TargetProfile::kMujoco, {ValidatedKind::kMjcf, ValidatedKind::kUrdf}, {".obj", ".stl"}},
      {TargetProfile::kIsaac, {ValidatedKind::kUsda}, {}},
      {TargetProfile::kGazebo, {ValidatedKind::kSdf}, {".dae", ".obj", ".stl", ".glb", ".gltf"}},
      {TargetProfile::kSapien, {ValidatedKind::kUrdf}, {".obj", ".stl", ".dae", ".glb", ".ply"}}};
  const auto found = std::find_if(targets.begin(), targets.end(),
                                  [&](const Target& one) { return one.profile == profile; });
  if (found == targets.end()) throw Error(ErrorCode::kInvalidArgument, "no such target");
  return *found;
}

std::string EndingOf(const std::string& name) {
  std::string ending = fs::path(name).extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

bool Collides(const ForeignShape& shape) { return shape.use != ShapeUse::kVisual; }

class ProfileCheck {
 public:
  ProfileCheck(const ProfileQuestion& question, const Target& target, FaultList& faults)
      : q_(question), target_(target), faults_(faults) {}

  void Check() {
    if (!target_.kinds.contains(q_.kind))
      return faults_.Add(
          "PRF001", q_.object.place,
          std::string(NameOf(q_.kind)) + " for " + std::string(NameOf(target_.profile)));
    CheckBodies();
    CheckMeshFiles();
    if (target_.profile == TargetProfile::kIsaac) CheckStage();
    if (target_.profile == TargetProfile::kGazebo) CheckModelFolder();
    const bool fills =
        target_.profile == TargetProfile::kMujoco || target_.profile == TargetProfile::kSapien;
    if (fills) CheckConvex();
  }

 private:
  // A body is what fixed joints hold together.
  void CheckBodies() {
    std::vector<bool> collides(q_.object.links.size(), false);
    std::vector<bool> weighs(q_.object.links.size(), false);
    for (std::size_t i = 0; i < q_.object.links.size(); ++i) {
      const ForeignLink& link = q_.object.links[i];
      const std::size_t body = q_.tree.body_of[i];
      const bool has = std::any_of(link.shapes.begin(), link.shapes.end(), [&](const auto& shape) {
        return Collides(shape) || q_.object.paired.contains(shape.name);
      });
      collides[body] = collides[body] || has;
      const bool whole = link.inertial && link.inertial->inertia_kg_m2.has_value();
      weighs[body] = weighs[body] || whole;
    }
    const bool computed = q_.kind == ValidatedKind::kMjcf;  // of geoms, where nothing is stated
    for (std::size_t i = 0; i < q_.object.links.size(); ++i) {
      if (q_.tree.body_of[i] != i || !q_.tree.moves[i]) continue;
      const ForeignLink& link = q_.object.links[i];
      if (!weighs[i] && !computed)
        faults_.Add("PRF002", link.place, "\"" + link.name + "\" has none");
      if (!collides[i]) faults_.Add("PRF003", link.place, "\"" + link.name + "\" has none");
    }
  }

  void CheckMeshFiles() {
    std::set<std::string> seen;
    for (const ForeignLink& link : q_.object.links) {
      for (const ForeignShape& shape : link.shapes) {
        const auto* file = std::get_if<ForeignMeshFile>(&shape.geometry);
        if (file == nullptr || target_.meshes.contains(EndingOf(file->name))) continue;
        // MuJoCo passes over what a URDF draws
        const bool drawn_only = target_.profile == TargetProfile::kMujoco &&
                                q_.kind == ValidatedKind::kUrdf && !Collides(shape);
        if (!drawn_only && seen.insert(file->name).second)
          faults_.Add("PRF004", shape.place, "\"" + file->name + '"');
      }
    }
  }

  void CheckStage() {
    const StageFacts& stage = q_.object.stage;
    if (stage.unit_m != 1)
      faults_.Add("PRF005", q_.object.place, "metersPerUnit " + Digits(stage.unit_m));
    if (q_.object.y_up) faults_.Add("PRF005", q_.object.place, "upAxis Y");
    if (stage.default_prim.empty()) faults_.Add("PRF006", q_.object.place, "no defaultPrim");
    if (!q_.object.joints.empty() && stage.articulations != 1)
      faults_.Add("PRF007", q_.object.place,
                  Measured(static_cast<double>(stage.articulations), "articulation roots"));
    for (const ForeignLink& link : q_.object.links) {
      if (link.name != "world" && !stage.labelled.contains(link.name))
        faults_.Add("PRF008", link.place, "\"" + link.name + "\" has none");
      CheckColliders(link);
      for (const ForeignShape& shape : link.shapes) {
        const bool mesh = std::holds_alternative<TriangleMesh>(shape.geometry);
        if (mesh && !stage.with_extent.contains(shape.name))
          faults_.Add("PRF010", shape.place, "no extent");
      }
    }
    const fs::path picture =
        q_.file.parent_path() / ".thumbs/256x256" / (q_.file.filename().string() + ".png");
    CheckPicture(picture);
  }

  // PhysX moves no body that collides as its triangles.
  void CheckColliders(const ForeignLink& link) {
    const auto number = q_.tree.link_of.find(link.name);
    if (number == q_.tree.link_of.end() || !q_.tree.moves[number->second]) return;
    for (const ForeignShape& shape : link.shapes) {
      const bool triangles = std::holds_alternative<TriangleMesh>(shape.geometry);
      if (triangles && Collides(shape) && !shape.as_hull)
        faults_.Add("PRF009", shape.place, "no physics:approximation, or \"none\"");
    }
  }

  void CheckPicture(const fs::path& picture) {
    std::error_code error;
    if (!fs::is_regular_file(picture, error))
      faults_.Add("PRF011", q_.object.place,
                  "no " + picture.lexically_relative(q_.file.parent_path()).string());
  }

  void CheckModelFolder() {
    const fs::path config = q_.file.parent_path() / "model.config";
    const std::string own = q_.file.filename().string();
    std::error_code error;
    std::string text;
    constexpr std::uint64_t kMostConfigBytes = 1ULL << 20U;
    if (fs::is_regular_file(config, error)) {
      try {
        text = ReadFile(config, kMostConfigBytes);
      } catch (const Error&) {
        text.clear();
      }
    }
    if (text.empty())
      faults_.Add("PRF012", q_.object.place, "no model.config beside it");
    else if (text.find(own) == std::string::npos)
      faults_.Add("PRF012", q_.object.place, "model.config does not name " + own);
    CheckPicture(q_.file.parent_path() / "thumbnails/1.png");
  }

  // MuJoCo and SAPIEN let a mesh collide as its convex hull.
  void CheckConvex() {
    std::set<std::string> seen;
    for (const ForeignLink& link : q_.object.links) {
      for (const ForeignShape& shape : link.shapes) {
        const auto* file = std::get_if<ForeignMeshFile>(&shape.geometry);
        if (file == nullptr || !Collides(shape) || !seen.insert(file->name).second) continue;
        const double filled = FilledShare(*file, shape);
        if (filled > AnyRule("PRF013").limit)
          faults_.Add("PRF013", shape.place, Measured(filled, "of its hull"));
      }
    }
  }

  // How much of a closed mesh's hull is not its own; 0 of others.
  double FilledShare(const ForeignMeshFile& file, const ForeignShape& shape) {
    const auto path = q_.files.Find({file.name, shape.place, false}, faults_);
    if (!path) return 0;
    try {
      std::vector<ForeignFileName> others;
      const TriangleMesh mesh = Welded(TrianglesOf(*path, q_.files.places().root, others));
      const MeshTopology topology = MeasureTopology(mesh);
      const bool closed = topology.boundary_edges + topology.non_manifold_edges == 0;
      if (!closed || !(topology.volume_m3 > 0)) return 0;
      const double hull = MeasureTopology(ConvexHull(mesh.vertices)).volume_m3;
      return hull > 0 ? 1 - topology.volume_m3 / hull : 0;
    } catch (const RawMeshFault&) {
      return 0;  // GEO005 tells
    } catch (const Error&) {
      return 0;
    }
  }

  const ProfileQuestion& q_;
  const Target& target_;
  FaultList& faults_;
};

}  // namespace

void CheckProfile(const ProfileQuestion& question, TargetProfile target, FaultList& faults) {
  if (target == TargetProfile::kNone) return;
  ProfileCheck(question, TargetOf(target), faults).Check();
}

}  // namespace doorforge::foreign
