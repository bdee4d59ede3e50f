// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doors/latch_json.h"

#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"

namespace doorforge::internal {

nlohmann::ordered_json LatchToJson(const Latch& latch) {
  nlohmann::ordered_json json = {{"type", NameOf(latch.type)},
                                 {"unlock_angle_rad", latch.unlock_angle_rad},
                                 {"handle_done_angle_rad", latch.handle_done_angle_rad},
                                 {"lock_effort_nm", latch.lock_effort_nm},
                                 {"hinge_spring_nm_per_rad", latch.hinge_spring_nm_per_rad},
                                 {"handle_spring_nm_per_rad", latch.handle_spring_nm_per_rad},
                                 {"relatch", latch.relatch}};
  if (latch.unlocks_ajar) json["unlocks_ajar"] = true;  // records of before are as they were
  if (latch.type == LatchType::kBolt) json["bolt_throw_m"] = latch.bolt_throw_m;
  return json;
}

Latch LatchFromJson(const nlohmann::ordered_json& json, const std::string& path) {
  Latch latch;
  const auto type = LatchTypeNamed(ValueOf<std::string>(json, "type", path));
  if (!type) throw Error(ErrorCode::kFormat, path + ".type: unknown latch type");
  latch.type = *type;
  latch.unlock_angle_rad = ValueOf<double>(json, "unlock_angle_rad", path);
  latch.handle_done_angle_rad = ValueOf<double>(json, "handle_done_angle_rad", path);
  latch.lock_effort_nm = ValueOf<double>(json, "lock_effort_nm", path);
  latch.hinge_spring_nm_per_rad = ValueOf<double>(json, "hinge_spring_nm_per_rad", path);
  latch.handle_spring_nm_per_rad = ValueOf<double>(json, "handle_spring_nm_per_rad", path);
  latch.relatch = ValueOf<bool>(json, "relatch", path);
  if (json.contains("unlocks_ajar")) latch.unlocks_ajar = ValueOf<bool>(json, "unlocks_ajar", path);
  if (latch.type == LatchType::kBolt)
    latch.bolt_throw_m = ValueOf<double>(json, "bolt_throw_m", path);
  return latch;
}

}  // namespace doorforge::internal
