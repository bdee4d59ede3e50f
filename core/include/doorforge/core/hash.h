// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

struct evp_md_ctx_st;  // of libcrypto, known to hash.cpp alone

namespace doorforge {

/// Incremental SHA-256 (FIPS 180-4), computed by OpenSSL's libcrypto, which uses the processor's
/// own instructions for it. Movable. Throws std::bad_alloc alone.
class Sha256 {
 public:
  Sha256();
  void Update(std::span<const std::byte> bytes);
  void Update(std::string_view text);
  /// 64 lower-case hexadecimal digits; the object may not be used afterwards.
  std::string HexDigest();

 private:
  struct Delete {
    void operator()(evp_md_ctx_st* context) const;
  };
  std::unique_ptr<evp_md_ctx_st, Delete> context_;
};

std::string Sha256Hex(std::string_view text);

/// Throws Error(kMissing or kIo) when the file cannot be read.
std::string Sha256OfFile(const std::filesystem::path& path);

/// CRC-32C (Castagnoli, RFC 3720 appendix B.4), reflected, initial and final xor 0xFFFFFFFF.
/// Pass a previous result as `crc` to continue it.
std::uint32_t Crc32c(std::span<const std::byte> bytes, std::uint32_t crc = 0);

}  // namespace doorforge
