// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/compose/shared_doors.h"

#include <algorithm>
#include <map>
#include <set>

#include "doorforge/core/error.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/program.h"
#include "doorforge/core/record_id.h"
#include "doorforge/mesh/work_budget.h"
#include "doorforge/schemas/mesh_file.h"
#include "doorforge/schemas/mesh_pool.h"

#include "prepared_part.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Shape = PreparedPart::State::Shape;

constexpr std::size_t kPairsInBatch = 1024;

bool Holds(const fs::path& file, const std::string& text) {
  std::error_code error;
  if (!fs::is_regular_file(fs::symlink_status(file, error))) return false;
  if (fs::file_size(file, error) != text.size() || error) return false;
  return ReadFile(file) == text;
}

// A file of the pool: a mesh, a shape's record, or bytes that are there already.
struct PoolFile {
  const TriangleMesh* mesh = nullptr;
  const Shape* shape = nullptr;
  const std::string* bytes = nullptr;
};

std::string TextOf(const PoolFile& file) {
  if (file.bytes != nullptr) return *file.bytes;
  if (file.mesh != nullptr) return ToObj(*file.mesh);
  return ShapeText({file.shape->mesh_sha256, file.shape->hull_sha256, file.shape->visual_files});
}

using PoolFiles = std::map<std::string, PoolFile>;

void AddVisual(const Shape& shape, PoolFiles& files) {
  if (!shape.visual_files) return;
  const auto add = [&](const std::string& path, const std::string& bytes) {
    files.try_emplace(fs::path(path).filename(), PoolFile{nullptr, nullptr, &bytes});
  };
  add(shape.visual_files->mesh.path, shape.texts.mesh);
  add(shape.visual_files->materials.path, shape.texts.materials);
  for (const VisualSurface& surface : shape.visual.surfaces) {
    if (const auto& texture = surface.material.texture) add(FileNameOf(*texture), texture->bytes);
  }
}

// Parts that share a mesh name it alike; each file is written by the first that has it.
PoolFiles FilesOf(std::span<const PreparedPart> parts) {
  PoolFiles files;
  for (const PreparedPart& part : parts) {
    for (const Shape& shape : part.state().shapes) {
      files.try_emplace(PooledFileName(shape.sha256, ".json"), PoolFile{nullptr, &shape, nullptr});
      files.try_emplace(PooledFileName(shape.mesh_sha256, ".obj"), PoolFile{&shape.mesh});
      for (std::size_t i = 0; i < shape.hulls.size(); ++i)
        files.try_emplace(PooledFileName(shape.hull_sha256[i], ".obj"), PoolFile{&shape.hulls[i]});
      AddVisual(shape, files);
    }
  }
  return files;
}

void RequireRealFolder(const fs::path& pool) {
  if (fs::is_symlink(fs::symlink_status(pool)))
    throw Error(ErrorCode::kInvalidArgument,
                pool.string() + ": is a link; a mesh pool is a real folder");
}

SharedDoorOutcome WriteDoorOf(const SharedDoorPlan& plan, const PartPair& pair,
                              const fs::path& doors, const fs::path& staging) {
  SharedDoorOutcome outcome;
  const PreparedPart& body = plan.parts[pair.body];
  const PreparedPart& handle = plan.parts[pair.handle];
  outcome.id = NameOfPair(body.id(), handle.id(), plan.config);
  try {
    const SharedDoor door = ComposeSharedDoor(body, handle, plan.config, pair.body_from_handle);
    outcome.id = door.id;
    const fs::path folder = OutputBelow(doors, door.id);
    if (fs::exists(fs::symlink_status(folder))) {
      outcome.kept =
          Holds(folder / "door.json", door.door_json) && Holds(folder / "model.urdf", door.urdf);
      if (outcome.kept) return outcome;
      if (plan.existing == Existing::kRefuse)
        throw Error(ErrorCode::kInvalidArgument,
                    folder.string() + ": holds another door; pass --overwrite to replace it");
      RequireKind(folder,
                  kDoorFolder);  // one that is no door does not cost the others of its batch
    }
    WriteStaged(staging / door.id / "door.json", door.door_json);
    WriteStaged(staging / door.id / "model.urdf", door.urdf);
  } catch (const Error& error) {
    outcome.problem = error.what();
  } catch (const std::exception&) {
    outcome.problem = CurrentProblem(outcome.id);
  }
  return outcome;
}

}  // namespace

void WriteMeshPool(std::span<const PreparedPart> parts, const fs::path& doors, int threads) {
  const fs::path pool = doors / fs::path(kMeshPoolPath).filename();
  RequireRealFolder(pool);
  const PoolFiles files = FilesOf(parts);
  std::vector<std::pair<std::string, PoolFile>> list(files.begin(), files.end());
  StagedBatch batch(pool, kDoorFolder);
  ParallelFor(list.size(), threads, [&](std::size_t i) {
    const auto& [name, file] = list[i];
    const std::string text = TextOf(file);
    if (!Holds(pool / name, text)) WriteStaged(batch.path() / name, text);
  });
  if (!Holds(pool / "pool.json", MeshPoolText()))
    WriteStaged(batch.path() / "pool.json", MeshPoolText());
  batch.Commit();
}

std::vector<SharedDoorOutcome> WriteSharedDoors(const SharedDoorPlan& plan, const fs::path& doors,
                                                const std::function<void(std::size_t)>& progress) {
  std::vector<SharedDoorOutcome> outcomes(plan.pairs.size());
  for (std::size_t first = 0; first < plan.pairs.size(); first += kPairsInBatch) {
    const std::size_t count = std::min(kPairsInBatch, plan.pairs.size() - first);
    const bool stopped = StopRequested() != 0;
    StagedBatch batch(doors, kDoorFolder);
    ParallelFor(stopped ? 0 : count, plan.threads, [&](std::size_t i) {
      outcomes[first + i] = WriteDoorOf(plan, plan.pairs[first + i], doors, batch.path());
    });
    if (!stopped) batch.Commit();
    for (std::size_t i = first; stopped && i < first + count; ++i) {
      const PartPair& pair = plan.pairs[i];
      outcomes[i] = {
          NameOfPair(plan.parts[pair.body].id(), plan.parts[pair.handle].id(), plan.config), false,
          "stopped before its turn; run the same command again"};
    }
    progress(count);
  }
  return outcomes;
}

}  // namespace doorforge
