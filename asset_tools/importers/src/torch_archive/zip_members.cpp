// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "torch_archive/zip_members.h"

#include <cstdint>

#include "doorforge/core/error.h"

namespace doorforge::internal {
namespace {

constexpr std::string_view kEnd("PK\x05\x06", 4);
constexpr std::string_view kEntry("PK\x01\x02", 4);
constexpr std::string_view kLocal("PK\x03\x04", 4);
constexpr std::size_t kEndSize = 22;
constexpr std::size_t kEntrySize = 46;
constexpr std::size_t kLocalSize = 30;
constexpr std::size_t kMaxMembers = 1000;

class Archive {
 public:
  Archive(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  std::map<std::string, std::string_view> Members() const {
    const std::size_t end = bytes_.rfind(kEnd);
    if (end == std::string_view::npos || end + kEndSize > bytes_.size()) Fail("no directory");
    const std::uint64_t count = Number(end + 10, 2);
    if (count > kMaxMembers) Fail("more than a thousand members");
    std::uint64_t at = Number(end + 16, 4);
    std::map<std::string, std::string_view> members;
    for (std::uint64_t i = 0; i < count; ++i) {
      if (Slice(at, 4) != kEntry) Fail("a broken directory");
      const std::uint64_t name_size = Number(at + 28, 2);
      members[std::string(Slice(at + kEntrySize, name_size))] = Member(at);
      at += kEntrySize + name_size + Number(at + 30, 2) + Number(at + 32, 2);
    }
    return members;
  }

 private:
  [[noreturn]] void Fail(const std::string& problem) const {
    throw Error(ErrorCode::kFormat, name_ + ": a ZIP archive with " + problem);
  }

  std::string_view Slice(std::uint64_t at, std::uint64_t size) const {
    if (at > bytes_.size() || size > bytes_.size() - at) Fail("a member that is cut off");
    return bytes_.substr(at, size);
  }

  std::uint64_t Number(std::uint64_t at, std::size_t size) const {
    const std::string_view slice = Slice(at, size);
    std::uint64_t number = 0;
    for (std::size_t i = size; i-- > 0;)
      number = number << 8 | static_cast<unsigned char>(slice[i]);
    return number;
  }

  std::string_view Member(std::uint64_t entry) const {
    if ((Number(entry + 8, 2) & 1) != 0) Fail("an encrypted member");
    if (Number(entry + 10, 2) != 0) Fail("a compressed member, which torch does not write");
    const std::uint64_t size = Number(entry + 20, 4);
    const std::uint64_t local = Number(entry + 42, 4);
    if (Slice(local, 4) != kLocal) Fail("a broken member");
    const std::uint64_t start = local + kLocalSize + Number(local + 26, 2) + Number(local + 28, 2);
    return Slice(start, size);
  }

  std::string_view bytes_;
  const std::string& name_;
};

}  // namespace

std::map<std::string, std::string_view> ZipMembers(std::string_view bytes,
                                                   const std::string& name) {
  return Archive(bytes, name).Members();
}

}  // namespace doorforge::internal
