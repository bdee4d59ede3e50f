// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace doorforge {

/// A number at a step of a training run.
struct ScalarEvent {
  std::uint64_t step = 0;
  std::string tag;  ///< Such as "train/position_m"; what stands before the slash groups the charts.
  double value = 0;
};

/// Contents of an event file for TensorBoard (TFRecord frames of `Event` messages, each with its
/// masked CRC-32C), which it finds by a file name with "tfevents" in it. Written without the
/// library: the file is a few fields a record. The time of an event is its step, in seconds, so
/// that the same run gives the same bytes.
std::string TensorboardEvents(std::span<const ScalarEvent> events);

}  // namespace doorforge
