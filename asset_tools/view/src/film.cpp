// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "film.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <numbers>

#include "doorforge/core/error.h"

namespace doorforge::internal {
namespace {

using Json = PageContent::Json;

void AppendFloat(double value, std::string& bytes) {
  const auto number = static_cast<float>(value);
  char raw[sizeof number];
  std::memcpy(raw, &number, sizeof number);
  bytes.append(raw, sizeof raw);
}

// Position and quaternion (xyzw) of each pose, in frames after one another.
std::string PoseBytes(const std::vector<FilmFrame>& frames) {
  std::string bytes;
  for (const FilmFrame& frame : frames) {
    for (const RigidTransform& pose : frame.poses) {
      for (const double number : pose.translation()) AppendFloat(number, bytes);
      const Eigen::Quaterniond turn(pose.linear());
      for (const double number : turn.coeffs()) AppendFloat(number, bytes);
    }
  }
  return bytes;
}

// Each frame gives its number of points, then all points in steps of a millimetre's tenth about the
// first frame's first, then their labels.
Json CloudForView(const std::vector<FilmFrame>& frames, int most, PageContent& content) {
  constexpr double kStep = 1e-4;  // [m]
  std::string points;
  std::string labels;
  Json counts = Json::array();
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  for (const FilmFrame& frame : frames) {
    const std::size_t size = frame.cloud.label.size();
    if (labels.empty() && size > 0)
      origin = {frame.cloud.xyz[0], frame.cloud.xyz[1], frame.cloud.xyz[2]};
    const auto stride = std::max<std::size_t>(
        1, (size + static_cast<std::size_t>(most) - 1) / static_cast<std::size_t>(most));
    std::size_t count = 0;
    for (std::size_t i = 0; i < size; i += stride, ++count) {
      for (std::size_t k = 0; k < 3; ++k) {
        const double steps =
            std::round((frame.cloud.xyz[3 * i + k] - origin[static_cast<Eigen::Index>(k)]) / kStep);
        const auto number = static_cast<std::int16_t>(std::clamp(steps, -32767.0, 32767.0));
        char raw[sizeof number];
        std::memcpy(raw, &number, sizeof number);
        points.append(raw, sizeof raw);
      }
      labels += static_cast<char>(frame.cloud.label[i]);
    }
    counts.push_back(count);
  }
  if (labels.empty()) return nullptr;
  return {{"counts", counts},
          {"origin", Vector3ToJson(origin)},
          {"step", kStep},
          {"points", content.AddBytes(points)["at"]},
          {"labels", content.AddBytes(labels)["at"]}};
}

// null where any frame has none
Json ForcesForView(const std::vector<FilmFrame>& frames,
                   std::optional<double> FilmFrame::*quantity) {
  Json forces = Json::array();
  for (const FilmFrame& frame : frames) {
    if (!(frame.*quantity)) return nullptr;
    forces.push_back(std::round(100 * *(frame.*quantity)) / 100);
  }
  return forces;
}

std::string NumberText(const char* format, double number) {
  char text[64];
  std::snprintf(text, sizeof text, format, number);
  return text;
}

// The greatest of a quantity over the instants.
double Greatest(const EpisodeFilm& record, double FilmInstant::*quantity) {
  double most = 0;
  for (const FilmInstant& instant : record.instants) most = std::max(most, instant.*quantity);
  return most;
}

FilmFrame FrameAtInstant(const FilmInstant& instant, const Scene& scene, const DoorAsset& door,
                         const RobotModel& robot) {
  const JointVector joints = Eigen::Map<const Eigen::VectorXd>(
      instant.robot.data(), static_cast<Eigen::Index>(instant.robot.size()));
  const RobotPose pose = robot.PoseAt(joints, scene.world_from_robot_base);
  auto links = DoorFromLinks(door, instant.hinge_rad, instant.handle_rad);
  for (RigidTransform& link : links) link = scene.world_from_door * link;
  FilmFrame frame;
  frame.time_s = instant.time_s;
  frame.phase = instant.phase;
  frame.hinge_rad = instant.hinge_rad;
  frame.handle_rad = instant.handle_rad;
  if (scene.latch.type == LatchType::kBolt) frame.bolt_m = instant.bolt_m;
  frame.poses = PosesOf(links, pose);
  frame.hand_m = pose.world_from_hand.translation();
  frame.asked_m = instant.asked_m;
  frame.force_n = instant.force_n;
  frame.net_force_n = instant.net_force_n;
  return frame;
}

}  // namespace

Film FilmOf(const EpisodeFilm& record, const DoorAsset& door, const RobotModel& robot) {
  Require(record.scene.robot.name == robot.name() && !record.instants.empty() &&
              record.instants[0].robot.size() == static_cast<std::size_t>(robot.joint_count()),
          ErrorCode::kInvalidArgument,
          door.id + ": the episode is of the robot \"" + record.scene.robot.name +
              "\"; name its URDF with --robot");
  constexpr double kDegrees = 180 / std::numbers::pi;
  Film film;
  film.title = door.id;
  film.opened = record.outcome == EpisodeOutcome::kOpened;
  film.facts = {
      {"Door", door.id},
      {"Outcome", std::string(NameOf(record.outcome))},
      {"Detail", record.detail},
      {"Seed, number",
       std::to_string(record.scene.seed) + ", " + std::to_string(record.scene.episode)},
      {"Greatest hinge angle",
       NumberText("%.1f deg", kDegrees * Greatest(record, &FilmInstant::hinge_rad))},
      {"Greatest handle angle",
       NumberText("%.1f deg", kDegrees * Greatest(record, &FilmInstant::handle_rad))},
      {"Greatest force shown", NumberText("%.0f N", Greatest(record, &FilmInstant::force_n))},
      {"Simulated", NumberText("%.1f s", record.instants.back().time_s)}};
  for (const FilmInstant& instant : record.instants)
    film.frames.push_back(FrameAtInstant(instant, record.scene, door, robot));
  return film;
}

std::vector<RigidTransform> PosesOf(const std::array<RigidTransform, 3>& door,
                                    const RobotPose& robot) {
  std::vector<RigidTransform> poses(door.begin(), door.end());
  poses.insert(poses.end(), robot.world_from_body.begin(), robot.world_from_body.end());
  poses.push_back(robot.world_from_base);
  return poses;
}

Json RobotForView(const RobotModel& robot, PageContent& content) {
  Json pieces = Json::array();
  for (const RobotPiece& piece : robot.visuals()) {
    const int body = piece.joint < 0 ? robot.joint_count() : piece.joint;
    const Eigen::Vector4d& c = piece.color_rgba;
    pieces.push_back({{"mesh", content.AddMesh(piece.mesh)},
                      {"color", {c[0], c[1], c[2], c[3]}},
                      {"body", body}});
  }
  return {{"bodies", robot.joint_count() + 1}, {"pieces", std::move(pieces)}};
}

Json FilmForView(const Film& film, int points, PageContent& content) {
  Json shown = {{"title", film.title}, {"opened", film.opened}, {"facts", film.facts}};
  for (const char* name : {"times", "phases", "hinge", "handle", "bolt", "hands", "asked"})
    shown[name] = Json::array();
  for (const FilmFrame& frame : film.frames) {
    shown["times"].push_back(frame.time_s);
    shown["phases"].push_back(frame.phase);
    shown["hinge"].push_back(frame.hinge_rad);
    shown["handle"].push_back(frame.handle_rad);
    shown["bolt"].push_back(frame.bolt_m ? Json(*frame.bolt_m) : Json(nullptr));
    shown["hands"].push_back(Vector3ToJson(frame.hand_m));
    shown["asked"].push_back(frame.asked_m ? Vector3ToJson(*frame.asked_m) : Json(nullptr));
  }
  shown["force"] = ForcesForView(film.frames, &FilmFrame::force_n);
  shown["net_force"] = ForcesForView(film.frames, &FilmFrame::net_force_n);
  shown["hidden"] = Json::object();
  for (const auto& [name, shares] : film.hidden) shown["hidden"][name] = shares;
  shown["poses"] = content.AddBytes(PoseBytes(film.frames))["at"];
  shown["cloud"] = points > 0 ? CloudForView(film.frames, points, content) : Json(nullptr);
  return shown;
}

}  // namespace doorforge::internal
