// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/config_file.h"

#include <cctype>
#include <charconv>

#include <yaml-cpp/yaml.h>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"

namespace doorforge {
namespace {

using Json = nlohmann::ordered_json;

template <class T>
bool ParseNumber(const std::string& text, T& number) {
  const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(begin, end, number);
  return error == std::errc{} && stop == end && begin != end;
}

// YAML has them, but no setting here can mean them.
bool IsNoFiniteNumber(std::string text) {
  if (text.starts_with('+') || text.starts_with('-')) text.erase(0, 1);
  for (char& letter : text) letter = static_cast<char>(std::tolower(letter));
  return text == ".nan" || text == ".inf" || text == "nan" || text == "inf" || text == "infinity";
}

std::string LineOf(const YAML::Node& node) {
  return "line " + std::to_string(node.Mark().line + 1);
}

Json FromScalar(const YAML::Node& node) {
  const std::string& text = node.Scalar();
  if (node.Tag() == "!") return text;  // quoted
  if (IsNoFiniteNumber(text))
    throw Error(ErrorCode::kInvalidConfig, LineOf(node) + ": found " + text +
                                               ", expected a finite number (or \"" + text +
                                               "\" in quotes, if it is a name)");
  if (text == "true" || text == "True") return true;
  if (text == "false" || text == "False") return false;
  std::int64_t integer = 0;
  if (ParseNumber(text, integer)) return integer;
  double number = 0;
  if (ParseNumber(text, number)) return number;
  return text;
}

// A tree of a text may be far larger than the text, as names of nodes (anchors) may be used again
// and again, even inside themselves.
constexpr int kMaxYamlDepth = 64;
constexpr int kMaxYamlNodes = 100'000;

class YamlTree {
 public:
  Json Expand(const YAML::Node& node, int depth = 0) {
    if (depth > kMaxYamlDepth) Refuse(node, "nested deeper than", kMaxYamlDepth, "levels");
    if (++nodes_ > kMaxYamlNodes) Refuse(node, "more than", kMaxYamlNodes, "values");
    if (node.IsScalar()) return FromScalar(node);
    if (node.IsSequence()) {
      Json array = Json::array();
      for (const auto& element : node) array.push_back(Expand(element, depth + 1));
      return array;
    }
    if (!node.IsMap()) return nullptr;
    Json object = Json::object();
    for (const auto& entry : node) {
      if (!entry.first.IsScalar())
        throw Error(ErrorCode::kInvalidConfig, LineOf(entry.first) + ": expected a name as key");
      object[entry.first.Scalar()] = Expand(entry.second, depth + 1);
    }
    return object;
  }

 private:
  [[noreturn]] static void Refuse(const YAML::Node& node, const char* what, int allowed,
                                  const char* of) {
    throw Error(ErrorCode::kInvalidConfig,
                LineOf(node) + ": " + what + " the " + std::to_string(allowed) + " " + of +
                    " allowed; an alias (*name) counts as what it names");
  }

  int nodes_ = 0;
};

}  // namespace

Json ParseYaml(std::string_view text, const std::string& name) {
  try {
    return YamlTree().Expand(YAML::Load(std::string(text)));
  } catch (const YAML::Exception& error) {
    std::string place = name + ": ";
    if (!error.mark.is_null())
      place += "line " + std::to_string(error.mark.line + 1) + ", column " +
               std::to_string(error.mark.column + 1) + ": ";
    throw Error(ErrorCode::kInvalidConfig, place + "not YAML: " + error.msg);
  } catch (const Error& error) {
    throw Error(error.code(), name + ": " + error.what());
  }
}

Json ParseSettings(const std::vector<std::string>& settings) {
  Json root = Json::object();
  for (const std::string& setting : settings) {
    const std::size_t equals = setting.find('=');
    if (equals == std::string::npos || equals == 0)
      throw Error(ErrorCode::kInvalidConfig, "--set " + setting + ": expected key=value");
    Json* node = &root;
    std::size_t begin = 0;
    for (std::size_t dot = setting.find('.'); dot < equals; dot = setting.find('.', begin)) {
      node = &(*node)[setting.substr(begin, dot - begin)];
      begin = dot + 1;
      if (!node->is_null() && !node->is_object())
        throw Error(ErrorCode::kInvalidConfig, "--set " + setting + ": " + setting.substr(0, dot) +
                                                   " was given the value " + JsonText(*node) +
                                                   " before, which has no parts; give one of them");
    }
    (*node)[setting.substr(begin, equals - begin)] =
        ParseYaml(setting.substr(equals + 1), "--set " + setting);
  }
  return root;
}

std::string internal::WithConfigName(const std::string& path, const Error& error) {
  const std::string what = error.what();
  const std::string subject = what.substr(0, what.find(": "));
  // another file than the settings', or an option, is named already
  const bool is_named = subject.find('/') != std::string::npos || subject.ends_with(".yaml") ||
                        subject.starts_with("--");
  if (error.code() != ErrorCode::kInvalidConfig || is_named) return what;
  return (path.empty() ? "--set" : path) + ": " + what;
}

Json internal::ReadConfigFile(const std::filesystem::path& path) {
  Json json = ParseYaml(ReadFile(path, 1ULL << 20), path.string());
  return json.is_null() ? Json::object() : json;
}

}  // namespace doorforge
