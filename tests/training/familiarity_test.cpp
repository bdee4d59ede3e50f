// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/familiarity.h"

#include <cmath>
#include <filesystem>
#include <limits>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/rng.h"
#include "doorforge/schemas/cloud.h"
#include "doorforge/schemas/safetensors.h"

#include "door_cloud.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

constexpr auto kHandle = static_cast<std::uint8_t>(PointLabel::kHandle);
constexpr std::size_t kHandAt = 25;  // in the proprioception

// Looks at a door that stands a little higher or lower, and is open by 0 to 50 degrees, the hand
// near point 0. Every third point within 4 cm of that is the handle's.
struct Looks {
  std::vector<std::vector<float>> clouds;
  std::vector<std::vector<std::uint8_t>> labels;
  std::vector<TrainingSample> samples;

  Looks(std::size_t count, const std::string& name) : clouds(count), labels(count) {
    Rng rng(5, name);
    for (std::size_t i = 0; i < count; ++i) {
      std::vector<float>& cloud = clouds[i];
      cloud = testing::DoorCloud(1000 * name.size() + i, rng.Uniform(0, 0.9));
      const float shift = static_cast<float>(0.05 * rng.Normal());
      for (std::size_t k = 2; k < cloud.size(); k += 3) cloud[k] += shift;
      TrainingSample sample;
      for (std::size_t k = 0; k < 3; ++k)
        sample.proprioception.at(kHandAt + k) = cloud[k] + static_cast<float>(0.005 * rng.Normal());
      labels[i].resize(cloud.size() / 3);
      for (std::size_t p = 0; p < labels[i].size(); p += 3)
        labels[i][p] = Apart(cloud, p) < 0.04F ? kHandle : 0;
      sample.cloud = cloud;
      sample.label = labels[i];
      samples.push_back(sample);
    }
  }

  static float Apart(const std::vector<float>& cloud, std::size_t p) {
    return std::hypot(cloud[3 * p] - cloud[0], cloud[3 * p + 1] - cloud[1],
                      cloud[3 * p + 2] - cloud[2]);
  }
};

double DistanceOf(const Familiarity& familiarity, const TrainingSample& sample,
                  NetworkFamily family = NetworkFamily::kMotion) {
  return familiarity.DistanceOf(
      SightNumbersOf({sample.cloud, sample.label}, sample.proprioception, family));
}

// A wall at the door's place, with as many points, in the look of another sample.
std::vector<float> WallInPlaceOf(const TrainingSample& sample) {
  std::vector<float> wall(sample.cloud.begin(), sample.cloud.end());
  Rng rng(1, "wall");
  for (std::size_t i = 0; i < wall.size(); i += 3) {
    wall[i] = 0;
    wall[i + 1] = static_cast<float>(rng.Uniform(-1, 1));
    wall[i + 2] = static_cast<float>(rng.Uniform(0.1, 2));
  }
  for (std::size_t k = 1; k < 3; ++k) wall[k] = sample.cloud[k];
  return wall;
}

TEST(Familiarity, KnowsLooksLikeThoseOfTheTrainingAndNotAWall) {
  const Looks train(200, "train");
  const Looks validation(300, "validation");
  const Looks fresh(300, "fresh looks");
  for (const NetworkFamily family : {NetworkFamily::kMotion, NetworkFamily::kGrasp}) {
    const auto familiarity = FitFamiliarity(train.samples, validation.samples, family);
    ASSERT_TRUE(familiarity);
    const double limit = familiarity->DistanceAt(95);
    int beyond = 0;
    for (const TrainingSample& sample : fresh.samples)
      beyond += DistanceOf(*familiarity, sample, family) > limit ? 1 : 0;
    // 15 of 300 are expected, give or take 3.8 by chance and as much by the chance of the limit
    EXPECT_LT(beyond, 34);
    for (std::size_t i = 0; i < 20; ++i) {
      TrainingSample wall = fresh.samples[i];
      const std::vector<float> cloud = WallInPlaceOf(wall);
      wall.cloud = cloud;
      const double distance = DistanceOf(*familiarity, wall, family);
      EXPECT_GT(distance, 1.5 * familiarity->distances.back()) << i;
      EXPECT_EQ(familiarity->PercentileOf(distance), 100);
    }
  }
}

TEST(Familiarity, KnowsMirrorImagesWhereThePolicyWasShownThem) {
  const Looks train(400, "train");
  const Looks validation(300, "validation");
  const Looks fresh(100, "fresh looks");
  const auto as_seen = FitFamiliarity(train.samples, validation.samples, NetworkFamily::kGrasp);
  const auto both = FitFamiliarity(train.samples, validation.samples, NetworkFamily::kGrasp,
                                   SampleSides::kMirroredToo);
  int foreign_as_seen = 0;
  int foreign_with_both = 0;
  for (TrainingSample sample : fresh.samples) {
    std::vector<float> cloud(sample.cloud.begin(), sample.cloud.end());
    for (std::size_t y = 1; y < cloud.size(); y += 3) cloud[y] = -cloud[y];
    sample.cloud = cloud;
    const auto is_foreign = [&](const Familiarity& familiarity) {
      return DistanceOf(familiarity, sample, NetworkFamily::kGrasp) > familiarity.DistanceAt(95);
    };
    foreign_as_seen += is_foreign(*as_seen) ? 1 : 0;
    foreign_with_both += is_foreign(*both) ? 1 : 0;
  }
  EXPECT_LT(foreign_with_both, 20);  // 5 are expected
  EXPECT_GT(foreign_as_seen, 50);
}

TEST(Familiarity, AMaskBesideTheHandleIsForeign) {
  const Looks train(200, "train");
  const Looks validation(100, "validation");
  const Looks fresh(20, "fresh looks");
  const auto familiarity = FitFamiliarity(train.samples, validation.samples, NetworkFamily::kGrasp);
  for (TrainingSample sample : fresh.samples) {
    EXPECT_LE(DistanceOf(*familiarity, sample, NetworkFamily::kGrasp),
              1.5 * familiarity->distances.back());
    std::vector<std::uint8_t> elsewhere(sample.label.size(), 0);
    for (std::size_t p = 0; p < elsewhere.size(); ++p)
      elsewhere[p] =
          std::fabs(sample.cloud[3 * p + 2] - sample.cloud[2] - 0.3F) < 0.04F ? kHandle : 0;
    sample.label = elsewhere;
    EXPECT_GT(DistanceOf(*familiarity, sample, NetworkFamily::kGrasp),
              1.5 * familiarity->distances.back());
  }
}

// By definition, of independent numbers: training samples have a mean square of about 1 a number.
TEST(Familiarity, TheDistanceOfTrainingSamplesIsAboutOne) {
  const Looks train(400, "train");
  const auto familiarity = FitFamiliarity(train.samples, {}, NetworkFamily::kMotion);
  ASSERT_TRUE(familiarity);
  EXPECT_EQ(familiarity->distances.size(), 40U);  // held out, for want of validation samples
  double squares = 0;
  for (const TrainingSample& sample : train.samples)
    squares += std::pow(DistanceOf(*familiarity, sample), 2);
  const double mean_square = squares / static_cast<double>(train.samples.size());
  EXPECT_GT(mean_square, 0.3);  // numbers that never vary count as 0
  EXPECT_LT(mean_square, 1.3);
}

TEST(Familiarity, PercentilesCountTheValidationSamplesThatAreLessFar) {
  Familiarity familiarity;
  familiarity.distances = {1, 2, 3, 5};
  EXPECT_EQ(familiarity.PercentileOf(0.5), 0);
  EXPECT_EQ(familiarity.PercentileOf(2), 25);
  EXPECT_EQ(familiarity.PercentileOf(2.5), 50);
  EXPECT_EQ(familiarity.PercentileOf(9), 100);
  EXPECT_EQ(familiarity.DistanceAt(0), 1);
  EXPECT_EQ(familiarity.DistanceAt(50), 2.5);
  EXPECT_EQ(familiarity.DistanceAt(100), 5);
}

TEST(Familiarity, NeedsTwentySamplesAndAPoint) {
  const Looks train(20, "train");
  EXPECT_FALSE(FitFamiliarity(std::span(train.samples).first(19), {}, NetworkFamily::kMotion));
  EXPECT_TRUE(FitFamiliarity(train.samples, {}, NetworkFamily::kMotion));
  EXPECT_THROW(SightNumbersOf({}, {}, NetworkFamily::kMotion), Error);
  const TrainingSample& sample = train.samples.front();
  EXPECT_THROW(SightNumbersOf({sample.cloud, {}}, {}, NetworkFamily::kGrasp), Error);
  const auto familiarity = FitFamiliarity(train.samples, {}, NetworkFamily::kMotion);
  EXPECT_THROW(DistanceOf(*familiarity, sample, NetworkFamily::kGrasp), Error);
}

class FamiliarityFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("familiarity_test_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string Refusal(const TensorFile& file) const {
    CommitFile(folder_ / "familiar.safetensors", EncodeTensors(file));
    try {
      ReadFamiliarity(folder_, kData, NetworkFamily::kMotion);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kFormat);
      return error.what();
    }
    return "";
  }

  static constexpr const char* kData = "0123456789abcdef";
  fs::path folder_;
};

TEST_F(FamiliarityFile, ComesBackAndRefusesWhatDoesNotBelongThere) {
  const Looks train(40, "train");
  const auto written = FitFamiliarity(train.samples, {}, NetworkFamily::kMotion);
  WriteFamiliarity(folder_, written, kData);
  const auto read = ReadFamiliarity(folder_, kData, NetworkFamily::kMotion);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->mean, written->mean);
  EXPECT_EQ(read->whitening, written->whitening);
  EXPECT_EQ(read->distances, written->distances);

  const TensorFile sound = ReadTensors(folder_ / "familiar.safetensors");
  EXPECT_EQ(Refusal(sound), "");
  const auto refuses = [&](const std::string& word, const auto& change) {
    TensorFile file = sound;
    change(file);
    const std::string refusal = Refusal(file);
    EXPECT_NE(refusal.find(word), std::string::npos) << word << " not in: " << refusal;
    EXPECT_NE(refusal.find("familiar.safetensors"), std::string::npos);
  };
  refuses("version", [](TensorFile& file) { file.metadata["schema_version"] = "2"; });
  refuses("--resume", [](TensorFile& file) { file.metadata["dataset_sha256"] = "another"; });
  refuses("whitening", [](TensorFile& file) { file.tensors.erase("whitening"); });
  refuses("mean", [](TensorFile& file) {
    file.tensors["mean"] = MakeTensor<float>(std::vector<float>(7), {7});
  });
  refuses("not finite", [](TensorFile& file) {
    std::vector<float> mean(SightSize(NetworkFamily::kMotion));
    mean[3] = std::numeric_limits<float>::quiet_NaN();
    file.tensors["mean"] = MakeTensor<float>(mean, {mean.size()});
  });
  refuses("ascend", [](TensorFile& file) {
    file.tensors["distances"] = MakeTensor<float>(std::vector<float>{2, 1}, {2});
  });
  refuses("at least two", [](TensorFile& file) {
    file.tensors["distances"] = MakeTensor<float>(std::vector<float>{2}, {1});
  });

  WriteFamiliarity(folder_, std::nullopt, kData);
  EXPECT_FALSE(ReadFamiliarity(folder_, kData, NetworkFamily::kMotion));
}

}  // namespace
}  // namespace doorforge
