// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "doorforge/solids/sweep.h"

#include "handles/handle_base.h"

namespace doorforge::internal {
namespace {

/// A turned knob: neck and head, one solid of revolution about the handle's axis.
struct Knob {
  double diameter_m = 0.06;     ///< The head has it.
  double projection_m = 0.066;  ///< From the leaf to the front of the head.
  double head_depth_m = 0.04;   ///< The head has it along x.
  double neck_diameter_m = 0.022;
  double squareness = 2;  ///< Exponent of the head's outline: 2 round, 4 a rounded square.
  double aspect = 1;      ///< Height relative to the diameter.
  RoseParameters rose;
  std::string finish = "polished_brass";

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("diameter_m", self.diameter_m);
    visit("projection_m", self.projection_m);
    visit("head_depth_m", self.head_depth_m);
    visit("neck_diameter_m", self.neck_diameter_m);
    visit("squareness", self.squareness);
    visit("aspect", self.aspect);
    visit("rose", self.rose);
    visit("finish", self.finish);
  }
};

/// A head that widens to a rim.
struct RimmedKnob : Knob {
  double rim = 0.72;  ///< Place of the rim in the head: 0 at the neck, 1 at the front.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    Knob::VisitFields(self, visit);
    visit("rim", self.rim);
  }
};

struct MushroomKnob : RimmedKnob {
  MushroomKnob() { rim = 0.4; }
};

struct EggKnob : Knob {
  double point = 0.25;  ///< How much narrower the front is than the back; negative: wider.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    Knob::VisitFields(self, visit);
    visit("point", self.point);
  }
};

struct DiscKnob : Knob {
  double dish_m = 0.002;  ///< How far the middle of the front lies behind its rim.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    Knob::VisitFields(self, visit);
    visit("dish_m", self.dish_m);
  }
};

struct BeadedKnob : Knob {
  int beads = 2;  ///< Rings behind the head, each smaller than the next.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    Knob::VisitFields(self, visit);
    visit("beads", self.beads);
  }
};

struct FacetedKnob : Knob {
  int sides = 8;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    Knob::VisitFields(self, visit);
    visit("sides", self.sides);
  }
};

struct FlutedKnob : Knob {
  int flutes = 12;
  double flute_depth_m = 0.0016;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    Knob::VisitFields(self, visit);
    visit("flutes", self.flutes);
    visit("flute_depth_m", self.flute_depth_m);
  }
};

void Check(const Knob& knob, const std::string& path) {
  // an 80 mm gripper needs some room on both sides of the head
  RequireRange(path, "diameter_m", knob.diameter_m, 0.03, 0.066);
  RequireRange(path, "projection_m", knob.projection_m, 0.04, 0.09);
  RequireRange(path, "head_depth_m", knob.head_depth_m, 0.014, knob.projection_m - 0.014);
  RequireRange(path, "neck_diameter_m", knob.neck_diameter_m, 0.01, 0.8 * knob.diameter_m);
  RequireRange(path, "squareness", knob.squareness, 2, 5);
  RequireRange(path, "aspect", knob.aspect, 0.7, 1.05);
}

using Profile = std::vector<LathePoint>;

// A flared foot and the straight neck up to the head.
Profile NeckProfile(const Knob& knob, double start_x) {
  const double neck = knob.neck_diameter_m / 2;
  const double head_x = knob.projection_m - knob.head_depth_m;
  const double room = head_x - start_x;
  return {{start_x, neck * 1.25},
          {start_x + 0.12 * room, neck * 1.22},
          {start_x + 0.35 * room, neck * 1.05},
          {start_x + 0.6 * room, neck}};
}

// An ellipse around the axis, cut by the neck.
void AddBall(const Knob& knob, Profile& profile) {
  const double radius = knob.diameter_m / 2;
  const double half_depth = knob.head_depth_m / 2;
  const double center = knob.projection_m - half_depth;
  const double first = std::asin(std::min(1.0, knob.neck_diameter_m / 2 / radius));
  constexpr int kSteps = 18;
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = first + (std::numbers::pi * 0.975 - first) * i / kSteps;
    profile.push_back({center - half_depth * std::cos(angle), radius * std::sin(angle)});
  }
}

// Widens from the neck to a rim near the front, like a tulip; `rim` is the rim's place in the head.
void AddTulip(const Knob& knob, double rim, Profile& profile) {
  const double neck = knob.neck_diameter_m / 2;
  const double radius = knob.diameter_m / 2;
  const double head_x = knob.projection_m - knob.head_depth_m;
  const double rim_x = head_x + rim * knob.head_depth_m;
  constexpr int kSteps = 12;
  for (int i = 0; i <= kSteps; ++i) {
    const double t = static_cast<double>(i) / kSteps;
    const double flare = 0.5 - 0.5 * std::cos(std::numbers::pi * t);
    profile.push_back({head_x + t * (rim_x - head_x), neck + (radius - neck) * flare});
  }
  const double dome = knob.projection_m - rim_x;
  for (const double degrees : {20.0, 40.0, 58.0, 72.0, 82.0, 88.0}) {
    const double angle = degrees * std::numbers::pi / 180;
    profile.push_back({rim_x + dome * std::sin(angle), radius * std::cos(angle)});
  }
}

// A straight-sided head with broad chamfers on both ends.
void AddBarrel(const Knob& knob, double chamfer, Profile& profile) {
  const double radius = knob.diameter_m / 2;
  const double head_x = knob.projection_m - knob.head_depth_m;
  const double cut = chamfer * radius;
  profile.push_back({head_x, std::max(knob.neck_diameter_m / 2, radius - 1.4 * cut)});
  profile.push_back({head_x + cut, radius});
  profile.push_back({knob.projection_m - cut, radius});
  profile.push_back({knob.projection_m, radius - cut});
}

// A ball whose front half tapers (point > 0) or swells.
void AddEgg(const EggKnob& knob, Profile& profile) {
  const std::size_t first = profile.size();
  AddBall(knob, profile);
  const double back = knob.projection_m - knob.head_depth_m;
  double widest = 0;
  for (std::size_t i = first; i < profile.size(); ++i) {
    const double t = (profile[i].x_m - back) / knob.head_depth_m;
    profile[i].radius_m *= 1 - knob.point * (t - 0.5);
    widest = std::max(widest, profile[i].radius_m);
  }
  const double scale = knob.diameter_m / 2 / widest;
  for (std::size_t i = first; i < profile.size(); ++i) profile[i].radius_m *= scale;
}

// A flat disc with a rounded rim and a dished front.
void AddDisc(const DiscKnob& knob, Profile& profile) {
  const double radius = knob.diameter_m / 2;
  const double half = knob.head_depth_m / 2;
  const double center = knob.projection_m - half;
  const double round = std::min(half, 0.3 * radius);
  for (int i = 0; i <= 8; ++i) {
    const double angle = std::numbers::pi * i / 8;
    profile.push_back({center - half * std::cos(angle), radius - round * (1 - std::sin(angle))});
  }
  const double rim = radius - round;
  profile.push_back({knob.projection_m - 0.4 * knob.dish_m, 0.8 * rim});
  profile.push_back({knob.projection_m - 0.8 * knob.dish_m, 0.5 * rim});
  profile.push_back({knob.projection_m - knob.dish_m, 0.15 * rim});
}

// Rings in front of the neck, then a ball that takes the rest of the head.
void AddBeads(const BeadedKnob& knob, Profile& profile) {
  const double neck = knob.neck_diameter_m / 2;
  const double radius = knob.diameter_m / 2;
  const double bead_depth = 0.16 * knob.head_depth_m;
  double x = knob.projection_m - knob.head_depth_m;
  for (int bead = 0; bead < knob.beads; ++bead) {
    const double top = neck + (radius - neck) * (0.3 + 0.2 * bead);
    for (int i = 0; i <= 4; ++i)
      profile.push_back(
          {x + bead_depth * i / 5.0, neck + (top - neck) * std::sin(std::numbers::pi * i / 5.0)});
    x += bead_depth;
  }
  Knob ball = knob;
  ball.head_depth_m = knob.projection_m - x;
  AddBall(ball, profile);
}

double WidestX(const Profile& profile) {
  double radius = 0;
  for (const LathePoint& point : profile) radius = std::max(radius, point.radius_m);
  double first = 1e9;
  double last = -1e9;
  for (const LathePoint& point : profile) {
    if (point.radius_m < radius - 5e-4) continue;
    first = std::min(first, point.x_m);
    last = std::max(last, point.x_m);
  }
  return (first + last) / 2;
}

template <class AddHead>
Part KnobPart(const Knob& knob, const std::string& path, const LatheShape& shape,
              const AddHead& add_head) {
  Check(knob, path);
  LatheShape lathe = shape;
  lathe.squareness = knob.squareness;
  lathe.aspect = knob.aspect;
  Part part;
  const double start_x = AddRose(knob.rose, path + ".rose", part);
  Profile profile = NeckProfile(knob, start_x);
  add_head(profile);
  part.pieces.push_back(
      MakePiece("grip", LatheSolid(profile, lathe), knob.finish, path + ".finish"));
  part.joint = HandleJoint(true);
  part.part_from_grasp = GraspAt({WidestX(profile), 0, 0}, Closing::kVertical);
  part.grasp_half_extent_m = {0.006, 0.004, 0.25 * knob.head_depth_m};
  return part;
}

Part BuildBall(const nlohmann::ordered_json& json, const std::string& path) {
  const auto knob = ReadParameters<Knob>(json, path);
  return KnobPart(knob, path, {}, [&](Profile& profile) { AddBall(knob, profile); });
}

template <class Parameters>
Part BuildRimmed(const nlohmann::ordered_json& json, const std::string& path) {
  const auto knob = ReadParameters<Parameters>(json, path);
  RequireRange(path, "rim", knob.rim, 0.2, 0.9);
  return KnobPart(knob, path, {}, [&](Profile& profile) { AddTulip(knob, knob.rim, profile); });
}

Part BuildEgg(const nlohmann::ordered_json& json, const std::string& path) {
  const auto knob = ReadParameters<EggKnob>(json, path);
  RequireRange(path, "point", knob.point, -0.6, 0.6);
  return KnobPart(knob, path, {}, [&](Profile& profile) { AddEgg(knob, profile); });
}

Part BuildDisc(const nlohmann::ordered_json& json, const std::string& path) {
  const auto knob = ReadParameters<DiscKnob>(json, path);
  RequireRange(path, "dish_m", knob.dish_m, -0.008, 0.006);
  return KnobPart(knob, path, {}, [&](Profile& profile) { AddDisc(knob, profile); });
}

Part BuildBeaded(const nlohmann::ordered_json& json, const std::string& path) {
  const auto knob = ReadParameters<BeadedKnob>(json, path);
  RequireRange(path, "beads", knob.beads, 1, 3);
  return KnobPart(knob, path, {}, [&](Profile& profile) { AddBeads(knob, profile); });
}

Part BuildFaceted(const nlohmann::ordered_json& json, const std::string& path) {
  const auto knob = ReadParameters<FacetedKnob>(json, path);
  RequireRange(path, "sides", knob.sides, 6, 12);
  return KnobPart(knob, path, {knob.sides, 0, 0},
                  [&](Profile& profile) { AddBarrel(knob, 0.28, profile); });
}

Part BuildFluted(const nlohmann::ordered_json& json, const std::string& path) {
  const auto knob = ReadParameters<FlutedKnob>(json, path);
  RequireRange(path, "flutes", knob.flutes, 5, 24);
  RequireRange(path, "flute_depth_m", knob.flute_depth_m, 0.0005, 0.003);
  return KnobPart(knob, path,
                  {(knob.flutes < 12 ? 8 : 4) * knob.flutes, knob.flute_depth_m, knob.flutes},
                  [&](Profile& profile) { AddBarrel(knob, 0.12, profile); });
}

}  // namespace

std::span<const Family> KnobFamilies() {
  static const Family kFamilies[] = {
      {"knob_ball", PartRole::kHandle, Mechanism::kRound, BuildBall},
      {"knob_tulip", PartRole::kHandle, Mechanism::kRound, BuildRimmed<RimmedKnob>},
      {"knob_mushroom", PartRole::kHandle, Mechanism::kRound, BuildRimmed<MushroomKnob>},
      {"knob_faceted", PartRole::kHandle, Mechanism::kRound, BuildFaceted},
      {"knob_fluted", PartRole::kHandle, Mechanism::kRound, BuildFluted},
      {"knob_egg", PartRole::kHandle, Mechanism::kRound, BuildEgg},
      {"knob_disc", PartRole::kHandle, Mechanism::kRound, BuildDisc},
      {"knob_beaded", PartRole::kHandle, Mechanism::kRound, BuildBeaded},
  };
  return kFamilies;
}

}  // namespace doorforge::internal
