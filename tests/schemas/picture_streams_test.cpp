// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/picture_streams.h"

#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/schemas/dataset.h"
#include "doorforge/schemas/npy.h"

#include "shard_fixture.h"

namespace doorforge {
namespace {

using PictureStreamsTest = fixture::FolderTest;

TEST(PictureStreams, NamesTypesAndShapesBelongTogether) {
  EXPECT_EQ(PictureName(PictureStream::kDepth32, "left_eye"), "depth32_left_eye");
  const auto type = [](const std::string& name, const std::vector<std::size_t>& shape) {
    const auto feature = PictureFeature(name, shape);
    return feature ? feature->type : "none";
  };
  EXPECT_EQ(type("depth_front", {4, 6}), "<u2");
  EXPECT_EQ(type("depth32_front", {4, 6}), "<f4");
  EXPECT_EQ(type("label_a_b", {4, 6}), "|u1");
  EXPECT_EQ(type("normal_front", {4, 6, 3}), "|i1");
  EXPECT_EQ(type("pose_front", {3, 4}), "<f8");
  EXPECT_EQ(type("depth_front", {4, 6, 1}), "none");
  EXPECT_EQ(type("depth_front", {0, 6}), "none");
  EXPECT_EQ(type("normal_front", {4, 6}), "none");
  EXPECT_EQ(type("pose_front", {4, 4}), "none");
  EXPECT_EQ(type("label", {40}), "none");
  EXPECT_EQ(type("depth_", {4, 6}), "none");
  EXPECT_EQ(type("action", {9}), "none");
  EXPECT_EQ(type("cloud_rgb", {40, 3}), "|u1");
  EXPECT_EQ(type("cloud_rgb", {40, 4}), "none");
  EXPECT_EQ(type("cloud_rgb", {0, 3}), "|u1");
  EXPECT_EQ(PictureFeature("cloud_rgb", {40, 3})->shape, (std::vector<std::size_t>{0, 3}));
}

// A data set of one shard of one episode of three decisions with one more array.
void WriteWith(const std::filesystem::path& folder, const MemberBytes& picture) {
  ShardWriter writer(folder / "open" / "train", {0, "open", "train", std::string(64, '0')});
  std::vector<MemberBytes> members = fixture::MembersOf(fixture::MakeEpisode(1));
  members.push_back(picture);
  writer.Add("ep000001", 3, members);
  writer.Commit();
}

TEST_F(PictureStreamsTest, ADataSetsRecordDescribesThemAndReadsBack) {
  const std::vector<std::uint16_t> depth(3 * 2 * 5, 7);
  WriteWith(folder_, {"depth_front.npy", MakeNpy<std::uint16_t>(depth, {3, 2, 5})});
  const DatasetRecord record = SummarizeShards(folder_);
  ASSERT_EQ(record.pictures.size(), 1U);
  EXPECT_EQ(record.pictures[0].name, "depth_front");
  const auto json = DatasetToJson(record);
  EXPECT_EQ(json.at("features").back().at("dtype"), "<u2");
  EXPECT_EQ(json.at("features").back().at("shape"), nlohmann::ordered_json({"decisions", 2, 5}));
  EXPECT_EQ(DatasetToJson(DatasetFromJson(json, "record")), json);
}

// The fixture's clouds have 40 points.
TEST_F(PictureStreamsTest, ThereAreAsManyColoursAsPoints) {
  const std::vector<std::uint8_t> colors(3 * 41 * 3, 7);
  const std::span<const std::uint8_t> fitting(colors.data(), 3 * 40 * 3);
  WriteWith(folder_ / "a", {"cloud_rgb.npy", MakeNpy<std::uint8_t>(fitting, {3, 40, 3})});
  const auto json = DatasetToJson(SummarizeShards(folder_ / "a"));
  EXPECT_EQ(json.at("features").back().at("shape"),
            nlohmann::ordered_json({"decisions", "points", 3}));
  EXPECT_EQ(DatasetFromJson(json, "record").pictures.at(0).name, "cloud_rgb");
  EXPECT_EQ(DatasetToJson(DatasetFromJson(json, "record")), json);
  WriteWith(folder_ / "b", {"cloud_rgb.npy", MakeNpy<std::uint8_t>(colors, {3, 41, 3})});
  EXPECT_THROW(SummarizeShards(folder_ / "b"), Error);
}

TEST_F(PictureStreamsTest, AnArrayThatIsOnlyCalledSoIsRefused) {
  const std::vector<std::uint8_t> bytes(4 * 2 * 5, 7);
  WriteWith(folder_, {"depth_front.npy", MakeNpy<std::uint8_t>(bytes, {4, 2, 5})});
  try {
    SummarizeShards(folder_);
    FAIL() << "was taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kFormat);
    EXPECT_NE(std::string(error.what()).find("ep000001.depth_front.npy"), std::string::npos);
  }
}

}  // namespace
}  // namespace doorforge
