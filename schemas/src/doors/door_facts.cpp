// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/door_facts.h"

#include "doorforge/schemas/door_asset.h"

namespace doorforge {

DoorFacts FactsOf(const DoorAsset& door) {
  DoorFacts facts{door.category, door.mechanism, door.hinge_side, {}};
  facts.relatches = door.latch.type == LatchType::kEffort && door.latch.relatch;
  for (const DoorGeometry& geometry : door.links[kHandleLink].geometry) {
    for (const Eigen::Vector3d& vertex : geometry.mesh.vertices) facts.handle_box.extend(vertex);
  }
  return facts;
}

}  // namespace doorforge
