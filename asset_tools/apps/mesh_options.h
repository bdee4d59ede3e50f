// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "doorforge/importers/foreign_object.h"

namespace doorforge {

/// A config whose every field says "not set", for flags and AssignGiven().
LooseMeshConfig UnsetMeshOptions();

/// Flags of loose meshes: "--unit" and so on, or "--handle-unit" with the prefix "handle-". All
/// three add to fields that UnsetMeshOptions() left empty.
void AddMeshOptions(CLI::App& app, const std::string& prefix, LooseMeshConfig& mesh);
void AddHandleMeshOptions(CLI::App& app, const std::string& prefix, LooseMeshConfig& mesh);
void AddBodyMeshOptions(CLI::App& app, const std::string& prefix, LooseMeshConfig& mesh);

}  // namespace doorforge
