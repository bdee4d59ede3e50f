// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/tar.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

std::string Archive(const std::vector<std::pair<std::string, std::string>>& members) {
  std::string bytes;
  for (const auto& [name, content] : members)
    bytes += MakeTarHeader(name, content.size()) + content +
             std::string(TarPadding(content.size()), '\0');
  return bytes + std::string(kTarEnd, '\0');
}

TarListing List(const std::string& bytes) { return ListTar(std::as_bytes(std::span(bytes))); }

const std::string kLong(1300, 'x');

TEST(Tar, IsListedAsItWasWritten) {
  const std::string bytes = Archive({{"a.txt", "hello"}, {"b.bin", kLong}, {"c", ""}});
  const TarListing listing = List(bytes);
  EXPECT_TRUE(listing.is_complete);
  EXPECT_EQ(listing.fault, "");
  ASSERT_EQ(listing.members.size(), 3U);
  EXPECT_EQ(listing.members[1].name, "b.bin");
  EXPECT_EQ(bytes.substr(listing.members[1].offset, listing.members[1].size), kLong);
  for (const TarMember& member : listing.members) EXPECT_EQ(member.offset % 512, 0U);
}

TEST(Tar, IsReadByTheSystemsTar) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("doorforge_tar_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "a.tar") << Archive({{"ep1.meta.json", "hello"}, {"ep1.b", kLong}});
  const std::string command = "tar -tvf '" + (folder / "a.tar").string() + "' > '" +
                              (folder / "list").string() + "' && tar -xOf '" +
                              (folder / "a.tar").string() + "' ep1.b | wc -c >> '" +
                              (folder / "list").string() + "'";
  ASSERT_EQ(std::system(command.c_str()), 0);
  std::ifstream file(folder / "list");
  const std::string list((std::istreambuf_iterator<char>(file)), {});
  std::filesystem::remove_all(folder);
  EXPECT_NE(list.find("-rw-r--r-- 0/0"), std::string::npos) << list;
  EXPECT_NE(list.find("1970-01-01"), std::string::npos) << list;
  EXPECT_NE(list.find("ep1.meta.json"), std::string::npos) << list;
  EXPECT_NE(list.find("1300"), std::string::npos) << list;
}

TEST(Tar, GivesWhatComesBeforeACut) {
  const std::string bytes = Archive({{"a", "hello"}, {"b", kLong}});
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    const TarListing listing = List(bytes.substr(0, length));
    EXPECT_FALSE(listing.is_complete) << length;
    EXPECT_NE(listing.fault, "") << length;
    const std::size_t expected = (length >= 1024 ? 1 : 0) + (length >= 1024 + 512 + 1536 ? 1 : 0);
    EXPECT_EQ(listing.members.size(), expected) << length;
  }
}

TEST(Tar, NoticesAFlippedBitInAHeader) {
  const std::string bytes = Archive({{"a", "hello"}, {"b", kLong}});
  for (std::size_t bit = 0; bit < 8 * kTarBlock; ++bit) {
    std::string damaged = bytes;
    damaged[1024 + bit / 8] = static_cast<char>(damaged[1024 + bit / 8] ^ (1 << bit % 8));
    const TarListing listing = List(damaged);
    // the checksum's own last two bytes may change without harm
    const bool harmless = bit / 8 == 154 || bit / 8 == 155;
    EXPECT_TRUE(harmless || !listing.is_complete) << "bit " << bit;
  }
}

// POSIX puts the first part of a long name there, and tarfile reads it: "x/a" is not "a".
TEST(Tar, RefusesANameThatOthersReadOtherwise) {
  std::string bytes = Archive({{"a", "hello"}});
  bytes[345] = 'x';
  int sum = std::stoi(bytes.substr(148, 6), nullptr, 8) + 'x';
  for (int digit = 153; digit >= 148; --digit, sum /= 8)
    bytes[static_cast<std::size_t>(digit)] = static_cast<char>('0' + sum % 8);
  EXPECT_EQ(List(bytes).fault, "no valid header at byte 0");
}

TEST(Tar, RefusesNamesThatReadersWouldNotFind) {
  EXPECT_THROW(MakeTarHeader("", 0), Error);
  EXPECT_THROW(MakeTarHeader(std::string(101, 'a'), 0), Error);
  EXPECT_THROW(MakeTarHeader("two words", 0), Error);
  EXPECT_THROW(MakeTarHeader("a", 1ULL << 33), Error);
  EXPECT_NO_THROW(MakeTarHeader(std::string(100, 'a'), (1ULL << 33) - 1));
}

}  // namespace
}  // namespace doorforge
