// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "named_numbers.h"

#include <algorithm>
#include <cmath>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/config_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/nearest_name.h"

namespace doorforge::internal {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint64_t kMostBytes = 1ULL << 20U;

// Poses are typed by hand, with three or four decimals: what is so near to a unit quaternion means
// one. What is not is left to be refused.
Json WithUnitQuaternion(Json pose) {
  constexpr double kRounding = 1e-3;
  if (!pose.is_object() || !pose.contains("quaternion_xyzw")) return pose;
  Json& quaternion = pose["quaternion_xyzw"];
  double squares = 0;
  for (const Json& element : quaternion) {
    if (!element.is_number()) return pose;
    squares += std::pow(element.get<double>(), 2);
  }
  const double length = std::sqrt(squares);
  if (!(std::fabs(length - 1) <= kRounding)) return pose;
  for (Json& element : quaternion) element = element.get<double>() / length;
  return pose;
}

}  // namespace

Json ReadNamed(const std::filesystem::path& path) {
  std::string text = ReadFile(path, kMostBytes);
  // OpenCV's FileStorage begins with a directive that no YAML reader knows
  if (text.starts_with("%YAML:")) text.erase(0, std::min(text.find('\n'), text.size()));
  Json json = ParseYaml(text, path.string());
  if (!json.is_object())
    throw Error(ErrorCode::kInvalidConfig,
                path.string() + ": expected keys and values, such as \"width: ...\"");
  return json;
}

void NamedNumbers::RequireKnown(const std::vector<std::string>& known) const {
  for (const auto& [key, value] : json_.items()) {
    if (std::ranges::find(known, key) == known.end())
      Fail("unknown key \"" + key + "\"; did you mean \"" + NearestName(key, known) + "\"?");
  }
}

void NamedNumbers::Fail(const std::string& problem) const {
  throw Error(ErrorCode::kInvalidConfig, file_ + ": " + problem);
}

const Json& NamedNumbers::At(const std::string& key) const {
  if (!Has(key)) Fail("the key \"" + key + "\" is missing");
  return json_[key];
}

double NamedNumbers::Number(const std::string& key, double low, double high) const {
  const Json& value = At(key);
  const double number = value.is_number() ? value.get<double>() : NAN;
  if (!(number >= low && number <= high))
    Fail(key + ": found " + JsonText(value) + Format(", expected a number in [%g, %g]", low, high));
  return number;
}

int NamedNumbers::WholeNumber(const std::string& key, int low, int high) const {
  const double number = Number(key, low, high);
  if (number != std::floor(number)) Fail(key + ": expected a whole number");
  return static_cast<int>(number);
}

bool NamedNumbers::Flag(const std::string& key) const {
  if (!At(key).is_boolean()) Fail(key + ": expected true or false");
  return At(key).get<bool>();
}

std::string NamedNumbers::Word(const std::string& key) const {
  if (!At(key).is_string()) Fail(key + ": found " + JsonText(At(key)) + ", expected a word");
  return At(key).get<std::string>();
}

std::vector<double> NamedNumbers::Numbers(const std::string& key, std::size_t least,
                                          std::size_t most) const {
  const Json& value = At(key);
  const bool numbers = value.is_array() && std::ranges::all_of(value, [](const Json& element) {
                         return element.is_number() && std::isfinite(element.get<double>());
                       });
  if (!numbers || value.size() < least || value.size() > most)
    Fail(key + ": expected " + (least == most ? "" : std::to_string(least) + " to ") +
         std::to_string(most) + " numbers" +
         (value.is_array() ? ", found " + std::to_string(value.size()) : ""));
  return value.get<std::vector<double>>();
}

RigidTransform NamedNumbers::Pose(const std::string& key) const {
  try {
    return TransformFromJson(WithUnitQuaternion(At(key)), file_ + ": " + key);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::kInvalidConfig) throw;
    throw Error(ErrorCode::kInvalidConfig,
                std::string(error.what()) +
                    "; a pose is {position_m: [x, y, z], quaternion_xyzw: [x, y, z, w]}, the "
                    "quaternion of length 1 within 0.001");
  }
}

}  // namespace doorforge::internal
