// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/pictures/take_pictures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <thread>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/physics/scene_sampling.h"
#include "doorforge/pictures/scene_colors.h"
#include "doorforge/rollout/base_placement.h"
#include "doorforge/rollout/camera_observer.h"
#include "doorforge/rollout/remembered_view.h"
#include "doorforge/rollout/run_episode.h"
#include "doorforge/schemas/npy.h"

#include "../physics/primitive_door.h"

namespace doorforge {
namespace {

// A door ajar before a robot, seen by a camera that stands and one on the hand.
struct Setting {
  RobotModel robot = LoadMobileFranka();
  DoorAsset door = MakePrimitiveDoor({});
  Scene scene = PlaceRobotBase(robot, SampleScene(door, 1, 0), door);
  PicturesConfig config;

  Setting() {
    config.cameras.resize(2);
    config.cameras[0].name = "front";
    config.cameras[0].position_m = {1.9, 0.9, 1.4};
    config.cameras[1].name = "wrist";
    config.cameras[1].at = CameraPlace::kHand;
    for (PictureCamera& camera : config.cameras) {
      camera.width = 40;
      camera.height = 30;
    }
    config.streams = {PictureStream::kDepth, PictureStream::kDepth32, PictureStream::kLabel,
                      PictureStream::kLink, PictureStream::kNormal};
  }

  PictureLook LookAt(double hinge_rad) const {
    PictureLook look;
    look.snapshot.robot = robot.PoseAt(StartPosition(scene, robot), scene.world_from_robot_base);
    look.snapshot.door = DoorFromLinks(door, hinge_rad, 0.1);
    for (RigidTransform& pose : look.snapshot.door) pose = scene.world_from_door * pose;
    CameraObserver camera(scene, door, robot);
    look.depth = camera.Render(look.snapshot).depth;
    return look;
  }

  Pictures Take(const std::vector<PictureLook>& looks) const {
    return TakePictures({scene, door, robot, true, scene.camera}, config, looks);
  }
};

const std::string& BytesOf(const Pictures& pictures, const std::string& member) {
  const auto found = std::ranges::find(pictures.members, member, &MemberBytes::name);
  EXPECT_NE(found, pictures.members.end()) << member;
  return found->bytes;
}

template <class T>
std::vector<T> ArrayOf(const Pictures& pictures, const std::string& member,
                       const std::vector<std::size_t>& shape) {
  const std::string& bytes = BytesOf(pictures, member);
  const NpyHeader header = ParseNpyHeader(std::as_bytes(std::span(bytes)), member);
  EXPECT_EQ(header.type, NpyTypeOf<T>());
  EXPECT_EQ(header.shape, shape) << member;
  std::vector<T> values((bytes.size() - header.data_offset) / sizeof(T));
  std::memcpy(values.data(), bytes.data() + header.data_offset, values.size() * sizeof(T));
  return values;
}

RigidTransform PoseIn(const std::vector<double>& rows, std::size_t look) {
  RigidTransform pose = RigidTransform::Identity();
  for (std::size_t i = 0; i < 12; ++i)
    pose.matrix()(static_cast<Eigen::Index>(i / 4), static_cast<Eigen::Index>(i % 4)) =
        rows[12 * look + i];
  return pose;
}

struct Hit {
  double depth;
  int link;
  PointLabel label;
  Eigen::Vector3d normal;
};

// Moeller and Trumbore, of every triangle there is.
std::optional<Hit> NearestHit(const std::vector<VisibleMesh>& world, const Eigen::Vector3d& origin,
                              const Eigen::Vector3d& direction) {
  std::optional<Hit> nearest;
  for (const VisibleMesh& mesh : world) {
    for (const Eigen::Vector3i& triangle : mesh.mesh.triangles) {
      const auto corner = [&](int i) {
        return mesh.mesh.vertices[static_cast<std::size_t>(triangle[i])];
      };
      const Eigen::Vector3d a = corner(1) - corner(0);
      const Eigen::Vector3d b = corner(2) - corner(0);
      const Eigen::Vector3d p = direction.cross(b);
      const double determinant = a.dot(p);
      if (determinant == 0) continue;
      const Eigen::Vector3d from = origin - corner(0);
      const double u = from.dot(p) / determinant;
      const Eigen::Vector3d q = from.cross(a);
      const double v = direction.dot(q) / determinant;
      const double depth = b.dot(q) / determinant;
      if (u < 0 || v < 0 || u + v > 1 || depth <= 0) continue;
      if (nearest && nearest->depth <= depth) continue;
      Eigen::Vector3d normal = a.cross(b).normalized();
      if (normal.dot(direction) > 0) normal = -normal;
      nearest = Hit{depth, mesh.link, mesh.label, normal};
    }
  }
  return nearest;
}

std::vector<VisibleMesh> InWorld(const Setting& setting, const SceneSnapshot& snapshot) {
  std::vector<VisibleMesh> meshes = VisibleMeshesOf(setting.door, setting.robot);
  const std::vector<RigidTransform> poses = LinkPosesOf(snapshot);
  for (VisibleMesh& mesh : meshes) {
    for (Eigen::Vector3d& vertex : mesh.mesh.vertices)
      vertex = poses[static_cast<std::size_t>(mesh.link)] * vertex;
  }
  return meshes;
}

// Where two surfaces meet in a pixel's centre, rounding decides between them.
TEST(TakePictures, AreWhatRaysMeetThatAreCastAtEveryTriangle) {
  const Setting setting;
  const PictureLook look = setting.LookAt(0.5);
  const Pictures pictures = setting.Take({look});
  const std::vector<VisibleMesh> world = InWorld(setting, look.snapshot);
  for (const PictureCamera& camera : setting.config.cameras) {
    const std::string& name = camera.name;
    const auto depth32 = ArrayOf<float>(pictures, "depth32_" + name + ".npy", {1, 30, 40});
    const auto depth = ArrayOf<std::uint16_t>(pictures, "depth_" + name + ".npy", {1, 30, 40});
    const auto label = ArrayOf<std::uint8_t>(pictures, "label_" + name + ".npy", {1, 30, 40});
    const auto link = ArrayOf<std::uint8_t>(pictures, "link_" + name + ".npy", {1, 30, 40});
    const auto normal = ArrayOf<std::int8_t>(pictures, "normal_" + name + ".npy", {1, 30, 40, 3});
    const RigidTransform pose =
        PoseIn(ArrayOf<double>(pictures, "pose_" + name + ".npy", {1, 3, 4}), 0);
    const double focal = 20 / std::tan(camera.horizontal_fov_rad / 2);
    EXPECT_NEAR(pictures.record.at(name).at("intrinsic_matrix_px")[0][0].get<double>(), focal,
                1e-9);
    int seen = 0;
    int different = 0;
    for (std::size_t i = 0; i < depth.size(); ++i) {
      const Eigen::Vector3d in_camera((static_cast<double>(i % 40) + 0.5 - 20) / focal,
                                      (static_cast<double>(i / 40) + 0.5 - 15) / focal, 1);
      const auto hit = NearestHit(world, pose.translation(), pose.linear() * in_camera);
      const double found = static_cast<double>(depth32[i]);
      if (!hit) {
        different += link[i] != kNothingSeen || depth[i] != 0 || found != 0 ? 1 : 0;
        continue;
      }
      ++seen;
      const Eigen::Vector3d stored(normal[3 * i], normal[3 * i + 1], normal[3 * i + 2]);
      const bool same = std::fabs(hit->depth - found) < 1e-4 && link[i] == hit->link &&
                        label[i] == static_cast<std::uint8_t>(hit->label) &&
                        (stored / 127 - hit->normal).norm() < 0.02;
      different += same ? 0 : 1;
      if (same) {
        EXPECT_EQ(depth[i], std::lround(1000 * found));
      }
    }
    EXPECT_GT(seen, 150) << name;
    EXPECT_LE(different, 6) << name;
  }
}

// What docs/images.md tells users to compute; nothing here may be reordered or left out by a
// compiler that takes several numbers at once.
Eigen::Vector3d BackProjected(const RigidTransform& pose, double x, double y, double depth) {
  const Eigen::Matrix4d& m = pose.matrix();
  const volatile float rounded = static_cast<float>(m(2, 0) * x + (m(2, 1) * y + m(2, 2)));
  const Eigen::Vector3d direction((m(0, 0) * x + m(0, 1) * y) + m(0, 2),
                                  (m(1, 0) * x + m(1, 1) * y) + m(1, 2),
                                  static_cast<double>(rounded));
  return pose.translation() + depth * direction;
}

TEST(TakePictures, OfTheScenesCameraGiveItsCloud) {
  Setting setting;
  setting.config.cameras.resize(1);
  setting.config.cameras[0] = {};
  setting.config.cameras[0].name = "own";
  setting.config.cameras[0].at = CameraPlace::kScene;
  CloudConfig cloud;
  cloud.noise.sensor = DepthSensor::kStructuredLight;
  cloud.noise.extrinsic_m = 0.01;
  cloud.noise.extrinsic_rad = 0.05;
  PictureLook look = setting.LookAt(0.2);
  CameraObserver camera(setting.scene, setting.door, setting.robot, cloud);
  const CameraFrame frame = camera.Render(look.snapshot);
  look.depth = frame.depth;
  const Pictures pictures =
      TakePictures({setting.scene, setting.door, setting.robot, true, camera.as_calibrated()},
                   setting.config, std::span(&look, 1));
  const auto depth = ArrayOf<float>(pictures, "depth32_own.npy", {1, 256, 256});
  const RigidTransform pose = PoseIn(ArrayOf<double>(pictures, "pose_own.npy", {1, 3, 4}), 0);
  const double focal = pictures.record.at("own").at("intrinsic_matrix_px")[0][0].get<double>();
  std::vector<float> cloud_again;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const auto z = static_cast<double>(depth[i]);
    if (z == 0 || z >= cloud.max_depth_m) continue;
    const double x = (static_cast<double>(i % 256) + 0.5 - 128) / focal;
    const double y = (static_cast<double>(i / 256) + 0.5 - 128) / focal;
    const Eigen::Vector3d point = BackProjected(pose, x, y, z);
    if (point.z() <= cloud.min_height_m) continue;
    for (const double coordinate : point) cloud_again.push_back(static_cast<float>(coordinate));
  }
  EXPECT_GT(cloud_again.size(), 3000U);
  EXPECT_EQ(cloud_again, frame.visible.xyz);  // bit for bit
}

// The cloud's points are looked for in the picture of the same camera: it has their colours.
TEST(TakePictures, PointsHaveTheColoursOfThePixelsThatTheyAreMadeOf) {
  Setting setting;
  setting.config.cameras.resize(1);
  setting.config.cameras[0] = {};
  setting.config.cameras[0].name = "own";
  setting.config.cameras[0].at = CameraPlace::kScene;
  setting.config.streams = {PictureStream::kRgb, PictureStream::kDepth32};
  setting.config.cloud_rgb = true;
  setting.scene.appearance = SceneAppearance::kFull;
  CloudConfig cloud;
  cloud.point_count = 500;
  cloud.noise.sensor = DepthSensor::kStructuredLight;
  cloud.noise.extrinsic_rad = 0.05;
  PictureLook look = setting.LookAt(0.2);
  CameraObserver camera(setting.scene, setting.door, setting.robot, cloud);
  const CameraFrame frame = camera.Render(look.snapshot);
  look.depth = frame.depth;
  const PictureScene scene{setting.scene, setting.door, setting.robot, true,
                           camera.as_calibrated()};
  const LabelledCloud& points = frame.sampled.cloud;
  const Pictures pictures =
      TakePictures(scene, setting.config, std::span(&look, 1), {{&points}, nullptr});
  const auto colors = ArrayOf<std::uint8_t>(pictures, "cloud_rgb.npy", {1, 500, 3});
  const auto rgb = ArrayOf<std::uint8_t>(pictures, "rgb_own.npy", {1, 256, 256, 3});
  const auto depth = ArrayOf<float>(pictures, "depth32_own.npy", {1, 256, 256});
  const RigidTransform pose = PoseIn(ArrayOf<double>(pictures, "pose_own.npy", {1, 3, 4}), 0);
  const double focal = pictures.record.at("own").at("intrinsic_matrix_px")[0][0].get<double>();
  std::map<std::array<float, 3>, std::size_t> pixel_at;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const double x = (static_cast<double>(i % 256) + 0.5 - 128) / focal;
    const double y = (static_cast<double>(i / 256) + 0.5 - 128) / focal;
    const Eigen::Vector3f point =
        BackProjected(pose, x, y, static_cast<double>(depth[i])).cast<float>();
    if (depth[i] > 0) pixel_at[{point.x(), point.y(), point.z()}] = i;
  }
  for (std::size_t p = 0; p < 500; ++p) {
    const auto pixel =
        pixel_at.find({points.xyz[3 * p], points.xyz[3 * p + 1], points.xyz[3 * p + 2]});
    ASSERT_NE(pixel, pixel_at.end()) << p;
    for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(colors[3 * p + c], rgb[3 * pixel->second + c]);
  }

  // without a camera of their own they are the same, and a point of no picture has none
  setting.config.cameras.clear();
  const Pictures alone =
      TakePictures(scene, setting.config, std::span(&look, 1), {{&points}, nullptr});
  EXPECT_EQ(BytesOf(alone, "cloud_rgb.npy"), BytesOf(pictures, "cloud_rgb.npy"));
  LabelledCloud moved = points;
  moved.xyz[40] += 0.001F;
  EXPECT_THROW(TakePictures(scene, setting.config, std::span(&look, 1), {{&moved}, nullptr}),
               Error);
}

// What the robot hides is seen in the picture from before it came, which is finer.
TEST(TakePictures, RememberedPointsHaveTheColoursThatTheyHadBefore) {
  Setting setting;
  setting.config.cameras.clear();
  setting.config.cloud_rgb = true;
  CloudConfig cloud;
  cloud.point_count = 600;
  const RememberedViewConfig remembered{.resolution_scale = 2, .crop_radius_m = 0};
  PictureLook look = setting.LookAt(0);
  CameraObserver camera(setting.scene, setting.door, setting.robot, cloud);
  const CameraFrame frame = camera.Render(look.snapshot);
  look.depth = frame.depth;
  const RememberedLook before =
      LookBefore(setting.scene, setting.door, setting.robot, cloud, remembered);
  const LabelledCloud points = JoinedCloud(frame.visible, before.visible, {0, 0, 1}, {600});
  const PictureScene scene{setting.scene, setting.door, setting.robot, true,
                           camera.as_calibrated()};
  const Pictures pictures =
      TakePictures(scene, setting.config, std::span(&look, 1), {{&points}, &before});
  const auto colors = ArrayOf<std::uint8_t>(pictures, "cloud_rgb.npy", {1, 600, 3});
  EXPECT_GT(std::set<std::uint8_t>(colors.begin(), colors.end()).size(), 10U);
  EXPECT_THROW(TakePictures(scene, setting.config, std::span(&look, 1), {{&points}, nullptr}),
               Error);
}

// What a policy is shown while it acts is what it learned from: the arrays of a data set.
TEST(SceneColors, ArePartOfTheCloudsAndThoseOfThePictures) {
  Setting setting;
  setting.config.cameras.clear();
  setting.config.cloud_rgb = true;
  setting.config.samples = 1;
  setting.scene.appearance = SceneAppearance::kFull;
  CloudConfig cloud;
  cloud.point_count = 600;
  cloud.noise.sensor = DepthSensor::kTimeOfFlight;
  cloud.noise.extrinsic_rad = 0.02;
  const RememberedViewConfig remembered{.resolution_scale = 2, .crop_radius_m = 0};
  PictureLook look = setting.LookAt(0);
  look.snapshot.phase = EpisodePhase::kUnlock;
  const ColorSources colors = SceneColors(setting.door, setting.robot, 1);
  CameraObserver camera(setting.scene, setting.door, setting.robot, cloud);
  camera.ColorWith(colors(setting.scene, /*sees_robot=*/true));
  RememberedView view(setting.scene, setting.door, setting.robot, cloud, remembered);
  view.ColorWith(colors);
  camera.Remember(std::move(view));
  const CameraFrame frame = camera.Render(look.snapshot);
  look.depth = frame.depth;
  const LabelledCloud& points = frame.sampled.cloud;
  ASSERT_EQ(points.rgb.size(), points.xyz.size());
  const RememberedLook before =
      LookBefore(setting.scene, setting.door, setting.robot, cloud, remembered);
  const PictureScene scene{setting.scene, setting.door, setting.robot, true,
                           camera.as_calibrated()};
  const Pictures pictures =
      TakePictures(scene, setting.config, std::span(&look, 1), {{&points}, &before});
  const auto recorded = ArrayOf<std::uint8_t>(pictures, "cloud_rgb.npy", {1, 600, 3});
  // noise of the colours is drawn by the look, and the one before has a number of its own
  std::size_t far = 0;
  for (std::size_t i = 0; i < recorded.size(); ++i)
    far += std::abs(int{recorded[i]} - int{points.rgb[i]}) > 12 ? 1U : 0U;
  EXPECT_LT(far, recorded.size() / 100);
  EXPECT_GT(std::set<std::uint8_t>(points.rgb.begin(), points.rgb.end()).size(), 30U);
}

TEST(SceneColors, AreJoinedWithColoursAloneAndNeverOfWholeSurfaces) {
  const Setting setting;
  const ColorSources colors = SceneColors(setting.door, setting.robot, 1);
  CloudConfig whole;
  whole.whole = true;
  CameraObserver everywhere(setting.scene, setting.door, setting.robot, whole);
  EXPECT_THROW(everywhere.ColorWith(colors(setting.scene, true)), Error);
  LabelledCloud bare;
  bare.xyz = {0, 0, 1};
  bare.label = {0};
  LabelledCloud colored = bare;
  colored.rgb = {1, 2, 3};
  EXPECT_THROW(JoinedCloud(bare, colored, {0, 0, 1}, {1}), Error);
  EXPECT_EQ(JoinedCloud(colored, colored, {0, 0, 1}, {2}).rgb,
            (std::vector<std::uint8_t>{1, 2, 3, 1, 2, 3}));
}

TEST(TakePictures, TheHandsCameraGoesWithTheHandAndTheOtherStays) {
  const Setting setting;
  std::vector<PictureLook> looks = {setting.LookAt(0), setting.LookAt(0)};
  JointVector moved = StartPosition(setting.scene, setting.robot);
  moved[0] += 0.1;
  moved[7] += 0.3;
  looks[1].snapshot.robot = setting.robot.PoseAt(moved, setting.scene.world_from_robot_base);
  const Pictures pictures = setting.Take(looks);
  const auto wrist = ArrayOf<double>(pictures, "pose_wrist.npy", {2, 3, 4});
  const auto front = ArrayOf<double>(pictures, "pose_front.npy", {2, 3, 4});
  EXPECT_EQ(PoseIn(front, 0).matrix(), PoseIn(front, 1).matrix());
  const auto in_hand = [&](std::size_t i) {
    return looks[i].snapshot.robot.world_from_hand.inverse() * PoseIn(wrist, i);
  };
  EXPECT_GT((PoseIn(wrist, 0).matrix() - PoseIn(wrist, 1).matrix()).norm(), 0.1);
  EXPECT_LT((in_hand(0).matrix() - in_hand(1).matrix()).norm(), 1e-12);
}

TEST(TakePictures, AreTheSameBytesInAnyThreadAndByTheirLookAlone) {
  const Setting setting;
  const std::vector<PictureLook> looks = {setting.LookAt(0), setting.LookAt(0.4),
                                          setting.LookAt(0.8)};
  const Pictures here = setting.Take(looks);
  Pictures there;
  std::thread([&] {
    setting.Take({looks[2]});  // another camera has been here before
    there = setting.Take(looks);
  }).join();
  ASSERT_EQ(here.members.size(), 12U);
  for (std::size_t i = 0; i < here.members.size(); ++i) {
    EXPECT_EQ(here.members[i].name, there.members[i].name);
    EXPECT_EQ(here.members[i].bytes, there.members[i].bytes) << here.members[i].name;
  }
  EXPECT_TRUE(std::ranges::is_sorted(here.members, {}, &MemberBytes::name));
}

}  // namespace
}  // namespace doorforge
