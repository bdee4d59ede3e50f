// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// The meshes that the child reads with assimp, and the pictures that are read with libpng. Those
// libraries are Debian's, without sanitizers in them.

#include <array>

#include "doorforge/core/error.h"
#include "doorforge/sensor/picture.h"

#include "files/mesh_message.h"
#include "files/mesh_readers.h"
#include "fuzz_target.h"
#include "input_folder.h"

namespace doorforge::fuzz {
namespace {

void ReadMesh(const char* name, std::string_view input) {
  MeshImportLimits limits;
  limits.max_triangles = 20'000;
  const std::string message = Encoded(ReadWithAssimp(InputFile(name, input), limits));
  Expect(DecodedMesh(message).has_value(), "the parent takes what the child has read");
}

void ReadDae(std::string_view input) { ReadMesh("input.dae", input); }
void ReadGlb(std::string_view input) { ReadMesh("input.glb", input); }
void ReadOff(std::string_view input) { ReadMesh("input.off", input); }

void ReadDepthPng(std::string_view input) { DecodeDepthPng(input, 0.001, "input"); }
void ReadMaskPng(std::string_view input) { DecodeMaskPng(input, "input"); }

constexpr std::array kTargets{
    Target{"dae", Shape::kBytes, ReadDae},        Target{"glb", Shape::kGlb, ReadGlb},
    Target{"off", Shape::kBytes, ReadOff},        Target{"depth_png", Shape::kPng, ReadDepthPng},
    Target{"mask_png", Shape::kPng, ReadMaskPng},
};

}  // namespace

std::span<const Target> Targets() { return kTargets; }

}  // namespace doorforge::fuzz
