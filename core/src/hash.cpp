// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/hash.h"

#include <array>
#include <cstring>
#include <fstream>
#include <new>
#include <vector>

#include <openssl/evp.h>

#if defined(__x86_64__)
#include <nmmintrin.h>
#endif

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

constexpr std::array<std::uint32_t, 256> MakeCrcTable() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t crc = i;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1U) != 0 ? 0x82F63B78U : 0U);
    table[i] = crc;
  }
  return table;
}

constexpr std::array<std::uint32_t, 256> kCrcTable = MakeCrcTable();

std::uint32_t CrcByTable(std::span<const std::byte> bytes, std::uint32_t crc) {
  for (const std::byte b : bytes)
    crc = (crc >> 8) ^ kCrcTable[(crc ^ std::to_integer<std::uint32_t>(b)) & 0xFFU];
  return crc;
}

#if defined(__x86_64__)
// What a register becomes by kStreamBytes zero bytes more. A CRC is linear over GF(2), so that
// follows from what becomes of each bit.
constexpr std::size_t kStreamBytes = 1024;

class ShiftByAStream {
 public:
  ShiftByAStream() {
    constexpr std::array<std::byte, kStreamBytes> kZeros{};
    std::array<std::uint32_t, 32> of_bit{};
    for (std::size_t bit = 0; bit < 32; ++bit) of_bit[bit] = CrcByTable(kZeros, 1U << bit);
    for (std::size_t byte = 0; byte < 4; ++byte) {
      for (std::size_t value = 0; value < 256; ++value) {
        for (std::size_t bit = 0; bit < 8; ++bit)
          if ((value >> bit & 1U) != 0) table_[byte][value] ^= of_bit[8 * byte + bit];
      }
    }
  }

  std::uint32_t operator()(std::uint32_t crc) const {
    return table_[0][crc & 0xFFU] ^ table_[1][crc >> 8 & 0xFFU] ^ table_[2][crc >> 16 & 0xFFU] ^
           table_[3][crc >> 24];
  }

 private:
  std::array<std::array<std::uint32_t, 256>, 4> table_{};
};

std::uint64_t WordAt(const std::byte* bytes) {
  std::uint64_t word = 0;
  std::memcpy(&word, bytes, 8);
  return word;
}

// The instruction takes three cycles and can begin anew in each, so three streams side by side take
// no longer than one; the registers are joined behind them.
__attribute__((target("sse4.2"))) std::uint32_t CrcOfThreeStreams(const std::byte* bytes,
                                                                  std::uint32_t crc) {
  static const ShiftByAStream kShift;
  std::array<std::uint64_t, 3> crcs{crc, 0, 0};
  for (std::size_t i = 0; i < kStreamBytes; i += 8) {
    crcs[0] = _mm_crc32_u64(crcs[0], WordAt(bytes + i));
    crcs[1] = _mm_crc32_u64(crcs[1], WordAt(bytes + kStreamBytes + i));
    crcs[2] = _mm_crc32_u64(crcs[2], WordAt(bytes + 2 * kStreamBytes + i));
  }
  const std::uint32_t first_two =
      kShift(static_cast<std::uint32_t>(crcs[0])) ^ static_cast<std::uint32_t>(crcs[1]);
  return kShift(first_two) ^ static_cast<std::uint32_t>(crcs[2]);
}

__attribute__((target("sse4.2"))) std::uint32_t CrcBySse42(std::span<const std::byte> bytes,
                                                           std::uint32_t crc) {
  std::size_t i = 0;
  for (; i + 3 * kStreamBytes <= bytes.size(); i += 3 * kStreamBytes)
    crc = CrcOfThreeStreams(bytes.data() + i, crc);
  std::uint64_t crc64 = crc;
  for (; i + 8 <= bytes.size(); i += 8) crc64 = _mm_crc32_u64(crc64, WordAt(bytes.data() + i));
  return CrcByTable(bytes.subspan(i), static_cast<std::uint32_t>(crc64));
}
#endif

}  // namespace

Sha256::Sha256() : context_(::EVP_MD_CTX_new()) {
  // looked up once: a look-up costs as much as hashing a kilobyte
  static const EVP_MD* const kAlgorithm = ::EVP_MD_fetch(nullptr, "SHA256", nullptr);
  if (!context_ || ::EVP_DigestInit_ex2(context_.get(), kAlgorithm, nullptr) != 1)
    throw std::bad_alloc();
}

void Sha256::Delete::operator()(evp_md_ctx_st* context) const { ::EVP_MD_CTX_free(context); }

void Sha256::Update(std::span<const std::byte> bytes) {
  if (::EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()) != 1) throw std::bad_alloc();
}

void Sha256::Update(std::string_view text) { Update(std::as_bytes(std::span(text))); }

std::string Sha256::HexDigest() {
  std::array<unsigned char, 32> digest{};
  if (::EVP_DigestFinal_ex(context_.get(), digest.data(), nullptr) != 1) throw std::bad_alloc();
  std::string hex;
  for (const unsigned char byte : digest) {
    hex += "0123456789abcdef"[byte >> 4U];
    hex += "0123456789abcdef"[byte & 0xFU];
  }
  return hex;
}

std::string Sha256Hex(std::string_view text) {
  Sha256 hash;
  hash.Update(text);
  return hash.HexDigest();
}

std::string Sha256OfFile(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error(ErrorCode::kMissing, path.string() + ": cannot be opened for reading");
  Sha256 hash;
  std::vector<char> chunk(1 << 16);
  while (file.read(chunk.data(), static_cast<std::streamsize>(chunk.size())) || file.gcount() > 0)
    hash.Update(std::string_view(chunk.data(), static_cast<std::size_t>(file.gcount())));
  if (file.bad()) throw Error(ErrorCode::kIo, path.string() + ": read failed");
  return hash.HexDigest();
}

std::uint32_t Crc32c(std::span<const std::byte> bytes, std::uint32_t crc) {
  crc = ~crc;
#if defined(__x86_64__)
  if (__builtin_cpu_supports("sse4.2") != 0) return ~CrcBySse42(bytes, crc);
#endif
  return ~CrcByTable(bytes, crc);
}

}  // namespace doorforge
