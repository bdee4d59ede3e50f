// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Every bit of a shard of 64 KiB, and every length that it can be cut to.

#include <algorithm>
#include <cstddef>
#include <optional>

#include <fcntl.h>
#include <sys/mman.h>

#include "doorforge/core/error.h"
#include "doorforge/schemas/shard.h"

#include "shard_fixture.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

// The file's pages, shared with whoever else has it mapped.
class WritableMapping {
 public:
  explicit WritableMapping(const fs::path& path) : size_(fs::file_size(path)) {
    const int file = ::open(path.c_str(), O_RDWR);
    data_ = static_cast<unsigned char*>(
        ::mmap(nullptr, size_, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0));
    ::close(file);
  }
  WritableMapping(const WritableMapping&) = delete;
  WritableMapping& operator=(const WritableMapping&) = delete;
  ~WritableMapping() { ::munmap(data_, size_); }

  void Flip(std::size_t bit) { data_[bit / 8] ^= static_cast<unsigned char>(1U << (bit % 8)); }
  std::size_t size() const { return size_; }

 private:
  std::size_t size_;
  unsigned char* data_ = nullptr;
};

class DamagedShard : public fixture::FolderTest {
 protected:
  void SetUp() override {
    FolderTest::SetUp();
    ShardWriter writer(folder_, {0, "open", "train", std::string(64, 'c')});
    for (int i = 0; i < 2; ++i) {
      const Episode episode = fixture::MakeEpisode(static_cast<std::uint64_t>(i), 3, 550);
      writer.Add("ep" + std::to_string(100000 + i), 3, fixture::MembersOf(episode));
    }
    writer.AddFailure({"ep100002", "door_9", "grip_lost", "at 0.3 rad", 0.3, 0.7});
    writer.Commit();
    EXPECT_GT(fs::file_size(tar()), 60U << 10);
    EXPECT_LT(fs::file_size(tar()), 80U << 10);
  }

  fs::path tar() const { return folder_ / "shard-000000.tar"; }
  fs::path index() const { return folder_ / "shard-000000.index.json"; }

  bool CanBeOpened() const {
    try {
      const ShardReader reader(index());
      return true;
    } catch (const Error&) {
      return false;
    }
  }
};

// Where in the index a byte of the tar belongs.
struct Place {
  std::size_t episode;
  std::string member;
};

std::vector<std::optional<Place>> PlacesOf(const ShardIndex& index) {
  std::vector<std::optional<Place>> places(index.tar_bytes);
  for (std::size_t i = 0; i < index.episodes.size(); ++i) {
    for (const ShardMember& member : index.episodes[i].members)
      std::fill_n(places.begin() + static_cast<std::ptrdiff_t>(member.offset), member.size,
                  Place{i, member.name});
  }
  return places;
}

bool IsNoticed(const ShardReader& reader, const std::optional<Place>& place) {
  if (!place) return reader.FindFrameFault().has_value();
  try {
    static_cast<void>(reader.Read(place->episode, place->member));
    return false;
  } catch (const Error&) {
    return true;
  }
}

TEST_F(DamagedShard, IsNoticedForEachFlippedBitOfTheTar) {
  const ShardReader reader(index(), CrcCheck::kOnEveryRead);
  const std::vector<std::optional<Place>> places = PlacesOf(reader.index());
  WritableMapping mapping(tar());
  ASSERT_FALSE(reader.FindFrameFault().has_value());
  ASSERT_TRUE(reader.FindFaults().empty());
  std::size_t unnoticed = 0;
  for (std::size_t bit = 0; bit < 8 * mapping.size(); ++bit) {
    mapping.Flip(bit);
    if (!IsNoticed(reader, places[bit / 8])) ++unnoticed;
    // the whole check, SHA-256 and all, now and then
    if (bit % 4099 == 0) {
      EXPECT_FALSE(reader.FindFaults().empty()) << "bit " << bit;
    }
    mapping.Flip(bit);
  }
  EXPECT_EQ(unnoticed, 0U);
  EXPECT_TRUE(reader.FindFaults().empty());
}

TEST_F(DamagedShard, IsNoticedForEachFlippedBitOfTheIndex) {
  WritableMapping mapping(index());
  for (std::size_t bit = 0; bit < 8 * mapping.size(); ++bit) {
    mapping.Flip(bit);
    EXPECT_FALSE(CanBeOpened()) << "bit " << bit;
    mapping.Flip(bit);
  }
  EXPECT_TRUE(CanBeOpened());
}

TEST_F(DamagedShard, IsNoticedWhereverItIsCut) {
  const std::string text = fixture::Slurp(index());
  for (std::size_t length = text.size(); length-- > 0;) {
    fs::resize_file(index(), length);
    EXPECT_FALSE(CanBeOpened()) << "index of " << length << " bytes";
  }
  fixture::Spill(index(), text);
  EXPECT_TRUE(CanBeOpened());
  for (std::size_t length = fs::file_size(tar()); length-- > 0;) {
    fs::resize_file(tar(), length);
    EXPECT_FALSE(CanBeOpened()) << "tar of " << length << " bytes";
  }
}

TEST_F(DamagedShard, IsReadWithoutAChecksumAsEarlierBuildsWroteIt) {
  nlohmann::ordered_json json = nlohmann::ordered_json::parse(fixture::Slurp(index()));
  json.erase("index_crc32c");
  fixture::Spill(index(), json.dump(2) + "\n");
  EXPECT_TRUE(CanBeOpened());
}

}  // namespace
}  // namespace doorforge
