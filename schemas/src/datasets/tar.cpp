// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/tar.h"

#include <algorithm>
#include <array>
#include <optional>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

constexpr std::size_t kNameLength = 100;
constexpr std::size_t kSizeField = 124;
constexpr std::size_t kChecksumField = 148;
constexpr std::size_t kTypeField = 156;
constexpr std::size_t kPrefixField = 345;
constexpr std::size_t kPrefixLength = 155;
constexpr std::uint64_t kSizeLimit = 1ULL << 33;  // eleven octal digits

using Block = std::array<char, kTarBlock>;

void PutText(Block& block, std::size_t at, std::string_view text) {
  std::copy(text.begin(), text.end(), block.begin() + static_cast<std::ptrdiff_t>(at));
}

// `digits` octal digits, zero-padded.
void PutOctal(Block& block, std::size_t at, std::size_t digits, std::uint64_t value) {
  for (std::size_t i = digits; i-- > 0; value /= 8)
    block[at + i] = static_cast<char>('0' + value % 8);
}

// Sum of all bytes, those of the checksum field counting as blanks.
unsigned ChecksumOf(std::string_view block) {
  unsigned sum = 0;
  for (std::size_t i = 0; i < block.size(); ++i) {
    const bool is_field = i >= kChecksumField && i < kChecksumField + 8;
    sum += is_field ? static_cast<unsigned>(' ') : static_cast<unsigned char>(block[i]);
  }
  return sum;
}

// Octal digits up to a blank or zero byte.
std::optional<std::uint64_t> GetOctal(std::string_view field) {
  const std::size_t end = field.find_first_not_of("01234567");
  const std::string_view digits = field.substr(0, std::min(end, field.size()));
  if (digits.empty() || (end != std::string_view::npos && field[end] != ' ' && field[end] != '\0'))
    return std::nullopt;
  std::uint64_t value = 0;
  for (const char digit : digits) value = value * 8 + static_cast<std::uint64_t>(digit - '0');
  return value;
}

bool IsPrintable(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c < '\x7f'; });
}

// The member that a header block announces; nothing if the block is not one of ours.
std::optional<TarMember> ParseHeader(std::string_view block, std::uint64_t at) {
  const auto checksum = GetOctal(block.substr(kChecksumField, 8));
  const auto size = GetOctal(block.substr(kSizeField, 12));
  const std::string_view name = block.substr(0, std::min(block.find('\0'), kNameLength));
  const bool is_file = block[kTypeField] == '0' || block[kTypeField] == '\0';
  // other readers put it before the name
  const bool has_prefix =
      block.substr(kPrefixField, kPrefixLength).find_first_not_of('\0') != std::string_view::npos;
  if (!checksum || *checksum != ChecksumOf(block) || !size || !is_file || name.empty() ||
      !IsPrintable(name) || has_prefix)
    return std::nullopt;
  return TarMember{std::string(name), at + kTarBlock, *size};
}

}  // namespace

std::string MakeTarHeader(const std::string& name, std::uint64_t size) {
  Require(!name.empty() && name.size() <= kNameLength && IsPrintable(name),
          ErrorCode::kInvalidArgument,
          "tar: member name \"" + name + "\" is not 1 to 100 printable characters");
  Require(size < kSizeLimit, ErrorCode::kInvalidArgument, "tar: a member of 8 GiB or more");
  Block block{};
  PutText(block, 0, name);
  PutText(block, 100, "0000644");  // mode
  PutText(block, 108, "0000000");  // owner
  PutText(block, 116, "0000000");  // group
  PutOctal(block, kSizeField, 11, size);
  PutText(block, 136, "00000000000");  // time
  block[kTypeField] = '0';
  PutText(block, 257, std::string_view("ustar\00000", 8));
  PutOctal(block, kChecksumField, 6, ChecksumOf({block.data(), block.size()}));
  block[kChecksumField + 7] = ' ';
  return {block.data(), block.size()};
}

std::size_t TarPadding(std::uint64_t size) {
  return (kTarBlock - static_cast<std::size_t>(size % kTarBlock)) % kTarBlock;
}

TarListing ListTar(std::span<const std::byte> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  TarListing listing;
  std::uint64_t at = 0;
  while (text.size() - at >= kTarBlock) {
    const std::string_view block = text.substr(at, kTarBlock);
    if (block.find_first_not_of('\0') == std::string_view::npos) {
      listing.is_complete = text.size() - at >= kTarEnd;
      if (!listing.is_complete) listing.fault = "the end is cut off";
      return listing;
    }
    std::optional<TarMember> member = ParseHeader(block, at);
    if (!member) {
      listing.fault = "no valid header at byte " + std::to_string(at);
      return listing;
    }
    const std::uint64_t left = text.size() - member->offset;
    if (member->size > left || left - member->size < TarPadding(member->size)) {
      listing.fault = "member " + member->name + " at byte " + std::to_string(at) + " is cut off";
      return listing;
    }
    at = member->offset + member->size + TarPadding(member->size);
    listing.members.push_back(std::move(*member));
  }
  listing.fault = "cut off at byte " + std::to_string(text.size()) + ", within or before a header";
  return listing;
}

}  // namespace doorforge
