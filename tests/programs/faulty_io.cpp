// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Loaded before the C library of a program and of those that it starts (LD_PRELOAD): counts what
// they change below one folder of the disk, over all of them together, and makes one of these
// operations fail, fall short, or be the last. writer_faults_test.py says which and judges what
// becomes of it.
//
//     FAULTY_ROOT   the folder
//     FAULTY_STATE  a file of 8 bytes that the processes share: the count
//     FAULTY_AT     number of the operation, from 0; -1: none
//     FAULTY_KIND   EIO, EACCES or EINTR: it fails once; ENOSPC: it and all after it that need
//                   room; short: a write that takes half of its bytes; kill: nothing is done from
//                   then on
//     FAULTY_LOG    a file with a line for each operation
//     FAULTY_CLOCK  if it is set, the wall clock jumps ten years at each look, there and back
//
// A sync below the folder is counted and not done: what a power cut leaves is played from the log,
// and syncs were most of the time that this took.

#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string>

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <sys/uio.h>
#include <unistd.h>

namespace {

enum class Need { kRoom, kNone };

const char* Environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

// The next function of this name, which is the library's.
template <class Function>
Function* Real(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

long* SharedCount() {
  static long* const count = [] {
    const long file =
        ::syscall(SYS_openat, AT_FDCWD, Environment("FAULTY_STATE"), O_RDWR | O_CLOEXEC);
    void* memory = ::mmap(nullptr, sizeof(long), PROT_READ | PROT_WRITE, MAP_SHARED,
                          static_cast<int>(file), 0);
    if (memory == MAP_FAILED) ::abort();
    ::syscall(SYS_close, file);
    return static_cast<long*>(memory);
  }();
  return count;
}

const std::string& Root() {
  static const std::string root = std::string(Environment("FAULTY_ROOT")) + "/";
  return root;
}

std::string NameOf(int file) {
  char name[4096];
  const std::string link = "/proc/self/fd/" + std::to_string(file);
  const ssize_t size = ::readlink(link.c_str(), name, sizeof name);
  return size < 0 ? std::string() : std::string(name, static_cast<std::size_t>(size));
}

std::string PathOf(int folder, const char* path) {
  if (path == nullptr || path[0] == '/') return path == nullptr ? "" : path;
  if (folder != AT_FDCWD) return NameOf(folder) + "/" + path;
  char here[4096];
  return ::getcwd(here, sizeof here) == nullptr ? path : std::string(here) + "/" + path;
}

void Log(const std::string& line) {
  const long file = ::syscall(SYS_openat, AT_FDCWD, Environment("FAULTY_LOG"),
                              O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  ::syscall(SYS_write, file, line.data(), line.size());
  ::syscall(SYS_close, file);
}

/// One operation on a path. Step() says whether it is refused, with errno set.
class Operation {
 public:
  Operation(const char* name, std::string path, Need need = Need::kNone)
      : name_(name), path_(std::move(path)), need_(need) {}

  bool IsRefused() {
    if (!IsCounted()) return false;
    const int before = errno;
    const long number = __atomic_fetch_add(SharedCount(), 1, __ATOMIC_SEQ_CST);
    const long at = std::atol(Environment("FAULTY_AT"));
    const std::string kind = Environment("FAULTY_KIND");
    const bool is_it = number == at;
    if (at >= 0 && number >= at && kind == "kill") ::raise(SIGKILL);
    const bool has_no_room =
        kind == "ENOSPC" && at >= 0 && (is_it || (number > at && need_ == Need::kRoom));
    is_short_ = is_it && kind == "short";
    Log(std::string(name_) + "\t" + path_ + "\t" + std::to_string(::getpid()) + "\n");
    errno = before;
    if (has_no_room) return Refuse(ENOSPC);
    if (!is_it) return false;
    if (kind == "EIO") return Refuse(EIO);
    if (kind == "EACCES") return Refuse(EACCES);
    return kind == "EINTR" && Refuse(EINTR);
  }

  /// How many bytes of a write are taken.
  std::size_t Taken(std::size_t bytes) const { return is_short_ && bytes > 1 ? bytes / 2 : bytes; }

  bool IsCounted() const {
    return Root().size() > 1 && path_.compare(0, Root().size(), Root()) == 0;
  }

 private:
  static bool Refuse(int error) {
    errno = error;
    return true;
  }

  const char* name_;
  std::string path_;
  Need need_;
  bool is_short_ = false;
};

int Sync(const char* operation_name, int file, const char* function) {
  Operation operation(operation_name, NameOf(file));
  if (operation.IsRefused()) return -1;
  return operation.IsCounted() ? 0 : Real<int(int)>(function)(file);
}

constexpr int kChanges = O_WRONLY | O_RDWR | O_CREAT | O_TRUNC;

bool IsOpenRefused(int folder, const char* path, int flags) {
  if ((flags & kChanges) == 0) return false;
  return Operation("open", PathOf(folder, path), Need::kRoom).IsRefused();
}

mode_t ModeOf(int flags, va_list& more) {
  return (flags & (O_CREAT | __O_TMPFILE)) != 0 ? va_arg(more, mode_t) : 0;
}

// How far the clock is off at this look [s].
time_t Jump() {
  static int looks = 0;
  if (Environment("FAULTY_CLOCK")[0] == '\0') return 0;
  constexpr time_t kTenYears = 315576000;
  return __atomic_fetch_add(&looks, 1, __ATOMIC_RELAXED) % 2 == 0 ? kTenYears : -kTenYears;
}

}  // namespace

extern "C" {

int clock_gettime(clockid_t clock, timespec* now) noexcept {
  const long result = ::syscall(SYS_clock_gettime, clock, now);
  if (result == 0 && clock == CLOCK_REALTIME) now->tv_sec += Jump();
  return static_cast<int>(result);
}

int gettimeofday(timeval* now, void*) noexcept {
  timespec precise{};
  const int result = clock_gettime(CLOCK_REALTIME, &precise);
  *now = {precise.tv_sec, precise.tv_nsec / 1000};
  return result;
}

time_t time(time_t* now) noexcept {
  timespec precise{};
  clock_gettime(CLOCK_REALTIME, &precise);
  if (now != nullptr) *now = precise.tv_sec;
  return precise.tv_sec;
}

int open(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = ModeOf(flags, more);
  va_end(more);
  if (IsOpenRefused(AT_FDCWD, path, flags)) return -1;
  return Real<int(const char*, int, ...)>("open")(path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = ModeOf(flags, more);
  va_end(more);
  if (IsOpenRefused(AT_FDCWD, path, flags)) return -1;
  return Real<int(const char*, int, ...)>("open64")(path, flags, mode);
}

int openat(int folder, const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = ModeOf(flags, more);
  va_end(more);
  if (IsOpenRefused(folder, path, flags)) return -1;
  return Real<int(int, const char*, int, ...)>("openat")(folder, path, flags, mode);
}

int openat64(int folder, const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = ModeOf(flags, more);
  va_end(more);
  if (IsOpenRefused(folder, path, flags)) return -1;
  return Real<int(int, const char*, int, ...)>("openat64")(folder, path, flags, mode);
}

// What is written through it is not seen by write(): nothing of ours does.
FILE* fopen(const char* path, const char* mode) {
  if (std::strpbrk(mode, "wa+") != nullptr && IsOpenRefused(AT_FDCWD, path, O_WRONLY))
    return nullptr;
  return Real<FILE*(const char*, const char*)>("fopen")(path, mode);
}

FILE* fopen64(const char* path, const char* mode) {
  if (std::strpbrk(mode, "wa+") != nullptr && IsOpenRefused(AT_FDCWD, path, O_WRONLY))
    return nullptr;
  return Real<FILE*(const char*, const char*)>("fopen64")(path, mode);
}

ssize_t write(int file, const void* bytes, size_t size) {
  Operation operation("write", NameOf(file), Need::kRoom);
  if (operation.IsRefused()) return -1;
  return Real<ssize_t(int, const void*, size_t)>("write")(file, bytes, operation.Taken(size));
}

ssize_t writev(int file, const iovec* parts, int count) {
  Operation operation("write", NameOf(file), Need::kRoom);
  if (operation.IsRefused()) return -1;
  const bool is_short = operation.Taken(2) == 1;
  return Real<ssize_t(int, const iovec*, int)>("writev")(file, parts,
                                                         is_short && count > 1 ? 1 : count);
}

ssize_t pwrite(int file, const void* bytes, size_t size, off_t at) {
  Operation operation("write", NameOf(file), Need::kRoom);
  if (operation.IsRefused()) return -1;
  return Real<ssize_t(int, const void*, size_t, off_t)>("pwrite")(file, bytes,
                                                                  operation.Taken(size), at);
}

ssize_t pwrite64(int file, const void* bytes, size_t size, off64_t at) {
  Operation operation("write", NameOf(file), Need::kRoom);
  if (operation.IsRefused()) return -1;
  return Real<ssize_t(int, const void*, size_t, off64_t)>("pwrite64")(file, bytes,
                                                                      operation.Taken(size), at);
}

ssize_t sendfile(int to, int from, off_t* at, size_t size) {
  Operation operation("write", NameOf(to), Need::kRoom);
  if (operation.IsRefused()) return -1;
  return Real<ssize_t(int, int, off_t*, size_t)>("sendfile")(to, from, at, operation.Taken(size));
}

ssize_t sendfile64(int to, int from, off64_t* at, size_t size) {
  Operation operation("write", NameOf(to), Need::kRoom);
  if (operation.IsRefused()) return -1;
  return Real<ssize_t(int, int, off64_t*, size_t)>("sendfile64")(to, from, at,
                                                                 operation.Taken(size));
}

ssize_t copy_file_range(int from, off64_t* from_at, int to, off64_t* to_at, size_t size,
                        unsigned flags) {
  Operation operation("write", NameOf(to), Need::kRoom);
  if (operation.IsRefused()) return -1;
  return Real<ssize_t(int, off64_t*, int, off64_t*, size_t, unsigned)>("copy_file_range")(
      from, from_at, to, to_at, operation.Taken(size), flags);
}

int ftruncate(int file, off_t size) {
  if (Operation("truncate", NameOf(file)).IsRefused()) return -1;
  return Real<int(int, off_t)>("ftruncate")(file, size);
}

int ftruncate64(int file, off64_t size) {
  if (Operation("truncate", NameOf(file)).IsRefused()) return -1;
  return Real<int(int, off64_t)>("ftruncate64")(file, size);
}

int fsync(int file) { return Sync("sync", file, "fsync"); }

int fdatasync(int file) { return Sync("sync", file, "fdatasync"); }

int syncfs(int file) { return Sync("syncfs", file, "syncfs"); }

int rename(const char* from, const char* to) {
  const std::string names = PathOf(AT_FDCWD, from) + "\t" + PathOf(AT_FDCWD, to);
  if (Operation("rename", names).IsRefused()) return -1;
  return Real<int(const char*, const char*)>("rename")(from, to);
}

int renameat(int from_folder, const char* from, int to_folder, const char* to) {
  const std::string names = PathOf(from_folder, from) + "\t" + PathOf(to_folder, to);
  if (Operation("rename", names).IsRefused()) return -1;
  return Real<int(int, const char*, int, const char*)>("renameat")(from_folder, from, to_folder,
                                                                   to);
}

int renameat2(int from_folder, const char* from, int to_folder, const char* to, unsigned flags) {
  const char* name = (flags & RENAME_EXCHANGE) != 0 ? "exchange" : "rename";
  const std::string names = PathOf(from_folder, from) + "\t" + PathOf(to_folder, to);
  if (Operation(name, names).IsRefused()) return -1;
  return Real<int(int, const char*, int, const char*, unsigned)>("renameat2")(from_folder, from,
                                                                              to_folder, to, flags);
}

int link(const char* from, const char* to) {
  if (Operation("link", PathOf(AT_FDCWD, to), Need::kRoom).IsRefused()) return -1;
  return Real<int(const char*, const char*)>("link")(from, to);
}

int symlink(const char* what, const char* path) {
  if (Operation("link", PathOf(AT_FDCWD, path), Need::kRoom).IsRefused()) return -1;
  return Real<int(const char*, const char*)>("symlink")(what, path);
}

int mkdir(const char* path, mode_t mode) {
  if (Operation("mkdir", PathOf(AT_FDCWD, path), Need::kRoom).IsRefused()) return -1;
  return Real<int(const char*, mode_t)>("mkdir")(path, mode);
}

int mkdirat(int folder, const char* path, mode_t mode) {
  if (Operation("mkdir", PathOf(folder, path), Need::kRoom).IsRefused()) return -1;
  return Real<int(int, const char*, mode_t)>("mkdirat")(folder, path, mode);
}

int unlink(const char* path) {
  if (Operation("remove", PathOf(AT_FDCWD, path)).IsRefused()) return -1;
  return Real<int(const char*)>("unlink")(path);
}

int unlinkat(int folder, const char* path, int flags) {
  if (Operation("remove", PathOf(folder, path)).IsRefused()) return -1;
  return Real<int(int, const char*, int)>("unlinkat")(folder, path, flags);
}

int remove(const char* path) {
  if (Operation("remove", PathOf(AT_FDCWD, path)).IsRefused()) return -1;
  return Real<int(const char*)>("remove")(path);
}

int rmdir(const char* path) {
  if (Operation("remove", PathOf(AT_FDCWD, path)).IsRefused()) return -1;
  return Real<int(const char*)>("rmdir")(path);
}

}  // extern "C"
