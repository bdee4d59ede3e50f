// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "doorforge/core/named_enum.h"

namespace doorforge {

/// The six categories of UniDoorManip, Table 1.
enum class Category { kInterior, kWindow, kCar, kSafe, kStorageFurniture, kRefrigerator };
inline constexpr NamedValue<Category> kCategories[] = {
    {Category::kInterior, "interior"},
    {Category::kWindow, "window"},
    {Category::kCar, "car"},
    {Category::kSafe, "safe"},
    {Category::kStorageFurniture, "storagefurniture"},
    {Category::kRefrigerator, "refrigerator"}};
constexpr std::span<const NamedValue<Category>> ValuesOf(Category) { return kCategories; }

/// A door is composed of one body (frame and leaf) and one handle.
enum class PartRole { kBody, kHandle };
inline constexpr NamedValue<PartRole> kPartRoles[] = {{PartRole::kBody, "body"},
                                                      {PartRole::kHandle, "handle"}};
constexpr std::span<const NamedValue<PartRole>> ValuesOf(PartRole) { return kPartRoles; }

/// How a handle releases the latch. kNone is a plain pull on a door without a latch.
enum class Mechanism { kNone, kLever, kRound, kKey, kValve, kFlap };
inline constexpr NamedValue<Mechanism> kMechanisms[] = {
    {Mechanism::kNone, "none"}, {Mechanism::kLever, "lever"}, {Mechanism::kRound, "round"},
    {Mechanism::kKey, "key"},   {Mechanism::kValve, "valve"}, {Mechanism::kFlap, "flap"}};
constexpr std::span<const NamedValue<Mechanism>> ValuesOf(Mechanism) { return kMechanisms; }

/// How the latch holds the leaf, see Latch in door_asset.h.
enum class LatchType { kNone, kEffort, kBolt };
inline constexpr NamedValue<LatchType> kLatchTypes[] = {
    {LatchType::kNone, "none"}, {LatchType::kEffort, "effort"}, {LatchType::kBolt, "bolt"}};
constexpr std::span<const NamedValue<LatchType>> ValuesOf(LatchType) { return kLatchTypes; }

/// Where the hinge is for who stands in front of the handle and looks at the leaf.
enum class HingeSide { kLeft, kRight };
inline constexpr NamedValue<HingeSide> kHingeSides[] = {{HingeSide::kLeft, "left"},
                                                        {HingeSide::kRight, "right"}};
constexpr std::span<const NamedValue<HingeSide>> ValuesOf(HingeSide) { return kHingeSides; }

/// Whether the leaf comes towards who stands in front of the handle, or goes away.
enum class Opening { kPull, kPush };
inline constexpr NamedValue<Opening> kOpenings[] = {{Opening::kPull, "pull"},
                                                    {Opening::kPush, "push"}};
constexpr std::span<const NamedValue<Opening>> ValuesOf(Opening) { return kOpenings; }

/// The value that a word in a file stands for, as NameOf() writes it; nothing if it is unknown.
inline std::optional<Category> CategoryNamed(std::string_view name) {
  return ValueNamed<Category>(name);
}
/// Throws Error(kInvalidArgument) that names `option` and the categories, unless `word` is one.
void RequireCategory(const std::string& option, const std::string& word);
inline std::optional<PartRole> PartRoleNamed(std::string_view name) {
  return ValueNamed<PartRole>(name);
}
inline std::optional<Mechanism> MechanismNamed(std::string_view name) {
  return ValueNamed<Mechanism>(name);
}
inline std::optional<LatchType> LatchTypeNamed(std::string_view name) {
  return ValueNamed<LatchType>(name);
}
inline std::optional<HingeSide> HingeSideNamed(std::string_view name) {
  return ValueNamed<HingeSide>(name);
}
inline std::optional<Opening> OpeningNamed(std::string_view name) {
  return ValueNamed<Opening>(name);
}

}  // namespace doorforge
