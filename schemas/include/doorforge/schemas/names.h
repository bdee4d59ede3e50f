// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

namespace doorforge {

/// The six categories of UniDoorManip, Table 1.
enum class Category { kInterior, kWindow, kCar, kSafe, kStorageFurniture, kRefrigerator };

/// A door is composed of one body (frame and leaf) and one handle.
enum class PartRole { kBody, kHandle };

/// How a handle releases the latch. kNone is a plain pull on a door without a latch.
enum class Mechanism { kNone, kLever, kRound, kKey, kValve, kFlap };

/// How the latch holds the leaf, see Latch in door_asset.h.
enum class LatchType { kNone, kEffort, kBolt };

/// Where the hinge is for who stands in front of the handle and looks at the leaf.
enum class HingeSide { kLeft, kRight };

/// Whether the leaf comes towards who stands in front of the handle, or goes away.
enum class Opening { kPull, kPush };

/// Names in files: "interior", "window", "car", "safe", "storagefurniture", "refrigerator".
std::string_view NameOf(Category category);
/// "body", "handle".
std::string_view NameOf(PartRole role);
/// "none", "lever", "round", "key", "valve", "flap".
std::string_view NameOf(Mechanism mechanism);
/// "none", "effort", "bolt".
std::string_view NameOf(LatchType type);
/// "left", "right".
std::string_view NameOf(HingeSide side);
/// "pull", "push".
std::string_view NameOf(Opening opening);

/// Inverse of NameOf; nothing if the name is unknown.
std::optional<Category> CategoryNamed(std::string_view name);
std::optional<PartRole> PartRoleNamed(std::string_view name);
std::optional<Mechanism> MechanismNamed(std::string_view name);
std::optional<LatchType> LatchTypeNamed(std::string_view name);
std::optional<HingeSide> HingeSideNamed(std::string_view name);
std::optional<Opening> OpeningNamed(std::string_view name);

}  // namespace doorforge
