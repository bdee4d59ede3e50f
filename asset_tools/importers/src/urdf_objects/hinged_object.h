// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "doorforge/importers/foreign_object.h"
#include "doorforge/schemas/urdf.h"

namespace doorforge::internal {

/// A URDF of something with hinged leaves, and what its format knows beyond the URDF.
struct HingedObject {
  std::string name;     ///< For the report, such as "partnet-mobility/8877".
  std::string id;       ///< Stem of the parts' ids, such as "pm-8877".
  std::string where;    ///< The URDF's file, for messages.
  std::string source;   ///< For Part::source.
  std::string license;  ///< For Part::license.
  UrdfModel model;      ///< Joint types as they really are.
  Eigen::Matrix3d upright_from_base = Eigen::Matrix3d::Identity();  ///< Turns the base z up.
  double height_m = 0;  ///< The whole object is scaled to it; 0: numbers are metres.
  Category category = Category::kInterior;
  bool category_by_height = false;  ///< Nobody said it: the object's height tells, and it is said.
  /// What a link is called ("door", "knob", "lid"); links that are not in it go by their own name.
  std::map<std::string, std::string> words = {};
  /// Bounds of links that the source's own records state, in the base's frame and units.
  std::map<std::string, Eigen::AlignedBox3d> stated_boxes = {};
  /// The file of a mesh as the URDF names it. Throws Error as FileInside() does.
  std::function<std::filesystem::path(const std::string& filename)> find_mesh;
  std::filesystem::path folder;  ///< Materials and textures of its meshes lie below it.
  bool exported = false;         ///< By this project: closed meshes stay as they are.
  bool pushed = false;           ///< The handle is on the side that the leaf swings away from.
  bool frame_may_miss = false;   ///< Meshes that no leaf carries may be absent.
};

/// One object for each hinged leaf; if there is none, one that says why not.
///
/// A leaf is a link below a revolute joint that no other movable joint carries; what is fixed to
/// it, or moves on it in any other way than a handle, belongs to it. All else is its frame, other
/// leaves included, at zero joint angles. A leaf that is authored open is closed first: turned to
/// the limit at which its outline across the hinge, or that of the whole object, is much smaller.
/// The handle is, of what turns on the leaf or is called a handle, what turns first and is largest.
/// Every other joint that moves is named in the notes with what became of what it carries.
/// A piece of which every link states a mass that can be meant keeps it, see stated_mass.h.
///
/// Part frame: turned about z by a multiple of 90 degrees, or freely where none fits within 20, so
/// that opening moves the leaf towards +x; then, for an upright hinge at the large-y side, mirrored
/// (see ForeignObject::mirrored). The handle of an object that is `pushed` is in that frame with
/// front and back exchanged, so that it points towards +x, as `doorforge compose` expects of the
/// handle of a door that it makes pushed. A hinge must be upright or level within 20 degrees, and
/// opening must swing the leaf out rather than lift it.
///
/// @throws Error(kMissing) if meshes are absent: all are named; Error(kFormat) if one cannot be
///     read, or the model is no tree.
std::vector<ForeignObject> ReadHingedObject(const HingedObject& object);

}  // namespace doorforge::internal
