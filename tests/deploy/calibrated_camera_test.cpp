// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/deploy/calibrated_camera.h"

#include <cmath>
#include <filesystem>
#include <string>
#include <string_view>

#include <gtest/gtest.h>
#include <unistd.h>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/deploy/depth_picture.h"

#include "../program_answer.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

const std::string kPose =
    "world_from_camera: {position_m: [1.8, 0, 1.8], quaternion_xyzw: [0, 0, 0.6, 0.8]}\n";

// `ros2 topic echo --once /depth/camera_info` prints a time-of-flight camera like this.
const std::string kRos2 =
    "header:\n  stamp:\n    sec: 1\n    nanosec: 5\n  frame_id: depth_camera_link\n"
    "height: 576\nwidth: 640\ndistortion_model: rational_polynomial\n"
    "d:\n- 0.52\n- -2.6\n- 0.0007\n- -0.0003\n- 1.48\n- 0.4\n- -2.43\n- 1.41\n"
    "k:\n- 504.1\n- 0.0\n- 321.7\n- 0.0\n- 503.9\n- 336.2\n- 0.0\n- 0.0\n- 1.0\n"
    "r:\n- 1.0\n- 0.0\n- 0.0\n- 0.0\n- 1.0\n- 0.0\n- 0.0\n- 0.0\n- 1.0\n"
    "p:\n- 490.0\n- 0.0\n- 320.0\n- 0.0\n- 0.0\n- 491.0\n- 330.0\n- 0.0\n- 0.0\n- 0.0\n- 1.0\n"
    "- 0.0\nbinning_x: 0\nbinning_y: 0\nroi:\n  x_offset: 0\n  y_offset: 0\n  height: 0\n"
    "  width: 0\n  do_rectify: false\n";

// camera_calibration stores a camera like this.
const std::string kStored =
    "image_width: 640\nimage_height: 576\ncamera_name: depth\n"
    "camera_matrix:\n  rows: 3\n  cols: 3\n  data: [504.1, 0, 321.7, 0, 503.9, 336.2, 0, 0, 1]\n"
    "distortion_model: rational_polynomial\n"
    "distortion_coefficients:\n  rows: 1\n  cols: 8\n"
    "  data: [0.52, -2.6, 0.0007, -0.0003, 1.48, 0.4, -2.43, 1.41]\n"
    "rectification_matrix:\n  rows: 3\n  cols: 3\n  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]\n"
    "projection_matrix:\n  rows: 3\n  cols: 4\n"
    "  data: [490, 0, 320, 0, 0, 491, 330, 0, 0, 0, 1, 0]\n";

// OpenCV's calibration example stores a camera like this.
const std::string kOpenCv =
    "%YAML:1.0\n---\ncalibration_time: \"Thu\"\nimage_width: 640\nimage_height: 576\n"
    "camera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n"
    "   data: [ 504.1, 0., 321.7, 0., 503.9, 336.2, 0., 0., 1. ]\n"
    "distortion_coefficients: !!opencv-matrix\n   rows: 8\n   cols: 1\n   dt: d\n"
    "   data: [ 0.52, -2.6, 0.0007, -0.0003, 1.48, 0.4, -2.43, 1.41 ]\n";

const std::string kOwn =
    "width: 640\nheight: 480\nfx: 600\nfy: 601\ncx: 319.5\ncy: 239.5\n" + kPose;

std::string Replaced(std::string text, std::string_view from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

class CalibratedCameraTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("calibrated_camera_test_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  CalibratedCamera Read(const std::string& text) const {
    CommitFile(folder_ / "camera.yaml", text);
    return ReadCalibratedCamera(folder_ / "camera.yaml");
  }
  std::string Refusal(const std::string& text) const {
    try {
      Read(text);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kInvalidConfig);
      return error.what();
    }
    return "taken";
  }
  void ExpectRefused(const std::string& text, const std::string& why) const {
    const std::string refusal = Refusal(text);
    EXPECT_NE(refusal.find(why), std::string::npos) << refusal;
  }

  fs::path folder_;
};

// The model as its makers write it down, of k1 k2 p1 p2 k3 k4 k5 k6 above.
Eigen::Vector2d RationalPixel(const Eigen::Vector2d& ideal) {
  const double x = ideal.x();
  const double y = ideal.y();
  const double r2 = x * x + y * y;
  const double r4 = r2 * r2;
  const double r6 = r4 * r2;
  const double f = (1 + 0.52 * r2 - 2.6 * r4 + 1.48 * r6) / (1 + 0.4 * r2 - 2.43 * r4 + 1.41 * r6);
  const double p1 = 0.0007;
  const double p2 = -0.0003;
  return {504.1 * (x * f + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)) + 321.7,
          503.9 * (y * f + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y) + 336.2};
}

// Every pixel's direction, shown through the lens, is that pixel.
void ExpectDirections(const CalibratedCamera& camera) {
  ASSERT_NE(camera.directions, nullptr);
  ASSERT_EQ(camera.directions->ideal.size(), 640U * 576U);
  for (std::size_t i = 0; i < camera.directions->ideal.size(); i += 97) {
    const Eigen::Vector2d& ideal = camera.directions->ideal[i];
    if (!ideal.allFinite()) continue;
    const Eigen::Vector2d pixel = RationalPixel(ideal);
    EXPECT_NEAR(pixel.x(), static_cast<double>(i % 640), 1e-7);
    EXPECT_NEAR(pixel.y(), static_cast<double>(i / 640), 1e-7);
  }
}

TEST_F(CalibratedCameraTest, ACameraInfoOfRosOrOpenCvIsReadWithOurKeysInIt) {
  for (const std::string& info : {kRos2, kStored, kOpenCv}) {
    const CalibratedCamera camera = Read(info + "rectified: false\ndepth_unit_m: 0.001\n" + kPose);
    EXPECT_EQ(camera.view.width, 640);
    EXPECT_EQ(camera.view.height, 576);
    EXPECT_DOUBLE_EQ(camera.view.fx, 504.1);
    EXPECT_DOUBLE_EQ(camera.view.cy, 336.7) << "counted from the corner";
    EXPECT_DOUBLE_EQ(camera.view.world_from_camera.translation().x(), 1.8);
    ExpectDirections(camera);
  }
  // ROS 1 has capital letters
  std::string ros1 = kRos2;
  for (const auto& [from, to] :
       {std::pair{"\nd:", "\nD:"}, {"\nk:", "\nK:"}, {"\nr:", "\nR:"}, {"\np:", "\nP:"}})
    ros1 = Replaced(ros1, from, to);
  ExpectDirections(Read(ros1 + "rectified: false\n" + kPose));
}

TEST_F(CalibratedCameraTest, ACameraFileNamesACameraInfoBesideIt) {
  CommitFile(folder_ / "info.yaml", kRos2 + "---\n");
  ExpectDirections(Read("camera_info: info.yaml\nrectified: false\n" + kPose));
  EXPECT_THROW(Read("camera_info: other.yaml\n" + kPose), Error);
  ExpectRefused("camera_info: info.yaml\nrectified: false\nfx: 3\n" + kPose, "unknown key \"fx\"");
}

TEST_F(CalibratedCameraTest, TheRectifiedPictureIsAPinholes) {
  const CalibratedCamera camera = Read(kRos2 + "rectified: true\n" + kPose);
  EXPECT_EQ(camera.directions, nullptr);
  EXPECT_DOUBLE_EQ(camera.view.fx, 490);
  EXPECT_DOUBLE_EQ(camera.view.fy, 491);
  EXPECT_DOUBLE_EQ(camera.view.cx, 320.5);
  ExpectRefused(kRos2 + kPose, "image_rect");
  // without distortion, and projected alike, there is nothing to say
  std::string plain =
      Replaced(kStored, "[0.52, -2.6, 0.0007, -0.0003, 1.48, 0.4, -2.43, 1.41]", "[0, 0, 0, 0, 0]");
  plain = Replaced(plain, "[490, 0, 320, 0, 0, 491, 330,", "[504.1, 0, 321.7, 0, 0, 503.9, 336.2,");
  EXPECT_EQ(Read(plain + kPose).directions, nullptr);
}

TEST_F(CalibratedCameraTest, ARawPictureIsTurnedAsItsRectificationTurns) {
  const std::string turned =
      Replaced(kStored, "[1, 0, 0, 0, 1, 0, 0, 0, 1]", "[0.96, 0, 0.28, 0, 1, 0, -0.28, 0, 0.96]");
  Eigen::Matrix3d rectification;
  rectification << 0.96, 0, 0.28, 0, 1, 0, -0.28, 0, 0.96;
  const RigidTransform world = Read(turned + "rectified: true\n" + kPose).view.world_from_camera;
  const RigidTransform raw = Read(turned + "rectified: false\n" + kPose).view.world_from_camera;
  EXPECT_LT((raw.linear() - world.linear() * rectification).norm(), 1e-12);
  EXPECT_EQ(raw.translation(), world.translation());
  ExpectRefused(Replaced(kStored, "[1, 0, 0, 0, 1, 0, 0, 0, 1]", "[1, 0, 0, 0, 1, 0, 0, 0, 2]") +
                    "rectified: false\n" + kPose,
                "no rotation");
}

// A pixel of 2 x 2 of the sensor's has its centre in the middle of them.
TEST_F(CalibratedCameraTest, APartOfTheSensorInLargerPixelsSeesWhatTheseSee) {
  std::string part = Replaced(kRos2, "binning_x: 0\nbinning_y: 0", "binning_x: 2\nbinning_y: 4");
  part = Replaced(part, "x_offset: 0\n  y_offset: 0\n  height: 0\n  width: 0",
                  "x_offset: 100\n  y_offset: 60\n  height: 400\n  width: 320");
  const CalibratedCamera camera = Read(part + "rectified: false\n" + kPose);
  ASSERT_EQ(camera.view.width, 160);
  ASSERT_EQ(camera.view.height, 100);
  for (std::size_t i = 0; i < camera.directions->ideal.size(); i += 53) {
    const Eigen::Vector2d pixel = RationalPixel(camera.directions->ideal[i]);
    EXPECT_NEAR(pixel.x(), 100 + 2 * static_cast<double>(i % 160) + 0.5, 1e-7);
    EXPECT_NEAR(pixel.y(), 60 + 4 * static_cast<double>(i / 160) + 1.5, 1e-7);
  }
}

TEST_F(CalibratedCameraTest, OurOwnFileMayHaveALens) {
  const auto camera = [&](const std::string& model, const std::string& coefficients) {
    return Read(kOwn + "distortion_model: " + model + "\ndistortion_coefficients: " + coefficients +
                "\n");
  };
  EXPECT_EQ(camera("plumb_bob", "[0.1, 0, 0, 0, 0]").lens.model, LensModel::kPolynomial);
  EXPECT_EQ(camera("equidistant", "[0.1, 0, 0, 0]").lens.model, LensModel::kFisheye);
  EXPECT_EQ(camera("Inverse Brown Conrady", "[0.1, 0, 0, 0, 0]").lens.model,
            LensModel::kInverseBrown);
  EXPECT_EQ(camera("distortion.inverse_brown_conrady", "[0, 0, 0, 0, 0]").directions, nullptr)
      << "a RealSense's depth has been rectified within";
  ExpectRefused(kOwn + "distortion_model: plum_bob\ndistortion_coefficients: [0.1]\n",
                "did you mean \"plumb_bob\"");
  ExpectRefused(kOwn + "distortion_model: plumb_bob\n", "\"distortion_coefficients\" is missing");
  ExpectRefused(kOwn + "distortion_model: plumb_bob\ndistortion_coefficients: [0, 0, 0, 0, 0, 1]\n",
                "6 of them");
  ExpectRefused(kOwn + "distortion_model: none\ndistortion_coefficients: [0.1]\n", "are read");
  ExpectRefused(kOwn + "distortion_model: plumb_bob\ndistortion_coefficients: [-20, 0, 0, 0]\n",
                "order");
}

TEST_F(CalibratedCameraTest, WhatACalibrationDoesNotSayIsAskedForByName) {
  ExpectRefused(kRos2 + "rectified: false\n", "tf2_echo");
  ExpectRefused(Replaced(kRos2, "- 504.1", "- 0.0") + "rectified: false\n" + kPose,
                "not calibrated");
  ExpectRefused(Replaced(kStored, "504.1, 0,", "504.1,") + "rectified: false\n" + kPose,
                "camera_matrix: data: expected 9 numbers, found 8");
}

using DepthPictureTest = CalibratedCameraTest;

TEST_F(DepthPictureTest, ArraysOfNumPyAreReadInTheirUnits) {
  const std::string folder = folder_.string();
  const ProgramAnswer made = AnswerOf(
      PYTHON
      " -c \"import numpy as n; d = n.full((3, 5), 1.25); d[0] = [0, n.nan, n.inf, -1, 2.5];"
      "[n.save('" +
      folder +
      "/' + t, d.astype(t)) for t in ('float32', 'float64')];"
      "n.save('" +
      folder +
      "/third', d.astype('float32')[:, :, None]);"
      "n.save('" +
      folder +
      "/mm', (1000 * d.astype('float32')));"
      "n.save('" +
      folder +
      "/uint16', n.where(d > 0, n.where(d < 9, 4000 * d, 0), 0)"
      ".astype('uint16')); n.save('" +
      folder +
      "/flat', d.ravel());"
      "n.save('" +
      folder + "/int64', d.astype('int64'))\" 2>/dev/null");
  ASSERT_EQ(made.code, 0);
  CalibratedCamera camera;
  const auto expect = [&](const std::string& name) {
    const DepthImage depth = ReadDepthPicture(folder_ / (name + ".npy"), camera);
    ASSERT_EQ(depth.width, 5);
    ASSERT_EQ(depth.height, 3);
    ASSERT_EQ(depth.label.size(), 15U);
    for (std::size_t i = 0; i < 15; ++i)
      EXPECT_EQ(depth.depth_m[i], i < 4 ? HUGE_VALF : i == 4 ? 2.5F : 1.25F) << name << i;
  };
  for (const char* name : {"float32", "float64", "third"}) expect(name);
  camera.metres_per_unit = 0.00025;
  expect("uint16");
  camera.metres_per_float = 0.001;
  expect("mm");
  for (const char* name : {"flat", "int64"})
    EXPECT_THROW(ReadDepthPicture(folder_ / (std::string(name) + ".npy"), camera), Error);
}

TEST_F(DepthPictureTest, AUnitThatCannotBeIsRefusedWithTheOneThatCan) {
  DepthImage depth = MakeDepthImage(4, 4, std::vector<float>(16, 1.5F));
  WriteDepthPng(folder_ / "mm.png", depth);
  const auto refusal = [&](double unit) -> std::string {
    CalibratedCamera camera;
    camera.metres_per_unit = unit;
    try {
      ReadDepthPicture(folder_ / "mm.png", camera);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
      return error.what();
    }
    return "taken";
  };
  EXPECT_EQ(refusal(0.001), "taken");
  EXPECT_EQ(refusal(0.00025), "taken") << "as near as a robot's wrist may be";
  EXPECT_EQ(refusal(1), (folder_ / "mm.png").string() +
                            ": the depths cannot be right: their median, read with depth_unit_m: "
                            "1, is 1500 m, and cameras see from 0.05 to 30 m; with depth_unit_m: "
                            "0.001 in the camera file it is 1.5 m");
  EXPECT_NE(refusal(1e-6).find("is 0.0015 m"), std::string::npos) << refusal(1e-6);
  EXPECT_THROW(RequirePlausibleDepths(MakeDepthImage(1, 1, {1500}), "in metres"), Error);
  EXPECT_NO_THROW(RequirePlausibleDepths(MakeDepthImage(1, 1, {0}), "in metres"));
}

TEST_F(DepthPictureTest, ATiffOrExrIsRefusedWithTheCommandThatHelps) {
  for (const std::string_view magic : {std::string_view("II*\0x", 5), std::string_view("MM\0*", 4),
                                       std::string_view("\x76\x2f\x31\x01", 4)}) {
    CommitFile(folder_ / "depth.tiff", std::string(magic));
    try {
      ReadDepthPicture(folder_ / "depth.tiff", {});
      ADD_FAILURE();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kFormat);
      EXPECT_NE(std::string(error.what()).find("numpy.save('depth.npy'"), std::string::npos);
    }
  }
}

TEST_F(DepthPictureTest, ColoursOfAnotherSizeAreNotOfThisDepth) {
  Picture picture{640, 480, {}};
  for (std::size_t i = 0; i < 640UL * 480 * 3; ++i)
    picture.rgb.push_back(static_cast<std::uint8_t>(i / 640 % 251));
  WritePng(folder_ / "c.png", picture);
  DepthImage depth;
  depth.width = 640;
  depth.height = 480;
  AddColors("", depth);
  EXPECT_TRUE(depth.rgb.empty());
  AddColors(folder_ / "c.png", depth);
  EXPECT_EQ(depth.rgb, picture.rgb);
  CommitFile(folder_ / "c.jpg", EncodeJpeg(picture, 95));
  AddColors(folder_ / "c.jpg", depth);
  EXPECT_EQ(depth.rgb.size(), picture.rgb.size());
  depth.width = 848;
  try {
    AddColors(folder_ / "c.png", depth);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("640 x 480 pixels, the depth has 848 x 480"),
              std::string::npos)
        << error.what();
    EXPECT_NE(std::string(error.what()).find("align_depth"), std::string::npos);
  }
}

}  // namespace
}  // namespace doorforge
