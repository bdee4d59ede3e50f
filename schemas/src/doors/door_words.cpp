// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/door_words.h"

#include <charconv>
#include <cmath>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

std::string WordOf(double number) {
  char digits[32];
  // + 0.0 turns -0 into 0
  return {digits, std::to_chars(digits, digits + sizeof digits, number + 0.0).ptr};
}

std::string WordOf(bool is) { return is ? "true" : "false"; }

/// Words of one record, each of which must be there.
class LatchReader {
 public:
  LatchReader(const std::map<std::string, std::string>& words, const std::string& where)
      : words_(words), where_(where) {}

  std::string Word(const std::string& name) const {
    const auto word = words_.find("latch_" + name);
    if (word == words_.end()) Fail(name, "is missing");
    return word->second;
  }

  double Number(const std::string& name) const {
    const std::string word = Word(name);
    double number = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc{} || end != word.data() + word.size() || !std::isfinite(number))
      Fail(name, "is \"" + word + "\", which is no finite number");
    return number;
  }

  bool Truth(const std::string& name) const {
    const std::string word = Word(name);
    if (word != "true" && word != "false")
      Fail(name, "is \"" + word + "\", allowed are true and false");
    return word == "true";
  }

  [[noreturn]] void Fail(const std::string& name, const std::string& problem) const {
    throw Error(ErrorCode::kFormat, where_ + ": the latch's " + name + " " + problem);
  }

 private:
  const std::map<std::string, std::string>& words_;
  const std::string& where_;
};

}  // namespace

std::vector<std::pair<std::string, std::string>> LatchWords(const Latch& latch) {
  return {{"type", std::string(NameOf(latch.type))},
          {"unlock_angle_rad", WordOf(latch.unlock_angle_rad)},
          {"handle_done_angle_rad", WordOf(latch.handle_done_angle_rad)},
          {"lock_effort_nm", WordOf(latch.lock_effort_nm)},
          {"hinge_spring_nm_per_rad", WordOf(latch.hinge_spring_nm_per_rad)},
          {"handle_spring_nm_per_rad", WordOf(latch.handle_spring_nm_per_rad)},
          {"relatch", WordOf(latch.relatch)},
          {"unlocks_ajar", WordOf(latch.unlocks_ajar)},
          {"bolt_throw_m", WordOf(latch.bolt_throw_m)}};
}

std::vector<std::pair<std::string, std::string>> DoorWords(const DoorAsset& door) {
  return {{"id", door.id},
          {"category", std::string(NameOf(door.category))},
          {"mechanism", std::string(NameOf(door.mechanism))},
          {"hinge_side", std::string(NameOf(door.hinge_side))},
          {"opening", std::string(NameOf(door.opening))},
          {"license", door.license}};
}

std::optional<Latch> LatchFromWords(const std::map<std::string, std::string>& words,
                                    const std::string& where) {
  if (!words.contains("latch_type")) return std::nullopt;
  const LatchReader read(words, where);
  const auto type = LatchTypeNamed(read.Word("type"));
  if (!type) read.Fail("type", "is \"" + read.Word("type") + "\", which is unknown");
  return Latch{.type = *type,
               .unlock_angle_rad = read.Number("unlock_angle_rad"),
               .handle_done_angle_rad = read.Number("handle_done_angle_rad"),
               .lock_effort_nm = read.Number("lock_effort_nm"),
               .hinge_spring_nm_per_rad = read.Number("hinge_spring_nm_per_rad"),
               .handle_spring_nm_per_rad = read.Number("handle_spring_nm_per_rad"),
               .relatch = read.Truth("relatch"),
               .unlocks_ajar = read.Truth("unlocks_ajar"),
               .bolt_throw_m = read.Number("bolt_throw_m")};
}

}  // namespace doorforge
