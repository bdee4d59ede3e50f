// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "preview_verb.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "doorforge/cli/command_line.h"
#include "doorforge/core/error.h"
#include "doorforge/core/output_file.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/program.h"
#include "doorforge/core/progress.h"
#include "doorforge/schemas/door_asset.h"
#include "doorforge/schemas/part.h"
#include "doorforge/sensor/scene_picture.h"
#include "doorforge/validate/validate_door.h"

#ifdef DOORFORGE_WITH_OPENABLE
#include "episode_sheet.h"
#endif
#include "handle_views.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::vector<std::string> paths;
  std::string out;
  double hinge_deg = 0;
  double handle_deg = 0;
  double azimuth_deg = -34;
  int columns = 6;
  int width = 0;  // 0: by what is drawn
  int threads = 0;
  std::string focus = {};  // empty: by how many are drawn
  bool collision = false;
  bool episode = false;
  bool overwrite = false;
  std::uint64_t seed = 1;
  int frames = 7;
};

Options Parse(int argc, char** argv) {
  Options options;
  CLI::App app("Pictures of doors and parts; a contact sheet where there are several.",
               "doorforge preview");
  app.add_option("PATH,--door", options.paths,
                 "folders of doors or parts, or folders that hold some")
      ->required();
  app.add_option("--out", options.out, "PNG file")->required();
  app.add_option("--hinge-deg", options.hinge_deg, "open doors by this angle, within their limits")
      ->check(CLI::Range(0.0, 180.0));
  app.add_option("--handle-deg", options.handle_deg,
                 "turn handles by this angle, within their limits")
      ->check(CLI::Range(-90.0, 90.0));
  app.add_option("--azimuth-deg", options.azimuth_deg,
                 "where to stand: 0 in front, positive towards the free edge")
      ->check(CLI::Range(-180.0, 180.0));
  app.add_option("--columns", options.columns, "of a contact sheet")->check(CLI::Range(1, 24));
  app.add_option(
         "--focus", options.focus,
         "all: the whole and the handle large from three sides, with a bar of 50 mm and the "
         "axes (of one door or handle, if left out); whole; handle")
      ->check(CLI::IsMember({"all", "whole", "handle"}));
  app.add_option("--width", options.width,
                 "of each picture in pixels; 960, with the handle beside it 640, on a sheet 320")
      ->check(CLI::Range(32, 4096));
  app.add_option("--threads", options.threads, "0: all processors");
  app.add_flag("--overwrite", options.overwrite, "replace --out if it is there");
  app.add_flag("--collision", options.collision, "draw the collision shapes instead");
#ifdef DOORFORGE_WITH_OPENABLE
  app.add_flag("--episode", options.episode,
               "a film strip of the expert opening the door; a row each where there are several");
  app.add_option("--seed", options.seed, "of the scene, with --episode")->needs("--episode");
  app.add_option("--frames", options.frames, "of the strip, with --episode")
      ->needs("--episode")
      ->check(CLI::Range(2, 40));
#endif
  app.footer(
      "examples:\n"
      "  doorforge preview parts --out parts.png\n"
      "  doorforge preview doors/mine --hinge-deg 40 --handle-deg 30 --out mine.png\n"
      "  doorforge preview doors --focus handle --out handles.png\n"
      "  doorforge preview --episode --door doors/mine --seed 3 --out opened.png");
  ParseVerb(app, argc, argv);
  return options;
}

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

Model LoadModel(const fs::path& folder, const Options& options) {
  Model model;
  if (fs::exists(folder / "door.json")) {
    const DoorAsset door = ReadDoor(folder);
    for (std::size_t i = 0; i < door.links.size(); ++i) {
      for (const DoorGeometry& geometry : door.links[i].geometry)
        AddShape({geometry.mesh, geometry.hulls, geometry.color_rgba, geometry.visual},
                 static_cast<int>(i), options.collision, model);
    }
    for (const RigidTransform& pose :
         DoorFromLinks(door, WithinLimits(options.hinge_deg, door.hinge, folder),
                       WithinLimits(options.handle_deg, door.handle_joint, folder)))
      model.poses.push_back(pose);
    return model;
  }
  const Part part = ReadPart(folder);
  for (const PartPiece& piece : part.pieces)
    AddShape({piece.mesh, piece.hulls, piece.color_rgba, piece.visual}, 0, options.collision,
             model);
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
std::vector<VisibleMesh> ShapesOf(const DoorLink& link, bool handle, const Options& options) {
  Model model;
  for (const DoorGeometry& geometry : link.geometry) {
    if ((geometry.label == PointLabel::kHandle) == handle)
      AddShape({geometry.mesh, geometry.hulls, geometry.color_rgba, geometry.visual}, 0,
               options.collision, model);
  }
  return std::move(model.meshes);
}

// Whatever its hinge, the handle is looked at on the closed door, where the leaf lies along y.
HandleScene HandleOf(const DoorAsset& door, const fs::path& folder, const Options& options) {
  const auto poses =
      DoorFromLinks(door, 0, WithinLimits(options.handle_deg, door.handle_joint, folder));
  HandleScene scene;
  scene.leaf = ShapesOf(door.links[kLeafLink], false, options);
  Place(poses[kLeafLink], scene.leaf);
  std::vector<VisibleMesh> rose = ShapesOf(door.links[kLeafLink], true, options);
  Place(poses[kLeafLink], rose);
  scene.handle = ShapesOf(door.links[kHandleLink], true, options);
  Place(poses[kHandleLink], scene.handle);
  Move(std::move(rose), scene.handle);
  return scene;
}

// Empty of a part that is no handle.
HandleScene LoadHandle(const fs::path& folder, const Options& options) {
  if (fs::exists(folder / "door.json")) return HandleOf(ReadDoor(folder), folder, options);
  HandleScene scene;
  const Part part = ReadPart(folder);
  if (part.role != PartRole::kHandle) return scene;
  scene.handle = LoadModel(folder, options).meshes;
  return scene;
}

Picture DrawWhole(const fs::path& folder, const Options& options, int width) {
  Model model = LoadModel(folder, options);
  SceneGeometry scene(std::move(model.meshes));
  scene.MoveLinks(model.poses);
  ViewConfig view;
  view.width = width;
  view.height = width * 3 / 4;
  view.azimuth_rad = options.azimuth_deg * std::numbers::pi / 180;
  ScenePictureConfig config;
  config.floor = model.stands;
  return RenderPicture(scene, FramingCamera(scene, view), config);
}

constexpr int kWidth = 960;
constexpr int kTileWidth = 640;
constexpr int kSheetWidth = 320;

std::string NameOf(const fs::path& folder) {
  return fs::absolute(folder).lexically_normal().filename().string();
}

// A body alone has no handle, so that it is drawn as a whole whatever is asked for.
std::vector<CaptionedPicture> TilesOf(const fs::path& folder, const Options& options, int width) {
  std::vector<CaptionedPicture> tiles;
  if (options.focus != "whole")
    tiles = HandleViews(LoadHandle(folder, options), width, width * 3 / 4);
  if (tiles.empty() || options.focus == "all")
    tiles.insert(tiles.begin(), {DrawWhole(folder, options, width), "", NameOf(folder)});
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

Picture DrawOne(const fs::path& folder, const Options& options) {
  const auto width = [&](int usual) { return options.width > 0 ? options.width : usual; };
  if (options.focus == "whole") return DrawWhole(folder, options, width(kWidth));
  const std::vector<CaptionedPicture> tiles = TilesOf(folder, options, width(kTileWidth));
  if (tiles.size() == 1) return DrawWhole(folder, options, width(kWidth));
  return SheetOf(tiles, tiles.size() == 4 ? 2 : 3);
}

// The views of one handle stay side by side.
Picture DrawSheet(const std::vector<fs::path>& folders, const Options& options) {
  std::vector<std::vector<CaptionedPicture>> drawn(folders.size());
  Progress progress("drawing", folders.size());
  ParallelFor(folders.size(), options.threads, [&](std::size_t i) {
    drawn[i] = TilesOf(folders[i], options, options.width > 0 ? options.width : kSheetWidth);
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
  return SheetOf(tiles, together * std::max(1, options.columns / together));
}

}  // namespace

void WritePreview(const fs::path& folder, const fs::path& png) {
  Options options;
  options.focus = "all";
  WritePng(png, DrawOne(folder, options));
}

int RunPreviewVerb(int argc, char** argv) {
  Options options = Parse(argc, argv);
  RequireNoFile(options.out, options.overwrite);
  std::vector<fs::path> folders;
  for (const std::string& path : options.paths) {
    for (fs::path& folder : FindRecords(path)) folders.push_back(std::move(folder));
  }
#ifdef DOORFORGE_WITH_OPENABLE
  if (options.episode) {
    WriteEpisodeSheet(folders, {.out = options.out,
                                .seed = options.seed,
                                .frames = options.frames,
                                .width = options.width,
                                .threads = options.threads});
    return 0;
  }
#endif
  const bool sheet = folders.size() > 1;
  if (options.focus.empty()) options.focus = sheet ? "whole" : "all";
  WritePng(options.out, sheet ? DrawSheet(folders, options) : DrawOne(folders[0], options));
  std::printf("%s: %zu pictured\n", options.out.c_str(), folders.size());
  return 0;
}

}  // namespace doorforge
