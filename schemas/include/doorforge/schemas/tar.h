// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace doorforge {

/// Uncompressed USTAR (POSIX.1-1988) as far as shards need it: regular files with short names, mode
/// 0644, and zero for owner, group and time, so that equal content gives equal bytes.

inline constexpr std::size_t kTarBlock = 512;
/// Zero bytes at the end of an archive: two blocks.
inline constexpr std::size_t kTarEnd = 2 * kTarBlock;

/// The block before a member's data.
///
/// @throws Error(kInvalidArgument) if the name is empty, longer than 100 bytes or not printable
///     ASCII, or the size is 8 GiB or more.
std::string MakeTarHeader(const std::string& name, std::uint64_t size);

/// Zero bytes between a member's data and the next block: (-size) mod 512.
std::size_t TarPadding(std::uint64_t size);

struct TarMember {
  std::string name;
  std::uint64_t offset = 0;  ///< The data begin there in the archive, at a multiple of 512.
  std::uint64_t size = 0;    ///< Bytes of data.
};

struct TarListing {
  std::vector<TarMember> members;  ///< Those that are there with all their data, in file order.
  bool is_complete = false;        ///< The archive ends as it should.
  std::string fault;               ///< Else: what is wrong and at which byte.
};

/// Walks over an archive as far as it makes sense; a cut or damaged one gives what comes before.
/// Never reads outside `bytes`. Member types other than regular files count as damage.
TarListing ListTar(std::span<const std::byte> bytes);

}  // namespace doorforge
