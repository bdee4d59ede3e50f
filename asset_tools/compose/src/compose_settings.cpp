// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "compose_settings.h"

#include <array>
#include <cmath>

#include <nlohmann/json.hpp>

#include "doorforge/core/closed_mesh.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/record_id.h"
#include "doorforge/core/rng.h"

namespace doorforge {
namespace {

constexpr std::array kRules = {
    ComposeRule{"CMP001", "a door is one body and one handle"},
    ComposeRule{"CMP002", "both are of one category"},
    ComposeRule{"CMP003", "the body has a leaf, the handle a grip"},
    ComposeRule{"CMP004", "the handle's back is not larger than the leaf"},
    ComposeRule{"CMP005", "the leaf has a surface behind the handle's back"},
    ComposeRule{"CMP006", "only what one passes or looks through is pushed: interior, window"},
    ComposeRule{"CMP007", "a latch needs a handle that turns"},
    ComposeRule{"CMP008", "the wanted place of the handle is on the leaf"},
    ComposeRule{"CMP009", "the licence of each part is one of license_allow"},
    ComposeRule{"CMP010", "a mirrored or turned handle reaches at most 10 mm beyond the leaf"},
    ComposeRule{"CMP011", "the author's place is that of one imported object"},
    ComposeRule{"CMP012", "what turns the other way is a lever, a knob, a key or a wheel"},
};

constexpr std::array kJointSources = {
    ComposePreset{"paper",
                  "springs 3 and 3 N m/rad: UniDoorManip, Section 3.2; damping 0.5 and 0.05 N m s: "
                  "doorforge, docs/design/simulation.md"},
    ComposePreset{"unidoormanip",
                  "springs 3 and 3 N m/rad, no damping: the released simulator of UniDoorManip"},
    ComposePreset{
        "doorgym",
        "DoorGym's generator: hinge damping 1 to 2 N m s, spring 0.1 to 0.2 N m/rad; knob "
        "damping 1 to 2, spring 1 to 1.5"},
};

constexpr std::array kMassSources = {
    ComposePreset{"part",
                  "the parts' own masses: finishes of the catalogue, or densities of usual "
                  "constructions, docs/design/door.md"},
    ComposePreset{"unidoormanip",
                  "1000 kg/m3 everywhere: the engine's default that UniDoorManip's released "
                  "simulator leaves in place"},
    ComposePreset{"doorgym",
                  "DoorGym's generator: leaf 300 kg/m3, knob 1 kg; the frame is the "
                  "part's own"},
};

struct Range {
  double low;
  double high;
};

struct JointRanges {
  Range hinge_spring;
  Range handle_spring;
  Range hinge_damping;
  Range handle_damping;
};

// in the order of JointPreset
constexpr std::array kJointRanges = {
    JointRanges{{3, 3}, {3, 3}, {0.5, 0.5}, {0.05, 0.05}},
    JointRanges{{3, 3}, {3, 3}, {0, 0}, {0, 0}},
    JointRanges{{0.1, 0.2}, {1, 1.5}, {1, 2}, {1, 2}},
};

std::string Text(double value) { return JsonText(value); }

[[noreturn]] void Fail(const std::string& name, const std::string& found,
                       const std::string& allowed) {
  throw Error(ErrorCode::kInvalidConfig,
              "config." + name + ": found " + found + ", allowed " + allowed);
}

void CheckRange(const char* name, double value, const Range& range) {
  if (!(value >= range.low && value <= range.high))
    Fail(name, Text(value), Text(range.low) + " to " + Text(range.high));
}

// 0 or -1 leave the choice to others
void CheckUnless(const char* name, double value, double unset, const Range& range) {
  if (value == unset) return;
  if (!(value >= range.low && value <= range.high))
    Fail(name, Text(value), Text(unset) + " or " + Text(range.low) + " to " + Text(range.high));
}

template <class Preset>
std::string WithSource(Preset preset, std::span<const ComposePreset> sources) {
  return std::string(NameOf(preset)) + " (" +
         std::string(sources[static_cast<std::size_t>(preset)].source) + ")";
}

MassProperties Scaled(MassProperties mass, double factor) {
  mass.mass_kg *= factor;
  mass.inertia_kg_m2 *= factor;
  return mass;
}

void CheckPlace(const ComposeConfig& config) {
  if (config.place != HandlePlace::kAuthor && config.place != HandlePlace::kAxis) return;
  const std::string moved = internal::MovesTheHandle(config);
  if (!moved.empty())
    Fail("place", '"' + std::string(NameOf(config.place)) + "\" together with " + moved,
         "auto or seat where the handle or the leaf is changed");
}

}  // namespace

std::span<const ComposeRule> ComposeRules() { return kRules; }
std::span<const ComposePreset> JointPresets() { return kJointSources; }
std::span<const ComposePreset> MassPresets() { return kMassSources; }

std::string ComposeRulesText() {
  std::string text;
  for (const ComposeRule& rule : ComposeRules())
    text += std::string(rule.code) + " " + std::string(rule.text) + "\n";
  const auto list = [&](const std::string& key, std::span<const ComposePreset> presets) {
    for (const ComposePreset& preset : presets)
      text += key + ": " + std::string(preset.name) + "  " + std::string(preset.source) + "\n";
  };
  list("masses", MassPresets());
  list("joints", JointPresets());
  return text;
}

namespace internal {

void CheckComposeConfig(const ComposeConfig& config) {
  CheckUnless("leaf_width_m", config.leaf_width_m, 0, {0.1, 4});
  CheckUnless("leaf_height_m", config.leaf_height_m, 0, {0.1, 4});
  CheckUnless("handle_height_m", config.handle_height_m, 0, {0.01, 4});
  CheckUnless("backset_m", config.backset_m, 0, {0.005, 4});
  CheckRange("handle_scale", config.handle_scale, {0.5, 2});
  CheckPlace(config);
  const int turn = config.handle_turn_deg;
  if (turn != 0 && turn != 90 && turn != 180 && turn != 270)
    Fail("handle_turn_deg", std::to_string(turn), "0, 90, 180, 270");
  CheckUnless("unlock_angle_rad", config.unlock_angle_rad, 0, {0.01, 6.283});
  CheckUnless("handle_done_angle_rad", config.handle_done_angle_rad, 0, {0.01, 6.283});
  CheckRange("lock_effort_nm", config.lock_effort_nm, {0, 1000});
  if (config.relatch && config.unlocks_ajar) Fail("unlocks_ajar", "true", "false with relatch");
  CheckRange("bolt_throw_m", config.bolt_throw_m, {0.002, 0.03});
  CheckUnless("hinge_spring_nm_per_rad", config.hinge_spring_nm_per_rad, -1, {0, 1000});
  CheckUnless("handle_spring_nm_per_rad", config.handle_spring_nm_per_rad, -1, {0, 1000});
  CheckUnless("hinge_damping_nm_s", config.hinge_damping_nm_s, -1, {0, 1000});
  CheckUnless("handle_damping_nm_s", config.handle_damping_nm_s, -1, {0, 1000});
}

std::string MovesTheHandle(const ComposeConfig& config) {
  if (config.leaf_width_m > 0) return "leaf_width_m";
  if (config.leaf_height_m > 0) return "leaf_height_m";
  if (config.handle_height_m > 0) return "handle_height_m";
  if (config.backset_m > 0) return "backset_m";
  if (config.handle_scale != 1) return "handle_scale";
  if (config.handle_mirrored) return "handle_mirrored";
  if (config.handle_turn_deg != 0) return "handle_turn_deg";
  return config.seed != 0 ? "seed" : "";
}

void RefusePair(std::string_view code, const std::string& why) {
  for (const ComposeRule& rule : kRules) {
    if (rule.code == code)
      throw Error(ErrorCode::kInvalidArgument,
                  "compose: " + std::string(code) + " " + std::string(rule.text) + ": " + why);
  }
  throw Error(ErrorCode::kInvalidArgument, "compose: " + why);
}

JointNumbers JointNumbersOf(const ComposeConfig& config, const std::string& pair) {
  const JointRanges& ranges = kJointRanges.at(static_cast<std::size_t>(config.joints));
  const auto number = [&](double wanted, const Range& range, const char* name) {
    if (wanted >= 0) return wanted;
    if (config.seed == 0) return (range.low + range.high) / 2;
    return Rng(config.seed, "compose/" + pair + "/" + name).Uniform(range.low, range.high);
  };
  return {number(config.hinge_spring_nm_per_rad, ranges.hinge_spring, "hinge_spring"),
          number(config.handle_spring_nm_per_rad, ranges.handle_spring, "handle_spring"),
          number(config.hinge_damping_nm_s, ranges.hinge_damping, "hinge_damping"),
          number(config.handle_damping_nm_s, ranges.handle_damping, "handle_damping")};
}

MassProperties PresetMass(const PartPiece& piece, PartRole role, MassPreset preset) {
  const double mass = piece.mass.mass_kg;
  if (preset == MassPreset::kPart || !(mass > 0)) return piece.mass;
  const double volume = MeasureTopology(piece.mesh).volume_m3;
  if (preset == MassPreset::kUniDoorManip) return Scaled(piece.mass, 1000 * volume / mass);
  if (role == PartRole::kHandle) return Scaled(piece.mass, 1 / mass);
  return piece.name == "leaf" ? Scaled(piece.mass, 300 * volume / mass) : piece.mass;
}

std::string PhysicsSourceOf(const ComposeConfig& config) {
  const std::string text = "masses " + WithSource(config.masses, kMassSources) + "; joints " +
                           WithSource(config.joints, kJointSources);
  const bool set = config.hinge_spring_nm_per_rad >= 0 || config.handle_spring_nm_per_rad >= 0 ||
                   config.hinge_damping_nm_s >= 0 || config.handle_damping_nm_s >= 0;
  return set ? text + ", some numbers set by hand" : text;
}

std::string DoorIdOf(const std::string& body, const std::string& handle,
                     const ComposeConfig& config) {
  if (!config.id.empty()) {
    const std::string problem = IdProblem(config.id);
    Require(problem.empty(), ErrorCode::kInvalidConfig, "config.id: " + problem);
    return config.id;
  }
  std::string id = body + "__" + handle;
  if (config.hinge_side == HingeSide::kRight) id += "__right";
  if (config.opening == Opening::kPush) id += "__push";
  if (config.handle_mirrored) id += "__mirrored";
  if (config.handle_sense == HandleSense::kReversed) id += "__reversed";
  if (config.handle_turn_deg != 0) id += "__turned" + std::to_string(config.handle_turn_deg);
  if (config.seed != 0) id += "__s" + std::to_string(config.seed);
  const std::string problem = IdProblem(id);
  Require(problem.empty(), ErrorCode::kInvalidConfig,
          "config.id: is made of the parts' names, and these are long: " + problem + "; give one");
  return id;
}

double DrawnFactor(const ComposeConfig& config, const std::string& stream) {
  return config.seed == 0 ? 1 : Rng(config.seed, "compose/" + stream).Uniform(0.95, 1.05);
}

}  // namespace internal

std::string NameOfPair(const std::string& body, const std::string& handle,
                       const ComposeConfig& config) {
  try {
    return internal::DoorIdOf(body, handle, config);
  } catch (const Error&) {
    return body + "__" + handle;
  }
}
}  // namespace doorforge
