// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/occlusion.h"

#include <algorithm>

namespace doorforge {
namespace {

std::vector<VisibleMesh> MeshesOf(const DoorAsset& door, std::span<const DoorLinkIndex> links) {
  std::vector<VisibleMesh> meshes;
  for (const DoorLinkIndex link : links) {
    for (const DoorGeometry& geometry : door.links[static_cast<std::size_t>(link)].geometry)
      meshes.push_back({geometry.mesh, link, geometry.label});
  }
  return meshes;
}

double PixelsOf(const DepthImage& image, DoorLinkIndex link) {
  return static_cast<double>(std::count(image.link.begin(), image.link.end(), link));
}

HiddenShare Hidden(double alone, double with_door, double with_all) {
  if (alone == 0) return {};
  return {(with_door - with_all) / alone, (alone - with_door) / alone};
}

constexpr DoorLinkIndex kWhole[] = {kBaseLink, kLeafLink, kHandleLink};
constexpr DoorLinkIndex kLeaf[] = {kLeafLink};
constexpr DoorLinkIndex kHandle[] = {kHandleLink};

}  // namespace

OcclusionMeter::OcclusionMeter(const DoorAsset& door)
    : door_(MeshesOf(door, kWhole)),
      leaf_(MeshesOf(door, kLeaf)),
      handle_(MeshesOf(door, kHandle)) {}

Occlusion OcclusionMeter::Measure(const DepthImage& seen, const CameraModel& camera,
                                  const SceneSnapshot& snapshot) {
  const DepthImage door = door_.Render(camera, snapshot.door);
  const auto hidden = [&](DepthCamera& alone, DoorLinkIndex link) {
    return Hidden(PixelsOf(alone.Render(camera, snapshot.door), link), PixelsOf(door, link),
                  PixelsOf(seen, link));
  };
  return {hidden(handle_, kHandleLink), hidden(leaf_, kLeafLink)};
}

}  // namespace doorforge
