// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/importers/import_objects.h"

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <mutex>
#include <optional>

#include "doorforge/core/config_io.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/mesh_transform.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/program.h"
#include "doorforge/core/progress.h"
#include "doorforge/core/record_id.h"
#include "doorforge/importers/author_place.h"
#include "doorforge/mesh/work_budget.h"

#include "subtask.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double kLongestGrip = 10;  // [m]
constexpr const char* kStoppedMessage =
    "stopped before its turn; run the same command again to go on";

// A part to make, and what came of it.
struct PartJob {
  std::string id;
  ForeignPart part;      // of the first object that has it
  fs::path source;       // of the same object
  bool present = false;  // made by an earlier run
  bool written = false;
  MadePart made;
  std::string problem;
  ImportOutcome outcome = ImportOutcome::kImported;
  double box_deviation_m = 0;
  RefinedGrasp grasp;
  bool done = false;
};

using Words = std::map<std::string, std::string>;

class Import {
 public:
  Import(const std::vector<ForeignSource>& sources, fs::path out, const ImportConfig& config,
         Existing existing)
      : sources_(sources), out_(std::move(out)), config_(config), existing_(existing) {
    settings_ = ToJson(config_.make);
    settings_.erase("threads");
    settings_["visual"] = config_.visual;
  }

  ImportReport Run() {
    RequireWritable(out_);
    ReadAll();
    MakeAll();
    RememberPlaces();
    Summarize();
    WriteRecord();
    return std::move(report_);
  }

 private:
  // reads the sources side by side and finds out, in their order, which parts are needed
  void ReadAll() {
    std::vector<std::vector<ImportedObject>> entries(sources_.size());
    std::vector<std::vector<ForeignObject>> objects(sources_.size());
    Progress progress("reading objects", sources_.size());
    ParallelFor(sources_.size(), config_.threads, [&](std::size_t i) {
      ReadOne(sources_[i], objects[i], entries[i]);
      const std::lock_guard lock(mutex_);
      progress.Advance(1, entries[i].front().name);
    });
    for (std::size_t i = 0; i < sources_.size(); ++i) {
      for (std::size_t k = 0; k < entries[i].size(); ++k) {
        if (!IsWanted(entries[i][k])) {
          ++report_.left_out;
          continue;
        }
        report_.objects.push_back(std::move(entries[i][k]));
        jobs_of_.emplace_back();
        hinge_to_handle_m_.push_back(k < objects[i].size() ? objects[i][k].hinge_to_handle_m
                                                           : std::nullopt);
        settings_of_.push_back(k < objects[i].size() ? objects[i][k].compose_settings : Words());
        if (k < objects[i].size()) Plan(objects[i][k]);
      }
    }
  }

  // what cannot be read has no category and stays in the report
  bool IsWanted(const ImportedObject& entry) const {
    return config_.only.empty() || entry.category.empty() ||
           std::find(config_.only.begin(), config_.only.end(), entry.category) !=
               config_.only.end();
  }

  // one entry an object, or one for a source that cannot be read
  void ReadOne(const ForeignSource& source, std::vector<ForeignObject>& objects,
               std::vector<ImportedObject>& entries) const {
    ImportedObject failed;
    failed.source = source;
    failed.name = internal::ObjectNameOf(source.path);
    try {
      const WorkBudget budget(source.path.string(), config_.max_seconds);
      if (StopRequested() == 0) {
        objects = ReadObjects(source, config_.read);
      } else {
        failed.outcome = ImportOutcome::kStopped;
        failed.message = kStoppedMessage;
      }
    } catch (const Error& error) {
      failed.outcome = error.code() == ErrorCode::kMissing ? ImportOutcome::kIncomplete
                                                           : ImportOutcome::kInvalid;
      failed.message = error.what();
    } catch (const std::exception&) {
      failed.message = CurrentProblem(source.path.string());
      objects.clear();
    }
    for (const ForeignObject& object : objects) entries.push_back(EntryFor(source, object));
    if (objects.empty()) entries.push_back(std::move(failed));
  }

  static ImportedObject EntryFor(const ForeignSource& source, const ForeignObject& object) {
    ImportedObject entry;
    entry.source = source;
    entry.name = object.name;
    entry.category = object.category;
    entry.mechanism = object.mechanism;
    entry.notes = object.notes;
    entry.scale = object.scale;
    entry.mirrored = object.mirrored;
    entry.outcome = object.refusal.empty() ? ImportOutcome::kImported : ImportOutcome::kRefused;
    entry.message = object.refusal;
    return entry;
  }

  // of the object last entered; where the output holds a damaged part of its name, that is its
  // failure alone
  void Plan(const ForeignObject& object) {
    ImportedObject& entry = report_.objects.back();
    try {
      PlanParts(object, entry);
    } catch (const std::exception&) {
      jobs_of_.back().clear();
      entry.outcome = ImportOutcome::kInvalid;
      entry.message = CurrentProblem(out_.string());
    }
  }

  void PlanParts(const ForeignObject& object, ImportedObject& entry) {
    for (const ForeignPart& part : object.parts) {
      const std::size_t job = JobFor(part);
      jobs_of_.back().push_back(job);
      (part.role == PartRole::kBody ? entry.body_id : entry.handle_id) = jobs_[job].id;
    }
  }

  std::size_t JobFor(const ForeignPart& part) {
    const std::string& source_hash = part.source_sha256;
    const auto known = job_by_hash_.find(source_hash);
    if (known != job_by_hash_.end()) return known->second;
    for (int count = 1;; ++count) {
      const std::string id = count == 1 ? part.id : part.id + "-" + std::to_string(count);
      if (taken_.contains(id)) continue;
      const std::optional<std::string> there = SourceHashOf(out_ / id);
      // something else of that name stays what it is
      if (!there && fs::exists(fs::symlink_status(out_ / id))) continue;
      if (there && *there != source_hash) continue;
      taken_[id] = true;
      job_by_hash_[source_hash] = jobs_.size();
      jobs_.push_back(NewJob(part, id, there.has_value()));
      jobs_.back().source = report_.objects.back().source.path;
      return jobs_.size() - 1;
    }
  }

  PartJob NewJob(const ForeignPart& part, const std::string& id, bool there) const {
    PartJob job;
    job.id = id;
    job.part = part;
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
    if (job.part.role == PartRole::kHandle)
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
      job.problem = kStoppedMessage;
      return;
    }
    try {
      const WorkBudget budget(job.source.string(), config_.max_seconds);
      LoadedPart loaded = job.part.load();
      PartDraft& draft = loaded.draft;
      draft.facts.id = job.id;
      job.box_deviation_m = loaded.box_deviation_m;
      if (!config_.visual) DropVisuals(draft);
      MakePartConfig make = config_.make;
      make.threads = 1;  // parts already run side by side
      job.made = MakePart(draft, make);
      job.problem = ProblemOf(job.made);
      if (!job.made.part) job.outcome = ImportOutcome::kNotClosed;
      if (job.made.part && job.part.role == PartRole::kHandle) SetGrasp(job);
    } catch (const Error& error) {
      job.outcome = ImportOutcome::kInvalid;
      job.problem = error.what();
    } catch (const std::exception&) {
      job.outcome = ImportOutcome::kInvalid;
      job.problem = CurrentProblem(job.source.string());
    }
    if (job.outcome == ImportOutcome::kInvalid) job.made = {};
  }

  static void DropVisuals(PartDraft& draft) {
    for (RawPiece& piece : draft.pieces) {
      piece.visual = {};
      piece.notes.clear();
    }
  }

  static void SetGrasp(PartJob& job) {
    Part& part = *job.made.part;
    // nothing that a hand holds; looking for a grasp takes memory by its size
    const Eigen::Vector3d size = BoundsOf(FindPiece(part, "grip")->mesh).sizes();
    if (size.maxCoeff() > kLongestGrip) return;
    std::vector<TriangleMesh> pieces;
    for (const PartPiece& piece : part.pieces) pieces.push_back(piece.mesh);
    job.grasp = RefineGrasp(FindPiece(part, "grip")->mesh, Merged(pieces), part.part_from_grasp);
    part.part_from_grasp = job.grasp.part_from_grasp;
    part.grasp_half_extent_m = job.grasp.half_extent_m;
  }

  // under the lock: a part is kept only if all of its object's came out
  void WriteCompleteObjects() {
    for (const std::vector<std::size_t>& jobs : jobs_of_) {
      const bool complete = std::all_of(jobs.begin(), jobs.end(), [&](std::size_t j) {
        return jobs_[j].done && (jobs_[j].present || jobs_[j].made.part);
      });
      if (complete) WriteTogether(jobs);
    }
  }

  // The parts of an object: none appears before all of them are written.
  void WriteTogether(const std::vector<std::size_t>& jobs) {
    std::vector<std::unique_ptr<StagedFolder>> staged;
    for (const std::size_t j : jobs) {
      if (!jobs_[j].present && !jobs_[j].written) staged.push_back(Staged(jobs_[j]));
    }
    for (const std::unique_ptr<StagedFolder>& folder : staged) folder->Commit();
    for (const std::size_t j : jobs) jobs_[j].written = !jobs_[j].present;
  }

  std::unique_ptr<StagedFolder> Staged(const PartJob& job) const {
    auto staged = std::make_unique<StagedFolder>(OutputBelow(out_, job.id), kPartFolder, existing_);
    WritePart(*job.made.part, staged->path());
    Json json = doorforge::ToJson(job.made);
    json["settings"] = settings_;
    json["box_deviation_m"] = job.box_deviation_m;
    if (job.part.role == PartRole::kHandle) json["grasp"] = GraspToJson(job.grasp);
    WriteJsonFile(staged->path() / "repair.json", json);
    return staged;
  }

  static Json GraspToJson(const RefinedGrasp& grasp) {
    return {{"holds", grasp.fit.holds},       {"moved_m", grasp.moved_m},
            {"turned_rad", grasp.turned_rad}, {"width_m", grasp.fit.width_m},
            {"contact", grasp.fit.contact},   {"tip_clearance_m", grasp.fit.tip_clearance_m}};
  }

  // a body and a handle of one object; both parts are there
  void RememberPlaces() const {
    std::map<std::string, AuthorPlaces> places;
    for (std::size_t i = 0; i < jobs_of_.size(); ++i) {
      const std::optional<Eigen::Vector3d>& offset = hinge_to_handle_m_[i];
      if (!offset || jobs_of_[i].size() != 2) continue;
      const PartJob& body = jobs_[jobs_of_[i][0]];
      const PartJob& handle = jobs_[jobs_of_[i][1]];
      if (!IsThere(body) || !IsThere(handle)) continue;
      RememberSettings(body.id, handle.id, settings_of_[i]);
      places[body.id][handle.part.source_sha256] = Translation(HingeOf(body) + *offset);
    }
    for (const auto& [id, handles] : places) RememberAuthorPlaces(out_ / id, handles);
  }

  // A config of `doorforge compose`, beside the body.
  void RememberSettings(const std::string& body, const std::string& handle,
                        const Words& settings) const {
    if (settings.empty()) return;
    Json json = {{"body", body}, {"handle", handle}, {"place", "author"}};
    for (const auto& [name, word] : settings) {
      const Json value = Json::parse(word, nullptr, false);
      json[name] = value.is_number() || value.is_boolean() ? value : Json(word);
    }
    WriteJsonFile(out_ / body / "as_exported.json", json);
  }

  static bool IsThere(const PartJob& job) { return job.present || job.written; }

  // a part made by an earlier run says it itself
  Eigen::Vector3d HingeOf(const PartJob& body) const {
    if (body.made.part) return body.made.part->joint.origin_m;
    const std::string path = (out_ / body.id / "part.json").string();
    const Json json = ReadJsonFile(path);
    return Vector3FromJson(MemberOf(MemberOf(json, "joint", path), "origin_m", path), path);
  }

  void Summarize() {
    for (std::size_t i = 0; i < jobs_of_.size(); ++i) {
      for (const std::size_t j : jobs_of_[i]) Summarize(jobs_[j], report_.objects[i]);
    }
  }

  static void Summarize(const PartJob& job, ImportedObject& entry) {
    const bool is_body = job.part.role == PartRole::kBody;
    (is_body ? entry.body_box_deviation_m : entry.handle_box_deviation_m) = job.box_deviation_m;
    if (!is_body) entry.grasp_holds = job.grasp.fit.holds;
    for (const PieceReport& piece : job.made.pieces) {
      for (const std::string& note : piece.visual_notes)
        entry.notes.push_back(piece.piece + ": " + note);
    }
    if (job.outcome == ImportOutcome::kImported) return;
    entry.outcome = job.outcome;
    entry.message += (entry.message.empty() ? "" : "; ") + job.id + ": " + job.problem;
  }

  void WriteRecord() const {
    const bool any = std::any_of(report_.objects.begin(), report_.objects.end(), [](const auto& o) {
      return o.outcome == ImportOutcome::kImported;
    });
    if (any) WriteJsonFile(out_ / "import.json", doorforge::ToJson(report_));
  }

  const std::vector<ForeignSource>& sources_;
  fs::path out_;
  const ImportConfig& config_;
  Existing existing_;
  Json settings_;
  ImportReport report_;
  std::vector<std::vector<std::size_t>> jobs_of_;                  // of each object in the report
  std::vector<std::optional<Eigen::Vector3d>> hinge_to_handle_m_;  // the same
  std::vector<Words> settings_of_;                                 // the same
  std::vector<PartJob> jobs_;
  std::map<std::string, std::size_t> job_by_hash_;
  std::map<std::string, bool> taken_;
  std::mutex mutex_;
};

// Names of files may hold what a terminal obeys; lines of a message stay lines.
std::string Shown(std::string text) {
  for (char& c : text) {
    if ((static_cast<unsigned char>(c) < 0x20 && c != '\n') || c == 0x7F) c = '?';
  }
  return text;
}

std::string LineOf(const ImportedObject& object) {
  std::string notes;
  if (!object.handle_id.empty() && !object.grasp_holds) notes = "no grasp that holds was found";
  for (const std::string& note : object.notes) notes += (notes.empty() ? "" : "; ") + note;
  const auto padded = [](std::string word, std::size_t width) {
    if (word.empty()) word = "-";
    return word + std::string(word.size() < width ? width - word.size() : 0, ' ') + ' ';
  };
  return padded(object.name, 26) + padded(object.category, 16) + padded(object.body_id, 14) +
         (object.handle_id.empty() ? "-" : object.handle_id) +
         (notes.empty() ? "" : "  (" + notes + ")") + "\n";
}

}  // namespace

std::string_view NameOf(ImportOutcome outcome) {
  static constexpr std::array<std::string_view, 7> kNames = {
      "imported", "incomplete", "invalid", "refused", "not_closed", "exists", "stopped"};
  return kNames.at(static_cast<std::size_t>(outcome));
}

ImportReport ImportObjects(const std::vector<ForeignSource>& sources, const fs::path& out,
                           const ImportConfig& config, Existing existing) {
  return Import(sources, out, config, existing).Run();
}

nlohmann::ordered_json ToJson(const ImportReport& report) {
  Json objects = Json::array();
  for (const ImportedObject& object : report.objects) {
    objects.push_back({{"object", object.name},
                       {"format", object.source.format},
                       {"outcome", NameOf(object.outcome)},
                       {"message", object.message},
                       {"category", object.category},
                       {"mechanism", object.mechanism},
                       {"body", object.body_id},
                       {"handle", object.handle_id},
                       {"scale", object.scale},
                       {"mirrored", object.mirrored},
                       {"notes", object.notes},
                       {"body_box_deviation_m", object.body_box_deviation_m},
                       {"handle_box_deviation_m", object.handle_box_deviation_m},
                       {"grasp_holds", object.grasp_holds}});
  }
  return {{"schema", "doorforge.import"}, {"schema_version", 1}, {"objects", objects}};
}

std::string ImportText(const ImportReport& report) {
  std::string text;
  std::map<ImportOutcome, int> counts;
  for (const ImportedObject& object : report.objects) {
    ++counts[object.outcome];
    if (object.outcome == ImportOutcome::kImported) text += Shown(LineOf(object));
  }
  const auto counted = [](std::size_t count) {
    return std::to_string(count) + (count == 1 ? " object" : " objects");
  };
  text += counted(report.objects.size()) + ":";
  for (const auto& [outcome, count] : counts)
    text += " " + std::to_string(count) + " " + std::string(NameOf(outcome));
  text += "\n";
  if (report.left_out > 0)
    text += counted(static_cast<std::size_t>(report.left_out)) + " of other categories left out\n";
  return text;
}

std::vector<std::string> FaultsOf(const ImportReport& report) {
  std::vector<std::string> faults;
  for (const ImportedObject& object : report.objects) {
    if (object.outcome != ImportOutcome::kImported)
      faults.push_back(
          Shown(object.name + ": " + std::string(NameOf(object.outcome)) + ": " + object.message));
  }
  return faults;
}

}  // namespace doorforge
