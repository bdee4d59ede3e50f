// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/conformance/conformance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/program.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::array kClients = {
    ConformanceClient{"mujoco", "pip install mujoco"},
    ConformanceClient{"newton",
                      "pip install newton mujoco-warp newton-usd-schemas usd-core trimesh scipy"},
    ConformanceClient{"pybullet", "pip install pybullet (Python 3.11 or earlier)"},
    ConformanceClient{"sapien", "pip install sapien"},
    ConformanceClient{"drake", "pip install drake"}};

constexpr double kDegrees = 180 / std::numbers::pi;

const ConformanceClient& ClientNamed(const std::string& name) {
  for (const ConformanceClient& client : kClients) {
    if (client.name == name) return client;
  }
  throw Error(ErrorCode::kInvalidArgument, "conformance: no client \"" + name + '"');
}

std::string FileOf(const std::string& format) {
  if (format == "mjcf") return "model.xml";
  return "model." + format;
}

// This is the arm of the pull at the grasp about the hinge.
double ArmOf(const DoorAsset& door) {
  const Eigen::Vector3d grasp =
      door.handle_joint.parent_from_child_at_zero * door.handle_from_grasp.translation();
  const Eigen::Vector3d axis = door.hinge.axis.normalized();
  return (grasp - axis.dot(grasp) * axis).norm();
}

bool Turns(const DoorJoint& joint) { return joint.upper_rad > joint.lower_rad; }

Json JobOf(const DoorAsset& door, const std::string& format, const fs::path& folder) {
  const bool turns = Turns(door.handle_joint);
  Json limits = {{door.hinge.name, {door.hinge.lower_rad, door.hinge.upper_rad}}};
  if (turns)
    limits[door.handle_joint.name] = {door.handle_joint.lower_rad, door.handle_joint.upper_rad};
  Json masses = {{door.links[kLeafLink].name, door.links[kLeafLink].mass.mass_kg}};
  // readers weld a handle that does not turn to its leaf
  if (turns)
    masses[door.links[kHandleLink].name] = door.links[kHandleLink].mass.mass_kg;
  else
    masses.clear();
  return {{"door", door.id},
          {"format", format},
          {"path", fs::absolute(folder / FileOf(format)).string()},
          {"latched", door.latch.type != LatchType::kNone},
          {"turns", turns},
          {"arm_m", ArmOf(door)},
          {"handle_spring_nm_per_rad", door.latch.handle_spring_nm_per_rad},
          {"handle_upper_rad", door.handle_joint.upper_rad},
          {"law_unlock_deg", door.latch.unlock_angle_rad * kDegrees},
          {"masses_kg", masses},
          {"limits", limits}};
}

/// Runs the judge in child processes and keeps its files in a folder.
class Judge {
 public:
  Judge(const ConformanceRun& run, const ConformanceClient& client)
      : client_(client),
        python_(run.python),
        folder_(run.out),
        judge_(DataFolder() / "conformance" / "judge.py") {
    Require(fs::exists(judge_), ErrorCode::kMissing,
            judge_.string() + ": is not there; install doorforge with its data");
  }

  ConformanceEngine Probe() const {
    ConformanceEngine engine{std::string(client_.name), {}, {}, {}};
    const fs::path answer = File("probe");
    fs::remove(answer);
    const int code = Run({"--probe", answer.string()});
    const Json json = fs::exists(answer) ? ReadJsonFile(answer) : Json::object();
    if (json.contains("version")) {
      engine.version = json["version"].get<std::string>();
      for (const auto& [format, needs] : json["formats"].items())
        engine.loader[format] = needs.get<std::string>();
    } else {
      engine.absent = json.contains("missing") ? json["missing"].get<std::string>()
                                               : "ended with code " + std::to_string(code);
      engine.absent += "; " + std::string(client_.install) + ", or --python PATH of where it is";
    }
    fs::remove(answer);
    return engine;
  }

  // One answer a job, in their order.
  std::vector<Json> Ask(const Json& jobs) const {
    std::vector<Json> answers;
    while (answers.size() < jobs.size()) {
      if (StopRequested() != 0) throw Error(ErrorCode::kIncomplete, "conformance: stopped");
      const Json rest(std::vector<Json>(jobs.begin() + static_cast<std::ptrdiff_t>(answers.size()),
                                        jobs.end()));
      const std::size_t before = answers.size();
      const int code = AskOnce(rest, answers);
      if (answers.size() == jobs.size()) break;
      const Json& job = jobs[answers.size()];
      const std::string end = "the engine's process ended with code " + std::to_string(code);
      answers.push_back(
          {{"door", job["door"]}, {"format", job["format"]}, {"loads", false}, {"problem", end}});
      if (code == 0 && answers.size() == before + 1)
        throw Error(ErrorCode::kFormat, judge_.string() + ": gave no answer");
    }
    return answers;
  }

 private:
  fs::path File(const char* what) const {
    return folder_ / (std::string(client_.name) + "." + what + ".json");
  }

  int Run(const std::vector<std::string>& arguments) const {
    std::vector<std::string> argv = {"/usr/bin/env", python_, "-B", judge_.string(),
                                     std::string(client_.name)};
    argv.insert(argv.end(), arguments.begin(), arguments.end());
    return RunChild(argv);
  }

  int AskOnce(const Json& jobs, std::vector<Json>& answers) const {
    WriteJsonFile(File("jobs"), jobs);
    fs::remove(File("answers"));
    const int code = Run({File("jobs").string(), File("answers").string()});
    if (fs::exists(File("answers"))) {
      const Json record = ReadJsonFile(File("answers"));
      for (const Json& answer : record["results"]) answers.push_back(answer);
    }
    fs::remove(File("jobs"));
    fs::remove(File("answers"));
    return code;
  }

  const ConformanceClient& client_;
  std::string python_;
  fs::path folder_;
  fs::path judge_;
};

std::optional<double> NumberIn(const Json& json, const char* key) {
  const auto entry = json.find(key);
  if (entry == json.end() || !entry->is_number()) return std::nullopt;
  return entry->get<double>();
}

ConformanceRow RowOf(const std::string& client, const Json& job, const Json& answer) {
  ConformanceRow row;
  row.client = client;
  row.format = job["format"].get<std::string>();
  row.door = job["door"].get<std::string>();
  row.latched = job["latched"].get<bool>();
  row.loads = answer.value("loads", false);
  row.problem = answer.value("problem", std::string());
  row.mass_error = NumberIn(answer, "mass_error");
  row.limit_error = NumberIn(answer, "limit_error");
  row.held_deg = NumberIn(answer, "held_deg");
  row.unlock_deg = NumberIn(answer, "unlock_deg");
  if (row.latched) row.law_unlock_deg = NumberIn(job, "law_unlock_deg");
  row.open_s = NumberIn(answer, "open_s");
  return row;
}

bool Wanted(const ConformanceRun& run, const std::string& format) {
  return run.formats.empty() ||
         std::find(run.formats.begin(), run.formats.end(), format) != run.formats.end();
}

Json JobsOf(const std::vector<DoorAsset>& doors, const ConformanceRun& run,
            const ConformanceEngine& engine) {
  Json jobs = Json::array();
  for (const DoorAsset& door : doors) {
    for (const auto& [format, needs] : engine.loader) {
      if (Wanted(run, format)) jobs.push_back(JobOf(door, format, run.out / door.id));
    }
  }
  return jobs;
}

// The meshes stay on disk: engines read them there.
std::vector<DoorAsset> ExportAll(std::span<const fs::path> folders, const ConformanceRun& run) {
  std::vector<DoorFormat> formats;
  for (const char* name : {"urdf", "mjcf", "sdf", "usda"}) {
    if (Wanted(run, name)) formats.push_back(*DoorFormatNamed(name));
  }
  std::vector<DoorAsset> doors;
  for (const fs::path& folder : folders) {
    DoorAsset door = ReadDoor(folder);
    WriteExportedDoor(door, formats, run.out / door.id, Existing::kReplace, run.settings);
    for (DoorLink& link : door.links) link.geometry.clear();
    doors.push_back(std::move(door));
  }
  return doors;
}

}  // namespace

std::span<const ConformanceClient> ConformanceClients() { return kClients; }

std::vector<std::string> ConformanceClientNames() {
  std::vector<std::string> names;
  for (const ConformanceClient& client : kClients) names.emplace_back(client.name);
  return names;
}

ConformanceReport RunConformance(std::span<const fs::path> folders, const ConformanceRun& run) {
  fs::create_directories(run.out);
  const std::vector<DoorAsset> doors = ExportAll(folders, run);
  ConformanceReport report;
  for (const std::string& name : run.clients) {
    const Judge judge(run, ClientNamed(name));
    report.engines.push_back(judge.Probe());
    const Json jobs = JobsOf(doors, run, report.engines.back());
    const std::vector<Json> answers = judge.Ask(jobs);
    for (std::size_t i = 0; i < answers.size(); ++i)
      report.rows.push_back(RowOf(name, jobs[i], answers[i]));
  }
  return report;
}

Json ToJson(const ConformanceReport& report) {
  const auto number = [](const std::optional<double>& value) {
    return value ? Json(*value) : Json(nullptr);
  };
  Json engines = Json::array();
  for (const ConformanceEngine& engine : report.engines)
    engines.push_back({{"name", engine.name},
                       {"version", engine.version},
                       {"absent", engine.absent},
                       {"loader", engine.loader}});
  Json rows = Json::array();
  for (const ConformanceRow& row : report.rows)
    rows.push_back({{"client", row.client},
                    {"format", row.format},
                    {"door", row.door},
                    {"latched", row.latched},
                    {"loads", row.loads},
                    {"problem", row.problem},
                    {"mass_error", number(row.mass_error)},
                    {"limit_error_rad", number(row.limit_error)},
                    {"held_deg", number(row.held_deg)},
                    {"unlock_deg", number(row.unlock_deg)},
                    {"law_unlock_deg", number(row.law_unlock_deg)},
                    {"open_s", number(row.open_s)},
                    {"held", row.held()},
                    {"opened", row.opened()}});
  return {{"schema", "doorforge.conformance"},
          {"schema_version", 1},
          {"engines", engines},
          {"rows", rows}};
}

}  // namespace doorforge
