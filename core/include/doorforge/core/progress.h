// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <mutex>
#include <string>

namespace doorforge {

/// Progress of long work on standard error: a bar with rate and time left on a terminal, otherwise
/// a plain line every 30 s and one at the end. Safe to call from several threads.
class Progress {
 public:
  Progress(std::string title, std::size_t total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Marks `count` more items done; `note` (such as "success 93 %") is shown behind the figures.
  void Advance(std::size_t count = 1, const std::string& note = {});

 private:
  void Show(bool last);

  std::mutex mutex_;
  std::string title_;
  std::string note_;
  std::size_t total_;
  std::size_t done_ = 0;
  bool terminal_;
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point shown_;
};

}  // namespace doorforge
