// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "car/car_shell.h"
#include "family.h"
#include "leaf_layout.h"

namespace doorforge::internal {
namespace {

constexpr double kHandleM = 0.2;          // every car handle is as long as this
constexpr double kMountBelowBeltM = 0.1;  // where the skin is nearly upright

/// What all cars share.
struct CarBody {
  CarLeafShape leaf;
  double mount_to_edge_m = 0.24;  ///< From the handle's axis to the free edge; it points there.
  double leaf_mass_kg = 0;        ///< Sheets around what the volume does not tell; 0: by volume.
  std::string finish = "paint_silver";

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("leaf", self.leaf);
    visit("mount_to_edge_m", self.mount_to_edge_m);
    visit("leaf_mass_kg", self.leaf_mass_kg);
    visit("finish", self.finish);
  }
};

struct ShelledCar : CarBody {
  CarShellShape shell;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    CarBody::VisitFields(self, visit);
    visit("shell", self.shell);
  }
};

void AddLeaf(const CarBody& body, const std::string& path, Part& part) {
  CheckCarLeaf(body.leaf, path + ".leaf");
  RequireRange(path, "mount_to_edge_m", body.mount_to_edge_m, kHandleM + 0.02, 0.32);
  part.joint = BodyHinge(HingeEdgeX(body.leaf));
  PartPiece leaf = MakePiece("leaf", CarLeafSolid(body.leaf), body.finish, path + ".finish");
  if (body.leaf_mass_kg > 0) {
    RequireRange(path, "leaf_mass_kg", body.leaf_mass_kg, 8, 25);
    leaf.mass.inertia_kg_m2 *= body.leaf_mass_kg / leaf.mass.mass_kg;
    leaf.mass.mass_kg = body.leaf_mass_kg;
  }
  part.pieces.push_back(std::move(leaf));
  const double z = body.leaf.belt_m - kMountBelowBeltM;
  part.part_from_mount =
      Translation({SkinX(body.leaf, z), body.leaf.length_m - body.mount_to_edge_m, z});
}

// Without the shell the leaf itself stands on the ground.
Part BuildLeafAlone(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<CarBody>(json, path);
  RequireRange(path + ".leaf", "sill_m", body.leaf.sill_m, 0, 0);
  Part part;
  AddLeaf(body, path, part);
  return part;
}

template <CarStyle kStyle>
Part BuildShelled(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<ShelledCar>(json, path);
  CheckCarShell(body.shell, body.leaf, path + ".shell");
  Part part;
  CheckCarLeaf(body.leaf, path + ".leaf");
  part.pieces.push_back(MakePiece("frame", CarShellSolid(kStyle, body.shell, body.leaf),
                                  body.finish, path + ".finish"));
  AddLeaf(body, path, part);
  return part;
}

}  // namespace

std::span<const Family> CarBodyFamilies() {
  static const Family kFamilies[] = {
      {"car_leaf", PartRole::kBody, Mechanism::kNone, BuildLeafAlone},
      {"car_sedan", PartRole::kBody, Mechanism::kNone, BuildShelled<CarStyle::kSedan>},
      {"car_hatch", PartRole::kBody, Mechanism::kNone, BuildShelled<CarStyle::kHatch>},
      {"car_coupe", PartRole::kBody, Mechanism::kNone, BuildShelled<CarStyle::kCoupe>},
      {"car_roadster", PartRole::kBody, Mechanism::kNone, BuildShelled<CarStyle::kRoadster>},
      {"car_van", PartRole::kBody, Mechanism::kNone, BuildShelled<CarStyle::kVan>},
      {"car_pickup", PartRole::kBody, Mechanism::kNone, BuildShelled<CarStyle::kPickup>},
      {"car_box", PartRole::kBody, Mechanism::kNone, BuildShelled<CarStyle::kBox>},
  };
  return kFamilies;
}

}  // namespace doorforge::internal
