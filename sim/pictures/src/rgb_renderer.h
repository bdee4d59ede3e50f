// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "doorforge/pictures/take_pictures.h"
#include "doorforge/schemas/camera_model.h"
#include "doorforge/sensor/depth_camera.h"
#include "doorforge/sensor/ray_packet.h"
#include "doorforge/sensor/scene_geometry.h"

#include "appearance.h"
#include "drawn_surfaces.h"
#include "light_shares.h"
#include "picture_room.h"
#include "seen_point.h"

namespace doorforge {

class PinholeDirections;

/// What of a picture is coloured.
enum class PicturePart { kAll, kSurfaces };

/// Colours what a camera sees: lamps with soft shadows, light from all around that corners keep
/// out, highlights, mirrors, glass, and the camera's own faults.
///
/// Pixels whose neighbours see something else, and whose corners do, are what `samples` rays meet;
/// others would meet the same with each. What reaches a pixel of light is found by ShareLight().
class RgbRenderer {
 public:
  /// `geometry` is rendered from whenever Render() is called, its links where they were last put.
  RgbRenderer(const PictureScene& scene, const PicturesConfig& config, SceneGeometry& geometry);

  /// sRGB, height x width x 3.
  ///
  /// @param surfaces What the camera sees, with the links where they are now.
  /// @param look Number of the look: its noise is named by it.
  /// @param part With kSurfaces the pixels that show the room have any colour; the others' are the
  ///     same, in as much less time as there are fewer of them.
  std::vector<std::uint8_t> Render(const CameraModel& camera, const SurfaceImage& surfaces,
                                   std::size_t look, PicturePart part = PicturePart::kAll);

 private:
  // The height of a lamp's highlight by the cosine to its middle, which a power would say too
  // slowly. It is 0 where the power is below 1 / 4096.
  class Highlight {
   public:
    explicit Highlight(float exponent);
    float At(float cosine) const {
      if (!(cosine > least_)) return 0;
      const float place = (cosine - least_) * scale_;
      const auto step = static_cast<std::size_t>(place);
      if (step >= kSteps) return 1;
      return table_[step] + (place - static_cast<float>(step)) * (table_[step + 1] - table_[step]);
    }

   private:
    static constexpr std::size_t kSteps = 128;
    float least_;
    float scale_;
    std::array<float, kSteps + 1> table_;
  };
  struct Material {
    Finish finish;
    Highlight highlight;
  };
  // Where a mesh is, in floats.
  struct MeshFrame {
    Eigen::Matrix3f world_from_mesh;
    Eigen::Vector3f origin;

    Eigen::Vector3f InMesh(const Eigen::Vector3f& point) const {
      return world_from_mesh.transpose() * (point - origin);
    }
  };
  static constexpr int kCornerTile = 4;  // corners a side whose rays are cast together
  static_assert(kCornerTile * kCornerTile == RayPacket::kSize);
  // One of the rays through an edge pixel.
  struct EdgeSample {
    const PacketHits& hits;
    std::size_t slot;
    const Eigen::Vector3f& origin;
    const Eigen::Vector3f& through;
  };
  class MetSurfaces;

  void PlaceMeshes();
  SeenPoint MeshPoint(std::size_t mesh, std::size_t triangle, const Eigen::Vector2f& uv,
                      const Eigen::Vector3f& position) const;
  SeenPoint RoomPoint(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) const;
  bool IsPane(std::size_t mesh, const Eigen::Vector3f& in_mesh) const;
  std::uint16_t PaneMaterial() const { return static_cast<std::uint16_t>(frames_.size()); }
  LinearColor AlbedoOf(const SeenPoint& point);

  void FindPoints(const CameraModel& camera, const SurfaceImage& surfaces);
  LinearColor Shade(const SeenPoint& point, const LightShares& shares);
  LinearColor RoomLight(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction);
  LinearColor Behind(const SeenPoint& pane);
  void ShadePixels();
  // smooth_edges.cpp
  void SmoothEdges(const CameraModel& camera);
  bool IsWantedEdge(int column, int row) const;
  bool HasOneSurface(int column, int row) const;
  void FindCorners(const PinholeDirections& directions);
  void FindCornersOfTile(const PinholeDirections& directions, const Eigen::Vector2i& left_top,
                         const std::vector<std::uint8_t>& is_wanted);
  SeenPoint PointMet(const EdgeSample& sample) const;
  std::size_t CornerAt(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width + 1) +
           static_cast<std::size_t>(x);
  }
  LinearColor EdgeColor(const PinholeDirections& directions, int column, int row);
  LinearColor SampleColor(const EdgeSample& sample, const Eigen::Vector2i& pixel, MetSurfaces& met);
  const LinearColor* ColorNear(const SeenPoint& point, int column, int row) const;

  SceneGeometry& geometry_;
  std::optional<DrawnSurfaces> drawn_;  // where their authors' looks are wanted, and there are any
  PictureRoom room_;
  Appearance appearance_;
  LitScene lit_;
  std::size_t door_meshes_ = 0;                  // the first of all are the door's
  std::vector<Eigen::AlignedBox3f> pane_boxes_;  // by mesh; empty where there is no pane
  std::vector<Material> materials_;              // of meshes, the pane, the parts of the room
  int samples_;
  int rounds_;  // each pixel looks once a round for a place of each lamp
  std::uint32_t seed_;

  std::vector<MeshFrame> frames_;  // by mesh
  PointImage image_;
  std::vector<LightShares> light_;
  std::vector<LinearColor> colors_;
  std::vector<SeenPoint> corners_;  // of pixels, row by row; those alone that an edge pixel has
};

}  // namespace doorforge
