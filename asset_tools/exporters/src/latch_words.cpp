// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "latch_words.h"

#include "export_text.h"

namespace doorforge::internal {

std::vector<std::pair<std::string, std::string>> LatchWords(const DoorAsset& door) {
  const Latch& latch = door.latch;
  const auto truth = [](bool is) { return std::string(is ? "true" : "false"); };
  return {{"type", std::string(NameOf(latch.type))},
          {"unlock_angle_rad", Decimal(latch.unlock_angle_rad)},
          {"handle_done_angle_rad", Decimal(latch.handle_done_angle_rad)},
          {"lock_effort_nm", Decimal(latch.lock_effort_nm)},
          {"hinge_spring_nm_per_rad", Decimal(latch.hinge_spring_nm_per_rad)},
          {"handle_spring_nm_per_rad", Decimal(latch.handle_spring_nm_per_rad)},
          {"relatch", truth(latch.relatch)},
          {"unlocks_ajar", truth(latch.unlocks_ajar)},
          {"bolt_throw_m", Decimal(latch.bolt_throw_m)}};
}

std::vector<std::pair<std::string, std::string>> DoorWords(const DoorAsset& door) {
  return {{"id", door.id},
          {"category", std::string(NameOf(door.category))},
          {"mechanism", std::string(NameOf(door.mechanism))},
          {"hinge_side", std::string(NameOf(door.hinge_side))},
          {"opening", std::string(NameOf(door.opening))},
          {"license", door.license}};
}

}  // namespace doorforge::internal
