// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "collision/convex_probe.h"

#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>

#include "collision/bullet_body.h"

namespace doorforge::internal {
namespace {

Eigen::Vector3d FromBullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

ProbeHull MakeProbeHull(const TriangleMesh& mesh, const RigidTransform& owner_from_mesh,
                        double margin_m) {
  ProbeHull hull;
  hull.shape = std::make_unique<btConvexHullShape>();
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    const Eigen::Vector3d point = owner_from_mesh * vertex;
    hull.shape->addPoint(ToBullet(point), false);
    hull.box.extend(point);
  }
  hull.shape->setMargin(margin_m);
  hull.shape->recalcLocalAabb();
  return hull;
}

Separation Separate(const ProbeHull& moving, const RigidTransform& fixed_from_moving,
                    const ProbeHull& fixed) {
  btVoronoiSimplexSolver simplex;
  btGjkEpaPenetrationDepthSolver penetration;
  btGjkPairDetector detector(moving.shape.get(), fixed.shape.get(), &simplex, &penetration);
  btGjkPairDetector::ClosestPointInput input;
  input.m_transformA = ToBullet(fixed_from_moving);
  input.m_transformB.setIdentity();
  btPointCollector result;
  detector.getClosestPoints(input, result, nullptr);
  if (!result.m_hasResult) return {};
  return {result.m_distance, FromBullet(result.m_pointInWorld),
          FromBullet(result.m_normalOnBInWorld)};
}

}  // namespace doorforge::internal
