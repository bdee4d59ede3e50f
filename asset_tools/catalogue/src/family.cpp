// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "family.h"

#include <optional>

#include "doorforge/core/closed_mesh.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/mesh_transform.h"
#include "doorforge/core/nearest_name.h"
#include "doorforge/mesh/convex_parts.h"

#include "finish.h"

namespace doorforge::internal {

const Family& FamilyNamed(std::string_view name, const std::string& path) {
  std::vector<std::string> known;
  for (const auto& source : kFamilySources) {
    for (const Family& family : source()) {
      if (family.name == name) return family;
      known.emplace_back(family.name);
    }
  }
  throw Error(ErrorCode::kInvalidConfig, path + ".family: unknown family \"" + std::string(name) +
                                             "\"; did you mean \"" + NearestName(name, known) +
                                             "\"?");
}

PartPiece MakePiece(const std::string& name, const Solid& solid, const std::string& finish_name,
                    const std::string& path) {
  const Finish& finish = FinishNamed(finish_name, path);
  PartPiece piece;
  piece.name = name;
  // as the canonical files hold them, so that a part read back equals the part in memory
  piece.mesh = RoundedToFloat(solid.mesh);
  // a hull whose corners were rounded may have a dent of that size: it is found again from them
  for (const TriangleMesh& hull : solid.hulls)
    piece.hulls.push_back(ConvexHull(RoundedToFloat(hull).vertices));
  const std::optional<ClosedMesh> closed = ClosedMesh::From(piece.mesh);
  Require(closed.has_value(), ErrorCode::kInvalidArgument, path + ": the mesh is not closed");
  piece.color_rgba << finish.color_rgb, 1.0;
  piece.mass = MassPropertiesOf(*closed, finish.density_kg_m3);
  return piece;
}

}  // namespace doorforge::internal
