// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/door/import_objects.h"

#include <algorithm>
#include <array>
#include <map>
#include <mutex>
#include <optional>

#include "doorforge/core/config_io.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/program.h"
#include "doorforge/core/progress.h"
#include "doorforge/door/import_unidoormanip.h"

#include "placed_mesh.h"
#include "subtask.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// A part to make, and what came of it.
struct PartJob {
  std::string id;
  std::size_t object;  // the first one that has it; its files are read
  PartRole role;
  bool present = false;  // made by an earlier run
  bool written = false;
  MadePart made;
  std::string problem;
  ImportOutcome outcome = ImportOutcome::kImported;
  double box_deviation_m = 0;
  RefinedGrasp grasp;
  bool done = false;
};

class Import {
 public:
  Import(const std::vector<fs::path>& folders, fs::path out, const ImportConfig& config,
         Existing existing)
      : folders_(folders), out_(std::move(out)), config_(config), existing_(existing) {
    settings_ = ToJson(config_.make);
    settings_.erase("threads");
    report_.objects.resize(folders.size());
    objects_.resize(folders.size());
    jobs_of_.resize(folders.size());
  }

  ImportReport Run() {
    for (std::size_t i = 0; i < folders_.size(); ++i) Plan(i);
    MakeAll();
    Summarize();
    WriteRecord();
    return std::move(report_);
  }

 private:
  // reads the small files of one object and finds out which parts it needs
  void Plan(std::size_t i) {
    ImportedObject& entry = report_.objects[i];
    entry.folder = folders_[i];
    entry.name = internal::ObjectNameOf(folders_[i]);
    try {
      objects_[i] = ReadUniDoorManip(folders_[i], config_.category);
      const UniDoorManipObject& object = *objects_[i];
      entry.name = object.name;
      entry.category = NameOf(object.category);
      entry.mechanism = NameOf(object.mechanism);
      jobs_of_[i] = {
          JobFor(i, PartRole::kBody, "udm-" + object.body_name, BodySourceHash(object)),
          JobFor(i, PartRole::kHandle, "udm-" + object.handle_name, HandleSourceHash(object))};
      entry.body_id = jobs_[jobs_of_[i]->at(0)].id;
      entry.handle_id = jobs_[jobs_of_[i]->at(1)].id;
    } catch (const Error& error) {
      entry.outcome = error.code() == ErrorCode::kMissing ? ImportOutcome::kIncomplete
                                                          : ImportOutcome::kInvalid;
      entry.message = error.what();
    }
  }

  std::size_t JobFor(std::size_t object, PartRole role, const std::string& stem,
                     const std::string& source_hash) {
    const auto known = job_by_hash_.find(source_hash);
    if (known != job_by_hash_.end()) return known->second;
    for (int count = 1;; ++count) {
      const std::string id = count == 1 ? stem : stem + "-" + std::to_string(count);
      if (taken_.contains(id)) continue;
      const std::optional<std::string> there = SourceHashOf(out_ / id);
      if (there && *there != source_hash) continue;
      taken_[id] = true;
      job_by_hash_[source_hash] = jobs_.size();
      jobs_.push_back(NewJob(object, role, id, there.has_value()));
      return jobs_.size() - 1;
    }
  }

  PartJob NewJob(std::size_t object, PartRole role, const std::string& id, bool there) const {
    PartJob job;
    job.id = id;
    job.object = object;
    job.role = role;
    if (!there || existing_ == Existing::kReplace) return job;
    job.present = SameSettings(out_ / id);
    job.done = true;
    if (job.present) RecallReport(job);
    if (job.present) return job;
    job.outcome = ImportOutcome::kExists;
    job.problem =
        (out_ / id).string() + ": was made with other settings; pass --overwrite to replace it";
    return job;
  }

  // nothing if no part is there
  static std::optional<std::string> SourceHashOf(const fs::path& folder) {
    if (!fs::exists(folder / "part.json")) return std::nullopt;
    const std::string path = (folder / "part.json").string();
    return ValueOf<std::string>(ReadJsonFile(path), "source_sha256", path);
  }

  bool SameSettings(const fs::path& folder) const {
    const fs::path path = folder / "repair.json";
    if (!fs::exists(path)) return false;
    return MemberOf(ReadJsonFile(path), "settings", path.string()) == settings_;
  }

  // what an earlier run measured
  void RecallReport(PartJob& job) const {
    const std::string path = (out_ / job.id / "repair.json").string();
    const Json json = ReadJsonFile(path);
    job.box_deviation_m = ValueOf<double>(json, "box_deviation_m", path);
    if (job.role == PartRole::kHandle)
      job.grasp.fit.holds = ValueOf<bool>(MemberOf(json, "grasp", path), "holds", path);
  }

  void MakeAll() {
    std::vector<std::size_t> open;
    for (std::size_t j = 0; j < jobs_.size(); ++j) {
      if (!jobs_[j].done) open.push_back(j);
    }
    Progress progress("importing parts", open.size());
    ParallelFor(open.size(), config_.threads, [&](std::size_t k) {
      Make(jobs_[open[k]]);
      const std::lock_guard lock(mutex_);
      jobs_[open[k]].done = true;
      WriteCompleteObjects();
      progress.Advance(1, jobs_[open[k]].id);
    });
  }

  void Make(PartJob& job) const {
    if (StopRequested() != 0) {
      job.outcome = ImportOutcome::kStopped;
      job.problem = "stopped before its turn; run the same command again to go on";
      return;
    }
    const UniDoorManipObject& object = *objects_[job.object];
    try {
      PartDraft draft = job.role == PartRole::kBody ? LoadBody(object) : LoadHandle(object);
      draft.facts.id = job.id;
      job.box_deviation_m = BoxDeviation(object, draft);
      MakePartConfig make = config_.make;
      make.threads = 1;  // parts already run side by side
      job.made = MakePart(draft, make);
      job.problem = ProblemOf(job.made);
      if (!job.made.part) job.outcome = ImportOutcome::kNotClosed;
      if (job.made.part && job.role == PartRole::kHandle) SetGrasp(job);
    } catch (const Error& error) {
      job.outcome = ImportOutcome::kInvalid;
      job.problem = error.what();
    }
  }

  static void SetGrasp(PartJob& job) {
    Part& part = *job.made.part;
    std::vector<TriangleMesh> pieces;
    for (const PartPiece& piece : part.pieces) pieces.push_back(piece.mesh);
    job.grasp = RefineGrasp(FindPiece(part, "grip")->mesh, internal::JoinedMeshes(pieces),
                            part.part_from_grasp);
    part.part_from_grasp = job.grasp.part_from_grasp;
    part.grasp_half_extent_m = job.grasp.half_extent_m;
  }

  // under the lock: a half is kept only if the other half came out too
  void WriteCompleteObjects() {
    for (std::size_t i = 0; i < objects_.size(); ++i) {
      if (!jobs_of_[i]) continue;
      const bool complete = std::all_of(
          jobs_of_[i]->begin(), jobs_of_[i]->end(),
          [&](std::size_t j) { return jobs_[j].done && (jobs_[j].present || jobs_[j].made.part); });
      if (!complete) continue;
      for (const std::size_t j : *jobs_of_[i]) Write(jobs_[j]);
    }
  }

  void Write(PartJob& job) const {
    if (job.present || job.written) return;
    StagedFolder staged(out_ / job.id, existing_);
    WritePart(*job.made.part, staged.path());
    Json json = doorforge::ToJson(job.made);
    json["settings"] = settings_;
    json["box_deviation_m"] = job.box_deviation_m;
    if (job.role == PartRole::kHandle) json["grasp"] = GraspToJson(job.grasp);
    WriteJsonFile(staged.path() / "repair.json", json);
    staged.Commit();
    job.written = true;
  }

  static Json GraspToJson(const RefinedGrasp& grasp) {
    return {{"holds", grasp.fit.holds},       {"moved_m", grasp.moved_m},
            {"turned_rad", grasp.turned_rad}, {"width_m", grasp.fit.width_m},
            {"contact", grasp.fit.contact},   {"tip_clearance_m", grasp.fit.tip_clearance_m}};
  }

  void Summarize() {
    for (std::size_t i = 0; i < objects_.size(); ++i) {
      if (!jobs_of_[i]) continue;
      ImportedObject& entry = report_.objects[i];
      entry.outcome = ImportOutcome::kImported;
      for (const std::size_t j : *jobs_of_[i]) {
        const PartJob& job = jobs_[j];
        if (job.outcome == ImportOutcome::kImported) continue;
        entry.outcome = job.outcome;
        entry.message += (entry.message.empty() ? "" : "; ") + job.id + ": " + job.problem;
      }
      entry.body_box_deviation_m = jobs_[jobs_of_[i]->at(0)].box_deviation_m;
      entry.handle_box_deviation_m = jobs_[jobs_of_[i]->at(1)].box_deviation_m;
      entry.grasp_holds = jobs_[jobs_of_[i]->at(1)].grasp.fit.holds;
    }
  }

  void WriteRecord() const {
    const bool any = std::any_of(report_.objects.begin(), report_.objects.end(), [](const auto& o) {
      return o.outcome == ImportOutcome::kImported;
    });
    if (any) WriteJsonFile(out_ / "import.json", doorforge::ToJson(report_));
  }

  const std::vector<fs::path>& folders_;
  fs::path out_;
  const ImportConfig& config_;
  Existing existing_;
  Json settings_;
  ImportReport report_;
  std::vector<std::optional<UniDoorManipObject>> objects_;
  std::vector<std::optional<std::array<std::size_t, 2>>> jobs_of_;  // body, handle
  std::vector<PartJob> jobs_;
  std::map<std::string, std::size_t> job_by_hash_;
  std::map<std::string, bool> taken_;
  std::mutex mutex_;
};

}  // namespace

std::string_view NameOf(ImportOutcome outcome) {
  static constexpr std::array<std::string_view, 6> kNames = {"imported",   "incomplete", "invalid",
                                                             "not_closed", "exists",     "stopped"};
  return kNames.at(static_cast<std::size_t>(outcome));
}

std::vector<fs::path> FindObjects(const fs::path& source) {
  if (IsUniDoorManipObject(source)) return {source};
  std::error_code error;
  if (!fs::is_directory(source, error))
    throw Error(ErrorCode::kMissing, source.string() +
                                         ": no such folder; give one object (a folder "
                                         "with mobility.urdf) or a folder of them");
  std::vector<fs::path> found;
  auto entry = fs::recursive_directory_iterator(
      source, fs::directory_options::skip_permission_denied, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    if (!entry->is_directory(error)) continue;
    const bool is_object = IsUniDoorManipObject(entry->path());
    if (is_object) found.push_back(entry->path());
    if (is_object || entry.depth() >= 2) entry.disable_recursion_pending();
  }
  if (found.empty())
    throw Error(ErrorCode::kMissing, source.string() +
                                         ": holds no object; an object is a folder "
                                         "with mobility.urdf");
  std::sort(found.begin(), found.end());
  return found;
}

ImportReport ImportObjects(const std::vector<fs::path>& folders, const fs::path& out,
                           const ImportConfig& config, Existing existing) {
  return Import(folders, out, config, existing).Run();
}

nlohmann::ordered_json ToJson(const ImportReport& report) {
  Json objects = Json::array();
  for (const ImportedObject& object : report.objects) {
    objects.push_back({{"object", object.name},
                       {"outcome", NameOf(object.outcome)},
                       {"message", object.message},
                       {"category", object.category},
                       {"mechanism", object.mechanism},
                       {"body", object.body_id},
                       {"handle", object.handle_id},
                       {"body_box_deviation_m", object.body_box_deviation_m},
                       {"handle_box_deviation_m", object.handle_box_deviation_m},
                       {"grasp_holds", object.grasp_holds}});
  }
  return {{"schema", "doorforge.import"}, {"schema_version", 1}, {"objects", objects}};
}

}  // namespace doorforge
