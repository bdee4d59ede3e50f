// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/preview/draw_records.h"

#include <algorithm>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "doorforge/core/error.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/progress.h"
#include "doorforge/schemas/door_asset.h"
#include "doorforge/schemas/part.h"
#include "doorforge/sensor/scene_picture.h"

#include "handle_views.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

struct Model {
  std::vector<VisibleMesh> meshes;
  std::vector<RigidTransform> poses;
  bool stands = true;  // on the floor
};

// one colour a collision shape, so that its pieces can be told apart
Eigen::Vector3d PieceColor(std::size_t index) {
  static const Eigen::Vector3d kColors[] = {{0.86, 0.37, 0.34}, {0.36, 0.68, 0.41},
                                            {0.33, 0.52, 0.80}, {0.88, 0.74, 0.30},
                                            {0.62, 0.43, 0.73}, {0.34, 0.71, 0.73}};
  return kColors[index % std::size(kColors)];
}

struct Shape {
  const TriangleMesh& mesh;
  const std::vector<TriangleMesh>& hulls;
  const Eigen::Vector4d& color_rgba;
  const VisualMesh& visual;
};

Eigen::Vector3d Facing(const VisualMesh& visual, const Eigen::Vector3i& t) {
  const Eigen::Vector3d& a = visual.vertices[static_cast<std::size_t>(t[0])];
  const Eigen::Vector3d normal = (visual.vertices[static_cast<std::size_t>(t[1])] - a)
                                     .cross(visual.vertices[static_cast<std::size_t>(t[2])] - a);
  return normal.norm() > 0 ? Eigen::Vector3d(normal.normalized()) : Eigen::Vector3d::Zero();
}

// What its author drew, a mesh for each material. A sheet may have two sides of two materials:
// every vertex goes a hair the way its triangles face, so that the near side is the one seen.
void AddVisual(const VisualMesh& visual, int link, Model& model) {
  constexpr double kHair = 5e-5;  // [m]
  for (const VisualSurface& surface : visual.surfaces) {
    std::vector<int> index_of(visual.vertices.size(), -1);
    std::vector<Eigen::Vector3d> facing;
    TriangleMesh mesh;
    mesh.triangles = surface.triangles;
    for (Eigen::Vector3i& triangle : mesh.triangles) {
      const Eigen::Vector3d faces = Facing(visual, triangle);
      for (int& corner : triangle) {
        int& index = index_of[static_cast<std::size_t>(corner)];
        if (index < 0) {
          index = static_cast<int>(mesh.vertices.size());
          mesh.vertices.push_back(visual.vertices[static_cast<std::size_t>(corner)]);
          facing.emplace_back(0, 0, 0);
        }
        corner = index;
        facing[static_cast<std::size_t>(index)] += faces;
      }
    }
    for (std::size_t i = 0; i < facing.size(); ++i)
      mesh.vertices[i] += kHair * facing[i].stableNormalized();
    model.meshes.push_back(
        {std::move(mesh), link, PointLabel::kOther, surface.material.color_rgba.head<3>()});
  }
}

void AddShape(const Shape& shape, int link, bool collision, Model& model) {
  if (!collision && !shape.visual.empty()) {
    AddVisual(shape.visual, link, model);
    return;
  }
  if (!collision) {
    model.meshes.push_back({shape.mesh, link, PointLabel::kOther, shape.color_rgba.head<3>()});
    return;
  }
  for (const TriangleMesh& hull : shape.hulls)
    model.meshes.push_back({hull, link, PointLabel::kOther, PieceColor(model.meshes.size())});
}

double WithinLimits(double degrees, const DoorJoint& joint, const fs::path& folder) {
  if (!(joint.lower_rad <= joint.upper_rad))
    throw Error(ErrorCode::kFormat, (folder / "door.json").string() + ": joint \"" + joint.name +
                                        "\": its lower limit lies above its upper one; `doorforge "
                                        "validate` says more");
  return std::clamp(degrees * std::numbers::pi / 180, joint.lower_rad, joint.upper_rad);
}

Model LoadModel(const fs::path& folder, const PreviewConfig& config) {
  Model model;
  if (fs::exists(folder / "door.json")) {
    const DoorAsset door = ReadDoor(folder);
    for (std::size_t i = 0; i < door.links.size(); ++i) {
      for (const DoorGeometry& geometry : door.links[i].geometry)
        AddShape({geometry.mesh, geometry.hulls, geometry.color_rgba, geometry.visual},
                 static_cast<int>(i), config.collision, model);
    }
    for (const RigidTransform& pose :
         DoorFromLinks(door, WithinLimits(config.hinge_deg, door.hinge, folder),
                       WithinLimits(config.handle_deg, door.handle_joint, folder)))
      model.poses.push_back(pose);
    return model;
  }
  const Part part = ReadPart(folder);
  for (const PartPiece& piece : part.pieces)
    AddShape({piece.mesh, piece.hulls, piece.color_rgba, piece.visual}, 0, config.collision, model);
  model.poses = {RigidTransform::Identity()};
  model.stands = part.role == PartRole::kBody;
  return model;
}

void Place(const RigidTransform& frame_from_link, std::vector<VisibleMesh>& meshes) {
  for (VisibleMesh& mesh : meshes) {
    for (Eigen::Vector3d& vertex : mesh.mesh.vertices) vertex = frame_from_link * vertex;
  }
}

void Move(std::vector<VisibleMesh> meshes, std::vector<VisibleMesh>& to) {
  for (VisibleMesh& mesh : meshes) to.push_back(std::move(mesh));
}

// One link's shapes that are the handle, or those that are not.
std::vector<VisibleMesh> ShapesOf(const DoorLink& link, bool handle, const PreviewConfig& config) {
  Model model;
  for (const DoorGeometry& geometry : link.geometry) {
    if ((geometry.label == PointLabel::kHandle) == handle)
      AddShape({geometry.mesh, geometry.hulls, geometry.color_rgba, geometry.visual}, 0,
               config.collision, model);
  }
  return std::move(model.meshes);
}

// Whatever its hinge, the handle is looked at on the closed door, where the leaf lies along y.
HandleScene HandleOf(const DoorAsset& door, const fs::path& folder, const PreviewConfig& config) {
  const auto poses =
      DoorFromLinks(door, 0, WithinLimits(config.handle_deg, door.handle_joint, folder));
  HandleScene scene;
  scene.leaf = ShapesOf(door.links[kLeafLink], false, config);
  Place(poses[kLeafLink], scene.leaf);
  std::vector<VisibleMesh> rose = ShapesOf(door.links[kLeafLink], true, config);
  Place(poses[kLeafLink], rose);
  scene.handle = ShapesOf(door.links[kHandleLink], true, config);
  Place(poses[kHandleLink], scene.handle);
  Move(std::move(rose), scene.handle);
  return scene;
}

// Empty of a part that is no handle.
HandleScene LoadHandle(const fs::path& folder, const PreviewConfig& config) {
  if (fs::exists(folder / "door.json")) return HandleOf(ReadDoor(folder), folder, config);
  HandleScene scene;
  const Part part = ReadPart(folder);
  if (part.role != PartRole::kHandle) return scene;
  scene.handle = LoadModel(folder, config).meshes;
  return scene;
}

Picture DrawWhole(const fs::path& folder, const PreviewConfig& config, int width, int height) {
  Model model = LoadModel(folder, config);
  SceneGeometry scene(std::move(model.meshes));
  scene.MoveLinks(model.poses);
  ViewConfig view;
  view.width = width;
  view.height = height;
  view.azimuth_rad = config.azimuth_deg * std::numbers::pi / 180;
  ScenePictureConfig shading;
  shading.floor = model.stands;
  return RenderPicture(scene, FramingCamera(scene, view), shading);
}

Picture DrawWhole(const fs::path& folder, const PreviewConfig& config, int width) {
  return DrawWhole(folder, config, width, width * 3 / 4);
}

constexpr int kWidth = 960;
constexpr int kTileWidth = 640;
constexpr int kSheetWidth = 320;

std::string NameOf(const fs::path& folder) {
  return fs::absolute(folder).lexically_normal().filename().string();
}

// A body alone has no handle, so that it is drawn as a whole whatever is asked for.
std::vector<CaptionedPicture> TilesOf(const fs::path& folder, const PreviewConfig& config,
                                      int width) {
  std::vector<CaptionedPicture> tiles;
  if (config.focus != PreviewFocus::kWhole)
    tiles = HandleViews(LoadHandle(folder, config), width, width * 3 / 4);
  if (tiles.empty() || config.focus == PreviewFocus::kAll)
    tiles.insert(tiles.begin(), {DrawWhole(folder, config, width), "", NameOf(folder)});
  return tiles;
}

Picture SheetOf(const std::vector<CaptionedPicture>& tiles, int columns) {
  std::vector<Picture> pictures;
  std::vector<std::string> captions;
  for (const CaptionedPicture& tile : tiles) {
    pictures.push_back(tile.picture);
    captions.push_back(tile.caption);
  }
  ContactSheetConfig config;
  config.columns = columns;
  config.tile_width = tiles.front().picture.width;
  config.tile_height = tiles.front().picture.height;
  return ContactSheet(pictures, captions, config);
}

Picture DrawOne(const fs::path& folder, const PreviewConfig& config) {
  const auto width = [&](int usual) { return config.width > 0 ? config.width : usual; };
  if (config.focus == PreviewFocus::kWhole) return DrawWhole(folder, config, width(kWidth));
  const std::vector<CaptionedPicture> tiles = TilesOf(folder, config, width(kTileWidth));
  if (tiles.size() == 1) return DrawWhole(folder, config, width(kWidth));
  return SheetOf(tiles, tiles.size() == 4 ? 2 : 3);
}

// The views of one handle stay side by side.
Picture DrawSheet(std::span<const fs::path> folders, const PreviewConfig& config) {
  std::vector<std::vector<CaptionedPicture>> drawn(folders.size());
  Progress progress("drawing", folders.size());
  ParallelFor(folders.size(), config.threads, [&](std::size_t i) {
    drawn[i] = TilesOf(folders[i], config, config.width > 0 ? config.width : kSheetWidth);
    progress.Advance();
  });
  std::vector<CaptionedPicture> tiles;
  std::size_t most = 1;
  for (std::size_t i = 0; i < folders.size(); ++i) {
    most = std::max(most, drawn[i].size());
    for (CaptionedPicture& tile : drawn[i]) {
      if (!tile.side.empty()) tile.caption = NameOf(folders[i]) + ", " + tile.side;
      tiles.push_back(std::move(tile));
    }
  }
  const int together = static_cast<int>(most);
  return SheetOf(tiles, together * std::max(1, config.columns / together));
}

}  // namespace

Picture DrawRecords(std::span<const fs::path> folders, const PreviewConfig& config) {
  PreviewConfig chosen = config;
  const bool sheet = folders.size() > 1;
  if (!chosen.focus) chosen.focus = sheet ? PreviewFocus::kWhole : PreviewFocus::kAll;
  return sheet ? DrawSheet(folders, chosen) : DrawOne(folders[0], chosen);
}

std::string DrawnThumbnail(const fs::path& folder) {
  constexpr int kSide = 256;  // as Omniverse's browser has them
  return EncodePng(DrawWhole(folder, {}, kSide, kSide));
}

}  // namespace doorforge
