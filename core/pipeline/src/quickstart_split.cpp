// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/pipeline/quickstart_split.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/rng.h"
#include "doorforge/core/shape_descriptor.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kTrainPairs = 24;
constexpr std::size_t kTestPairs = 5;
constexpr std::size_t kHoldOutEvery = 3;

struct PartRow {
  std::string id;
  std::string category;
  std::string mechanism;
  std::string source;
  fs::path folder;
  ShapeDescriptor shape;
  bool is_body = false;
  bool held_out = false;
};

std::vector<PartRow> ReadParts(const fs::path& parts_folder) {
  std::vector<PartRow> parts;
  for (const auto& entry : fs::recursive_directory_iterator(parts_folder)) {
    if (entry.path().filename() != "part.json") continue;
    const std::string path = entry.path().string();
    const auto json = ReadJsonFile(path);
    parts.push_back(
        {ValueOf<std::string>(json, "id", path), ValueOf<std::string>(json, "category", path),
         ValueOf<std::string>(json, "mechanism", path),
         ValueOf<std::string>(json, "source_sha256", path), entry.path().parent_path(),
         ShapeOfRecord(json, path), ValueOf<std::string>(json, "role", path) == "body"});
  }
  std::sort(parts.begin(), parts.end(),
            [](const PartRow& a, const PartRow& b) { return a.id < b.id; });
  return parts;
}

bool OfOneSource(const PartRow& a, const PartRow& b) {
  return a.is_body == b.is_body && (a.source == b.source || SameShape(a.shape, b.shape));
}

// the first part of a source decides for all that were made from it, and for its copies
void HoldOut(std::vector<PartRow>& parts) {
  std::map<std::tuple<std::string, bool, std::string>, std::size_t> count;
  for (auto part = parts.begin(); part != parts.end(); ++part) {
    const auto known = std::find_if(
        parts.begin(), part, [&](const PartRow& earlier) { return OfOneSource(earlier, *part); });
    if (known != part) {
      part->held_out = known->held_out;
      continue;
    }
    const std::size_t index = count[{part->category, part->is_body, part->mechanism}]++;
    part->held_out = index % kHoldOutEvery == kHoldOutEvery - 1;
  }
}

bool ExpertOpens(const PartRow& handle) {
  const bool category = handle.category == "interior" || handle.category == "storagefurniture";
  return category &&
         (handle.mechanism == "lever" || handle.mechanism == "round" || handle.mechanism == "none");
}

using PairsByKind = std::map<std::tuple<std::string, std::string, bool>, std::vector<DoorPair>>;

PairsByKind AllPairs(const std::vector<PartRow>& parts) {
  PairsByKind pairs;
  for (const PartRow& handle : parts) {
    if (handle.is_body || !ExpertOpens(handle)) continue;
    for (const PartRow& body : parts) {
      if (!body.is_body || body.category != handle.category || body.held_out != handle.held_out)
        continue;
      pairs[{handle.category, handle.mechanism, handle.held_out}].push_back(
          {body.id, handle.id, body.folder, handle.folder, handle.held_out ? "test" : "train"});
    }
  }
  return pairs;
}

void Draw(std::vector<DoorPair>& pairs, std::size_t count, Rng rng) {
  for (std::size_t i = pairs.size(); i > 1; --i)
    std::swap(pairs[i - 1], pairs[rng.Index(static_cast<std::uint32_t>(i))]);
  pairs.resize(std::min(count, pairs.size()));
}

}  // namespace

std::vector<DoorPair> SplitIntoDoors(const fs::path& parts_folder, std::uint64_t seed) {
  std::vector<PartRow> parts = ReadParts(parts_folder);
  HoldOut(parts);
  std::vector<DoorPair> chosen;
  std::set<std::string> subsets;
  for (auto& [kind, pairs] : AllPairs(parts)) {
    const auto& [category, mechanism, held_out] = kind;
    Draw(pairs, held_out ? kTestPairs : kTrainPairs,
         Rng(seed, "quickstart/" + category + "/" + mechanism));
    for (DoorPair& pair : pairs) {
      subsets.insert(pair.subset);
      chosen.push_back(std::move(pair));
    }
  }
  if (subsets.size() < 2)
    throw Error(ErrorCode::kMissing, parts_folder.string() +
                                         ": too few bodies and handles to train on some and hold "
                                         "out others; at least three of each kind are needed");
  std::sort(chosen.begin(), chosen.end(), [](const DoorPair& a, const DoorPair& b) {
    return std::tie(a.subset, a.body_id, a.handle_id) < std::tie(b.subset, b.body_id, b.handle_id);
  });
  return chosen;
}

}  // namespace doorforge
