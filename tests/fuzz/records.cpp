// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Readers of the room schemas: arrays, archives, tensors, models, and the records of parts, doors,
// data sets and episodes.

#include <algorithm>
#include <array>

#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/json_file.h"
#include "doorforge/schemas/dataset.h"
#include "doorforge/schemas/door_asset.h"
#include "doorforge/schemas/door_index.h"
#include "doorforge/schemas/episode_film.h"
#include "doorforge/schemas/glb.h"
#include "doorforge/schemas/mesh_file.h"
#include "doorforge/schemas/mjcf.h"
#include "doorforge/schemas/npy.h"
#include "doorforge/schemas/part.h"
#include "doorforge/schemas/safetensors.h"
#include "doorforge/schemas/scene.h"
#include "doorforge/schemas/sdf.h"
#include "doorforge/schemas/shard.h"
#include "doorforge/schemas/split.h"
#include "doorforge/schemas/tar.h"
#include "doorforge/schemas/urdf.h"
#include "doorforge/schemas/usda.h"
#include "doorforge/schemas/visual_mesh.h"

#include "datasets/shard_journal.h"
#include "fuzz_target.h"
#include "input_folder.h"

namespace doorforge::fuzz {
namespace {

using Json = nlohmann::ordered_json;

std::span<const std::byte> BytesOf(std::string_view input) {
  return std::as_bytes(std::span(input));
}

void ReadNpy(std::string_view input) {
  const NpyHeader header = ParseNpyHeader(BytesOf(input), "input");
  Tell({{"type", header.type}, {"shape", header.shape}, {"offset", header.data_offset}});
  Expect(header.data_offset <= input.size(), "an array's elements begin within its file");
  std::size_t count = 1;
  for (const std::size_t length : header.shape) count *= length;
  Expect(count <= input.size(), "an array has no more elements than bytes");
}

void TellTar(const TarListing& listing) {
  Json members = Json::array();
  for (const TarMember& member : listing.members)
    members.push_back({member.name, member.offset, member.size});
  Tell({{"members", members}, {"complete", listing.is_complete}, {"fault", listing.fault}});
}

void ReadTar(std::string_view input) {
  const TarListing listing = ListTar(BytesOf(input));
  if (Telling()) TellTar(listing);
  for (const TarMember& member : listing.members)
    Expect(member.offset <= input.size() && member.size <= input.size() - member.offset,
           "a member lies within its archive");
}

void TellTensors(const TensorFile& file) {
  Json tensors = Json::object();
  for (const auto& [name, tensor] : file.tensors)
    tensors[name] = {NameOf(tensor.type), tensor.shape, Crc32c(BytesOf(tensor.bytes))};
  Tell({{"tensors", tensors}, {"metadata", file.metadata}});
}

void ReadSafetensors(std::string_view input) {
  const TensorFile file = DecodeTensors(input, "input");
  if (Telling()) TellTensors(file);
  for (const auto& [name, tensor] : file.tensors)
    if (tensor.type != TensorType::kI64 && tensor.type != TensorType::kU8 &&
        tensor.type != TensorType::kF64)
      FloatsOf(tensor, tensor.shape, name);
  const std::string encoded = EncodeTensors(file);
  Expect(EncodeTensors(DecodeTensors(encoded, "encoded")) == encoded,
         "tensors are written as read");
}

void ReadCanonicalObj(std::string_view input) {
  const std::string text = ToObj(ParseObj(input, "input"));
  Expect(ToObj(ParseObj(text, "text")) == text, "a mesh is written as read");
}

// The mesh, and behind a line of its own its materials.
void ReadVisual(std::string_view input) {
  constexpr std::string_view kCut = "\n%%\n";
  const std::size_t cut = std::min(input.find(kCut), input.size());
  const std::string_view materials =
      cut < input.size() ? input.substr(cut + kCut.size()) : std::string_view();
  const VisualFiles files{{"a.obj", ""}, {"a.mtl", ""}, {}};
  ReadVisualMesh(files, [&](const RecordedFile& file) {
    return std::string(file.path == "a.obj" ? input.substr(0, cut) : materials);
  });
}

void CheckModel(const UrdfModel& model, std::span<const UrdfFault> faults) {
  const auto unusable = [](const UrdfFault& f) { return f.kind == UrdfFaultKind::kUnusable; };
  if (std::any_of(faults.begin(), faults.end(), unusable)) return;
  std::string text;
  try {
    text = ToUrdf(model);
    RootLinkOf(model);
  } catch (const Error&) {
    return;
  }
  Expect(ToUrdf(ParseUrdf(text, "text")) == text,
         "a model is written to a URDF that is read alike");
}

void ReadUrdfText(std::string_view input) {
  std::vector<UrdfFault> faults;
  const UrdfModel model = ParseUrdf(std::string(input), "input", faults);
  CheckModel(model, faults);
}

void ReadMjcfText(std::string_view input) {
  std::vector<UrdfFault> faults;
  ParseMjcf(std::string(input), "input", faults);
}

void ReadSdfText(std::string_view input) {
  std::vector<UrdfFault> faults;
  ParseSdf(std::string(input), "input", faults);
}

void ReadUsdaModel(std::string_view input) {
  std::vector<UrdfFault> faults;
  ParseUsdaModel(std::string(input), "input", faults);
}

void ReadGlbModel(std::string_view input) { ParseGlb(input, "input"); }

/// Checks that what is read of a record is written to what is read alike.
template <class Read, class Write>
void CheckRecord(std::string_view input, Read&& read, Write&& write) {
  const Json first = write(read(ParseJson(input, "input"), "input"));
  Expect(write(read(ParseJson(JsonText(first), "text"), "text")) == first,
         "a record is written as read");
}

void ReadDatasetRecord(std::string_view input) {
  CheckRecord(input, DatasetFromJson, DatasetToJson);
}

void ReadProvenance(std::string_view input) {
  CheckRecord(input, ProvenanceFromJson, ProvenanceToJson);
}

void ReadScene(std::string_view input) { CheckRecord(input, SceneFromJson, SceneToJson); }

void ReadFilm(std::string_view input) { CheckRecord(input, FilmFromJson, FilmToJson); }

void ReadIndexRecord(std::string_view input) {
  CheckRecord(input, ShardIndexFromJson, ShardIndexToJson);
}

void ReadIndexFile(std::string_view input) { ReadShardIndex(InputFile("input.index.json", input)); }

void ReadDoorIndexRecord(std::string_view input) {
  const std::string text = DoorIndex::FromJson(ParseJson(input, "input"), "input").ToText();
  Expect(DoorIndex::FromJson(ParseJson(text, "text"), "text").ToText() == text,
         "an index of doors is written as read");
}

void ReadSplitFile(std::string_view input) { ReadSplit(InputFile("input.yaml", input)); }

// A journal of the lines of the input, and once more with the checksum that each line needs.
void ReadJournal(std::string_view input) {
  internal::JournalEntries(input);
  const ShardHeader header{0, "open", "train", std::string(64, '0')};
  std::string sealed = internal::JournalHeaderLine(header);
  for (std::size_t at = 0; at < input.size();) {
    const std::size_t end = std::min(input.find('\n', at), input.size());
    try {
      sealed += internal::JournalLine(ParseJson(input.substr(at, end - at), "line"));
    } catch (const Error&) {
      sealed += std::string(input.substr(at, end - at)) + "\n";
    }
    at = end + 1;
  }
  const auto folder = InputFile(".shard-000000.journal", sealed).parent_path();
  InputFile(".shard-000000.tar.partial", std::string(4096, '\0'));
  internal::RecoverJournal(folder, header);
}

TriangleMesh Tetrahedron(const std::string&, const std::string&) {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

VisualMesh NoVisual(const VisualFiles&) { return {}; }

void ReadDoorRecord(std::string_view input) {
  const DoorAsset door =
      ReadDoor(InputFile("door.json", input).parent_path(), Tetrahedron, NoVisual);
  ContentHash(door);
  DoorFromLinks(door, door.hinge.upper_rad, door.handle_joint.upper_rad);
}

void ReadDoorFilesRecord(std::string_view input) {
  ReadDoorFiles(InputFile("door.json", input).parent_path());
}

void ReadPartRecord(std::string_view input) {
  ContentHash(ReadPart(InputFile("part.json", input).parent_path(), Tetrahedron, NoVisual));
}

constexpr std::array kTargets{
    Target{"npy", Shape::kBytes, ReadNpy},
    Target{"tar", Shape::kTar, ReadTar},
    Target{"safetensors", Shape::kTensors, ReadSafetensors},
    Target{"canonical_obj", Shape::kBytes, ReadCanonicalObj},
    Target{"visual_mesh", Shape::kBytes, ReadVisual},
    Target{"urdf", Shape::kBytes, ReadUrdfText},
    Target{"mjcf", Shape::kBytes, ReadMjcfText},
    Target{"sdf", Shape::kBytes, ReadSdfText},
    Target{"usda_model", Shape::kBytes, ReadUsdaModel},
    Target{"glb_model", Shape::kBytes, ReadGlbModel},
    Target{"dataset", Shape::kJson, ReadDatasetRecord},
    Target{"provenance", Shape::kJson, ReadProvenance},
    Target{"scene", Shape::kJson, ReadScene},
    Target{"film", Shape::kJson, ReadFilm},
    Target{"shard_index", Shape::kJson, ReadIndexRecord},
    Target{"shard_index_file", Shape::kBytes, ReadIndexFile},
    Target{"door_index", Shape::kJson, ReadDoorIndexRecord},
    Target{"split", Shape::kBytes, ReadSplitFile},
    Target{"journal", Shape::kBytes, ReadJournal},
    Target{"door", Shape::kJson, ReadDoorRecord},
    Target{"door_files", Shape::kJson, ReadDoorFilesRecord},
    Target{"part", Shape::kJson, ReadPartRecord},
};

}  // namespace

std::span<const Target> Targets() { return kTargets; }

}  // namespace doorforge::fuzz
