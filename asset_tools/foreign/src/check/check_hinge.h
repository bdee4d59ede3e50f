// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "check/checks.h"

namespace doorforge::foreign {

struct HingeQuestion {
  const ArticulatedObject& object;
  const ObjectTree& tree;
  const std::vector<LinkBounds>& bounds;
  const MeshFiles& files;
  std::string hinge;   ///< Joint; empty: it is looked for.
  std::string handle;  ///< Link; empty: it is looked for.
};

/// MEC002, MEC003, MEC009, HND003 and HND009 where hinge and handle are known; measured by
/// the boxes about the shapes. What was taken for them, or why none was, becomes a note.
void CheckHinge(const HingeQuestion& question, FaultList& faults, std::vector<std::string>& notes);

}  // namespace doorforge::foreign
