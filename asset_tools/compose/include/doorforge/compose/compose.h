// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "doorforge/core/named_enum.h"
#include "doorforge/schemas/door_asset.h"
#include "doorforge/schemas/part.h"

namespace doorforge {

/// Where the handle goes.
enum class HandlePlace {
  kAuto,    ///< kAxis for parts of one object that no other setting moves or stretches, else kSeat.
  kSeat,    ///< The handle sits at the body's mount, its back laid on the leaf's surface.
  kPlane,   ///< It sits there too, with the plane x = 0 of its frame on the surface.
  kAuthor,  ///< It is exactly where it was on the object that both parts were imported from.
  kAxis,  ///< It is about the axis that it had there, slid along it to where that leaves the leaf.
};
inline constexpr NamedValue<HandlePlace> kHandlePlaces[] = {{HandlePlace::kAuto, "auto"},
                                                            {HandlePlace::kSeat, "seat"},
                                                            {HandlePlace::kPlane, "plane"},
                                                            {HandlePlace::kAuthor, "author"},
                                                            {HandlePlace::kAxis, "axis"}};
constexpr std::span<const NamedValue<HandlePlace>> ValuesOf(HandlePlace) { return kHandlePlaces; }

/// Which latch a composed door has.
enum class LatchChoice {
  kAuto,    ///< kEffort where a mechanism turns, else kNone.
  kNone,    ///< The leaf is free.
  kEffort,  ///< See LatchType::kEffort.
  kBolt,    ///< See LatchType::kBolt.
};
inline constexpr NamedValue<LatchChoice> kLatchChoices[] = {{LatchChoice::kAuto, "auto"},
                                                            {LatchChoice::kNone, "none"},
                                                            {LatchChoice::kEffort, "effort"},
                                                            {LatchChoice::kBolt, "bolt"}};
constexpr std::span<const NamedValue<LatchChoice>> ValuesOf(LatchChoice) { return kLatchChoices; }

/// Which way a handle turns to unlock.
enum class HandleSense {
  kAsMade,    ///< It turns the way that its author made it turn: levers go down.
  kReversed,  ///< It turns the other way, which nobody sees from its shape: levers go up.
};
inline constexpr NamedValue<HandleSense> kHandleSenses[] = {{HandleSense::kAsMade, "as_made"},
                                                            {HandleSense::kReversed, "reversed"}};
constexpr std::span<const NamedValue<HandleSense>> ValuesOf(HandleSense) { return kHandleSenses; }

/// Where springs and damping come from, see JointPresets().
enum class JointPreset { kPaper, kUniDoorManip, kDoorGym };
inline constexpr NamedValue<JointPreset> kJointPresets[] = {
    {JointPreset::kPaper, "paper"},
    {JointPreset::kUniDoorManip, "unidoormanip"},
    {JointPreset::kDoorGym, "doorgym"}};
constexpr std::span<const NamedValue<JointPreset>> ValuesOf(JointPreset) { return kJointPresets; }

/// Where densities come from, see MassPresets().
enum class MassPreset { kPart, kUniDoorManip, kDoorGym };
inline constexpr NamedValue<MassPreset> kMassPresets[] = {
    {MassPreset::kPart, "part"},
    {MassPreset::kUniDoorManip, "unidoormanip"},
    {MassPreset::kDoorGym, "doorgym"}};
constexpr std::span<const NamedValue<MassPreset>> ValuesOf(MassPreset) { return kMassPresets; }

/// How a door differs from what the authors of its parts made. Where a number is "0: as ..." or
/// "-1: by preset", any other value replaces what the parts, the category or the preset say.
struct ComposeConfig {
  std::string id = {};  ///< Empty: "<body id>__<handle id>", with what was changed behind it.
  double leaf_width_m =
      0;  ///< The body is stretched along y until its leaf is so wide; 0: as made.
  double leaf_height_m = 0;  ///< So it is along z.
  double handle_height_m =
      0;                    ///< Above the body's lowest point; 0: where the body's author put it.
  double backset_m = 0;     ///< Handle to free edge of the leaf; 0: as the body's author put it.
  double handle_scale = 1;  ///< 0.5 to 2, alike in all directions.
  HandlePlace place = HandlePlace::kAuto;
  HingeSide hinge_side = HingeSide::kLeft;
  Opening opening = Opening::kPull;
  bool handle_mirrored = false;  ///< A lever then points the other way.
  HandleSense handle_sense = HandleSense::kAsMade;
  int handle_turn_deg = 0;  ///< 0, 90, 180, 270, about x.
  LatchChoice latch = LatchChoice::kAuto;
  double unlock_angle_rad = 0;       ///< 0: the category's share of the handle's range.
  double handle_done_angle_rad = 0;  ///< 0: the same.
  double lock_effort_nm = 150;
  bool relatch = false;
  bool unlocks_ajar = false;  ///< The released code's latch; see Latch. Not together with relatch.
  double bolt_throw_m = 0.012;  ///< 0.002 to 0.03.
  JointPreset joints = JointPreset::kPaper;
  double hinge_spring_nm_per_rad = -1;  ///< -1: by preset, as the three below.
  double handle_spring_nm_per_rad = -1;
  double hinge_damping_nm_s = -1;
  double handle_damping_nm_s = -1;
  MassPreset masses = MassPreset::kPart;
  /// SPDX expressions that a part may have; empty: any.
  std::vector<std::string> license_allow = {};
  /// Not 0: leaf width and height (of each body) and handle height (of each pair) vary by +-5 %
  /// unless set, and a preset's ranges are drawn from instead of their middles.
  std::uint64_t seed = 0;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("id", self.id);
    visit("leaf_width_m", self.leaf_width_m);
    visit("leaf_height_m", self.leaf_height_m);
    visit("handle_height_m", self.handle_height_m);
    visit("backset_m", self.backset_m);
    visit("handle_scale", self.handle_scale);
    visit("place", self.place);
    visit("hinge_side", self.hinge_side);
    visit("opening", self.opening);
    visit("handle_mirrored", self.handle_mirrored);
    visit("handle_sense", self.handle_sense);
    visit("handle_turn_deg", self.handle_turn_deg);
    visit("latch", self.latch);
    visit("unlock_angle_rad", self.unlock_angle_rad);
    visit("handle_done_angle_rad", self.handle_done_angle_rad);
    visit("lock_effort_nm", self.lock_effort_nm);
    visit("relatch", self.relatch);
    visit("unlocks_ajar", self.unlocks_ajar);
    visit("bolt_throw_m", self.bolt_throw_m);
    visit("joints", self.joints);
    visit("hinge_spring_nm_per_rad", self.hinge_spring_nm_per_rad);
    visit("handle_spring_nm_per_rad", self.handle_spring_nm_per_rad);
    visit("hinge_damping_nm_s", self.hinge_damping_nm_s);
    visit("handle_damping_nm_s", self.handle_damping_nm_s);
    visit("masses", self.masses);
    visit("license_allow", self.license_allow);
    visit("seed", self.seed);
  }
};

/// [kg m^2] What a handle turns with at least, about every axis: a lighter one makes a step of
/// 1/240 s unstable under a stiff grasp. The missing rest is added to the grip's inertia.
inline constexpr double kMinimumHandleInertia = 5e-4;

/// Why a body and a handle are no door. Codes are never reused; docs/compose.md lists the same.
struct ComposeRule {
  std::string_view code;
  std::string_view text;  ///< What holds when the rule is met.
};
std::span<const ComposeRule> ComposeRules();

/// A preset with the source of its numbers; those of each kind are in the order of their enum.
struct ComposePreset {
  std::string_view name;
  std::string_view source;
};
std::span<const ComposePreset> JointPresets();
std::span<const ComposePreset> MassPresets();

/// The rules of pairs and the presets for people, one a line.
std::string ComposeRulesText();

/// A part with everything that composing needs of it alone, worked out once: its content hash, the
/// part as the config changes it, the leaf's surface or the handle's back, the meshes as doors
/// share them. Copies share what they hold.
class PreparedPart {
 public:
  struct State;

  /// Throws Error(kInvalidConfig) on a config value out of range and Error(kInvalidArgument), with
  /// the rule, on a part that no door can have.
  PreparedPart(const Part& part, const ComposeConfig& config);

  const std::string& id() const;
  const std::string& source_sha256() const;
  PartRole role() const;
  Category category() const;
  const State& state() const { return *state_; }

 private:
  std::shared_ptr<const State> state_;
};

/// Puts a handle on a body of the same category, whatever both come from.
///
/// Where the handle goes is `config.place`. Seated, it goes to the body's mount (or to
/// `handle_height_m` and `backset_m`). It is moved along x until its back rests on the leaf's real
/// surface as seen from outside, so that it is neither buried nor afloat, and in the leaf's plane
/// by as much as its back would reach beyond the leaf's outline. Latch, thresholds and range follow
/// LatchOf(). Hinged right: both parts are mirrored across y. Pushed: the body is mirrored across x
/// and the handle sits on the face that is in front then. Deterministic.
///
/// @param body_from_handle Where the author of an object that gave both parts had the handle, see
///     author_place.h; parts as they were made. Of a door that is pushed it counts only where its
///     mirror image across x is in front of the leaf, as of parts that come from a pushed door.
/// @throws Error(kInvalidArgument) that begins with the code of the rule if the two are no door;
///     Error(kInvalidConfig) on a config value out of range.
DoorAsset ComposeDoor(const Part& body, const Part& handle, const ComposeConfig& config,
                      const std::optional<RigidTransform>& body_from_handle = std::nullopt);

/// What messages call the door of a pair that is not composed: the id that it would have, or the
/// names of its parts where those make no id.
std::string NameOfPair(const std::string& body, const std::string& handle,
                       const ComposeConfig& config);

/// A door whose meshes lie in the pool that WriteMeshPool() writes: the texts of its two files.
struct SharedDoor {
  std::string id;
  std::string door_json;
  std::string urdf;
};

/// Composes the door that ComposeDoor() makes of the same parts and config: read back, it has the
/// same content hash. Both parts were prepared with `config`. Throws as ComposeDoor().
SharedDoor ComposeSharedDoor(const PreparedPart& body, const PreparedPart& handle,
                             const ComposeConfig& config,
                             const std::optional<RigidTransform>& body_from_handle = std::nullopt);

}  // namespace doorforge
