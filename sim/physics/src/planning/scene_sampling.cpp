// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/physics/scene_sampling.h"

#include <algorithm>
#include <numbers>

#include "doorforge/core/error.h"
#include "doorforge/core/rng.h"

namespace doorforge {
namespace {

struct Range {
  double low;
  double high;
};

// Where UniDoorManip puts the grasp point of a closed door and the robot's base, in the world.
struct Placement {
  Range grasp_x;
  Range grasp_y;
  Range grasp_z;
  Eigen::Vector2d base;
  Eigen::Vector2d jitter;  ///< Along x and y.
};

Placement PlacementOf(Category category) {
  switch (category) {
    case Category::kInterior:
      return {{0.04, 0.12}, {0.16, 0.40}, {0.90, 1.11}, {0.70, 0}, {0.10, 0.15}};
    case Category::kWindow:
      return {{0.04, 0.13}, {0.21, 0.44}, {0.74, 1.04}, {0.65, 0}, {0.10, 0.10}};
    case Category::kCar:
      return {{0.02, 0.05}, {0.07, 0.09}, {0.80, 0.98}, {0.60, -0.10}, {0.10, 0.10}};
    case Category::kSafe:
      return {{0.02, 0.13}, {0, 0}, {0.83, 1.06}, {0.77, 0}, {0.08, 0.08}};
    case Category::kStorageFurniture:
      return {{0.03, 0.08}, {0, 0}, {0.74, 0.96}, {0.70, 0}, {0.10, 0.15}};
    case Category::kRefrigerator:
      return {{0.06, 0.11}, {-0.06, -0.04}, {0.84, 1.02}, {0.70, 0}, {0.10, 0.15}};
  }
  return {};
}

constexpr double kLeastHeight = 0.1;
constexpr double kBaseHeight = 0.1;

// The arm's way to a handle, from the grasp along x [m].
constexpr double kWayFrom = 0.1;
constexpr double kWayTo = 0.7;
constexpr double kHalfWay = 0.08;

constexpr double kPushLean = 0.35;         // [rad]
constexpr double kUprightPushLean = 0.9;   // [rad] about a handle that stands upright
constexpr double kMostHeightJitter = 0.5;  // [m] beyond it the arm reaches few handles

double ClippedNormal(Rng& rng) { return std::clamp(0.5 * rng.Normal(), -1.0, 1.0); }

double ShiftInto(const Range& range, double value) {
  return std::clamp(value, range.low, range.high) - value;
}

// A door hinged right stands where the mirror image of one hinged left would.
Placement PlacementOf(const DoorAsset& door) {
  Placement placement = PlacementOf(door.category);
  if (door.hinge_side == HingeSide::kLeft) return placement;
  placement.grasp_y = {-placement.grasp_y.high, -placement.grasp_y.low};
  placement.base.y() = -placement.base.y();
  return placement;
}

Eigen::Vector3d GraspInDoor(const DoorAsset& door) {
  return (DoorFromLinks(door, 0, 0)[kHandleLink] * door.handle_from_grasp).translation();
}

// Whoever pushes a cupboard's door stands in the cupboard.
void RequireFreeWay(const DoorAsset& door) {
  const Eigen::Vector3d grasp = GraspInDoor(door);
  const Eigen::AlignedBox3d way(grasp + Eigen::Vector3d(kWayFrom, -kHalfWay, -kHalfWay),
                                grasp + Eigen::Vector3d(kWayTo, kHalfWay, kHalfWay));
  for (const DoorGeometry& geometry : door.links[kBaseLink].geometry) {
    for (const TriangleMesh& hull : geometry.hulls) {
      Eigen::AlignedBox3d box;
      for (const Eigen::Vector3d& vertex : hull.vertices) box.extend(vertex);
      if (!way.intersects(box)) continue;
      throw Error(ErrorCode::kInvalidArgument,
                  "scene: door \"" + door.id + "\": its \"" + geometry.name + "\" is " +
                      std::to_string(std::max(0.0, box.min().x() - grasp.x())) +
                      " m in front of the handle, where the arm has to reach through; a body like "
                      "this cannot be pushed open, compose it with opening: pull");
    }
  }
}

RigidTransform PlaceDoor(const DoorAsset& door, const Placement& placement) {
  const Eigen::Vector3d grasp = GraspInDoor(door);
  const double lift = kLeastHeight + ShiftInto(placement.grasp_z, grasp.z() + kLeastHeight);
  return Translation({ShiftInto(placement.grasp_x, grasp.x()),
                      ShiftInto(placement.grasp_y, grasp.y()), std::max(lift, kLeastHeight)});
}

RigidTransform PlaceRobot(const Placement& placement, double jitter, Rng rng) {
  const double x = placement.base.x() + jitter * placement.jitter.x() * ClippedNormal(rng);
  const double y = placement.base.y() + jitter * placement.jitter.y() * ClippedNormal(rng);
  return Translation({x, y, kBaseHeight}) *
         RotationAbout(Eigen::Vector3d::UnitZ(), std::numbers::pi);
}

RigidTransform GraspNoise(const DoorAsset& door, double scale, Rng rng) {
  const double turn = scale * ClippedNormal(rng) * std::numbers::pi / 18;
  const bool along = door.mechanism == Mechanism::kLever || door.mechanism == Mechanism::kFlap;
  const double shift = along ? scale * ClippedNormal(rng) * door.grasp_half_extent_m.x() : 0;
  return Translation({shift, 0, 0}) * RotationAbout(Eigen::Vector3d::UnitZ(), turn);
}

// Who pushes follows the handle through the doorway, past the jamb on the handle's side. So the
// hand leans away from the jamb, about the pads' normal; and on a knob, which has no up or down,
// the wide hand stands upright half way through the turn. Across a handle that stands upright the
// wide hand would meet the jamb: it leans about the handle, and straightens with the leaf.
RigidTransform ClearOfTheJamb(const DoorAsset& door) {
  const Eigen::Matrix3d grasp = door.handle_from_grasp.linear();
  const double to_hinge = door.hinge_side == HingeSide::kLeft ? -1 : 1;
  if (IsPushedUpright(door))
    return RigidTransform(RotationAbout(
        Eigen::Vector3d::UnitX(), kUprightPushLean * to_hinge * std::copysign(1, grasp(2, 0))));
  const double turn = door.mechanism == Mechanism::kRound ? door.latch.handle_done_angle_rad : 0;
  return RotationAbout(Eigen::Vector3d::UnitZ(),
                       -turn / 2 * door.handle_joint.axis.dot(grasp.col(2))) *
         RotationAbout(Eigen::Vector3d::UnitY(), -kPushLean * to_hinge * grasp(1, 0));
}

// Ranges of "strong"; docs/design/simulation.md says where they come from.
constexpr Range kHandleFriction{1, 1.5};
constexpr Range kSpring{0.58, 1.33};
constexpr Range kUnlockAngle{0.77, 1.03};
constexpr Range kMass{0.7, 1.3};
constexpr Range kDamping{0.7, 1.4};
constexpr double kCameraShift = 0.05;  // [m] along each axis
constexpr double kTargetShift = 0.03;
constexpr double kArmShift = 0.05;  // [rad] of each joint

double Draw(const Range& range, Rng& rng) { return rng.Uniform(range.low, range.high); }

Eigen::Vector3d DrawShift(double most, Rng& rng) {
  const double x = rng.Uniform(-most, most);
  const double y = rng.Uniform(-most, most);
  return {x, y, rng.Uniform(-most, most)};
}

void VaryLatch(Latch& latch, Rng rng) {
  latch.hinge_spring_nm_per_rad *= Draw(kSpring, rng);
  latch.handle_spring_nm_per_rad *= Draw(kSpring, rng);
  latch.unlock_angle_rad =
      std::min(latch.unlock_angle_rad * Draw(kUnlockAngle, rng), latch.handle_done_angle_rad);
}

void VaryDoor(Scene& scene, Rng rng) {
  scene.physics.handle_friction *= Draw(kHandleFriction, rng);
  scene.variation.leaf_mass = Draw(kMass, rng);
  scene.variation.handle_mass = Draw(kMass, rng);
  scene.variation.hinge_damping = Draw(kDamping, rng);
  scene.variation.handle_damping = Draw(kDamping, rng);
}

void VaryView(Scene& scene, Rng rng) {
  scene.camera.position_m += DrawShift(kCameraShift, rng);
  scene.camera.target_m += DrawShift(kTargetShift, rng);
}

double HeightShift(const SceneConfig& config, Rng rng) {
  Require(config.height_jitter_m >= 0 && config.height_jitter_m <= kMostHeightJitter,
          ErrorCode::kInvalidConfig, "config.scene.height_jitter_m: out of 0..0.5");
  return rng.Uniform(-config.height_jitter_m, config.height_jitter_m);
}

// How much of the paper's own jitter there is.
double PaperShare(const SceneConfig& config) {
  return config.randomisation == Randomisation::kOff ? 0 : 1;
}

Latch LatchOf(const DoorAsset& door, const SceneConfig& config) {
  Latch latch = door.latch;
  if (config.latch == SceneLatch::kNone) latch.type = LatchType::kNone;
  return latch;
}

Eigen::Vector3d PointOf(const std::vector<double>& numbers, const std::string& name) {
  if (numbers.size() != 3)
    throw Error(ErrorCode::kInvalidConfig,
                "config.scene.camera." + name + ": found " + std::to_string(numbers.size()) +
                    " numbers, expected the 3 of a point, such as [1.8, 0, 1.8]");
  return {numbers[0], numbers[1], numbers[2]};
}

void RequireCamera(bool good, const std::string& problem) {
  if (!good) throw Error(ErrorCode::kInvalidConfig, "config.scene.camera." + problem);
}

}  // namespace

CameraModel CameraOf(const CameraConfig& config) {
  CameraModel camera;
  camera.position_m = PointOf(config.position_m, "position_m");
  camera.target_m = PointOf(config.target_m, "target_m");
  camera.width = config.width;
  camera.height = config.height;
  camera.horizontal_fov_rad = config.horizontal_fov_rad;
  const Eigen::Vector3d view = camera.target_m - camera.position_m;
  RequireCamera(view.head<2>().norm() > 1e-3,
                "target_m: lies at, above or below position_m; let the camera look aside");
  RequireCamera(config.width > 0 && config.height > 0, "width, height: must be positive");
  RequireCamera(config.horizontal_fov_rad > 0 && config.horizontal_fov_rad < std::numbers::pi,
                "horizontal_fov_rad: must lie in (0, pi)");
  return camera;
}

bool IsPushedUpright(const DoorAsset& door) {
  constexpr double kUpright = 0.7;  // share of the grasp's axis along the handle that is vertical
  return door.opening == Opening::kPush && door.mechanism != Mechanism::kRound &&
         std::abs(door.handle_from_grasp.linear()(2, 0)) > kUpright;
}

namespace {

/// Which scene of a door.
struct SceneDraw {
  std::uint64_t seed;
  std::uint64_t episode;
};

Scene Sample(const DoorAsset& door, const std::string& door_sha256, const SceneDraw& draw,
             const SceneConfig& config) {
  RequireSimulatable(door, "scene");
  if (door.opening == Opening::kPush) RequireFreeWay(door);
  const std::string stream = "scene/" + door.id + "/" + std::to_string(draw.episode) + "/";
  const Placement placement = PlacementOf(door);
  const double share = PaperShare(config);
  Scene scene;
  scene.door_id = door.id;
  scene.door_sha256 = door_sha256;
  scene.seed = draw.seed;
  scene.episode = draw.episode;
  scene.world_from_door = PlaceDoor(door, placement);
  scene.world_from_door.translation().z() += HeightShift(config, Rng(draw.seed, stream + "height"));
  scene.world_from_robot_base =
      PlaceRobot(placement, share * config.base_jitter, Rng(draw.seed, stream + "base"));
  scene.latch = LatchOf(door, config);
  scene.grasp_from_noisy_grasp =
      GraspNoise(door, share * config.grasp_noise, Rng(draw.seed, stream + "grasp"));
  if (door.opening == Opening::kPush)
    scene.grasp_from_noisy_grasp = scene.grasp_from_noisy_grasp * ClearOfTheJamb(door);
  scene.physics = config.physics;
  CheckEpisodeLimits(config.episode, "config.scene.episode");
  scene.limits = config.episode;
  scene.camera = CameraOf(config.camera);
  scene.appearance = config.appearance;
  if (config.randomisation != Randomisation::kStrong) return scene;
  VaryLatch(scene.latch, Rng(draw.seed, stream + "latch"));
  VaryDoor(scene, Rng(draw.seed, stream + "door"));
  VaryView(scene, Rng(draw.seed, stream + "camera"));
  Rng start(draw.seed, stream + "start");
  for (double& offset : scene.arm_start_offset_rad) offset = start.Uniform(-kArmShift, kArmShift);
  return scene;
}

}  // namespace

Scene SampleScene(const DoorAsset& door, std::uint64_t seed, std::uint64_t episode,
                  const SceneConfig& config) {
  return Sample(door, ContentHash(door), {seed, episode}, config);
}

Scene SampleScene(const IdentifiedDoor& door, std::uint64_t seed, std::uint64_t episode,
                  const SceneConfig& config) {
  return Sample(*door, door.sha256, {seed, episode}, config);
}

}  // namespace doorforge
