// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "doorforge/core/error.h"
#include "doorforge/core/file_system.h"

namespace doorforge::synthetic {

/// What becomes of one file operation.
enum class Fault {
  kRefused,     ///< It fails and does nothing, as fsync does on a bad disk.
  kDiskFull,    ///< It and all writes after it; the first writes half of its bytes.
  kKilled,      ///< The process ends before it.
  kKilledHalf,  ///< The process ends in it; a write has written half of its bytes.
  kPowerCut,    ///< The machine stops before it: what no fsync has seen is lost.
};

/// Thrown where the process would have ended; nothing on the disk changes after it.
struct Killed {};

/// The system's files with a fault at one operation. Does not wait for the disk.
class FaultyFiles : public FileSystem {
 public:
  FaultyFiles(Fault fault, int at) : fault_(fault), at_(at) {}

  int operations() const { return count_; }

  int Create(const std::filesystem::path& path) override {
    Step(path);
    return Opened(SystemFiles().Create(path), path);
  }
  int OpenToAppend(const std::filesystem::path& path) override {
    Step(path);
    return Opened(SystemFiles().OpenToAppend(path), path);
  }
  std::size_t WriteSome(int file, std::string_view bytes,
                        const std::filesystem::path& path) override {
    const bool is_faulty = count_ == at_;
    if (is_full_) Refuse(path);
    if (is_faulty && (fault_ == Fault::kDiskFull || fault_ == Fault::kKilledHalf))
      WriteAll(SystemFiles(), file, bytes.substr(0, bytes.size() / 2), path);
    Step(path);
    return SystemFiles().WriteSome(file, bytes, path);
  }
  void Truncate(int file, std::uint64_t size, const std::filesystem::path& path) override {
    Step(path);
    SystemFiles().Truncate(file, size, path);
    synced_[path.string()] = std::min(synced_[path.string()], size);
  }
  void Sync(int, const std::filesystem::path& path) override {
    Step(path);
    synced_[path.string()] = std::filesystem::file_size(path);
  }
  void SyncFolder(const std::filesystem::path& folder) override { Step(folder); }
  void CreateFolder(const std::filesystem::path& folder) override {
    Step(folder);
    SystemFiles().CreateFolder(folder);
  }
  void Rename(const std::filesystem::path& from, const std::filesystem::path& to) override {
    Step(to);
    SystemFiles().Rename(from, to);
    Move(from, to);
  }
  bool RenameToNew(const std::filesystem::path& from, const std::filesystem::path& to) override {
    Step(to);
    const bool is_done = SystemFiles().RenameToNew(from, to);
    if (is_done) Move(from, to);
    return is_done;
  }
  bool HardLink(const std::filesystem::path& from, const std::filesystem::path& to) override {
    Step(to);
    return links_ && SystemFiles().HardLink(from, to);
  }
  void Remove(const std::filesystem::path& path) override {
    Step(path);
    SystemFiles().Remove(path);
    synced_.erase(path.string());
  }
  void Close(int file) noexcept override { SystemFiles().Close(file); }

  /// As between two file systems.
  void RefuseLinks() { links_ = false; }

 private:
  void Step(const std::filesystem::path& path) {
    if (is_dead_) throw Killed{};
    if (count_++ != at_) return;
    switch (fault_) {
      case Fault::kRefused:
        throw Error(ErrorCode::kIo, path.string() + ": refused by the test");
      case Fault::kDiskFull:
        is_full_ = true;
        Refuse(path);
      case Fault::kPowerCut:
        for (const auto& [name, size] : synced_) {
          if (std::filesystem::exists(name)) std::filesystem::resize_file(name, size);
        }
        [[fallthrough]];
      default:
        is_dead_ = true;
        throw Killed{};
    }
  }

  [[noreturn]] static void Refuse(const std::filesystem::path& path) {
    throw Error(ErrorCode::kIo, path.string() + ": No space left on device");
  }

  int Opened(int file, const std::filesystem::path& path) {
    synced_.emplace(path.string(), std::filesystem::file_size(path));
    return file;
  }

  void Move(const std::filesystem::path& from, const std::filesystem::path& to) {
    const auto found = synced_.find(from.string());
    if (found == synced_.end()) return;
    synced_[to.string()] = found->second;
    synced_.erase(found);
  }

  Fault fault_;
  int at_;
  int count_ = 0;
  bool is_dead_ = false;
  bool is_full_ = false;
  bool links_ = true;
  std::map<std::string, std::uint64_t> synced_;
};

}  // namespace doorforge::synthetic
