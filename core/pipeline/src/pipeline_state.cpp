// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "pipeline_state.h"

#include <algorithm>

#include "doorforge/core/error.h"
#include "doorforge/core/file_system.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/json_file.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kSchema = "doorforge.pipeline_step";
constexpr int kSchemaVersion = 1;

fs::path FileOf(const fs::path& out, const std::string& step) {
  return out / "pipeline" / (step + ".json");
}

// hashes are named by their beginning, as people compare them
std::string Short(const std::string& value) {
  const bool hash =
      value.size() == 64 && value.find_first_not_of("0123456789abcdef") == std::string::npos;
  return hash ? value.substr(0, 12) : value;
}

std::string ValueOfInput(const StepInputs& inputs, const std::string& name) {
  const auto found = std::ranges::find(inputs, name, [](const auto& input) { return input.first; });
  return found == inputs.end() ? "" : found->second;
}

std::string Difference(const StepInputs& before, const StepInputs& now) {
  for (const auto& [name, value] : now) {
    const std::string old = ValueOfInput(before, name);
    if (old != value) return name + " changed: \"" + Short(old) + "\" -> \"" + Short(value) + "\"";
  }
  return "it no longer needs what it was made from";
}

void AddFiles(const fs::path& folder, const std::vector<std::string>& endings,
              std::vector<fs::path>& files) {
  if (!fs::is_directory(folder)) return;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    const bool wanted = !name.starts_with('.') && std::ranges::any_of(endings, [&](const auto& e) {
      return name.ends_with(e);
    });
    if (wanted && entry.is_regular_file()) files.push_back(entry.path());
  }
}

}  // namespace

std::string BuildThatFinished(const StepRecord& record) {
  return record.output_sha256.empty() ? "" : ValueOfInput(record.inputs, "build");
}

StepDecision Decide(const std::optional<StepRecord>& record, const StepInputs& inputs,
                    const std::string& output_sha256) {
  if (!record) return {StepAction::kStart, "it has not run yet"};
  if (record->inputs != inputs) return {StepAction::kRestart, Difference(record->inputs, inputs)};
  if (record->output_sha256.empty()) return {StepAction::kResume, "it was stopped"};
  if (output_sha256.empty()) return {StepAction::kRestart, "what it made is gone"};
  if (record->output_sha256 != output_sha256)
    return {StepAction::kRestart, "what it made has been changed since"};
  return {StepAction::kSkip, "nothing has changed"};
}

std::string HashOfRecords(const std::vector<std::string>& folders,
                          const std::vector<std::string>& endings) {
  Sha256 hash;
  bool any = false;
  for (const std::string& folder : folders) {
    std::vector<fs::path> files;
    AddFiles(folder, endings, files);
    std::ranges::sort(files);
    for (const fs::path& file : files) {
      any = true;
      hash.Update(file.lexically_relative(folder).generic_string() + '\n' + Sha256OfFile(file) +
                  '\n');
    }
  }
  return any ? hash.HexDigest() : "";
}

void WriteStepRecord(const fs::path& out, const std::string& step, const StepRecord& record) {
  Json inputs = Json::object();
  for (const auto& [name, value] : record.inputs) inputs[name] = value;
  WriteJsonFile(FileOf(out, step), {{"schema", kSchema},
                                    {"schema_version", kSchemaVersion},
                                    {"step", step},
                                    {"state", record.output_sha256.empty() ? "begun" : "done"},
                                    {"inputs", inputs},
                                    {"output_sha256", record.output_sha256}});
}

std::optional<StepRecord> ReadStepRecord(const fs::path& out, const std::string& step) {
  const fs::path file = FileOf(out, step);
  if (!fs::exists(file)) return std::nullopt;
  const std::string path = file.string();
  const Json json = ReadJsonFile(file);
  RequireSchema(json, kSchema, kSchemaVersion, path);
  StepRecord record;
  record.output_sha256 = ValueOf<std::string>(json, "output_sha256", path);
  const Json& inputs = MemberOf(json, "inputs", path);
  for (const auto& [name, value] : inputs.items())
    record.inputs.emplace_back(name, ValueOf<std::string>(inputs, name, path));
  return record;
}

void RemoveStepRecord(const fs::path& out, const std::string& step) {
  SystemFiles().Remove(FileOf(out, step));
}

}  // namespace doorforge
