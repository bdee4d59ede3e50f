// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "files/file_frame.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string_view>

#include <nlohmann/json.hpp>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"

namespace doorforge {
namespace {

using Json = nlohmann::json;

constexpr double kLengthTolerance = 0.01;  // of a rotation: exporters write single precision

[[noreturn]] void Fail(const std::string& problem) { throw Error(ErrorCode::kFormat, problem); }

std::string WithoutComments(std::string text) {
  for (std::size_t at = 0; (at = text.find("<!--", at)) != std::string::npos;) {
    const std::size_t end = text.find("-->", at);
    text.erase(at, end == std::string::npos ? std::string::npos : end + 3 - at);
  }
  return text;
}

std::string_view Trimmed(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r\n";
  const std::size_t first = text.find_first_not_of(kSpace);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kSpace) + 1 - first);
}

// Between two marks; nothing where they are not there.
std::string_view Between(std::string_view text, std::string_view before, std::string_view after) {
  const std::size_t at = text.find(before);
  if (at == std::string_view::npos) return {};
  text.remove_prefix(at + before.size());
  return text.substr(0, text.find(after));
}

// The document's <asset> comes first in it; those of its parts speak of the parts.
std::string AssetOf(const std::string& text) {
  const std::size_t end = text.find("</asset>");
  return end == std::string::npos ? "" : WithoutComments(text.substr(0, end));
}

std::string_view AttributeOf(std::string_view element, const std::string& name) {
  for (const char quote : {'"', '\''}) {
    const std::string_view value = Between(element, name + '=' + quote, std::string(1, quote));
    if (value.data() != nullptr) return value;
  }
  return {};
}

double ColladaUnit(std::string_view asset) {
  const std::string_view text = Trimmed(AttributeOf(Between(asset, "<unit", ">"), "meter"));
  if (text.empty()) return 1;
  double metres = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), metres);
  const bool number = error == std::errc{} && end == text.data() + text.size();
  if (!number || !std::isfinite(metres) || metres <= 0)
    Fail("<unit>: meter=\"" + std::string(text) +
         "\", allowed a number above 0; export the file again with a unit");
  return metres;
}

// The text of the file's tree: all of a glTF, the first chunk of a GLB.
std::string_view TreeOf(std::string_view content) {
  constexpr std::size_t kHeader = 20;  // magic, version, length; the chunk's length and kind
  if (!content.starts_with("glTF")) return content;
  if (content.size() < kHeader) return {};
  std::uint32_t bytes = 0;
  std::memcpy(&bytes, content.data() + 12, sizeof bytes);
  return content.substr(kHeader, bytes);
}

std::string NodeName(const Json& node, std::size_t index) {
  const auto name = node.find("name");
  const std::string number = "node " + std::to_string(index);
  return name != node.end() && name->is_string() ? number + " \"" + name->get<std::string>() + '"'
                                                 : number;
}

void RefuseRotation(const Json& node, std::size_t index) {
  const auto rotation = node.find("rotation");
  if (rotation == node.end() || !rotation->is_array()) return;
  double square = 0;
  for (const Json& number : *rotation) {
    if (!number.is_number()) return;
    square += number.get<double>() * number.get<double>();
  }
  if (std::abs(std::sqrt(square) - 1) <= kLengthTolerance) return;
  Fail(NodeName(node, index) + ": its rotation is a quaternion of length " +
       Json(std::sqrt(square)).dump() + ", allowed 1; export the file again");
}

}  // namespace

FileFrame FrameOfGltf() { return {.up = "y", .front = "z", .unit_m = 1, .states_unit = true}; }

FileFrame FrameOfCollada(const std::string& text) {
  const std::string asset = AssetOf(text);
  const std::string_view up = Trimmed(Between(asset, "<up_axis>", "<"));
  const double metres = ColladaUnit(asset);
  if (up == "X_UP") return {.up = "x", .front = "z", .unit_m = metres, .states_unit = true};
  if (up == "Z_UP") return {.up = "z", .front = "-y", .unit_m = metres, .states_unit = true};
  if (!up.empty() && up != "Y_UP")
    Fail("<up_axis>: \"" + std::string(up) + "\" is no axis; allowed are X_UP, Y_UP and Z_UP");
  return {.up = "y", .front = "z", .unit_m = metres, .states_unit = true};
}

void RefuseGltfRotations(const std::filesystem::path& path, const MeshImportLimits& limits) {
  const std::string content = ReadFile(path, limits.max_file_bytes);
  const Json tree = Json::parse(TreeOf(content), nullptr, false);
  if (!tree.is_object()) return;
  const auto nodes = tree.find("nodes");
  if (nodes == tree.end() || !nodes->is_array()) return;
  for (std::size_t i = 0; i < nodes->size(); ++i) {
    if ((*nodes)[i].is_object()) RefuseRotation((*nodes)[i], i);
  }
}

}  // namespace doorforge
