// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "doorforge/foreign/articulated_object.h"
#include "doorforge/foreign/target_profile.h"
#include "doorforge/validate/validate_door.h"

#include "check/mesh_measures.h"
#include "check/object_tree.h"
#include "faults/fault_list.h"

namespace doorforge::foreign {

/// A file with what it was read into.
struct ProfileQuestion {
  std::filesystem::path file;
  ValidatedKind kind;
  const ArticulatedObject& object;
  const ObjectTree& tree;
  const MeshFiles& files;
};

/// PRF: what the target demands beyond the format.
void CheckProfile(const ProfileQuestion& question, TargetProfile target, FaultList& faults);

}  // namespace doorforge::foreign
