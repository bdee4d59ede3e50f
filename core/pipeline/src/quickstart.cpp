// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/pipeline/quickstart.h"

#include <optional>
#include <string>
#include <vector>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/file_system.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/program.h"
#include "doorforge/core/progress.h"
#include "doorforge/core/record_id.h"
#include "doorforge/pipeline/pipeline_graph.h"
#include "doorforge/pipeline/pipeline_run.h"
#include "doorforge/pipeline/quickstart_split.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

void ComposeDoors(const std::vector<DoorPair>& pairs, const fs::path& out, int threads) {
  const std::string program = (ProgramFolder() / "doorforge-assets").string();
  Progress progress("compose", pairs.size());
  ParallelFor(pairs.size(), threads, [&](std::size_t i) {
    const DoorPair& pair = pairs[i];
    const fs::path door = OutputBelow(out / pair.subset, pair.body_id + "__" + pair.handle_id);
    if (!fs::exists(door / "door.json")) {
      const int code =
          RunChild({program, "compose", "--body", pair.body_folder.string(), "--handle",
                    pair.handle_folder.string(), "--out", door.string(), "--quiet"});
      if (code != 0)
        throw Error(ErrorCode::kIncomplete,
                    door.string() + ": compose ended with exit code " + std::to_string(code));
    }
    progress.Advance();
  });
}

// The record of the first step, which is there as soon as anything is.
constexpr FolderKind kQuickstartFolder{"a quickstart", "pipeline/parts.json",
                                       "doorforge.pipeline_step"};

bool IsEmptyFolder(const fs::path& folder) {
  return fs::is_directory(fs::symlink_status(folder)) && fs::is_empty(folder);
}

// Not while another process makes it.
void RemoveQuickstart(const fs::path& out) {
  RequireKind(out, kQuickstartFolder);
  const auto lock = FileLock::Try(SystemFiles(), out / "pipeline" / "lock");
  Require(lock.has_value(), ErrorCode::kInvalidArgument,
          out.string() +
              ": another process runs a pipeline there; wait until it has ended, or choose "
              "another folder");
  fs::remove_all(out);
}

void PrepareFolder(const QuickstartRequest& request) {
  const fs::path& out = request.out;
  if (request.overwrite && fs::exists(fs::symlink_status(out)) && !IsEmptyFolder(out))
    RemoveQuickstart(out);
  if (!request.resume && fs::exists(out) && !fs::is_empty(out))
    throw Error(ErrorCode::kInvalidArgument,
                out.string() + ": already exists; pass --resume to go on there, or --overwrite");
  SystemFiles().CreateFolder(out);
}

// real objects in place of the catalogue
void ImportParts(Pipeline& pipeline, const fs::path& assets) {
  PipelineStep& parts = pipeline.steps.at(0);
  parts.does = "Parts from real objects";
  parts.command = {"import", assets.string(), "--only",    "interior,storagefurniture",
                   "--out",  "{parts}",       "--threads", "{threads}"};
  parts.ok_exit_codes = {0, 1};  // some objects were refused, the others are done
}

}  // namespace

void ComposeQuickstartDoors(const fs::path& parts, const fs::path& out, std::uint64_t seed,
                            int threads) {
  ComposeDoors(SplitIntoDoors(parts, seed), out, threads);
}

int RunQuickstart(const QuickstartRequest& request) {
  PrepareFolder(request);
  Pipeline pipeline = ReadPipeline("quickstart", {"seed=" + std::to_string(request.seed),
                                                  "episodes=" + std::to_string(request.episodes),
                                                  "epochs=" + std::to_string(request.epochs)});
  if (!request.assets.empty()) ImportParts(pipeline, request.assets);
  return RunPipeline(pipeline, {.out = request.out,
                                .threads = request.threads,
                                .again = "run again with --resume",
                                .progress = request.progress,
                                .result = request.result});
}

}  // namespace doorforge
