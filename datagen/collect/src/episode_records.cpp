// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "episode_records.h"

#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"

namespace doorforge {
namespace {

using Json = nlohmann::ordered_json;

Json RowsOf(const RigidTransform& transform) {
  Json rows = Json::array();
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = 0; column < 4; ++column)
      rows.push_back(transform.matrix()(row, column));
  }
  return rows;
}

RigidTransform TransformOf(const Json& rows, const std::string& path) {
  constexpr std::size_t kCount = 12;
  if (!rows.is_array() || rows.size() != kCount)
    throw Error(ErrorCode::kFormat, path + ": expected 12 numbers");
  RigidTransform transform = RigidTransform::Identity();
  for (std::size_t i = 0; i < kCount; ++i) {
    if (!rows[i].is_number()) throw Error(ErrorCode::kFormat, path + ": expected 12 numbers");
    transform.matrix()(static_cast<Eigen::Index>(i / 4), static_cast<Eigen::Index>(i % 4)) =
        rows[i].get<double>();
  }
  return transform;
}

}  // namespace

Json CameraRecord(const CameraModel& camera) {
  Json matrix = Json::array();
  const Eigen::Matrix3d intrinsics = IntrinsicMatrix(camera);
  for (Eigen::Index row = 0; row < 3; ++row)
    matrix.push_back({intrinsics(row, 0), intrinsics(row, 1), intrinsics(row, 2)});
  return {{"intrinsic_matrix_px", matrix},
          {"world_from_camera", TransformToJson(WorldFromCamera(camera))}};
}

Json DoorRecord(const DoorAsset& door) {
  return {{"id", door.id},
          {"category", NameOf(door.category)},
          {"mechanism", NameOf(door.mechanism)},
          {"body", IdentityToJson(door.body)},
          {"handle", IdentityToJson(door.handle)},
          {"license", door.license}};
}

Json PosesRecord(const Scene& scene) {
  return {{"world_from_door_rows", RowsOf(scene.world_from_door)},
          {"world_from_robot_base_rows", RowsOf(scene.world_from_robot_base)}};
}

void ReadPoses(const Json& meta, const std::string& path, Scene& scene) {
  const std::string where = path + ".poses";
  const Json& poses = MemberOf(meta, "poses", path);
  scene.world_from_door = TransformOf(MemberOf(poses, "world_from_door_rows", where), where);
  scene.world_from_robot_base =
      TransformOf(MemberOf(poses, "world_from_robot_base_rows", where), where);
}

}  // namespace doorforge
