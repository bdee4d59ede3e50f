// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "doorforge/parts/make_part.h"
#include "doorforge/schemas/names.h"

namespace doorforge {

/// How loose meshes are meant; a mesh file says nothing of it.
struct LooseMeshConfig {
  std::string role = {};           ///< "body" (a leaf) or "handle"; needed.
  std::string mechanism = "none";  ///< Handles have it; the words are those of names.h.
  /// The unit of the file's numbers is m, cm, mm, in or ft. Where this is empty, the file's own is
  /// taken (glTF, DAE, FBX), or m; if that makes it no handle (0.02 to 0.6 m) or leaf (0.2 to 3.5
  /// m) and there is no scale, the one of m, cm and mm is taken which does.
  std::string unit = {};
  double size_m = 0;  ///< Length of its longest side; replaces unit and scale. 0: not set.
  std::vector<double> scale = {};  ///< One factor or three along the file's axes; empty: 1.
  /// Axis of the file: x, y, z, -x, -y or -z; empty: as the file states (glTF, DAE), else z
  /// (AKB-48: x). Of loose meshes also a direction in the file's axes, "x,y,z", of which counts
  /// what is square to `front`.
  std::string up = {};
  /// Axis of the file, or a direction "x,y,z" in its axes, that points out of the door; empty: as
  /// the file states, else x (y if up is nearly x).
  std::string front = {};
  std::string hinge = "left";  ///< Who faces the leaf has its hinge to the "left" or "right".
  std::string frame = {};      ///< Mesh file of a leaf's frame, in the same axes and units.
  std::string rose = {};       ///< Mesh file of what stays fixed around a grip.
  /// Point of the file, in its own axes and units. Leaf: where the handle goes. Handle: the point
  /// on its axis that lies on the leaf. Empty: see docs/import.md.
  std::vector<double> mount = {};
  std::string license = "NOASSERTION";  ///< SPDX expression.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("role", self.role);
    visit("mechanism", self.mechanism);
    visit("unit", self.unit);
    visit("size_m", self.size_m);
    visit("scale", self.scale);
    visit("up", self.up);
    visit("front", self.front);
    visit("hinge", self.hinge);
    visit("frame", self.frame);
    visit("rose", self.rose);
    visit("mount", self.mount);
    visit("license", self.license);
  }
};

/// What the user knows of an object beyond its files.
struct ReadConfig {
  std::string category = {};       ///< It is a word of names.h; empty: folder or content tell it.
  std::string allow_missing = {};  ///< "frame": an object without its frame's mesh is read, too.
  /// This is the height of the whole object [m], for formats without a unit (PartNet-Mobility,
  /// GAPartNet); 0 stands for what is usual for its kind.
  double height_m = 0;
  LooseMeshConfig mesh = {};

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("category", self.category);
    visit("allow_missing", self.allow_missing);
    visit("height_m", self.height_m);
    visit("mesh", self.mesh);
  }
};

/// A part's pieces, loaded.
struct LoadedPart {
  PartDraft draft;
  /// Largest distance between the faces of the box that the source's own records state and the box
  /// of the loaded meshes [m]; 0 where none is stated.
  double box_deviation_m = 0;
};

/// One part that an object gives. Its meshes are loaded when they are needed.
struct ForeignPart {
  std::string id;  ///< Wanted name of the part's folder.
  PartRole role = PartRole::kBody;
  /// This hash covers everything the part is made of, and is equal for parts that several objects
  /// share.
  std::string source_sha256;
  std::function<LoadedPart()> load;  ///< Throws Error as ImportMesh() does.
};

/// A door, or half of one, found in a foreign file.
struct ForeignObject {
  std::string name;
  std::string category;  ///< Empty if refused before it was known.
  std::string mechanism;
  std::vector<ForeignPart> parts;  ///< Written all or none; empty exactly if it is refused.
  std::string refusal;             ///< Why this cannot be a door, and what it is.
  std::vector<std::string> notes;  ///< What was left out or assumed.
  double scale = 1;                ///< Metres a unit of the source.
  /// Settings of `doorforge compose`, as words, that make the exported door of the two parts again;
  /// empty where the source is no export of this project.
  std::map<std::string, std::string> compose_settings = {};
  /// Where an object has both parts, this leads from the body's PartJoint::origin_m to the origin
  /// of the handle's frame as the source places it, in the parts' common axes.
  std::optional<Eigen::Vector3d> hinge_to_handle_m = {};
  /// The source's hinge is at the large-y side (right for who faces the door). Its mirror image in
  /// the plane y = 0 was imported, for parts are hinged at the small-y side.
  bool mirrored = false;
};

/// A file or folder that one of the formats reads.
struct ForeignSource {
  std::filesystem::path path;
  std::string format;  ///< One of ImportFormatNames().
};

/// The words for the formats, such as "urdf", in the order in which they are tried.
const std::vector<std::string>& ImportFormatNames();

/// The objects at or below `source`, by path.
///
/// A folder is searched up to three levels deep. With "auto" each folder goes to the first format
/// that knows it, and a single mesh file is read as "mesh"; meshes in folders are taken only if
/// `format` says "mesh".
///
/// @throws Error(kMissing) if there is nothing, Error(kInvalidArgument) on an unknown format.
std::vector<ForeignSource> FindObjects(const std::filesystem::path& source,
                                       const std::string& format = "auto");

/// This does the same for several, as a shell's glob names them, and gives each object once, in
/// their order. Where
/// nothing is found at one of them it comes back as a source that ReadObjects() refuses, so that
/// the others are not lost; a single one throws as above.
std::vector<ForeignSource> FindObjects(const std::vector<std::filesystem::path>& sources,
                                       const std::string& format = "auto");

/// Reads one source: at least one object. What cannot be a door comes back with its refusal.
///
/// @throws Error kMissing: files that the source names are absent, all of them named; kFormat: a
///     file does not follow its format; kInvalidArgument: the user has to say more, or said
///     something that does not fit.
std::vector<ForeignObject> ReadObjects(const ForeignSource& source, const ReadConfig& config);

}  // namespace doorforge
