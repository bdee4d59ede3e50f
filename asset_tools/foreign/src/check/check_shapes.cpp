// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <set>

#include "doorforge/foreign/foreign_rules.h"

#include "check/checks.h"

namespace doorforge::foreign {
namespace {

using Box = Eigen::AlignedBox3d;

constexpr double kSmallestDiagonalM = 0.001;

Box MovedBox(const Box& box, const RigidTransform& to_from_box) {
  Box moved;
  if (box.isEmpty()) return moved;
  for (int corner = 0; corner < 8; ++corner)
    moved.extend(to_from_box * box.corner(static_cast<Box::CornerType>(corner)));
  return moved;
}

Box Scaled(const Box& box, const Eigen::Vector3d& scale) {
  Box scaled;
  if (box.isEmpty()) return scaled;
  scaled.extend(box.min().cwiseProduct(scale));
  scaled.extend(box.max().cwiseProduct(scale));
  return scaled;
}

Box About(const Eigen::Vector3d& half) { return {Eigen::Vector3d(-half), half}; }

// What the shapes of an object are judged with, one after the other.
class ShapeCheck {
 public:
  ShapeCheck(MeshFiles& files, FaultList& faults) : files_(files), faults_(faults) {}

  /// The shape's bounds in its own frame; empty where they are not known.
  Box Check(const ForeignShape& shape) {
    shape_ = &shape;
    return std::visit(*this, shape.geometry);
  }

  Box operator()(const std::monostate&) const { return {}; }
  Box operator()(const ForeignBox& box) const {
    return Sized(box.size_m.minCoeff(), About(box.size_m / 2));
  }
  Box operator()(const ForeignSphere& sphere) const {
    return Sized(sphere.radius_m, About(Eigen::Vector3d::Constant(sphere.radius_m)));
  }
  Box operator()(const ForeignCylinder& cylinder) const {
    const double r = cylinder.radius_m;
    return Sized(std::min(r, cylinder.length_m), About({r, r, cylinder.length_m / 2}));
  }
  Box operator()(const TriangleMesh& mesh) const {
    const MeshMeasure measure = MeasureTriangles(mesh);
    if (CollidesAsItIs()) CheckTriangles(measure, shape_->place, "", faults_);
    return Sized(1, measure.topology.bounds);
  }
  Box operator()(const ForeignMeshFile& file) {
    if ((file.scale.array() == 0).any()) {
      faults_.Add("GEO006", shape_->place, ScaleText(file));
      return {};
    }
    const auto measure = files_.Measure(file.name, shape_->place, faults_);
    if (measure == nullptr) return {};
    if (file.scale.prod() < 0) faults_.Add("GEO007", shape_->place, ScaleText(file));
    if (CollidesAsItIs() && collided_.insert(file.name).second)
      CheckTriangles(*measure, shape_->place, "\"" + file.name + "\": ", faults_);
    if (named_.insert(file.name).second) {
      for (const ForeignFileName& name : measure->files) FindBeside(file.name, name);
    }
    const Box scaled = Scaled(measure->topology.bounds, file.scale);
    const double diagonal = scaled.isEmpty() ? 1 : scaled.diagonal().norm();
    if (diagonal > AnyRule("GEO008").limit || diagonal < kSmallestDiagonalM)
      faults_.Add("GEO008", shape_->place, Measured(diagonal, "m"));
    return scaled;
  }

 private:
  bool CollidesAsItIs() const { return shape_->use != ShapeUse::kVisual && !shape_->as_hull; }

  static std::string ScaleText(const ForeignMeshFile& file) {
    return Digits(file.scale.x()) + " " + Digits(file.scale.y()) + " " + Digits(file.scale.z());
  }

  Box Sized(double least, const Box& bounds) const {
    if (least > 0) return bounds;
    faults_.Add("GEO015", shape_->place, Measured(least, "m"));
    return {};
  }

  // Materials are named from where the mesh lies.
  void FindBeside(const std::string& mesh, const ForeignFileName& name) {
    FaultList unused;
    const auto path = files_.Find({mesh, {}, false}, unused);
    if (!path) return;
    MeshFiles::Places places = files_.places();
    places.folder = path->parent_path();
    MeshMemory memory;
    MeshFiles(places, memory).Find(name, faults_);
  }

  MeshFiles& files_;
  FaultList& faults_;
  const ForeignShape* shape_ = nullptr;
  std::set<std::string> collided_;
  std::set<std::string> named_;
};

struct PlacedShape {
  const ForeignShape* shape;
  Box world;
};

// The box about all but one of each, by boxes of those before and after.
void CheckDistances(const std::vector<PlacedShape>& shapes, FaultList& faults) {
  if (shapes.size() < 2) return;
  std::vector<Box> after(shapes.size() + 1);
  for (std::size_t i = shapes.size(); i-- > 0;) {
    after[i] = after[i + 1];
    after[i].extend(shapes[i].world);
  }
  Box before;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    Box others = before;
    if (!after[i + 1].isEmpty()) others.extend(after[i + 1]);
    const Box& own = shapes[i].world;
    const double size = std::max(others.diagonal().norm(), own.diagonal().norm());
    const double away = std::sqrt(others.squaredExteriorDistance(own));
    constexpr double kNearM = 1;
    if (away > AnyRule("GEO014").limit * size + kNearM)
      faults.Add("GEO014", shapes[i].shape->place, Measured(away, "m"));
    before.extend(own);
  }
}

}  // namespace

void CheckTriangles(const MeshMeasure& mesh, const SourcePlace& place, const std::string& name,
                    FaultList& faults) {
  const MeshTopology& topology = mesh.topology;
  const auto count = [&](const char* code, auto number, const char* what) {
    if (number <= 0) return;
    Measured measured(static_cast<double>(number), what);
    measured.text = name + measured.text;
    faults.Add(code, place, measured);
  };
  count("GEO009", topology.boundary_edges, "boundary edges");
  count("GEO017", topology.non_manifold_edges, "non-manifold edges");
  // where sheets were drawn from both sides, which of a pair was kept says nothing
  if (mesh.repeated == 0) count("GEO010", topology.inconsistent_edges, "inconsistent edges");
  count("GEO011", topology.degenerate_triangles, "degenerate triangles");
  count("GEO012", static_cast<long>(mesh.repeated), "repeated triangles");
  const bool closed =
      topology.boundary_edges + topology.non_manifold_edges + topology.inconsistent_edges == 0;
  if (closed && mesh.repeated == 0 && topology.volume_m3 < 0) {
    Measured measured(topology.volume_m3, "m3");
    measured.text = name + measured.text;
    faults.Add("GEO013", place, measured);
  }
}

std::vector<LinkBounds> CheckShapes(const ArticulatedObject& object, const ObjectTree& tree,
                                    MeshFiles& files, FaultList& faults) {
  std::vector<LinkBounds> bounds(object.links.size());
  std::vector<PlacedShape> placed;
  ShapeCheck check(files, faults);
  for (std::size_t i = 0; i < object.links.size(); ++i) {
    for (const ForeignShape& shape : object.links[i].shapes) {
      const Box in_link = MovedBox(check.Check(shape), shape.link_from_shape);
      bounds[i].shapes.push_back(in_link);
      if (in_link.isEmpty()) continue;
      bounds[i].all.extend(in_link);
      placed.push_back({&shape, MovedBox(in_link, tree.world_from_link[i])});
    }
  }
  CheckDistances(placed, faults);
  for (const ForeignFileName& name : object.files) files.Find(name, faults);
  return bounds;
}

}  // namespace doorforge::foreign
