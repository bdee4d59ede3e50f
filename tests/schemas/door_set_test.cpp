// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/door_set.h"

#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/json_file.h"
#include "doorforge/schemas/door_index.h"

#include "../physics/primitive_door.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

class DoorSetTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() /
              ("door_set_test_" + std::string(test->name()) + "_" + std::to_string(::getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "empty");
  }
  void TearDown() override { fs::remove_all(folder_); }

  void Write(const std::string& id, const std::string& place, double width_m = 0.8) const {
    PrimitiveDoor shape;
    shape.width_m = width_m;
    DoorAsset door = MakePrimitiveDoor(shape);
    door.id = id;
    door.body.id = id + "_body";
    door.body.sha256 = std::string(64, 'b');
    door.handle.id = id + "_handle";
    door.handle.shape = ShapeDescriptor(13, 0.25);
    fs::remove_all(folder_ / place);
    fs::create_directories(folder_ / place);
    WriteDoor(door, folder_ / place);
  }

  std::vector<FoundDoor> Find(DoorSelection selection = {}) const {
    if (selection.folders.empty()) selection.folders = {folder_};
    return FindDoorSet(selection, 2).doors;
  }

  // What the doors are, by reading each with all its meshes.
  static DoorIdentity Read(const fs::path& folder) { return IdentityOf(ReadDoor(folder)); }

  static std::string RefusalOf(ErrorCode code, const std::function<void()>& call) {
    try {
      call();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), code) << error.what();
      return error.what();
    }
    ADD_FAILURE() << "nothing was refused";
    return "";
  }

  fs::path IndexFile() const { return folder_ / kDoorIndexFile; }

  // Changes the one door of the index, or the index itself.
  void Forge(const std::function<void(nlohmann::ordered_json&)>& change) const {
    nlohmann::ordered_json json = ReadJsonFile(IndexFile());
    change(json);
    WriteJsonFile(IndexFile(), json);
  }

  fs::path folder_;
};

TEST_F(DoorSetTest, FindsDoorsAtAnyDepthAndSortsThemById) {
  Write("b", "x/deep/first");
  Write("a", "y");
  const auto doors = Find({.folders = {folder_ / "x", folder_ / "y"}});
  ASSERT_EQ(doors.size(), 2U);
  EXPECT_EQ(doors[0].identity, Read(folder_ / "y"));
  EXPECT_EQ(doors[1].identity, Read(folder_ / "x/deep/first"));
  EXPECT_EQ(doors[1].folder, folder_ / "x/deep/first");
}

TEST_F(DoorSetTest, WhatAKilledProgramLeftIsNoDoor) {
  Write("a", "doors/a");
  Write("b", "doors/.staged/b");
  ASSERT_EQ(Find().size(), 1U);
  EXPECT_EQ(Find()[0].identity.id, "a");
  EXPECT_EQ(Find({.folders = {folder_ / "doors/.staged"}}).size(), 1U) << "it is named itself";
}

TEST_F(DoorSetTest, ASelectionTakesSomeOfEachCategoryWhetherThereIsAnIndexOrNot) {
  for (const char* id : {"a", "b", "c", "d", "e", "f"}) Write(id, id);
  std::vector<std::string> drawn[2];
  for (const bool indexed : {false, true}) {
    if (indexed) WriteDoorIndex(folder_, 1);
    for (const auto& door : Find({.folders = {}, .per_category = 3}))
      drawn[indexed ? 1 : 0].push_back(door.identity.id);
  }
  EXPECT_EQ(drawn[0].size(), 3U);
  EXPECT_EQ(drawn[0], drawn[1]);
  EXPECT_TRUE(std::ranges::is_sorted(drawn[0]));
}

TEST_F(DoorSetTest, FewerDoorsThanWereAskedForAreSaid) {
  for (const char* id : {"a", "b"}) Write(id, id);
  const auto notes = [&](int most) {
    return FindDoorSet({.folders = {folder_}, .per_category = most}, 1).notes;
  };
  EXPECT_TRUE(notes(0).empty());
  EXPECT_TRUE(notes(2).empty());
  ASSERT_EQ(notes(5).size(), 1U);
  EXPECT_EQ(notes(5)[0], "interior: all of its 2 doors, 5 were asked for");
}

TEST_F(DoorSetTest, ACategoryOfWhichTheSplitHasNoHandleIsSaid) {
  Write("a", "a");
  Write("b", "b");
  nlohmann::ordered_json car = ReadJsonFile(folder_ / "b/door.json");
  car["category"] = "car";
  WriteJsonFile(folder_ / "b/door.json", car);
  const fs::path split = folder_ / "own.yaml";
  std::ofstream(split) << "schema: doorforge.split\nschema_version: 2\n"
                       << "test: [a_body, a_handle, b_body]\n";
  const DoorSet set = FindDoorSet({.folders = {folder_}, .split = split.string() + ":test"}, 1);
  EXPECT_EQ(set.doors.size(), 1U);
  ASSERT_EQ(set.notes.size(), 1U);
  EXPECT_EQ(set.notes[0],
            "car: none of its 1 doors has body and handle of " + split.string() + ":test");
}

TEST_F(DoorSetTest, ASplitTakesDoorsOfWhichBothPartsAreOnItsSide) {
  Write("a", "a");
  const fs::path split = folder_ / "own.yaml";
  const auto write = [&](const std::string& handle) {
    std::ofstream(split) << "schema: doorforge.split\nschema_version: 1\ntrain: []\ntest: [\""
                         << "a_body\", \"" << handle << "\"]\nunseen_categories: []\n";
  };
  const auto find = [&](const std::string& side, const std::string& default_side = "test") {
    return Find({.folders = {}, .split = split.string() + side, .default_side = default_side});
  };
  for (const bool indexed : {false, true}) {
    if (indexed) WriteDoorIndex(folder_, 1);
    write("another");
    RefusalOf(ErrorCode::kMissing, [&] { find(""); });
    write("a_handle");
    EXPECT_EQ(find("").size(), 1U);
    EXPECT_EQ(find(":test").size(), 1U);
    RefusalOf(ErrorCode::kMissing, [&] { find(":train"); });
    RefusalOf(ErrorCode::kMissing, [&] { find("", "train"); });
    RefusalOf(ErrorCode::kInvalidArgument, [&] { find(":tset"); });
    RefusalOf(ErrorCode::kInvalidArgument, [&] { find("", ""); });
  }
}

TEST_F(DoorSetTest, AmongTheWordsOfDoorsMayBeOneSplit) {
  std::ofstream(folder_ / "own.yaml") << "";
  const std::string split = (folder_ / "own.yaml").string();
  const DoorSelection selection = DoorSelectionOf({split + ":test", folder_.string()}, "train");
  EXPECT_EQ(selection.split, split + ":test");
  EXPECT_EQ(selection.default_side, "train");
  EXPECT_EQ(selection.folders, std::vector<fs::path>{folder_});
  RefusalOf(ErrorCode::kInvalidArgument, [&] { DoorSelectionOf({split, split, "doors"}, "test"); });
  RefusalOf(ErrorCode::kInvalidArgument, [&] { DoorSelectionOf({split}, "test"); });
}

TEST_F(DoorSetTest, TheSameDoorTwiceCountsOnceButAnIdMustNotMeanTwoDoors) {
  Write("a", "first");
  Write("a", "copy");
  EXPECT_EQ(Find().size(), 1U);
  Write("a", "other", 0.7);
  RefusalOf(ErrorCode::kInvalidArgument, [&] { Find(); });
  WriteDoorIndex(folder_, 1);
  RefusalOf(ErrorCode::kInvalidArgument, [&] { Find(); });
}

TEST_F(DoorSetTest, AFolderWithoutDoorsIsMissingInput) {
  RefusalOf(ErrorCode::kMissing, [&] { Find({.folders = {folder_ / "empty"}}); });
  RefusalOf(ErrorCode::kMissing, [&] { Find({.folders = {folder_ / "nowhere"}}); });
}

TEST_F(DoorSetTest, EveryDoorThatCannotBeReadIsNamed) {
  for (const char* id : {"a", "b", "c"}) Write(id, id);
  CommitFile(folder_ / "a/door.json", "{");
  fs::remove_all(folder_ / "c/meshes");
  const std::string refusal = RefusalOf(ErrorCode::kFormat, [&] { Find(); });
  EXPECT_NE(refusal.find("2 doors cannot be read"), std::string::npos) << refusal;
  EXPECT_NE(refusal.find((folder_ / "a").string()), std::string::npos) << refusal;
  EXPECT_NE(refusal.find((folder_ / "c").string()), std::string::npos) << refusal;
}

TEST_F(DoorSetTest, WithAnIndexTheSameDoorsAreFoundAndNoMeshIsRead) {
  for (const char* id : {"c", "a", "b"}) Write(id, id);
  const auto read = Find();
  WriteDoorIndex(folder_, 2);
  for (const char* id : {"a", "b", "c"}) fs::rename(folder_ / id / "meshes", folder_ / id / "away");
  const auto indexed = Find();
  ASSERT_EQ(indexed.size(), 3U);
  for (std::size_t i = 0; i < indexed.size(); ++i) {
    EXPECT_EQ(indexed[i].identity, read[i].identity);
    EXPECT_EQ(indexed[i].folder, read[i].folder);
    EXPECT_TRUE(indexed[i].is_indexed);
    EXPECT_FALSE(read[i].is_indexed);
  }
  for (const char* id : {"a", "b", "c"}) fs::rename(folder_ / id / "away", folder_ / id / "meshes");
  DoorCache shelf(indexed);
  for (std::size_t i = 0; i < indexed.size(); ++i) {
    for (int time = 0; time < 2; ++time) {
      const IdentifiedDoor taken = shelf.Take(i);
      EXPECT_EQ(taken.sha256, read[i].identity.sha256);
      EXPECT_EQ(ContentHash(*taken), taken.sha256);
    }
  }
}

TEST_F(DoorSetTest, DoorsChangedAddedRenamedAndTakenAwaySinceTheIndexAreNoticed) {
  for (const char* id : {"a", "b", "c"}) Write(id, id);
  WriteDoorIndex(folder_, 1);
  Write("a", "a", 0.7);                          // changed
  fs::remove_all(folder_ / "b");                 // taken away
  fs::rename(folder_ / "c", folder_ / "moved");  // renamed: still the same door
  Write("d", "d");                               // added
  const auto doors = Find();
  ASSERT_EQ(doors.size(), 3U);
  EXPECT_EQ(doors[0].identity, Read(folder_ / "a"));
  EXPECT_FALSE(doors[0].is_indexed);
  EXPECT_EQ(doors[1].identity, Read(folder_ / "moved"));
  EXPECT_TRUE(doors[1].is_indexed);
  EXPECT_EQ(doors[2].identity, Read(folder_ / "d"));
  EXPECT_FALSE(doors[2].is_indexed);
}

// Sizes and times of files say nothing of what is in them.
TEST_F(DoorSetTest, AChangeThatKeepsSizeAndTimeOfTheFileIsNoticed) {
  Write("a", "a");
  WriteDoorIndex(folder_, 1);
  const fs::path file = folder_ / "a/door.json";
  const auto time = fs::last_write_time(file);
  std::string text = ReadFile(file);
  const std::size_t at = text.find("a_body");
  ASSERT_NE(at, std::string::npos);
  text[at] = 'z';
  std::ofstream(file) << text;
  fs::last_write_time(file, time);
  const auto doors = Find();
  EXPECT_EQ(doors.at(0).identity.body.id, "z_body");
  EXPECT_EQ(doors.at(0).identity, Read(folder_ / "a"));
}

TEST_F(DoorSetTest, AMeshChangedSinceTheIndexIsRefusedWhenTheDoorIsTaken) {
  Write("a", "a");
  WriteDoorIndex(folder_, 1);
  const auto doors = Find();
  const fs::path mesh = folder_ / "a/meshes/visual/leaf.obj";
  ASSERT_TRUE(fs::exists(mesh));
  CommitFile(mesh, ReadFile(mesh) + "v 1 2 3\n");
  DoorCache shelf(doors);
  RefusalOf(ErrorCode::kFormat, [&] { shelf.Take(0); });
}

TEST_F(DoorSetTest, AForgedEntryNeverLeadsToADoor) {
  Write("a", "a");
  WriteDoorIndex(folder_, 1);
  const std::string sound = ReadFile(IndexFile());
  const auto refused = [&](const std::function<void(nlohmann::ordered_json&)>& change) {
    Forge(change);
    const auto doors = Find();
    ASSERT_TRUE(doors.at(0).is_indexed);
    DoorCache shelf(doors);
    const std::string refusal = RefusalOf(ErrorCode::kFormat, [&] { shelf.Take(0); });
    EXPECT_NE(refusal.find((folder_ / "a").string()), std::string::npos) << refusal;
    CommitFile(IndexFile(), sound);
  };
  refused([](auto& json) { json["doors"][0]["sha256"] = std::string(64, '0'); });
  refused([](auto& json) { json["doors"][0]["id"] = "another"; });
  refused([](auto& json) { json["doors"][0]["category"] = "safe"; });
  refused([](auto& json) { json["doors"][0]["mechanism"] = "none"; });
  refused([](auto& json) { json["doors"][0]["license"] = "0BSD"; });
  refused([](auto& json) { json["doors"][0]["body"] = json["doors"][0]["handle"]; });
  refused([](auto& json) { json["parts"][0]["id"] = "unseen"; });
  refused([](auto& json) { json["parts"][1]["shape"][0] = 0.5; });
  const auto doors = Find();
  DoorCache shelf(doors);
  EXPECT_EQ(shelf.Take(0)->id, "a");
}

TEST_F(DoorSetTest, ADamagedIndexIsRefusedByNameWithTheWayOut) {
  Write("a", "a");
  WriteDoorIndex(folder_, 1);
  const std::string sound = ReadFile(IndexFile());
  const auto refused = [&] {
    const std::string refusal = RefusalOf(ErrorCode::kFormat, [&] { Find(); });
    EXPECT_NE(refusal.find(IndexFile().string()), std::string::npos) << refusal;
    EXPECT_NE(refusal.find("remove this file"), std::string::npos) << refusal;
    CommitFile(IndexFile(), sound);
  };
  for (const std::string& text :
       {sound.substr(0, sound.size() / 2), std::string(100'000, '['), std::string("\xff\xfe")}) {
    CommitFile(IndexFile(), text);
    refused();
  }
  const std::vector<std::function<void(nlohmann::ordered_json&)>> changes = {
      [](auto& json) { json["schema"] = "doorforge.door"; },
      [](auto& json) { json["schema_version"] = kDoorIndexSchemaVersion + 1; },
      [](auto& json) { json["parts"] = 3; },
      [](auto& json) {
        json["doors"] = {{"a", 1}};
      },
      [](auto& json) { json["doors"][0] = 7; },
      [](auto& json) { json["doors"].push_back(json["doors"][0]); },
      [](auto& json) { json["doors"][0]["body"] = 2; },
      [](auto& json) { json["doors"][0]["body"] = -1; },
      [](auto& json) { json["doors"][0]["sha256"] = "../../etc"; },
      [](auto& json) { json["doors"][0]["record_sha256"] = std::string(64, 'G'); },
      [](auto& json) { json["doors"][0]["id"] = "../../a"; },
      [](auto& json) { json["doors"][0]["category"] = "gate"; },
      [](auto& json) { json["doors"][0].erase("license"); }};
  for (const auto& change : changes) {
    Forge(change);
    refused();
  }
  EXPECT_EQ(Find().size(), 1U);
}

TEST_F(DoorSetTest, AnIndexHasTheSameBytesWheneverItIsWritten) {
  for (const char* id : {"c", "a", "b"}) Write(id, id);
  CommitFile(folder_ / "broken/door.json", "{");
  WriteDoorIndex(folder_, 1);
  const std::string first = ReadFile(IndexFile());
  WriteDoorIndex(folder_, 4);
  EXPECT_EQ(ReadFile(IndexFile()), first);
  const auto json = ParseJson(first, "index");
  ASSERT_EQ(json["doors"].size(), 3U) << "what cannot be read has no entry";
  EXPECT_EQ(json["doors"][0]["id"], "a");
  EXPECT_EQ(json["doors"][0]["sha256"], Read(folder_ / "a").sha256);
  EXPECT_EQ(json["doors"][0]["record_sha256"], Sha256OfFile(folder_ / "a/door.json"));
  // reads back as it was
  EXPECT_EQ(DoorIndex::FromJson(json, "index").ToText(), first);
}

TEST_F(DoorSetTest, AShelfKeepsAFewDoorsHoweverManyAreTaken) {
  Write("d00", "d00");
  const std::string record = ReadFile(folder_ / "d00/door.json");
  for (int i = 10; i < 49; ++i) {
    const std::string id = "d" + std::to_string(i);
    fs::copy(folder_ / "d00", folder_ / id, fs::copy_options::recursive);
    std::string other = record;
    other.replace(other.find("\"d00\""), 5, '"' + id + '"');
    std::ofstream(folder_ / id / "door.json") << other;
  }
  const auto doors = Find();
  DoorCache shelf(doors);
  std::vector<std::weak_ptr<const DoorAsset>> taken;
  for (std::size_t i = 0; i < doors.size(); ++i) taken.push_back(shelf.Take(i).door);
  std::size_t kept = 0;
  for (const auto& door : taken) kept += door.expired() ? 0 : 1;
  EXPECT_EQ(kept, 32U);
  EXPECT_EQ(shelf.Take(39).door, taken[39].lock()) << "what was taken last is there still";
  EXPECT_EQ(shelf.Take(0)->id, doors[0].identity.id);
}

TEST_F(DoorSetTest, DoorsOfARecordAreFoundById) {
  Write("a", "x/a");
  Write("b", "x/b");
  std::vector<DatasetDoor> recorded;
  for (const FoundDoor& door : Find()) recorded.push_back(DatasetDoorOf(door.identity));
  recorded.insert(recorded.begin(), recorded[0]);
  recorded[0].id = "gone";
  const auto doors = FindRecordedDoors({.folders = {folder_}}, recorded, 1);
  ASSERT_EQ(doors.size(), 3U);
  DoorCache shelf(doors);
  RefusalOf(ErrorCode::kMissing, [&] { shelf.Take(0); });
  EXPECT_EQ(shelf.Take(1)->id, "a");
  Write("b", "x/b", 0.7);
  RefusalOf(ErrorCode::kFormat, [&] { shelf.Take(2); });
  recorded.resize(1);
  RefusalOf(ErrorCode::kInvalidArgument,
            [&] { FindRecordedDoors({.folders = {folder_}}, recorded, 1); });
}

// It keeps a reference, so a list that nobody else keeps is refused as the program is compiled.
static_assert(std::is_constructible_v<DoorCache, std::vector<FoundDoor>&>);
static_assert(!std::is_constructible_v<DoorCache, std::vector<FoundDoor>>);

}  // namespace
}  // namespace doorforge
