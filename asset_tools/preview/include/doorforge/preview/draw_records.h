// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "doorforge/core/named_enum.h"
#include "doorforge/sensor/picture.h"

namespace doorforge {

/// What a picture is of.
enum class PreviewFocus {
  kAll,  ///< The whole, and the handle large from three sides with a bar of 50 mm and the axes.
  kWhole,
  kHandle,
};
inline constexpr NamedValue<PreviewFocus> kPreviewFocuses[] = {{PreviewFocus::kAll, "all"},
                                                               {PreviewFocus::kWhole, "whole"},
                                                               {PreviewFocus::kHandle, "handle"}};
constexpr std::span<const NamedValue<PreviewFocus>> ValuesOf(PreviewFocus) {
  return kPreviewFocuses;
}

/// How doors and parts are drawn.
struct PreviewConfig {
  double hinge_deg = 0;      ///< Doors are open by this angle, within their limits.
  double handle_deg = 0;     ///< Handles are turned by this angle, within their limits.
  double azimuth_deg = -34;  ///< Where to stand: 0 in front, positive towards the free edge.
  int columns = 6;           ///< A contact sheet has so many.
  int width = 0;             ///< Each picture has so many pixels across; 0: what is drawn decides.
  int threads = 0;           ///< 0: all processors.
  std::optional<PreviewFocus> focus = {};  ///< Nothing: kAll of one record, kWhole of several.
  bool collision = false;  ///< The collision shapes are drawn instead of the surfaces.
};

/// Draws the doors and parts in the folders, of which there is at least one: a picture, or one with
/// captions side by side where there are several. Throws as ReadDoor() and ReadPart(), and
/// Error(kFormat) for a door with a joint whose limits are the wrong way round.
Picture DrawRecords(std::span<const std::filesystem::path> folders, const PreviewConfig& config);

/// PNG of 256 x 256 pixels of the whole door or part in the folder, as catalogues show it. Throws
/// as DrawRecords(). May be called from several threads.
std::string DrawnThumbnail(const std::filesystem::path& folder);

}  // namespace doorforge
