// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "urdf_objects/hinged_object.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <map>
#include <optional>
#include <sstream>

#include "doorforge/core/error.h"
#include "doorforge/core/mesh_transform.h"

#include "guessed_category.h"
#include "import_format.h"
#include "urdf_objects/handle_place.h"
#include "urdf_objects/hinged_shapes.h"
#include "urdf_objects/joint_tree.h"
#include "urdf_objects/leaf_motion.h"
#include "urdf_objects/stated_mass.h"

namespace doorforge::internal {
namespace {

constexpr double kNarrowOpening = 0.7854;  // [rad] below this a door does not count as open

std::string Degrees(double rad) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << rad * 180 / 3.141592653589793 << " degrees";
  return text.str();
}

// what could be grasped on a leaf: shapes, and the joint that turns them
struct HandleCandidate {
  std::vector<std::size_t> shapes;
  std::optional<std::size_t> joint;  // into UrdfModel::joints
  int rank = 0;
  double size_m = 0;
  std::string word;
};

class LeafReader {
 public:
  LeafReader(const HingedObject& object, const std::vector<TreeLink>& tree,
             const HingedShapes& shapes, std::size_t leaf_link)
      : object_(object), tree_(tree), shapes_(shapes), leaf_link_(leaf_link) {}

  ForeignObject Read(bool only_leaf) {
    const std::string link = object_.model.links[leaf_link_].name;
    read_.name = object_.name + (only_leaf ? "" : "/" + link);
    id_ = PartIdFrom(object_.id + (only_leaf ? "" : "-" + link));
    read_.category = NameOf(object_.category);
    read_.scale = shapes_.scale;
    SplitShapes();
    if (on_leaf_.empty()) return Refused("its link has no mesh");
    const std::optional<HandleCandidate> handle = ChooseHandle();
    TakeHandle(handle);
    motion_ = FindLeafMotion(AuthoredLeafOf());
    if (!motion_.refusal.empty()) return Refused(motion_.refusal);
    Note(handle);
    NoteStill(handle);
    MakeParts(handle);
    return read_;
  }

 private:
  ForeignObject Refused(const std::string& why) {
    read_.refusal = object_.model.links[leaf_link_].name + " (" + WordFor(object_, leaf_link_) +
                    ") is no door: " + why;
    return read_;
  }

  std::size_t HingeIndex() const { return *tree_[leaf_link_].joint; }

  bool IsOnLeaf(std::size_t link) const {
    const auto& movable = tree_[link].movable;
    return !movable.empty() && movable.front() == HingeIndex();
  }

  void SplitShapes() {
    for (std::size_t i = 0; i < shapes_.shapes.size(); ++i)
      (IsOnLeaf(shapes_.shapes[i].link) ? on_leaf_ : around_).push_back(i);
  }

  // what turns on the leaf, each by its uppermost joint above the hinge, and what is called a
  // handle
  std::vector<HandleCandidate> Candidates() const {
    std::vector<HandleCandidate> found;
    HandleCandidate fixed{{}, std::nullopt, 1, 0, "handle"};
    for (const std::size_t i : on_leaf_) {
      const HingedShape& shape = shapes_.shapes[i];
      const auto& movable = tree_[shape.link].movable;
      if (movable.size() > 1 && Turns(object_.model.joints[movable[1]])) {
        AddTurning(i, movable[1], found);
      } else if (movable.size() == 1 && (shape.handle || IsFixedHandle(shape.link))) {
        fixed.shapes.push_back(i);
      }
    }
    if (!fixed.shapes.empty() && fixed.shapes.size() < on_leaf_.size()) found.push_back(fixed);
    for (HandleCandidate& candidate : found) candidate.size_m = SizeOf(candidate.shapes);
    return found;
  }

  bool IsFixedHandle(std::size_t link) const {
    return link != leaf_link_ && IsHandleWord(WordFor(object_, link));
  }

  void AddTurning(std::size_t shape, std::size_t joint, std::vector<HandleCandidate>& found) const {
    const auto known = std::find_if(found.begin(), found.end(),
                                    [&](const HandleCandidate& c) { return c.joint == joint; });
    if (known != found.end()) {
      known->shapes.push_back(shape);
      return;
    }
    std::size_t link = shapes_.shapes[shape].link;
    while (tree_[link].joint != joint) link = *tree_[link].parent;
    const std::string word = WordFor(object_, link);
    found.push_back({{shape}, joint, word.find("handle") != std::string::npos ? 3 : 2, 0, word});
  }

  double SizeOf(const std::vector<std::size_t>& shapes) const {
    Eigen::AlignedBox3d bounds;
    for (const std::size_t i : shapes) bounds.extend(BoundsOf(shapes_.shapes[i].mesh));
    return bounds.isEmpty() ? 0 : bounds.diagonal().norm();
  }

  std::optional<HandleCandidate> ChooseHandle() {
    const std::vector<HandleCandidate> found = Candidates();
    if (found.empty()) return std::nullopt;
    const auto best = std::max_element(found.begin(), found.end(),
                                       [](const HandleCandidate& a, const HandleCandidate& b) {
                                         if (a.rank != b.rank) return a.rank < b.rank;
                                         return a.size_m < b.size_m;
                                       });
    for (const HandleCandidate& candidate : found) {
      if (&candidate != &*best)
        read_.notes.push_back("a second handle (" + candidate.word + ") became part of the leaf");
    }
    return *best;
  }

  void TakeHandle(const std::optional<HandleCandidate>& handle) {
    if (!handle) return;
    grip_ = handle->shapes;
    grip_joint_ = handle->joint;
    std::erase_if(on_leaf_, [&](std::size_t i) {
      return std::find(handle->shapes.begin(), handle->shapes.end(), i) != handle->shapes.end();
    });
  }

  TriangleMesh Joined(const std::vector<std::size_t>& shapes) const {
    std::vector<TriangleMesh> meshes;
    for (const std::size_t i : shapes) meshes.push_back(shapes_.shapes[i].mesh);
    return Merged(meshes);
  }

  // in the authored frame, before closing
  PartJoint AuthoredJoint(std::size_t joint_index) const {
    const UrdfJoint& joint = object_.model.joints[joint_index];
    std::size_t child = 0;
    while (tree_[child].joint != joint_index) ++child;
    const RigidTransform& base_from_joint = tree_[child].base_from_link;
    PartJoint made;
    made.origin_m = shapes_.authored_from_base * base_from_joint.translation();
    made.axis = (object_.upright_from_base * base_from_joint.linear() * joint.axis).normalized();
    made.lower_rad = joint.lower;
    made.upper_rad = joint.upper;
    return made;
  }

  AuthoredLeaf AuthoredLeafOf() const {
    AuthoredLeaf leaf;
    leaf.hinge = AuthoredJoint(HingeIndex());
    leaf.limited = object_.model.joints[HingeIndex()].type == UrdfJointType::kRevolute;
    leaf.mesh = Joined(on_leaf_);
    leaf.around = BoundsOf(Joined(around_));
    return leaf;
  }

  void Note(const std::optional<HandleCandidate>& handle) {
    read_.mirrored = HingeIsRight();
    if (HingeIsRight()) read_.notes.push_back("mirrored: the source's hinge is on the right");
    if (motion_.level) read_.notes.push_back("its hinge is level: the leaf tilts");
    if (motion_.ajar_rad > 0)
      read_.notes.push_back("authored ajar by " + Degrees(motion_.ajar_rad) + ", was closed");
    if (motion_.hinge.upper_rad < kNarrowOpening)
      read_.notes.push_back("opens by " + Degrees(motion_.hinge.upper_rad) + " only");
    if (!handle) read_.notes.push_back("has no handle: gives a body alone");
    for (const std::string& mesh : shapes_.left_out)
      read_.notes.push_back("without " + mesh + ", which is missing");
  }

  // Joints on the leaf or below what is no leaf, of which nothing else is said.
  void NoteStill(const std::optional<HandleCandidate>& handle) {
    for (std::size_t i = 0; i < tree_.size(); ++i) {
      const auto& movable = tree_[i].movable;
      if (movable.size() < 2 || tree_[i].joint != movable.back()) continue;
      if (handle && handle->joint == movable.back()) continue;
      const std::string moves = object_.model.links[i].name + " (" + WordFor(object_, i) + ") " +
                                (Turns(object_.model.joints[movable.back()]) ? "turns" : "slides");
      if (!IsOnLeaf(i))
        read_.notes.push_back("left as it is: " + moves + " on what stands still here");
      else if (handle && handle->joint &&
               std::find(movable.begin(), movable.end(), *handle->joint) != movable.end())
        read_.notes.push_back("left as it is: " + moves + " on the handle, of which it is a part");
      else if (!Turns(object_.model.joints[movable.back()]) || movable.size() > 2)
        read_.notes.push_back("left as it is: " + moves + " on the leaf, of which it is a part");
    }
  }

  Eigen::Affine3d PartFromAuthored(bool moves) const {
    const Eigen::Affine3d closing(motion_.closing.matrix());
    return moves ? motion_.part_from_authored * closing : motion_.part_from_authored;
  }

  // seen from where the handle is, which of a pushed door is behind it
  bool HingeIsRight() const { return !motion_.level && motion_.mirrored != object_.pushed; }

  Eigen::Affine3d HandleFromAuthored() const { return HandleFromBody() * PartFromAuthored(true); }

  Eigen::Affine3d HandleFromBody() const {
    return Eigen::Affine3d(Eigen::Scaling(object_.pushed ? -1.0 : 1.0, 1.0, 1.0));
  }

  std::vector<SourceMesh> PlacedSources(const std::vector<std::size_t>& shapes,
                                        const std::string& piece,
                                        const Eigen::Affine3d& part_from_authored) const {
    std::vector<SourceMesh> placed;
    for (const std::size_t i : shapes) {
      SourceMesh mesh = shapes_.shapes[i].source;
      mesh.piece = piece;
      mesh.part_from_raw = part_from_authored * mesh.part_from_raw;
      placed.push_back(std::move(mesh));
    }
    return placed;
  }

  TriangleMesh PlacedMesh(const std::vector<std::size_t>& shapes,
                          const Eigen::Affine3d& part_from_authored) const {
    TriangleMesh mesh = Joined(shapes);
    for (Eigen::Vector3d& vertex : mesh.vertices) vertex = part_from_authored * vertex;
    return mesh;
  }

  void MakeParts(const std::optional<HandleCandidate>& handle) {
    const TriangleMesh leaf = PlacedMesh(on_leaf_, PartFromAuthored(true));
    Eigen::Vector3d mount = DefaultMount(leaf, object_.category);
    Mechanism mechanism = Mechanism::kNone;
    if (handle) {
      const HandlePlace place = PlaceOf(*handle);
      mount = HandleFromBody() * place.mount_m;  // its own inverse
      read_.hinge_to_handle_m = mount - motion_.hinge.origin_m;
      mechanism = place.mechanism;
      AddBody(leaf, mount);
      AddHandle(*handle, place);
    } else {
      AddBody(leaf, mount);
    }
    read_.mechanism = NameOf(mechanism);
  }

  HandlePlace PlaceOf(const HandleCandidate& handle) const {
    HandleKnowledge known;
    known.category = object_.category;
    if (handle.joint) known.joint = MovedJoint(AuthoredJoint(*handle.joint), HandleFromAuthored());
    return PlaceHandle(PlacedMesh(handle.shapes, HandleFromAuthored()), known);
  }

  Part Facts(PartRole role) const {
    Part part;
    part.role = role;
    part.category = object_.category;
    part.id = id_ + (role == PartRole::kHandle ? "-handle" : "");
    part.license = object_.license;
    part.source = object_.source + " " + object_.model.links[leaf_link_].name +
                  (HingeIsRight() ? ", mirrored" : "");
    return part;
  }

  using StatedMasses = std::map<std::string, MassProperties>;  // by piece

  // Which piece a link's mass belongs to; nothing where its shapes go to two.
  std::optional<std::string> PieceOf(std::size_t link) const {
    bool grip = false;
    bool other = false;
    for (std::size_t i = 0; i < shapes_.shapes.size(); ++i) {
      if (shapes_.shapes[i].link != link) continue;
      (std::find(grip_.begin(), grip_.end(), i) != grip_.end() ? grip : other) = true;
    }
    if (grip && other) return std::nullopt;
    const auto& movable = tree_[link].movable;
    const bool turns =
        grip_joint_ && std::find(movable.begin(), movable.end(), *grip_joint_) != movable.end();
    if (grip || (turns && !other)) return "grip";
    return IsOnLeaf(link) ? "leaf" : "frame";
  }

  // Adds what the source says that a piece weighs, and says so.
  void AddStatedMass(const std::string& piece, const std::vector<std::size_t>& shapes,
                     const Eigen::Affine3d& part_from_authored, StatedMasses& masses) {
    if (object_.height_m > 0 || shapes.empty()) return;  // without a unit there is no mass
    StatedLinks stated;
    stated.has_shape.resize(object_.model.links.size(), false);
    for (const HingedShape& shape : shapes_.shapes) stated.has_shape[shape.link] = true;
    for (std::size_t i = 0; i < object_.model.links.size(); ++i) {
      const std::optional<std::string> owner = PieceOf(i);
      if (!owner && object_.model.links[i].inertial && piece != "frame") {
        read_.notes.push_back("mass of " + piece + " computed: link \"" +
                              object_.model.links[i].name + "\" is leaf and handle");
        return;
      }
      if (owner == piece) stated.links.push_back(i);
    }
    stated.piece_from_base = part_from_authored * shapes_.authored_from_base;
    TriangleMesh mesh = Joined(shapes);
    for (const Eigen::Vector3d& vertex : mesh.vertices)
      stated.bounds.extend(part_from_authored * vertex);
    const StatedMass found = StatedMassOf(object_, tree_, stated);
    if (found.mass) masses[piece] = *found.mass;
    if (found.mass) read_.notes.push_back("mass of " + piece + " is the source's");
    if (!found.problem.empty())
      read_.notes.push_back("mass of " + piece + " computed: " + found.problem);
  }

  void AddBody(const TriangleMesh& leaf, const Eigen::Vector3d& mount) {
    double lowest = BoundsOf(leaf).min().z();
    if (!around_.empty())
      lowest = std::min(lowest, BoundsOf(PlacedMesh(around_, PartFromAuthored(false))).min().z());
    const Eigen::Translation3d up(0, 0, -lowest);
    Part part = Facts(PartRole::kBody);
    part.joint = motion_.hinge;
    part.joint.origin_m = up * part.joint.origin_m;
    part.part_from_mount = Translation(up * mount);
    std::vector<SourceMesh> meshes = PlacedSources(around_, "frame", up * PartFromAuthored(false));
    for (SourceMesh& mesh : PlacedSources(on_leaf_, "leaf", up * PartFromAuthored(true)))
      meshes.push_back(std::move(mesh));
    StatedMasses masses;
    AddStatedMass("leaf", on_leaf_, up * PartFromAuthored(true), masses);
    AddStatedMass("frame", around_, up * PartFromAuthored(false), masses);
    AddPart(std::move(part), {std::move(meshes), std::move(masses)});
  }

  void AddHandle(const HandleCandidate& handle, const HandlePlace& place) {
    Part part = Facts(PartRole::kHandle);
    part.mechanism = place.mechanism;
    part.joint = place.joint;
    part.part_from_grasp = place.part_from_grasp;
    const Eigen::Translation3d to_mount(-place.mount_m);
    StatedMasses masses;
    AddStatedMass("grip", handle.shapes, to_mount * HandleFromAuthored(), masses);
    AddPart(
        std::move(part),
        {PlacedSources(handle.shapes, "grip", to_mount * HandleFromAuthored()), std::move(masses)},
        BoxDeviationOf(handle));
  }

  // from the box that the source states for the handle's link
  double BoxDeviationOf(const HandleCandidate& handle) const {
    const std::size_t link = shapes_.shapes[handle.shapes.front()].link;
    const auto stated = object_.stated_boxes.find(object_.model.links[link].name);
    if (stated == object_.stated_boxes.end()) return 0;
    Eigen::AlignedBox3d box;
    for (const auto corner :
         {Eigen::AlignedBox3d::BottomLeftFloor, Eigen::AlignedBox3d::TopRightCeil})
      box.extend(Eigen::Vector3d(shapes_.authored_from_base * stated->second.corner(corner)));
    const Eigen::AlignedBox3d loaded = BoundsOf(Joined(handle.shapes));
    return std::max((loaded.min() - box.min()).cwiseAbs().maxCoeff(),
                    (loaded.max() - box.max()).cwiseAbs().maxCoeff());
  }

  /// What a part is made of.
  struct Ingredients {
    std::vector<SourceMesh> meshes;
    StatedMasses masses;
    bool keep_closed = false;
  };

  static std::vector<RawPiece> PiecesOf(const Ingredients& from) {
    std::vector<RawPiece> pieces = LoadPieces(from.meshes);
    for (RawPiece& piece : pieces) {
      piece.keep_closed = from.keep_closed;
      const auto mass = from.masses.find(piece.name);
      if (mass != from.masses.end()) piece.stated_mass = mass->second;
    }
    return pieces;
  }

  void AddPart(Part part, Ingredients from, double box_deviation_m = 0) {
    from.keep_closed = object_.exported;
    part.source += ": " + FileNamesOf(from.meshes);
    part.source_sha256 = SourceHashOf(from.meshes, part, from.masses);
    ForeignPart added;
    added.id = part.id;
    added.role = part.role;
    added.source_sha256 = part.source_sha256;
    added.load = [part, from = std::move(from), box_deviation_m] {
      return LoadedPart{{part, PiecesOf(from)}, box_deviation_m};
    };
    read_.parts.push_back(std::move(added));
  }

  const HingedObject& object_;
  const std::vector<TreeLink>& tree_;
  const HingedShapes& shapes_;
  std::size_t leaf_link_;
  std::string id_;
  std::vector<std::size_t> on_leaf_;  // into shapes_; without the handle once it is chosen
  std::vector<std::size_t> around_;
  std::vector<std::size_t> grip_;  // and of these the handle's
  std::optional<std::size_t> grip_joint_;
  LeafMotion motion_;
  ForeignObject read_;
};

// links that a movable joint moves and none above it does, with what speaks against each
struct Leaves {
  std::vector<std::size_t> links;
  std::vector<std::string> others;
};

Leaves LeavesOf(const HingedObject& object, const std::vector<TreeLink>& tree) {
  Leaves leaves;
  for (std::size_t i = 0; i < tree.size(); ++i) {
    if (tree[i].movable.size() != 1 || tree[i].joint != tree[i].movable[0]) continue;
    const UrdfJoint& joint = object.model.joints[*tree[i].joint];
    const std::string named = object.model.links[i].name + " (" + WordFor(object, i) + ")";
    if (!Turns(joint))
      leaves.others.push_back(named + " slides");
    else if (IsHandleWord(WordFor(object, i)))
      leaves.others.push_back(named + " turns on what does not move, not on a leaf");
    else
      leaves.links.push_back(i);
  }
  return leaves;
}

std::string Joined(const std::vector<std::string>& texts) {
  std::string joined;
  for (const std::string& text : texts) joined += (joined.empty() ? "" : "; ") + text;
  return joined;
}

double HeightOf(const HingedShapes& shapes) {
  Eigen::AlignedBox3d bounds;
  for (const HingedShape& shape : shapes.shapes) bounds.extend(BoundsOf(shape.mesh));
  return bounds.isEmpty() ? 0 : bounds.sizes().z();
}

// Doors of one object have one frame, in which the leaves of the others are shut.
void AddSharedFrame(const std::vector<ForeignObject>& doors, ForeignObject& door) {
  constexpr std::size_t kNamed = 8;
  std::string names;
  std::size_t count = 0;
  for (const ForeignObject& other : doors) {
    if (&other == &door || other.parts.empty() || ++count > kNamed) continue;
    names += (names.empty() ? "" : ", ") + other.parts.front().id;
  }
  if (count == 0) return;
  if (count > kNamed) names += " and " + std::to_string(count - kNamed) + " more";
  door.notes.push_back("shares its frame with " + names + ", which are shut in it");
}

}  // namespace

std::vector<ForeignObject> ReadHingedObject(const HingedObject& object) {
  const std::vector<TreeLink> tree = JointTreeOf(object.model, object.where);
  const Leaves leaves = LeavesOf(object, tree);
  std::vector<ForeignObject> doors;
  std::vector<std::string> others = leaves.others;
  if (!leaves.links.empty()) {
    const HingedShapes shapes = LoadShapes(object, tree);
    HingedObject known = object;
    std::vector<std::string> notes;
    if (object.category_by_height) {
      const GuessedCategory guess = CategoryByHeight(HeightOf(shapes));
      known.category = guess.category;
      notes.push_back(GuessText(guess));
    }
    for (const std::size_t link : leaves.links) {
      ForeignObject door = LeafReader(known, tree, shapes, link).Read(leaves.links.size() == 1);
      door.notes.insert(door.notes.end(), notes.begin(), notes.end());
      if (door.refusal.empty())
        doors.push_back(std::move(door));
      else
        others.push_back(door.refusal);
    }
  }
  for (ForeignObject& door : doors) {
    for (const std::string& other : others) door.notes.push_back("left as it is: " + other);
    AddSharedFrame(doors, door);
  }
  if (!doors.empty()) return doors;
  ForeignObject refused;
  refused.name = object.name;
  refused.category = NameOf(object.category);
  refused.refusal =
      others.empty() ? "nothing turns on a hinge in it, so it is no door" : Joined(others);
  return {refused};
}

}  // namespace doorforge::internal
