// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "compose_command.h"

#include "doorforge/core/config_io.h"
#include "doorforge/core/json_file.h"

namespace doorforge::internal {
namespace {

using Json = nlohmann::ordered_json;

// For a POSIX shell.
std::string Quoted(const std::string& word) {
  const bool plain = word.find_first_not_of(
                         "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=") ==
                     std::string::npos;
  if (plain && !word.empty()) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string Text(const Json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

// It writes the value as --set reads it, which takes 7 and true for no words.
std::string Setting(const Json& value) {
  const std::string text = Text(value);
  const bool is_word = text.find_first_not_of("abcdefghijklmnopqrstuvwxyz_") == std::string::npos &&
                       text != "true" && text != "false" && text != "null";
  return is_word ? text : value.dump();
}

// The entries that are not as they are by default.
Json Changed(const Json& chosen, const Json& standard) {
  Json changed = Json::object();
  for (const auto& [key, value] : chosen.items()) {
    if (value != standard[key]) changed[key] = value;
  }
  return changed;
}

Json ChangedMesh(const LooseMeshConfig& mesh) {
  return Changed(ToJson(mesh), ToJson(LooseMeshConfig{}));
}

std::string MeshOptions(const std::string& prefix, const LooseMeshConfig& mesh) {
  std::string options;
  const Json changed = ChangedMesh(mesh);
  for (const auto& [key, value] : changed.items()) {
    options += " --" + prefix + (key == "size_m" ? "size" : key);
    // with "=", since an axis such as -y looks like an option
    if (!value.is_array()) options += '=' + Quoted(Text(value));
    if (!value.is_array()) continue;
    for (const Json& number : value) options += ' ' + Quoted(Text(number));
  }
  return options;
}

std::string PartsOption(const std::filesystem::path& parts) {
  return parts.empty() ? "" : " --parts " + Quoted(parts.string());
}

}  // namespace

std::string CommandOf(const ComposeRequest& request, const std::filesystem::path& parts) {
  std::string command =
      "doorforge compose --body " + Quoted(request.body) + MeshOptions("body-", request.body_mesh);
  command += " --handle " + Quoted(request.handle) + MeshOptions("handle-", request.handle_mesh);
  if (!request.category.empty()) command += " --category " + Quoted(request.category);
  command += std::string(" --out ") + kCommandOut + PartsOption(parts);
  const Json settings = Changed(ToJson(request.door), ToJson(ComposeConfig{}));
  for (const auto& [key, value] : settings.items())
    command += " --set " + Quoted(key + "=" + Setting(value));
  return command;
}

// Every value is written as JSON, which YAML takes.
std::string YamlOf(const ComposeRequest& request, const std::filesystem::path& parts) {
  Json entries = Changed(ToJson(request), ToJson(ComposeRequest{}));
  for (const auto& [key, mesh] :
       {std::pair("body_mesh", &request.body_mesh), {"handle_mesh", &request.handle_mesh}}) {
    if (entries.contains(key)) entries[key] = ChangedMesh(*mesh);
  }
  std::string yaml = std::string("# doorforge compose --config door.yaml --out ") + kCommandOut +
                     PartsOption(parts) + "\n";
  for (const auto& [key, value] : entries.items()) yaml += key + ": " + value.dump() + "\n";
  return yaml;
}

}  // namespace doorforge::internal
