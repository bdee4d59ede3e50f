// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/names.h"

#include <array>

namespace doorforge {
namespace {

constexpr std::array<std::string_view, 6> kCategories = {
    "interior", "window", "car", "safe", "storagefurniture", "refrigerator"};
constexpr std::array<std::string_view, 2> kRoles = {"body", "handle"};
constexpr std::array<std::string_view, 6> kMechanisms = {"none", "lever", "round",
                                                         "key",  "valve", "flap"};
constexpr std::array<std::string_view, 3> kLatchTypes = {"none", "effort", "bolt"};
constexpr std::array<std::string_view, 2> kHingeSides = {"left", "right"};
constexpr std::array<std::string_view, 2> kOpenings = {"pull", "push"};

template <class Enum, class Names>
std::optional<Enum> Find(const Names& names, std::string_view name) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == name) return static_cast<Enum>(i);
  }
  return std::nullopt;
}

}  // namespace

std::string_view NameOf(Category category) {
  return kCategories.at(static_cast<std::size_t>(category));
}
std::string_view NameOf(PartRole role) { return kRoles.at(static_cast<std::size_t>(role)); }
std::string_view NameOf(Mechanism mechanism) {
  return kMechanisms.at(static_cast<std::size_t>(mechanism));
}
std::string_view NameOf(LatchType type) { return kLatchTypes.at(static_cast<std::size_t>(type)); }
std::string_view NameOf(HingeSide side) { return kHingeSides.at(static_cast<std::size_t>(side)); }
std::string_view NameOf(Opening opening) { return kOpenings.at(static_cast<std::size_t>(opening)); }

std::optional<Category> CategoryNamed(std::string_view name) {
  return Find<Category>(kCategories, name);
}
std::optional<PartRole> PartRoleNamed(std::string_view name) {
  return Find<PartRole>(kRoles, name);
}
std::optional<Mechanism> MechanismNamed(std::string_view name) {
  return Find<Mechanism>(kMechanisms, name);
}
std::optional<LatchType> LatchTypeNamed(std::string_view name) {
  return Find<LatchType>(kLatchTypes, name);
}
std::optional<HingeSide> HingeSideNamed(std::string_view name) {
  return Find<HingeSide>(kHingeSides, name);
}
std::optional<Opening> OpeningNamed(std::string_view name) {
  return Find<Opening>(kOpenings, name);
}

}  // namespace doorforge
