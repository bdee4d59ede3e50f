// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "doorforge/core/config_io.h"
#include "doorforge/schemas/part.h"
#include "doorforge/solids/solid.h"

namespace doorforge::internal {

/// A parametric family: recipes name it and give its parameters.
struct Family {
  const char* name;
  PartRole role;
  Mechanism mechanism;
  /// Pieces, joint and mount or grasp; the caller adds identity, licence and source. `path` names
  /// the parameters in errors.
  Part (*build)(const nlohmann::ordered_json& parameters, const std::string& path);
};

/// The families of each source file. A new file is declared here, listed below and named in
/// CMakeLists.txt.
std::span<const Family> InteriorBodyFamilies();
std::span<const Family> InteriorShapedBodyFamilies();
std::span<const Family> StorageBodyFamilies();
std::span<const Family> SafeBodyFamilies();
std::span<const Family> SafeHandleFamilies();
std::span<const Family> RefrigeratorBodyFamilies();
std::span<const Family> LatchLeverFamilies();
std::span<const Family> LeverFamilies();
std::span<const Family> ShapedLeverFamilies();
std::span<const Family> KnobFamilies();
std::span<const Family> PullFamilies();
std::span<const Family> WindowBodyFamilies();
std::span<const Family> WindowHandleFamilies();
std::span<const Family> CarBodyFamilies();
std::span<const Family> CarHandleFamilies();

/// All of them, in the order in which errors list their families.
inline constexpr std::span<const Family> (*kFamilySources[])() = {
    InteriorBodyFamilies, InteriorShapedBodyFamilies,
    StorageBodyFamilies,  SafeBodyFamilies,
    SafeHandleFamilies,   RefrigeratorBodyFamilies,
    LatchLeverFamilies,   LeverFamilies,
    ShapedLeverFamilies,  KnobFamilies,
    PullFamilies,         WindowBodyFamilies,
    WindowHandleFamilies, CarBodyFamilies,
    CarHandleFamilies};

/// Throws Error(kInvalidConfig) that suggests the nearest family; `path` names the recipe.
const Family& FamilyNamed(std::string_view name, const std::string& path);

/// The parameters of a family from a recipe; unknown keys are errors.
template <class Parameters>
Parameters ReadParameters(const nlohmann::ordered_json& json, const std::string& path) {
  Parameters parameters;
  if (!json.is_null()) Assign(json, parameters, path);
  return parameters;
}

/// A piece with colour and mass properties by the named finish. Throws Error(kInvalidArgument) if
/// the mesh is not closed, which is a fault of the family.
PartPiece MakePiece(const std::string& name, const Solid& solid, const std::string& finish,
                    const std::string& path);

}  // namespace doorforge::internal
