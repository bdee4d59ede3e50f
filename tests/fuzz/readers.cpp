// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Readers that need the room core alone: JSON, YAML, settings, what torch.save() writes, messages
// of policies, and the meshes that are read in the child without assimp.

#include <array>

#include "doorforge/core/config_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"

#include "files/file_frame.h"
#include "files/mesh_message.h"
#include "files/mesh_readers.h"
#include "fuzz_target.h"
#include "input_folder.h"
#include "message.h"
#include "torch_archive/tensor_pickle.h"
#include "torch_archive/torch_numbers.h"
#include "torch_archive/zip_members.h"

namespace doorforge::fuzz {
namespace {

void ReadJson(std::string_view input) {
  const auto json = ParseJson(input, "input");
  if (Telling()) Tell(json);
  const std::string text = JsonText(json);
  Expect(JsonText(ParseJson(text, "text")) == text,
         "JSON that was read is written to what is read");
}

void ReadYaml(std::string_view input) { ParseYaml(input, "input"); }

void ReadSettings(std::string_view input) {
  std::vector<std::string> settings;
  for (std::size_t at = 0; at <= input.size() && settings.size() < 16;) {
    const std::size_t end = std::min(input.find('\n', at), input.size());
    settings.emplace_back(input.substr(at, end - at));
    at = end + 1;
  }
  ParseSettings(settings);
}

void ReadTorch(std::string_view input) {
  constexpr std::size_t kMost = 1000;
  Expect(internal::ParseTorchNumbers(input, "input", kMost).size() <= kMost,
         "no more numbers are given than are asked for");
}

void ReadPickle(std::string_view input) {
  const internal::PickledTensor tensor = internal::ParseTensorPickle(input, "input");
  Expect(tensor.size.size() == tensor.stride.size(), "a tensor has a stride for each axis");
}

void ReadZip(std::string_view input) {
  for (const auto& [name, bytes] : internal::ZipMembers(input, "input"))
    Expect(bytes.empty() || (bytes.data() >= input.data() &&
                             bytes.data() + bytes.size() <= input.data() + input.size()),
           "a member lies within its archive");
}

void ReadMessage(std::string_view input) {
  const internal::Value value = internal::Unpacked(input);
  if (const auto* array = value.As<internal::NumpyArray>()) array->Numbers("input");
  const std::string packed = internal::Packed(value);
  Expect(internal::Packed(internal::Unpacked(packed)) == packed,
         "what is packed is unpacked alike");
}

void CheckMesh(const ImportedMesh& mesh) {
  const std::string message = Encoded(mesh);
  const auto decoded = DecodedMesh(message);
  Expect(decoded && Encoded(*decoded) == message, "the parent takes what the child has read");
}

MeshImportLimits Limits() {
  MeshImportLimits limits;
  limits.max_triangles = 20'000;
  return limits;
}

// An OBJ and, behind a line of its own, the materials that it may name.
void ReadObjAndMaterials(std::string_view input) {
  constexpr std::string_view kCut = "\n%%\n";
  const std::size_t cut = std::min(input.find(kCut), input.size());
  if (cut < input.size()) InputFile("input.mtl", input.substr(cut + kCut.size()));
  CheckMesh(ReadObjFile(InputFile("input.obj", input.substr(0, cut)), Limits()));
}

void ReadStl(std::string_view input) {
  CheckMesh(ReadStlFile(InputFile("input.stl", input), Limits()));
}

void ReadPly(std::string_view input) {
  CheckMesh(ReadPlyFile(InputFile("input.ply", input), Limits()));
}

void ReadMeshMessage(std::string_view input) {
  if (const auto mesh = DecodedMesh(input)) CheckMesh(*mesh);
}

void ReadColladaFrame(std::string_view input) { FrameOfCollada(std::string(input)); }

void ReadGltfRotations(std::string_view input) {
  const bool binary = input.starts_with("glTF");
  RefuseGltfRotations(InputFile(binary ? "input.glb" : "input.gltf", input), Limits());
}

constexpr std::array kTargets{
    Target{"json", Shape::kJson, ReadJson},
    Target{"yaml", Shape::kBytes, ReadYaml},
    Target{"settings", Shape::kBytes, ReadSettings},
    Target{"torch", Shape::kBytes, ReadTorch},
    Target{"pickle", Shape::kBytes, ReadPickle},
    Target{"zip", Shape::kBytes, ReadZip},
    Target{"message", Shape::kBytes, ReadMessage},
    Target{"obj", Shape::kBytes, ReadObjAndMaterials},
    Target{"stl", Shape::kBytes, ReadStl},
    Target{"ply", Shape::kBytes, ReadPly},
    Target{"mesh_message", Shape::kBytes, ReadMeshMessage},
    Target{"collada_frame", Shape::kBytes, ReadColladaFrame},
    Target{"gltf_rotations", Shape::kGlb, ReadGltfRotations},
};

}  // namespace

std::span<const Target> Targets() { return kTargets; }

}  // namespace doorforge::fuzz
