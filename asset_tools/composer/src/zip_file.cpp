// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "zip_file.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"

namespace doorforge::internal {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kLocal = 0x04034b50;
constexpr std::uint32_t kCentral = 0x02014b50;
constexpr std::uint32_t kEnd = 0x06054b50;
constexpr std::uint16_t kVersion = 20;
constexpr std::uint16_t kUtf8 = 0x0800;
constexpr std::uint16_t kFirstDay = 0x21;  // 1980-01-01

void Append16(std::uint16_t number, std::string& bytes) {
  bytes += static_cast<char>(number & 0xff);
  bytes += static_cast<char>(number >> 8);
}

void Append32(std::uint32_t number, std::string& bytes) {
  Append16(static_cast<std::uint16_t>(number & 0xffff), bytes);
  Append16(static_cast<std::uint16_t>(number >> 16), bytes);
}

// What a member's two headers have in common.
void AppendFacts(const ZipMember& member, std::uint32_t crc, std::string& bytes) {
  const auto size = static_cast<std::uint32_t>(member.bytes.size());
  Append16(kVersion, bytes);
  Append16(kUtf8, bytes);
  Append16(0, bytes);  // stored
  Append16(0, bytes);
  Append16(kFirstDay, bytes);
  Append32(crc, bytes);
  Append32(size, bytes);
  Append32(size, bytes);
  Append16(static_cast<std::uint16_t>(member.name.size()), bytes);
  Append16(0, bytes);
}

}  // namespace

std::uint32_t Crc32(std::string_view bytes) {
  static const std::array<std::uint32_t, 256> kTable = [] {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t i = 0; i < 256; ++i) {
      std::uint32_t value = i;
      for (int bit = 0; bit < 8; ++bit) value = (value >> 1) ^ ((value & 1) != 0 ? 0xedb88320U : 0);
      table[i] = value;
    }
    return table;
  }();
  std::uint32_t crc = 0xffffffff;
  for (const char c : bytes)
    crc = kTable[(crc ^ static_cast<unsigned char>(c)) & 0xff] ^ (crc >> 8);
  return crc ^ 0xffffffff;
}

std::string ZipOf(const std::vector<ZipMember>& members) {
  std::uint64_t total = 0;
  for (const ZipMember& member : members)
    total += member.bytes.size() + 2 * member.name.size() + 128;
  Require(total < 0xffffffff && members.size() < 0xffff, ErrorCode::kInvalidArgument,
          "ZIP file: too large");
  std::string bytes;
  std::string directory;
  for (const ZipMember& member : members) {
    const auto offset = static_cast<std::uint32_t>(bytes.size());
    const std::uint32_t crc = Crc32(member.bytes);
    Append32(kLocal, bytes);
    AppendFacts(member, crc, bytes);
    bytes += member.name;
    bytes += member.bytes;
    Append32(kCentral, directory);
    Append16(kVersion, directory);
    AppendFacts(member, crc, directory);
    directory.append(10, '\0');  // no comment, first disk, no attributes
    Append32(offset, directory);
    directory += member.name;
  }
  const auto start = static_cast<std::uint32_t>(bytes.size());
  bytes += directory;
  Append32(kEnd, bytes);
  Append32(0, bytes);
  Append16(static_cast<std::uint16_t>(members.size()), bytes);
  Append16(static_cast<std::uint16_t>(members.size()), bytes);
  Append32(static_cast<std::uint32_t>(directory.size()), bytes);
  Append32(start, bytes);
  Append16(0, bytes);
  return bytes;
}

std::vector<ZipMember> MembersOf(const fs::path& folder, const std::string& top) {
  std::vector<ZipMember> members;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    members.push_back({top + "/" + entry.path().lexically_relative(folder).generic_string(),
                       ReadFile(entry.path())});
  }
  std::ranges::sort(members, {}, &ZipMember::name);
  return members;
}

}  // namespace doorforge::internal
