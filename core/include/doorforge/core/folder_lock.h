// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace doorforge {

/// Who else may write into a folder at the same time.
enum class Writers {
  kOne,       ///< Nobody.
  kTogether,  ///< Others that said the same, as the tasks of one collection.
};

/// The right to write into a folder, for as long as this lives and the process does.
///
///     const FolderLock lock(out, "doorforge train", Writers::kOne);
///
/// It is the lock of a hidden file in the folder, in which each holder says who it is. The file is
/// removed with the last holder; one that a killed process left holds nobody up and is removed with
/// the next one.
class FolderLock {
 public:
  static constexpr const char* kFileName = ".writing";

  /// Creates the folder, which goes again with this if nothing was written into it.
  ///
  /// @param work What the writer is, for the message that another one gets: "doorforge train".
  /// @throws Error(kInvalidArgument), which names folder, holder and what to do, if someone else
  ///     writes there, in this process or another; Error(kIo), also where the file system cannot
  ///     lock.
  FolderLock(std::filesystem::path folder, const std::string& work, Writers writers);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  std::filesystem::path path_;
  bool made_folder_;
  int file_ = -1;
};

}  // namespace doorforge
