// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/dataset/merge_dataset.h"

#include <fstream>
#include <vector>

#include <sys/stat.h>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/free_space.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/json_file.h"

#include "dataset_records.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

// A dataset's texts that are known before its first episode.
struct Beginning {
  std::string config;
  std::string provenance;
};

Beginning ReadBeginning(const fs::path& folder) {
  return {ReadFile(folder / "config.yaml"), ReadFile(folder / "provenance.json")};
}

void RequireSame(const Beginning& a, const fs::path& path_a, const Beginning& b,
                 const fs::path& path_b) {
  if (a.config == b.config && a.provenance == b.provenance) return;
  throw Error(ErrorCode::kInvalidArgument,
              path_a.string() + " and " + path_b.string() + ": tasks of different collections (" +
                  (a.config != b.config ? "config.yaml" : "provenance.json") +
                  " differs: settings, doors or build); collect one of them anew");
}

bool IsIndexed(const fs::path& folder, const ExpectedShard& shard) {
  return fs::exists(folder / (shard.Name() + ".index.json"));
}

fs::path CopyPath(const fs::path& tar) {
  return tar.parent_path() / (std::string(1, '.') + tar.filename().string() + ".copy");
}

// Files of two file systems are copied, those of one get a second name.
bool OnOneFileSystem(const fs::path& a, const fs::path& b) {
  struct stat first {};
  struct stat second {};
  return ::stat(a.c_str(), &first) == 0 && ::stat(b.c_str(), &second) == 0 &&
         first.st_dev == second.st_dev;
}

class Merge {
 public:
  explicit Merge(const MergeRequest& request) : request_(request), files_(*request.files) {}

  MergeSummary Run() {
    Begin();
    const DatasetProvenance provenance = ReadProvenance(request_.folder);
    const std::vector<ExpectedShard> shards = ExpectedShards(provenance);
    summary_.shards = shards.size();
    RequireSpaceForCopies(shards);
    for (const ExpectedShard& shard : shards) {
      for (const fs::path& part : request_.parts) {
        if (IsIndexed(part, shard)) Bring(part, shard);
      }
    }
    FinishDataset(files_, request_.folder);
    return summary_;
  }

 private:
  // All parts, and the folder if it was begun, are of one collection.
  void Begin() {
    const bool is_begun = fs::exists(request_.folder / "config.yaml");
    if (!is_begun && request_.parts.empty())
      throw Error(ErrorCode::kMissing,
                  request_.folder.string() + ": holds no dataset (no config.yaml)");
    const fs::path& records = request_.parts.empty() ? request_.folder : request_.parts.front();
    const Beginning beginning = ReadBeginning(records);
    for (const fs::path& part : request_.parts)
      RequireSame(beginning, records, ReadBeginning(part), part);
    RequirePlan(records);
    BeginDataset(files_, request_.folder, beginning.config, ReadProvenance(records));
    RemoveStaleFiles(files_, request_.folder);
  }

  static void RequirePlan(const fs::path& folder) {
    if (!ReadProvenance(folder).planned.empty()) return;
    throw Error(ErrorCode::kInvalidArgument,
                folder.string() +
                    ": provenance.json names no plan; it was written by an earlier "
                    "build, whose datasets are not merged");
  }

  void RequireSpaceForCopies(const std::vector<ExpectedShard>& shards) const {
    double needed = 0;
    for (const fs::path& part : request_.parts) {
      if (OnOneFileSystem(part, request_.folder)) continue;
      for (const ExpectedShard& shard : shards) {
        if (!IsIndexed(part, shard) || IsIndexed(request_.folder, shard)) continue;
        needed +=
            static_cast<double>(ReadShardIndex(part / (shard.Name() + ".index.json")).tar_bytes);
      }
    }
    RequireSpace(request_.folder, needed, "make room, or choose another folder");
  }

  // The tar first: without its index a shard counts for nothing.
  void Bring(const fs::path& part, const ExpectedShard& shard) {
    const fs::path from = part / (shard.Name() + ".index.json");
    const fs::path to = request_.folder / (shard.Name() + ".index.json");
    const std::string text = ReadFile(from);
    if (fs::exists(to)) {
      if (ReadFile(to) == text) return;
      throw Error(ErrorCode::kInvalidArgument,
                  from.string() + " and " + to.string() +
                      ": the same shard with different content; verify both, and delete the index "
                      "of the wrong one");
    }
    const ShardIndex index = ReadShardIndex(from);
    BringTar(from.parent_path() / index.tar, to.parent_path() / index.tar, index);
    CommitFile(files_, to, text, Existing::kRefuse);
  }

  void BringTar(const fs::path& from, const fs::path& to, const ShardIndex& index) {
    if (!fs::exists(from) || fs::file_size(from) != index.tar_bytes)
      throw Error(ErrorCode::kFormat, from.string() + ": missing, or not of the " +
                                          std::to_string(index.tar_bytes) +
                                          " bytes that its index says; delete the index and run "
                                          "the shard's task again");
    files_.CreateFolder(to.parent_path());
    RemoveShardLeftovers(files_, to.parent_path(), index.header.number);
    // what a killed merge left
    if (fs::exists(CopyPath(to))) files_.Remove(CopyPath(to));
    files_.Remove(to);
    if (files_.HardLink(from, to)) {
      files_.SyncFolder(to.parent_path());
      ++summary_.linked;
      return;
    }
    Copy(from, to, index);
    ++summary_.copied;
  }

  void Copy(const fs::path& from, const fs::path& to, const ShardIndex& index) {
    const fs::path partial = CopyPath(to);
    const int file = files_.Create(partial);
    try {
      CopyBytes(from, file, partial, index);
      files_.Sync(file, partial);
    } catch (...) {
      files_.Close(file);
      throw;
    }
    files_.Close(file);
    files_.Rename(partial, to);
    files_.SyncFolder(to.parent_path());
  }

  void CopyBytes(const fs::path& from, int file, const fs::path& partial, const ShardIndex& index) {
    std::ifstream source(from, std::ios::binary);
    std::vector<char> chunk(1 << 20);
    Sha256 hash;
    while (source.read(chunk.data(), static_cast<std::streamsize>(chunk.size())) ||
           source.gcount() > 0) {
      const std::string_view bytes(chunk.data(), static_cast<std::size_t>(source.gcount()));
      hash.Update(bytes);
      WriteAll(files_, file, bytes, partial);
    }
    if (hash.HexDigest() != index.tar_sha256)
      throw Error(ErrorCode::kFormat, from.string() +
                                          ": its SHA-256 is not the one in its index; delete the "
                                          "index and run the shard's task again");
  }

  const MergeRequest& request_;
  FileSystem& files_;
  MergeSummary summary_;
};

}  // namespace

MergeSummary MergeDataset(const MergeRequest& request) { return Merge(request).Run(); }

}  // namespace doorforge
