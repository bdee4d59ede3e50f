// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/progress.h"

#include <algorithm>
#include <cstdio>

#include <unistd.h>

namespace doorforge {
namespace {

using Clock = std::chrono::steady_clock;

std::string Duration(double seconds) {
  const int whole = static_cast<int>(std::clamp(seconds, 0.0, 3.6e6));
  char text[32];
  std::snprintf(text, sizeof text, "%d:%02d:%02d", whole / 3600, whole / 60 % 60, whole % 60);
  return text;
}

}  // namespace

Progress::Progress(std::string title, std::size_t total)
    : title_(std::move(title)),
      total_(total),
      terminal_(::isatty(STDERR_FILENO) == 1),
      start_(Clock::now()),
      shown_(start_) {}

Progress::~Progress() {
  const std::lock_guard lock(mutex_);
  Show(true);
}

void Progress::Advance(std::size_t count, const std::string& note) {
  const std::lock_guard lock(mutex_);
  done_ += count;
  if (!note.empty()) note_ = note;
  const auto interval = terminal_ ? std::chrono::milliseconds(200) : std::chrono::seconds(30);
  if (Clock::now() - shown_ >= interval) Show(false);
}

void Progress::Show(bool last) {
  shown_ = Clock::now();
  const double elapsed = std::chrono::duration<double>(shown_ - start_).count();
  const double rate = elapsed > 0 ? static_cast<double>(done_) / elapsed : 0;
  const double left = rate > 0 ? static_cast<double>(total_ - std::min(done_, total_)) / rate : 0;
  std::string bar;
  if (terminal_) {
    const std::size_t filled = total_ > 0 ? std::min<std::size_t>(24, done_ * 24 / total_) : 24;
    bar = "[" + std::string(filled, '#') + std::string(24 - filled, '.') + "] ";
  }
  std::fprintf(stderr, "%s%s %s%zu/%zu  %.2f/s  %s %s  %s%s", terminal_ ? "\r\033[K" : "",
               title_.c_str(), bar.c_str(), done_, total_, rate, last ? "took" : "left",
               Duration(last ? elapsed : left).c_str(), note_.c_str(),
               terminal_ && !last ? "" : "\n");
  std::fflush(stderr);
}

}  // namespace doorforge
