// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace doorforge {

/// Incremental SHA-256 (FIPS 180-4).
class Sha256 {
 public:
  Sha256();
  void Update(std::span<const std::byte> bytes);
  void Update(std::string_view text);
  /// 64 lower-case hexadecimal digits; the object may not be used afterwards.
  std::string HexDigest();

 private:
  void Compress(const std::byte* block);

  std::array<std::uint32_t, 8> state_;
  std::array<std::byte, 64> buffer_{};
  std::uint64_t length_ = 0;
};

std::string Sha256Hex(std::string_view text);

/// Throws Error(kMissing or kIo) when the file cannot be read.
std::string Sha256OfFile(const std::filesystem::path& path);

/// CRC-32C (Castagnoli, RFC 3720 appendix B.4), reflected, initial and final xor 0xFFFFFFFF.
/// Pass a previous result as `crc` to continue it.
std::uint32_t Crc32c(std::span<const std::byte> bytes, std::uint32_t crc = 0);

}  // namespace doorforge
