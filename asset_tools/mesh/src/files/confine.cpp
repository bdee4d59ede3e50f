// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/mesh/confine.h"

#include <array>
#include <cerrno>
#include <cstdint>
#include <memory>

#include <fcntl.h>
#include <linux/landlock.h>
#include <seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace doorforge::internal {
namespace {

namespace fs = std::filesystem;

// ---- files: Landlock ----------------------------------------------------------------------------

// Rights by the version that brought them; headers of the distribution know the first alone.
constexpr std::uint64_t kFileRightsOfVersion1 = (1ULL << 13) - 1;  // execute ... make_sym
constexpr std::uint64_t kRefer = 1ULL << 13;                       // version 2
constexpr std::uint64_t kTruncate = 1ULL << 14;                    // version 3
constexpr std::uint64_t kIoctlOfDevices = 1ULL << 15;              // version 5
constexpr std::uint64_t kConnections = 3;                          // version 4: bind, connect
constexpr std::uint64_t kScopes = 3;  // version 6: abstract sockets, signals

// The kernel declares it so since version 6; what earlier versions know is its beginning.
struct RulesetAttributes {
  std::uint64_t files = 0;
  std::uint64_t connections = 0;
  std::uint64_t scopes = 0;
};

RulesetAttributes EverythingIn(int version) {
  RulesetAttributes handled;
  handled.files = kFileRightsOfVersion1;
  if (version >= 2) handled.files |= kRefer;
  if (version >= 3) handled.files |= kTruncate;
  if (version >= 5) handled.files |= kIoctlOfDevices;
  if (version >= 4) handled.connections = kConnections;
  if (version >= 6) handled.scopes = kScopes;
  return handled;
}

std::size_t SizeIn(int version) {
  if (version >= 6) return sizeof(RulesetAttributes);
  return version >= 4 ? 2 * sizeof(std::uint64_t) : sizeof(std::uint64_t);
}

void AllowReading(int ruleset, const fs::path& path) {
  const int place = ::open(path.c_str(), O_PATH | O_CLOEXEC);
  if (place < 0) return;
  struct stat kind {};
  ::fstat(place, &kind);
  landlock_path_beneath_attr rule{};
  rule.allowed_access = LANDLOCK_ACCESS_FS_READ_FILE;
  if (S_ISDIR(kind.st_mode)) rule.allowed_access |= LANDLOCK_ACCESS_FS_READ_DIR;
  rule.parent_fd = place;
  ::syscall(SYS_landlock_add_rule, ruleset, LANDLOCK_RULE_PATH_BENEATH, &rule, 0);
  ::close(place);
}

bool ConfineFiles(int version, std::span<const fs::path> readable) {
  const RulesetAttributes handled = EverythingIn(version);
  const auto ruleset =
      static_cast<int>(::syscall(SYS_landlock_create_ruleset, &handled, SizeIn(version), 0));
  if (ruleset < 0) return false;
  for (const fs::path& path : readable) AllowReading(ruleset, path);
  const bool done = ::syscall(SYS_landlock_restrict_self, ruleset, 0) == 0;
  ::close(ruleset);
  return done;
}

// ---- system calls: seccomp ----------------------------------------------------------------------

// What reading, computing and ending take, whatever the arguments.
constexpr std::array kHarmless{SCMP_SYS(read),
                               SCMP_SYS(readv),
                               SCMP_SYS(pread64),
                               SCMP_SYS(write),
                               SCMP_SYS(writev),
                               SCMP_SYS(close),
                               SCMP_SYS(lseek),
                               SCMP_SYS(fstat),
                               SCMP_SYS(stat),
                               SCMP_SYS(lstat),
                               SCMP_SYS(newfstatat),
                               SCMP_SYS(statx),
                               SCMP_SYS(access),
                               SCMP_SYS(faccessat),
                               SCMP_SYS(faccessat2),
                               SCMP_SYS(readlink),
                               SCMP_SYS(readlinkat),
                               SCMP_SYS(getcwd),
                               SCMP_SYS(getdents64),
                               SCMP_SYS(fadvise64),
                               SCMP_SYS(brk),
                               SCMP_SYS(munmap),
                               SCMP_SYS(mremap),
                               SCMP_SYS(madvise),
                               SCMP_SYS(futex),
                               SCMP_SYS(getrandom),
                               SCMP_SYS(clock_gettime),
                               SCMP_SYS(clock_getres),
                               SCMP_SYS(gettimeofday),
                               SCMP_SYS(getrusage),
                               SCMP_SYS(getpid),
                               SCMP_SYS(gettid),
                               SCMP_SYS(sched_yield),
                               SCMP_SYS(rt_sigaction),
                               SCMP_SYS(rt_sigprocmask),
                               SCMP_SYS(rt_sigreturn),
                               SCMP_SYS(restart_syscall),
                               SCMP_SYS(exit),
                               SCMP_SYS(exit_group)};

constexpr scmp_datum_t kWriting = O_WRONLY | O_RDWR | O_CREAT | O_TRUNC;

using Filter = std::unique_ptr<void, void (*)(scmp_filter_ctx)>;

bool Allow(const Filter& filter, int call) {
  return ::seccomp_rule_add(filter.get(), SCMP_ACT_ALLOW, call, 0) == 0;
}

// Only where none of the bits is set in that argument.
bool AllowWithout(const Filter& filter, int call, unsigned argument, scmp_datum_t bits) {
  const scmp_arg_cmp without = SCMP_CMP(argument, SCMP_CMP_MASKED_EQ, bits, 0);
  return ::seccomp_rule_add_array(filter.get(), SCMP_ACT_ALLOW, call, 1, &without) == 0;
}

// Only where that argument is this.
bool AllowWith(const Filter& filter, int call, unsigned argument, scmp_datum_t value) {
  const scmp_arg_cmp with = SCMP_CMP(argument, SCMP_CMP_EQ, value);
  return ::seccomp_rule_add_array(filter.get(), SCMP_ACT_ALLOW, call, 1, &with) == 0;
}

bool ConfineCalls() {
  const Filter filter(::seccomp_init(SCMP_ACT_ERRNO(EPERM)), ::seccomp_release);
  if (!filter) return false;
  bool whole = true;
  for (const int call : kHarmless) whole = Allow(filter, call) && whole;
  whole = AllowWithout(filter, SCMP_SYS(open), 1, kWriting) && whole;
  whole = AllowWithout(filter, SCMP_SYS(openat), 2, kWriting) && whole;
  whole = AllowWithout(filter, SCMP_SYS(mmap), 2, PROT_EXEC) && whole;
  whole = AllowWithout(filter, SCMP_SYS(mprotect), 2, PROT_EXEC) && whole;
  for (const int what : {F_GETFL, F_GETFD, F_SETFD})  // a folder is opened with them
    whole = AllowWith(filter, SCMP_SYS(fcntl), 1, static_cast<scmp_datum_t>(what)) && whole;
  const auto itself = static_cast<scmp_datum_t>(::getpid());  // for abort()
  whole = AllowWith(filter, SCMP_SYS(tgkill), 0, itself) && whole;
  return whole && ::seccomp_load(filter.get()) == 0;
}

}  // namespace

ConfinementSupport ConfineToReading(std::span<const fs::path> readable) {
  ConfinementSupport put_up = ConfinementOfThisKernel();
  ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  if (put_up.landlock > 0 && !ConfineFiles(put_up.landlock, readable)) put_up.landlock = 0;
  put_up.seccomp = put_up.seccomp && ConfineCalls();
  return put_up;
}

}  // namespace doorforge::internal
