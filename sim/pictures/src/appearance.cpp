// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "appearance.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "doorforge/core/rng.h"

namespace doorforge {
namespace {

constexpr float kUnderCeiling = 0.12F;  // [m] lamps hang
constexpr float kLampPower = 3.4F;      // of all lamps together

Finish Painted(const LinearColor& color) { return {.color = color, .second = color}; }

Finish Metal(const LinearColor& color) {
  Finish finish = Painted(color);
  finish.gloss = 0.6F;
  finish.exponent = 50;
  finish.mirror = 0.35F;
  return finish;
}

Finish Glass() {
  Finish finish = Painted({0.55F, 0.68F, 0.64F});
  finish.gloss = 1;
  finish.exponent = 300;
  finish.mirror = 0.12F;
  finish.clear = 0.85F;
  return finish;
}

Finish Boards(const LinearColor& light, const LinearColor& dark) {
  return {.color = light,
          .second = dark,
          .texture = Texture::kPlanks,
          .scale_m = 0.14F,
          .gloss = 0.12F};
}

// Everything as its author coloured it.
Appearance PlainAppearance(const std::vector<VisibleMesh>& meshes, const PictureRoom& room) {
  Appearance plain;
  for (const VisibleMesh& mesh : meshes) {
    const LinearColor color = LinearOf(mesh.color_rgb);
    plain.meshes.push_back(mesh.label == PointLabel::kHandle ? Metal(color) : Painted(color));
    if (mesh.label == PointLabel::kRobot) {
      plain.meshes.back().gloss = 0.25F;
      plain.meshes.back().exponent = 35;
    }
  }
  plain.pane = Glass();
  const auto part = [&](RoomPart which) -> Finish& {
    return plain.room[static_cast<std::size_t>(which)];
  };
  part(RoomPart::kFloor) = Boards({0.42F, 0.29F, 0.18F}, {0.20F, 0.13F, 0.08F});
  part(RoomPart::kCeiling) = Painted({0.80F, 0.80F, 0.78F});
  part(RoomPart::kWalls) = Painted({0.62F, 0.60F, 0.55F});
  part(RoomPart::kDoorWall) = Painted({0.68F, 0.66F, 0.62F});
  part(RoomPart::kPlinth) = Painted({0.36F, 0.36F, 0.37F});
  const Eigen::AlignedBox3f& box = room.box();
  const float height = box.max().z() - kUnderCeiling;
  const float middle = box.center().y();
  const LinearColor half = LinearColor(1.0F, 0.96F, 0.90F) * (kLampPower / 2);
  plain.lamps = {{{room.wall_x() + 1.5F, middle - 1.0F, height}, 0.25F, half},
                 {{room.wall_x() + 2.3F, middle + 1.1F, height}, 0.25F, half}};
  plain.lamp_behind = {{room.wall_x() - 1.3F, middle, height}, 0.25F, 2.0F * half};
  return plain;
}

class AppearanceDraw {
 public:
  AppearanceDraw(const PictureScene& scene, const std::vector<VisibleMesh>& meshes,
                 const PictureRoom& room)
      : meshes_(meshes),
        room_(room),
        look_(PlainAppearance(meshes, room)),
        is_metal_(scene.door.category == Category::kCar || scene.door.category == Category::kSafe),
        rng_(scene.scene.seed, "scene/" + scene.scene.door_id + "/" +
                                   std::to_string(scene.scene.episode) + "/appearance") {}

  Appearance WithColors() {
    const LinearColor leaf = AnyColor();
    const LinearColor frame = Chance(0.5) ? leaf : AnyColor();
    const LinearColor handle = MetalColor();
    const LinearColor robot = Grey(0.04, 0.9);
    for (std::size_t i = 0; i < meshes_.size(); ++i) {
      Finish& finish = look_.meshes[i];
      switch (meshes_[i].label) {
        case PointLabel::kBody:
          Recolor(finish, leaf);
          break;
        case PointLabel::kFrame:
          Recolor(finish, frame);
          break;
        case PointLabel::kHandle:
          Recolor(finish, handle);
          break;
        case PointLabel::kRobot:
          Recolor(finish, finish.color * 0.6F + robot * 0.4F);
          break;
        case PointLabel::kOther:
          break;
      }
    }
    for (Finish& finish : look_.room) Recolor(finish, AnyColor());
    Recolor(Part(RoomPart::kCeiling), Grey(0.4, 0.9));
    return look_;
  }

  Appearance Full() {
    WithColors();
    // nobody makes cars and safes of wood
    const Texture grain = is_metal_ ? Texture::kPlain : Texture::kWood;
    const Texture leaf =
        AnyTexture({Texture::kPlain, grain, grain, is_metal_ ? Texture::kPlain : Texture::kSpeckle,
                    Texture::kBrushed});
    const Texture frame = Chance(0.6) ? leaf : AnyTexture({Texture::kPlain, grain});
    for (std::size_t i = 0; i < meshes_.size(); ++i) {
      if (meshes_[i].label == PointLabel::kBody) Cover(look_.meshes[i], leaf);
      if (meshes_[i].label == PointLabel::kFrame) Cover(look_.meshes[i], frame);
      if (meshes_[i].label == PointLabel::kHandle)
        Cover(look_.meshes[i], AnyTexture({Texture::kPlain, Texture::kBrushed}));
    }
    Cover(Part(RoomPart::kFloor),
          AnyTexture({Texture::kPlanks, Texture::kTiles, Texture::kSpeckle, Texture::kPlain}));
    const Texture walls = AnyTexture(
        {Texture::kPlain, Texture::kPlain, Texture::kSpeckle, Texture::kTiles, Texture::kWood});
    Cover(Part(RoomPart::kWalls), walls);
    Cover(Part(RoomPart::kDoorWall), walls);
    Part(RoomPart::kDoorWall) = Part(RoomPart::kWalls);
    Cover(Part(RoomPart::kPlinth), AnyTexture({Texture::kPlain, Texture::kWood}));
    look_.pane.clear = Draw(0.55, 0.9);
    look_.pane.mirror = Draw(0.05, 0.25);
    HangLamps();
    SetExposure();
    return look_;
  }

 private:
  float Draw(double low, double high) { return static_cast<float>(rng_.Uniform(low, high)); }
  bool Chance(double share) { return rng_.Uniform() < share; }
  Finish& Part(RoomPart part) { return look_.room[static_cast<std::size_t>(part)]; }

  LinearColor Grey(double low, double high) {
    return LinearOf(Eigen::Vector3d::Constant(rng_.Uniform(low, high)));
  }

  // Mostly pale or dull, as things in houses are; in a fifth of all cases anything.
  LinearColor AnyColor() {
    const double value = rng_.Uniform(0.12, 0.97);
    const double saturation = Chance(0.2) ? rng_.Uniform(0.4, 1) : rng_.Uniform(0, 0.4);
    const double hue = Chance(0.5) ? rng_.Uniform(0.02, 0.13) : rng_.Uniform();
    Eigen::Vector3d color;
    for (Eigen::Index i = 0; i < 3; ++i) {
      const double from_peak =
          std::fabs(std::fmod(6 * hue + 6 - 2 * static_cast<double>(i), 6) - 3);
      color[i] = value * (1 - saturation * (1 - std::clamp(from_peak - 1, 0.0, 1.0)));
    }
    return LinearOf(color);
  }

  LinearColor MetalColor() {
    constexpr double kMetals[][3] = {{0.80, 0.81, 0.83}, {0.62, 0.63, 0.65}, {0.85, 0.67, 0.30},
                                     {0.76, 0.46, 0.32}, {0.11, 0.11, 0.12}, {0.36, 0.27, 0.19}};
    const auto& metal = kMetals[rng_.Index(std::size(kMetals))];
    const double shade = rng_.Uniform(0.8, 1.1);
    return LinearOf({shade * metal[0], shade * metal[1], shade * metal[2]});
  }

  Texture AnyTexture(std::initializer_list<Texture> textures) {
    return textures.begin()[rng_.Index(static_cast<std::uint32_t>(textures.size()))];
  }

  static void Recolor(Finish& finish, const LinearColor& color) {
    const LinearColor darker = finish.second / finish.color.max(1e-3F);
    finish.color = color;
    finish.second = (color * darker).min(1.0F);
  }

  void Cover(Finish& finish, Texture texture) {
    finish.texture = texture;
    const bool fine = texture == Texture::kBrushed;
    finish.second = finish.color * (fine ? Draw(0.75, 0.95) : Draw(0.35, 0.85));
    switch (texture) {
      case Texture::kPlain:
        break;
      case Texture::kWood:
        finish.scale_m = Draw(0.15, 0.4);
        break;
      case Texture::kSpeckle:
        finish.scale_m = Draw(0.05, 0.25);
        break;
      case Texture::kBrushed:
        finish.scale_m = Draw(0.05, 0.1);
        break;
      case Texture::kTiles:
        finish.scale_m = Draw(0.15, 0.6);
        break;
      case Texture::kPlanks:
        finish.scale_m = Draw(0.08, 0.22);
        break;
    }
    finish.gloss = Draw(0.02, 0.5);
    finish.exponent = Draw(8, 80);
    if (finish.mirror == 0 && Chance(0.2)) finish.mirror = Draw(0.02, 0.12);
  }

  void HangLamps() {
    const Eigen::AlignedBox3f& box = room_.box();
    look_.lamps.resize(1 + rng_.Index(kMostLamps));
    const float share = kLampPower / static_cast<float>(look_.lamps.size());
    for (Lamp& lamp : look_.lamps) {
      lamp.position_m.x() = room_.wall_x() + Draw(0.9, 2.8);
      lamp.position_m.y() = box.center().y() + Draw(-1.5, 1.5);
      lamp.position_m.z() = box.max().z() - Draw(0.08, 0.7);
      lamp.radius_m = Draw(0.05, 0.4);
      lamp.power = Light(share, 0.5, 1.6);
    }
    look_.lamp_behind.power = Light(kLampPower, 0.1, 1.2);
    look_.ambient = Light(1, 0.12, 0.5);
  }

  // So bright, and in colour between the light of bulbs and that of an overcast sky.
  LinearColor Light(float power, double least, double most) {
    const float bright = power * Draw(least, most);
    const float warm = Draw(-1, 1);
    return bright * LinearColor(1 + 0.18F * warm, 1, 1 - 0.28F * warm);
  }

  void SetExposure() {
    Exposure& exposure = look_.exposure;
    const float gain = std::exp2(Draw(-0.8, 0.6));
    const float red = Draw(0.9, 1.1);
    const float blue = Draw(0.88, 1.12);
    exposure.gain = gain * LinearColor(red, 1, blue);
    exposure.blur_px = Draw(0, 0.7);
    exposure.noise = Draw(0, 0.025);
  }

  const std::vector<VisibleMesh>& meshes_;
  const PictureRoom& room_;
  Appearance look_;
  bool is_metal_;
  Rng rng_;
};

}  // namespace

Appearance DrawAppearance(const PictureScene& scene, const std::vector<VisibleMesh>& meshes,
                          const PictureRoom& room) {
  switch (scene.scene.appearance) {
    case SceneAppearance::kOff:
      return PlainAppearance(meshes, room);
    case SceneAppearance::kColour:
      return AppearanceDraw(scene, meshes, room).WithColors();
    case SceneAppearance::kFull:
      return AppearanceDraw(scene, meshes, room).Full();
  }
  return {};
}

}  // namespace doorforge
