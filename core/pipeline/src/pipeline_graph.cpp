// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/pipeline/pipeline_graph.h"

#include <algorithm>
#include <filesystem>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/config_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/nearest_name.h"
#include "doorforge/core/program.h"
#include "doorforge/core/record_id.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Values = std::map<std::string, std::vector<std::string>>;

constexpr const char* kOut = "out";
constexpr const char* kThreads = "threads";

[[noreturn]] void Fail(const std::string& where, const std::string& problem) {
  throw Error(ErrorCode::kInvalidConfig, where + ": " + problem);
}

fs::path PresetFolder() { return DataFolder() / "pipelines"; }

fs::path FileOf(const std::string& name) {
  if (name.ends_with(".yaml")) return name;
  const std::vector<std::string> presets = PipelinePresets();
  if (std::ranges::find(presets, name) == presets.end()) {
    std::string all;
    for (const std::string& preset : presets) all += (all.empty() ? "" : ", ") + preset;
    throw Error(ErrorCode::kInvalidArgument, "unknown pipeline \"" + name + "\"; there are " + all +
                                                 ", and files that end with .yaml");
  }
  return PresetFolder() / (name + ".yaml");
}

void RequireKnown(const Json& json, const std::vector<std::string>& known,
                  const std::string& where) {
  if (!json.is_object()) Fail(where, "expected keys and values");
  for (const auto& [key, value] : json.items()) {
    if (std::ranges::find(known, key) == known.end())
      Fail(where, "unknown key \"" + key + "\"; did you mean \"" + NearestName(key, known) + "\"?");
  }
}

// numbers become the texts that a user would type
std::string TextOf(const Json& value) {
  return value.is_string() ? value.get<std::string>() : JsonText(value);
}

std::vector<std::string> Texts(const Json& step, const std::string& key, const std::string& where) {
  std::vector<std::string> texts;
  if (!step.contains(key)) return texts;
  if (!step[key].is_array()) Fail(where, key + ": expected a list");
  for (const Json& element : step[key]) {
    if (!element.is_primitive() || element.is_null())
      Fail(where, key + ": expected a list of texts");
    texts.push_back(TextOf(element));
  }
  return texts;
}

std::string Text(const Json& step, const std::string& key, const std::string& where) {
  if (!step.contains(key) || !step[key].is_string() || step[key].get<std::string>().empty())
    Fail(where, key + ": expected a text");
  return step[key].get<std::string>();
}

CostTerms Cost(const Json& step, const std::string& key, const Json& settings,
               const std::string& where) {
  CostTerms terms;
  if (!step.contains(key)) return terms;
  if (!step[key].is_object()) Fail(where, key + ": expected keys and numbers");
  for (const auto& [name, value] : step[key].items()) {
    if (!value.is_number()) Fail(where, key + "." + name + ": expected a number");
    terms[name] = value.get<double>();
  }
  try {
    CostOf(terms, settings);
  } catch (const Error& error) {
    Fail(where, key + ": " + error.what());
  }
  return terms;
}

// a folder below the pipeline's own
bool IsOwnFolder(const fs::path& folder) {
  return folder.is_relative() && !folder.empty() && *folder.begin() != ".." &&
         *folder.begin() != "." && folder == folder.lexically_normal() &&
         folder.begin()->string() != "pipeline";
}

PipelineStep StepOf(const Json& json, const Json& settings, const std::string& where) {
  RequireKnown(json,
               {"name", "does", "command", "output", "records", "needs", "resume", "fine_codes",
                "given_with", "core_seconds", "mebibytes"},
               where);
  PipelineStep step;
  step.name = Text(json, "name", where);
  // its record is pipeline/<name>.json
  if (const std::string problem = IdProblem(step.name); !problem.empty())
    Fail(where, "name: " + problem);
  step.does = Text(json, "does", where);
  step.command = Texts(json, "command", where);
  if (json.contains("output")) step.output = Text(json, "output", where);
  step.records = Texts(json, "records", where);
  step.needs = Texts(json, "needs", where);
  if (step.command.empty()) Fail(where, "command: is empty");
  if (step.records.empty() != step.output.empty())
    Fail(where, "output and records belong together: changes could not be seen");
  if (!step.output.empty() && !IsOwnFolder(step.output))
    Fail(where, "output: expected a folder below the pipeline's");
  if (json.contains("resume")) step.resume = TextOf(json["resume"]);
  if (json.contains("given_with")) step.given_with = Text(json, "given_with", where);
  if (json.contains("fine_codes")) {
    step.ok_exit_codes.clear();
    for (const Json& code : json["fine_codes"]) {
      if (!code.is_number_integer() || code < 0 || code > 255)
        Fail(where, "fine_codes: expected exit codes, 0 to 255");
      step.ok_exit_codes.push_back(code.get<int>());
    }
  }
  step.core_seconds = Cost(json, "core_seconds", settings, where);
  step.mebibytes = Cost(json, "mebibytes", settings, where);
  return step;
}

void ChangeSettings(Json& settings, const std::vector<std::string>& changes,
                    const std::string& where) {
  std::vector<std::string> known;
  for (const auto& [key, value] : settings.items()) {
    if (!value.is_number() && !value.is_string())
      Fail(where, "settings." + key + ": expected a number or a text");
    known.push_back(key);
  }
  const Json wanted = ParseSettings(changes);
  RequireKnown(wanted.is_null() ? Json::object() : wanted, known, where + ": settings");
  for (const auto& [key, value] : wanted.items()) {
    const bool same = settings[key].is_number() ? value.is_number() && value >= 0
                                                : value.is_string() || value.is_number();
    if (!same || (settings[key].is_number_integer() && !value.is_number_integer()))
      Fail("--set " + key,
           "found " + JsonText(value) + ", expected the like of " + JsonText(settings[key]));
    settings[key] = settings[key].is_string() ? Json(TextOf(value)) : value;
  }
}

Json ParsePipeline(const fs::path& path) {
  const std::string where = path.string();
  Json json = ParseYaml(ReadFile(path, 1ULL << 20U), where);
  RequireKnown(json, {"schema", "schema_version", "about", "like", "settings", "steps"}, where);
  RequireSchema(json, "doorforge.pipeline", 1, where);
  return json;
}

std::string TextAt(const Json& json, const std::string& key) {
  const bool is_text = json.is_object() && json.contains(key) && json[key].is_string();
  return is_text ? json[key].get<std::string>() : std::string();
}

// What a change says of a command: arguments that go, others that take the place of equal ones, and
// those that come behind.
void ChangeCommand(const Json& change, Json& command, const std::string& where) {
  if (!command.is_array()) Fail(where, "command: expected a list");
  const auto occurs = [&](const std::string& argument) {
    return std::ranges::any_of(
        command, [&](const Json& held) { return held.is_string() && held == argument; });
  };
  for (const std::string& argument : Texts(change, "remove", where)) {
    if (!occurs(argument)) Fail(where, "remove: \"" + argument + "\" is no argument of it");
    command.erase(std::ranges::find(command, Json(argument)));
  }
  if (change.contains("replace")) {
    if (!change["replace"].is_object()) Fail(where, "replace: expected arguments and others");
    for (const auto& [argument, other] : change["replace"].items()) {
      if (!occurs(argument)) Fail(where, "replace: \"" + argument + "\" is no argument of it");
      std::ranges::replace(command, Json(argument), Json(TextOf(other)));
    }
  }
  if (!change.contains("append")) return;
  if (!change["append"].is_array()) Fail(where, "append: expected a list");
  for (const Json& argument : change["append"]) command.push_back(argument);
}

// Each of `changes` names one of the steps, whose command it changes and whose other keys it
// replaces; with a name of its own and a command it is one step more.
void ChangeSteps(const Json& changes, Json& steps, const std::string& where) {
  if (!changes.is_array()) Fail(where, "steps: expected a list");
  for (const Json& change : changes) {
    const std::string name = Text(change, "name", where + ": steps");
    const auto step = std::ranges::find_if(
        steps, [&](const Json& candidate) { return TextAt(candidate, "name") == name; });
    if (step == steps.end()) {
      if (!change.contains("command"))
        Fail(where, "steps: \"" + name +
                        "\" is no step of the preset that this one is like, and has no command");
      steps.push_back(change);
      continue;
    }
    for (const auto& [key, value] : change.items()) {
      if (key != "append" && key != "remove" && key != "replace") (*step)[key] = value;
    }
    ChangeCommand(change, (*step)["command"], where + ": " + name);
  }
}

// `like: quick` takes all of that preset but the settings and what is said of its steps; that one
// may be like another.
Json ReadDeclaration(const fs::path& path, int likes = 0) {
  constexpr int kMostLikes = 8;
  Json json = ParsePipeline(path);
  if (!json.contains("like")) return json;
  const std::string where = path.string();
  if (likes == kMostLikes) Fail(where, "like: the presets are like each other in a circle");
  Json base = ReadDeclaration(FileOf(Text(json, "like", where)), likes + 1);
  if (json.contains("settings")) {
    if (!json["settings"].is_object()) Fail(where, "settings: expected keys and values");
    for (const auto& [key, value] : json["settings"].items()) {
      if (!base["settings"].contains(key))
        Fail(where, "settings." + key + ": is no setting of " + Text(json, "like", where));
      base["settings"][key] = value;
    }
  }
  if (json.contains("steps")) ChangeSteps(json["steps"], base["steps"], where);
  base["about"] = Text(json, "about", where);
  return base;
}

/// Calls `replace(name)` for every {name} of the text; nothing keeps it as it is.
template <class Replace>
std::string Substitute(const std::string& text, Replace&& replace) {
  std::string result;
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t open = text.find('{', at);
    const std::size_t close = open == std::string::npos ? open : text.find('}', open);
    if (close == std::string::npos) break;
    const std::string name = text.substr(open + 1, close - open - 1);
    const std::optional<std::string> value = replace(name);
    result += text.substr(at, open - at) + (value ? *value : "{" + name + "}");
    at = close + 1;
  }
  return result + text.substr(at);
}

void CheckPlaceholders(const PipelineStep& step, const Json& settings, const std::string& where) {
  for (const std::string& argument : step.command) {
    Substitute(argument, [&](const std::string& name) -> std::optional<std::string> {
      const bool needed = std::ranges::find(step.needs, name) != step.needs.end();
      if (settings.contains(name) || name == kOut || name == kThreads || needed ||
          name == step.name)
        return "";
      Fail(where, "command: nothing stands for {" + name +
                      "}: it is no setting, and no step that this one needs");
    });
  }
}

void CheckStep(const PipelineStep& step, const Pipeline& pipeline, const std::string& where) {
  for (const PipelineStep& earlier : pipeline.steps) {
    if (earlier.name == step.name || (!step.output.empty() && earlier.output == step.output))
      Fail(where, "has the name or the output of an earlier step");
  }
  if (pipeline.settings.contains(step.name) || step.name == kOut || step.name == kThreads)
    Fail(where, "name: is that of a setting");
  if (!step.given_with.empty() && std::ranges::find(pipeline.steps, step.given_with,
                                                    &PipelineStep::name) == pipeline.steps.end())
    Fail(where, "given_with: no step before it is called \"" + step.given_with + "\"");
  for (const std::string& need : step.needs) {
    const auto found = std::ranges::find(pipeline.steps, need, &PipelineStep::name);
    if (found == pipeline.steps.end() || found->output.empty())
      Fail(where, "needs: no step before it is called \"" + need + "\" and makes something");
  }
  CheckPlaceholders(step, pipeline.settings, where);
}

}  // namespace

std::vector<std::string> PipelinePresets() {
  std::vector<std::string> names;
  if (!fs::is_directory(PresetFolder())) return names;
  for (const auto& entry : fs::directory_iterator(PresetFolder())) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  std::ranges::sort(names);
  return names;
}

Pipeline ReadPipeline(const std::string& name, const std::vector<std::string>& changes) {
  const fs::path path = FileOf(name);
  const std::string where = path.string();
  const Json json = ReadDeclaration(path);
  Pipeline pipeline;
  pipeline.name = path.stem().string();
  pipeline.about = Text(json, "about", where);
  pipeline.settings = json.contains("settings") ? json["settings"] : Json::object();
  if (!pipeline.settings.is_object()) Fail(where, "settings: expected keys and values");
  ChangeSettings(pipeline.settings, changes, where);
  if (!json.contains("steps") || !json["steps"].is_array() || json["steps"].empty())
    Fail(where, "steps: expected a list");
  for (const Json& entry : json["steps"]) {
    const std::string place = where + ": step " + std::to_string(pipeline.steps.size() + 1);
    PipelineStep step = StepOf(entry, pipeline.settings, place);
    CheckStep(step, pipeline, place + " (" + step.name + ")");
    pipeline.steps.push_back(std::move(step));
  }
  return pipeline;
}

void GiveOutput(Pipeline& pipeline, const std::string& step,
                const std::vector<std::string>& folders) {
  const auto given = std::ranges::find(pipeline.steps, step, &PipelineStep::name);
  if (given == pipeline.steps.end())
    throw Error(ErrorCode::kInvalidArgument,
                "pipeline \"" + pipeline.name + "\": has no step \"" + step + "\" to be given");
  for (PipelineStep& other : pipeline.steps) {
    if (other.name != step && other.given_with != step) continue;
    other.given = folders;
    other.needs.clear();
  }
  for (auto i = given - pipeline.steps.begin(); i-- > 0;) {
    const std::string& name = pipeline.steps[static_cast<std::size_t>(i)].name;
    const bool needed = std::ranges::any_of(pipeline.steps, [&](const PipelineStep& other) {
      return std::ranges::find(other.needs, name) != other.needs.end();
    });
    if (!needed) pipeline.steps.erase(pipeline.steps.begin() + i);
  }
}

std::vector<std::string> ExpandCommand(const PipelineStep& step, const Json& settings,
                                       const Values& more) {
  std::vector<std::string> expanded;
  for (const std::string& argument : step.command) {
    const bool alone = argument.starts_with('{') && argument.find('}') == argument.size() - 1;
    const auto list = alone ? more.find(argument.substr(1, argument.size() - 2)) : more.end();
    if (list != more.end()) {
      expanded.insert(expanded.end(), list->second.begin(), list->second.end());
      continue;
    }
    bool empty = false;
    const std::string text =
        Substitute(argument, [&](const std::string& name) -> std::optional<std::string> {
          std::optional<std::string> value;
          if (settings.contains(name)) value = TextOf(settings[name]);
          if (const auto found = more.find(name); found != more.end() && found->second.size() == 1)
            value = found->second[0];
          empty = empty || (value && value->empty());
          return value;
        });
    if (!empty) expanded.push_back(text);
  }
  return expanded;
}

double CostOf(const CostTerms& terms, const Json& settings) {
  double sum = 0;
  for (const auto& [term, factor] : terms) {
    double product = factor;
    for (std::size_t at = 0; term != "fixed" && at <= term.size();) {
      const std::size_t end = std::min(term.find('*', at), term.size());
      const std::string name = term.substr(at, end - at);
      if (!settings.contains(name) || !settings[name].is_number())
        throw Error(ErrorCode::kInvalidConfig, "\"" + name + "\" is no number among the settings");
      product *= settings[name].get<double>();
      at = end + 1;
    }
    sum += product;
  }
  return sum;
}

std::string PresetsText() {
  std::string lines;
  for (const std::string& name : PipelinePresets()) {
    const std::string space(name.size() < 11 ? 11 - name.size() : 1, ' ');
    lines += "  " + name + space + ReadPipeline(name, {}).about + "\n";
  }
  return lines;
}

}  // namespace doorforge
