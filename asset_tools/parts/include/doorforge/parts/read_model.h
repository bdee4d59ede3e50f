// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "doorforge/core/named_enum.h"
#include "doorforge/schemas/urdf.h"

namespace doorforge {

/// What an object of links and joints is written in.
enum class ModelFormat { kUrdf, kMjcf, kSdf, kUsda, kGlb };
inline constexpr NamedValue<ModelFormat> kModelFormats[] = {{ModelFormat::kUrdf, "urdf"},
                                                            {ModelFormat::kMjcf, "mjcf"},
                                                            {ModelFormat::kSdf, "sdf"},
                                                            {ModelFormat::kUsda, "usda"},
                                                            {ModelFormat::kGlb, "glb"}};
constexpr std::span<const NamedValue<ModelFormat>> ValuesOf(ModelFormat) { return kModelFormats; }

/// Reads a file as ReadUrdf(), ReadMjcf(), ReadSdf(), ReadUsda() and ReadGlb() do, with their
/// faults and errors, in the program doorforge-read-model: who made the file has the rights of a
/// process that can read that file and nothing else, 2 GiB of memory and 60 s of processor time.
/// What comes back has been looked at: joints name links, and triangles vertices.
UrdfModel ReadModelApart(const std::filesystem::path& file, ModelFormat format,
                         std::vector<UrdfFault>& faults);

/// A URDF, read likewise; throws where anything is kUnusable, as ReadUrdf() does.
UrdfModel ReadUrdfApart(const std::filesystem::path& file);

}  // namespace doorforge
