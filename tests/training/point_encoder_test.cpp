// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/networks/point_encoder.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/core/rng.h"
#include "doorforge/networks/point_operators.h"

#include "device_encoder.h"
#include "door_cloud.h"
#include "encoder_checks.h"
#include "packed_encoder.h"
#include "reference_network.h"

namespace doorforge {
namespace {

struct Net {
  ParameterLayout layout;
  std::vector<float> parameters;

  explicit Net(EncoderKind kind = {}) {
    AddEncoderLayers("", layout, kind);
    parameters = HeInitialisation(layout, 3, "");
    // biases that are not zero, so that their use is seen
    Rng rng(3, "test/bias");
    for (const DenseLayer& layer : layout.layers()) {
      for (std::size_t i = layer.bias_offset(); i < layer.end(); ++i)
        parameters[i] = static_cast<float>(rng.Uniform(-0.1, 0.1));
    }
  }
};

std::vector<std::uint16_t> AllPoints() {
  std::vector<std::uint16_t> all(kCloudPoints);
  std::iota(all.begin(), all.end(), std::uint16_t{0});
  return all;
}

std::vector<float> RandomVector(std::size_t size, const char* stream) {
  Rng rng(5, stream);
  std::vector<float> values(size);
  for (float& v : values) v = static_cast<float>(rng.Normal());
  return values;
}

// Largest difference, relative to the largest expected magnitude of the slice.
double WorstRelative(std::span<const float> expected, std::span<const float> actual) {
  double scale = 1e-12;
  double worst = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    scale = std::max(scale, std::abs(static_cast<double>(expected[i])));
    worst = std::max(worst, std::abs(static_cast<double>(expected[i]) - actual[i]));
  }
  return worst / scale;
}

void ExpectSameGradients(const ParameterLayout& layout, std::span<const float> expected,
                         std::span<const float> actual, double tolerance) {
  for (const DenseLayer& layer : layout.layers()) {
    const auto weight = [&](std::span<const float> all) {
      return all.subspan(layer.offset, layer.weight_count());
    };
    const auto bias = [&](std::span<const float> all) {
      return all.subspan(layer.bias_offset(), static_cast<std::size_t>(layer.outputs));
    };
    EXPECT_LT(testing::RelativeDistance(weight(expected), weight(actual)), tolerance) << layer.name;
    EXPECT_LT(testing::RelativeDistance(bias(expected), bias(actual)), tolerance)
        << layer.name << " bias";
  }
}

class PointEncoderOfWidth : public ::testing::TestWithParam<EncoderWidth> {};
INSTANTIATE_TEST_SUITE_P(Widths, PointEncoderOfWidth,
                         ::testing::Values(EncoderWidth::kFull, EncoderWidth::kNarrow));

TEST_P(PointEncoderOfWidth, GivesTheFeaturesAndGradientsOfStockOperatorsForAllPoints) {
  const Net net({EncoderNorm::kNone, false, GetParam()});
  const std::vector<float> cloud = testing::DoorCloud(1, 0.3);
  std::vector<float> wanted = RandomVector(std::size_t{kCloudPoints} * kFeatureSize, "all");
  // all of one sign: the sum is large against the few ReLUs that rounding switches
  for (float& w : wanted) w = std::abs(w);
  testing::ReferenceNetwork reference(net.layout, net.parameters, {cloud}, testing::kCloudCentre,
                                      testing::Precision::kDouble);
  const auto expected = reference.Run(wanted);
  for (const InstructionSet set : testing::SupportedSets()) {
    SCOPED_TRACE(NameOf(set));
    const CloudGeometry geometry = BuildGeometry(cloud, {testing::kCloudCentre}, AllPoints(), set);
    const PointEncoder encoder(net.layout, "", net.parameters, set);
    const PointEncoder::Trace trace = encoder.Forward(geometry);
    EXPECT_LT(WorstRelative(expected.features, trace.features), 1e-5);
    std::vector<float> gradient(net.parameters.size());
    encoder.AddGradient(geometry, trace, wanted, gradient);
    // rounding switches a few of the millions of ReLUs and maxima of all points
    ExpectSameGradients(net.layout, expected.gradient, gradient, 1e-3);
  }
}

TEST_P(PointEncoderOfWidth, GivesTheFeatureAndGradientOfStockOperatorsForPointZeroAlone) {
  const Net net({EncoderNorm::kNone, false, GetParam()});
  const std::vector<float> cloud = testing::DoorCloud(2, 0.6);
  const std::vector<float> wanted = RandomVector(kFeatureSize, "zero");
  std::vector<float> wanted_of_all(std::size_t{kCloudPoints} * kFeatureSize);
  std::copy(wanted.begin(), wanted.end(), wanted_of_all.begin());
  testing::ReferenceNetwork reference(net.layout, net.parameters, {cloud}, testing::kCloudCentre,
                                      testing::Precision::kDouble);
  const auto expected = reference.Run(wanted_of_all);
  for (const InstructionSet set : testing::SupportedSets()) {
    SCOPED_TRACE(NameOf(set));
    const CloudGeometry geometry = BuildGeometry(cloud, {testing::kCloudCentre});
    const PointEncoder encoder(net.layout, "", net.parameters, set);
    const PointEncoder::Trace trace = encoder.Forward(geometry);
    ASSERT_EQ(trace.features.size(), std::size_t{kFeatureSize});
    EXPECT_LT(WorstRelative({expected.features.data(), kFeatureSize}, trace.features), 1e-5);
    std::vector<float> gradient(net.parameters.size());
    encoder.AddGradient(geometry, trace, wanted, gradient);
    ExpectSameGradients(net.layout, expected.gradient, gradient, 1e-4);
  }
}

TEST(PointEncoder, LeavesOutOnlyWhatPointZeroDoesNotDependOn) {
  const Net net;
  const std::vector<float> cloud = testing::DoorCloud(7, 0.1);
  const InstructionSet set = BestInstructionSet();
  const PointEncoder encoder(net.layout, "", net.parameters, set);
  const CloudGeometry all = BuildGeometry(cloud, {testing::kCloudCentre}, AllPoints(), set);
  const CloudGeometry one = BuildGeometry(cloud, {testing::kCloudCentre});
  EXPECT_EQ(one.upsampling[0].size(), 1U);
  EXPECT_EQ(one.upsampling[1].size(), 3U);
  EXPECT_LE(one.upsampling[2].size(), 9U);
  EXPECT_LT(one.levels[3].size(), all.levels[3].size());
  const std::vector<float> of_all = encoder.Forward(all).features;
  const std::vector<float> of_one = encoder.Forward(one).features;
  ASSERT_EQ(of_one.size(), std::size_t{kFeatureSize});
  // rounded otherwise: for all points the first layers come before the interpolation
  for (std::size_t i = 0; i < of_one.size(); ++i) EXPECT_NEAR(of_one[i], of_all[i], 2e-6) << i;
}

TEST(PointEncoder, ProjectsFirstWhereManyPointsAreInterpolatedFromFew) {
  const std::vector<float> cloud = testing::DoorCloud(7, 0.1);
  const CloudGeometry all =
      BuildGeometry(cloud, {testing::kCloudCentre}, AllPoints(), BestInstructionSet());
  const CloudGeometry one = BuildGeometry(cloud, {testing::kCloudCentre});
  for (std::size_t l = 0; l < 4; ++l) {
    EXPECT_TRUE(internal::ProjectsFirst(all, l)) << l;
    EXPECT_FALSE(internal::ProjectsFirst(one, l)) << l;
  }
}

// Features and gradient of a batch, each cloud with its own share of `wanted`.
std::pair<std::vector<float>, std::vector<float>> OnDevice(const Net& net,
                                                           const internal::Geometries& geometries,
                                                           std::span<const float> wanted,
                                                           EncoderKind kind = {}) {
  ParameterLayout layout;  // the same places in the flat vector
  AddEncoderLayers("encoder.", layout, kind);
  internal::DeviceEncoder device(layout, net.parameters, "libtorch", /*in_double=*/true);
  std::vector<float> features = device.Forward(geometries, true);
  std::vector<float> gradient(net.parameters.size());
  device.AddGradient(wanted, gradient);
  return {std::move(features), std::move(gradient)};
}

TEST(PointEncoder, OnAnotherDeviceItIsTheSameNetwork) {
  const Net net;
  const std::vector<float> cloud = testing::DoorCloud(1, 0.3);
  std::vector<float> wanted = RandomVector(std::size_t{kCloudPoints} * kFeatureSize, "all");
  for (float& w : wanted) w = std::abs(w);
  testing::ReferenceNetwork reference(net.layout, net.parameters, {cloud}, testing::kCloudCentre,
                                      testing::Precision::kDouble);
  const auto expected = reference.Run(wanted);
  const auto geometry = std::make_shared<const CloudGeometry>(
      BuildGeometry(cloud, {testing::kCloudCentre}, AllPoints(), BestInstructionSet()));
  const auto [features, gradient] = OnDevice(net, {geometry}, wanted);
  ASSERT_EQ(features.size(), expected.features.size());
  for (std::size_t i = 0; i < features.size(); ++i)
    ASSERT_NEAR(features[i], expected.features[i], 1e-5) << i;
  ExpectSameGradients(net.layout, expected.gradient, gradient, 1e-5);
}

std::vector<std::uint8_t> RandomColors() {
  Rng rng(6, "test/colors");
  std::vector<std::uint8_t> rgb(std::size_t{3} * kCloudPoints);
  for (std::uint8_t& value : rgb) value = static_cast<std::uint8_t>(rng.Index(256));
  return rgb;
}

TEST(PointEncoder, ReadsColoursAsTheSameNetworkInStockOperators) {
  const EncoderKind kind{EncoderNorm::kNone, true};
  const Net net(kind);
  EXPECT_EQ(net.layout.layers().front().inputs, 9);
  const std::vector<float> cloud = testing::DoorCloud(1, 0.3);
  const std::vector<std::uint8_t> rgb = RandomColors();
  // a window that leaves points out, so that each must keep its own colour
  const CloudWindow window{testing::kCloudCentre, 0.5F};
  const std::vector<std::uint16_t> outputs = {0};
  const std::vector<float> wanted = RandomVector(kFeatureSize, "colors");
  const auto geometry = std::make_shared<const CloudGeometry>(
      BuildGeometry({cloud, rgb}, window, outputs, BestInstructionSet()));
  ASSERT_LT(geometry->rgb.size(), rgb.size());
  const auto [features, gradient] = OnDevice(net, {geometry}, wanted, kind);
  for (const InstructionSet set : testing::SupportedSets()) {
    SCOPED_TRACE(NameOf(set));
    const PointEncoder encoder(net.layout, "", net.parameters, set);
    const PointEncoder::Trace trace = encoder.Forward(*geometry);
    EXPECT_LT(WorstRelative(features, trace.features), 1e-5);
    std::vector<float> found(net.parameters.size());
    encoder.AddGradient(*geometry, trace, wanted, found);
    ExpectSameGradients(net.layout, gradient, found, 1e-4);
  }
}

TEST(PointEncoder, GivesEachPointItsOwnColour) {
  const std::vector<float> cloud = testing::DoorCloud(1, 0.3);
  std::vector<std::uint8_t> rgb(cloud.size());
  for (std::size_t i = 0; i < rgb.size(); ++i)  // where a point lies is what colour it has
    rgb[i] = static_cast<std::uint8_t>(std::clamp(100 * cloud[i] + 100, 0.0F, 255.0F));
  const CloudGeometry geometry = BuildGeometry({cloud, rgb}, {{}, 0.5F});
  ASSERT_EQ(geometry.rgb.size(), geometry.xyz.size());
  for (std::size_t i = 0; i < geometry.xyz.size(); ++i)
    ASSERT_EQ(geometry.rgb[i],
              static_cast<std::uint8_t>(std::clamp(100 * geometry.xyz[i] + 100, 0.0F, 255.0F)))
        << i;
}

TEST(PointEncoder, RefusesACloudWithoutTheColoursThatItReads) {
  const Net net({EncoderNorm::kNone, true});
  const PointEncoder encoder(net.layout, "", net.parameters, BestInstructionSet());
  const std::vector<float> cloud = testing::DoorCloud(1, 0.3);
  EXPECT_THROW(encoder.Forward(BuildGeometry(cloud, {testing::kCloudCentre})), Error);
  const std::vector<std::uint8_t> few(30);
  EXPECT_THROW(BuildGeometry({cloud, few}, {testing::kCloudCentre}), Error);
}

TEST(PointEncoder, OnAnotherDeviceABatchIsTheSumOfItsClouds) {
  const Net net;
  internal::Geometries all;
  for (const std::uint64_t seed : {3U, 4U, 5U}) {
    const std::vector<std::uint16_t> outputs = {0, static_cast<std::uint16_t>(seed)};
    all.push_back(std::make_shared<const CloudGeometry>(
        BuildGeometry(testing::DoorCloud(seed, 0.2), {testing::kCloudCentre, 50}, outputs,
                      BestInstructionSet())));
  }
  constexpr std::size_t kShare = std::size_t{2} * kFeatureSize;
  const std::vector<float> wanted = RandomVector(3 * kShare, "device");
  const auto [features, gradient] = OnDevice(net, all, wanted);
  std::vector<float> sum(gradient.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto [own, part] = OnDevice(net, {all[i]}, std::span(wanted).subspan(i * kShare, kShare));
    ASSERT_EQ(own.size(), kShare);
    for (std::size_t k = 0; k < kShare; ++k) ASSERT_NEAR(features[i * kShare + k], own[k], 1e-5);
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += part[k];
  }
  ExpectSameGradients(net.layout, sum, gradient, 1e-5);
  EXPECT_TRUE(OnDevice(net, {}, {}).first.empty());
}

// The cloud with all points farther than this from point 0 moved outward.
std::vector<float> WithFarPointsMoved(std::vector<float> cloud, float radius_m) {
  for (std::size_t i = 0; i < cloud.size(); i += 3) {
    float squared = 0;
    for (std::size_t k = 0; k < 3; ++k)
      squared += (cloud[i + k] - cloud[k]) * (cloud[i + k] - cloud[k]);
    if (squared <= radius_m * radius_m) continue;
    for (std::size_t k = 0; k < 3; ++k) cloud[i + k] += 0.5F * (cloud[i + k] - cloud[k]);
  }
  return cloud;
}

std::size_t PointsWithinOfFirst(const std::vector<float>& cloud, float radius_m) {
  return PointsWithin(ToColumns(cloud, {}), {cloud[0], cloud[1], cloud[2]}, radius_m, kCloudPoints,
                      InstructionSet::kBaseline)
      .size();
}

TEST(PointEncoder, SeesNothingBeyondTheWindow) {
  const Net net;
  const PointEncoder encoder(net.layout, "", net.parameters, BestInstructionSet());
  const std::vector<float> cloud = testing::DoorCloud(7, 0.1);
  const auto features = [&](const std::vector<float>& xyz, float radius_m) {
    return encoder.Forward(BuildGeometry(xyz, {testing::kCloudCentre, radius_m})).features;
  };
  constexpr float kRadius = 0.7F;
  const std::size_t inside = PointsWithinOfFirst(cloud, kRadius);
  ASSERT_GT(inside, 1100U);
  ASSERT_LT(inside, 3500U);
  EXPECT_EQ(BuildGeometry(cloud, {testing::kCloudCentre, kRadius}).xyz.size(), 3 * inside);
  const std::vector<float> moved = WithFarPointsMoved(cloud, kRadius);
  EXPECT_EQ(features(moved, kRadius), features(cloud, kRadius));
  EXPECT_NE(features(moved, 0), features(cloud, 0));
  EXPECT_NE(features(WithFarPointsMoved(cloud, 0.5F * kRadius), kRadius), features(cloud, kRadius));
  EXPECT_EQ(features(cloud, 50), features(cloud, 0)) << "all are inside";
}

TEST(PointEncoder, ZoomIsTheSameAsACloudOfALargerThing) {
  const Net net;
  const PointEncoder encoder(net.layout, "", net.parameters, BestInstructionSet());
  const std::vector<float> cloud = testing::DoorCloud(7, 0.1);
  std::vector<float> larger = cloud;  // by a power of two: not a bit is rounded
  for (float& coordinate : larger) coordinate *= 4;
  const auto features = [&](const std::vector<float>& xyz, const CloudWindow& window) {
    return encoder.Forward(BuildGeometry(xyz, window)).features;
  };
  const std::vector<float> zoomed = features(cloud, {{}, 0.7F, 4});
  EXPECT_EQ(zoomed, features(larger, {{}, 2.8F}));
  EXPECT_NE(zoomed, features(cloud, {{}, 0.7F}));
}

TEST(PointEncoder, AWindowWithFewPointsHoldsTheNearest) {
  const std::vector<float> cloud = testing::DoorCloud(7, 0.1);
  const CloudGeometry geometry = BuildGeometry(cloud, {testing::kCloudCentre, 0.01F});
  EXPECT_EQ(geometry.xyz.size(), std::size_t{3} * 1024);
  constexpr std::array<std::uint16_t, 2> kOutputs = {0, 4095};
  EXPECT_EQ(BuildGeometry(cloud, {testing::kCloudCentre, 50}, kOutputs, BestInstructionSet())
                .upsampling[0]
                .size(),
            2U);
  std::vector<float> alone = cloud;
  alone[std::size_t{3} * 4095] += 40;
  EXPECT_THROW(BuildGeometry(alone, {testing::kCloudCentre, 0.01F}, kOutputs, BestInstructionSet()),
               Error);
}

TEST(PointEncoder, GivesTheSameBitsWithEveryFusingInstructionSet) {
  if (!IsSupported(InstructionSet::kAvx512)) GTEST_SKIP() << "this processor lacks AVX-512";
  const Net net;
  const std::vector<float> cloud = testing::DoorCloud(4, 0.2);
  const std::vector<float> wanted = RandomVector(kFeatureSize, "bits");
  std::vector<std::vector<float>> gradients;
  for (const InstructionSet set : {InstructionSet::kAvx2, InstructionSet::kAvx512}) {
    constexpr std::array<std::uint16_t, 1> kPointZero = {0};
    const CloudGeometry geometry = BuildGeometry(cloud, {testing::kCloudCentre}, kPointZero, set);
    const PointEncoder encoder(net.layout, "", net.parameters, set);
    gradients.emplace_back(net.parameters.size());
    encoder.AddGradient(geometry, encoder.Forward(geometry), wanted, gradients.back());
  }
  EXPECT_EQ(gradients[0], gradients[1]);
}

TEST(PointEncoder, AgreesWithFiniteDifferences) {
  Net net;
  const std::vector<float> cloud = testing::DoorCloud(3, 0.5);
  const CloudGeometry geometry = BuildGeometry(cloud, {testing::kCloudCentre});
  const std::vector<float> wanted = RandomVector(kFeatureSize, "differences");
  const auto value = [&] {
    const PointEncoder encoder(net.layout, "", net.parameters, BestInstructionSet());
    const std::vector<float> features = encoder.Forward(geometry).features;
    return std::inner_product(features.begin(), features.end(), wanted.begin(), 0.0);
  };
  std::vector<float> gradient(net.parameters.size());
  const PointEncoder encoder(net.layout, "", net.parameters, BestInstructionSet());
  encoder.AddGradient(geometry, encoder.Forward(geometry), wanted, gradient);
  // one step along each layer's own gradient: large against rounding, small against the kinks
  for (const DenseLayer& layer : net.layout.layers()) {
    const std::span<const float> slope(gradient.data() + layer.offset, layer.weight_count());
    const double norm =
        std::sqrt(std::inner_product(slope.begin(), slope.end(), slope.begin(), 0.0));
    ASSERT_GT(norm, 0) << layer.name;
    const std::vector<float> saved = net.parameters;
    const auto at = [&](double step) {
      for (std::size_t i = 0; i < slope.size(); ++i)
        net.parameters[layer.offset + i] =
            saved[layer.offset + i] + static_cast<float>(step * slope[i] / norm);
      return value();
    };
    constexpr double kStep = 3e-4;
    const double difference = (at(kStep) - at(-kStep)) / (2 * kStep);
    net.parameters = saved;
    EXPECT_NEAR(difference / norm, 1.0, 0.02) << layer.name;
  }
}

}  // namespace
}  // namespace doorforge
