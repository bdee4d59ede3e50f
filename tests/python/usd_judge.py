# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Exported USD before usd-core: it opens without a complaint, and what the schemas say is there.

    usd_judge.py model.usda...
"""
import sys

from pxr import Usd, UsdGeom, UsdPhysics


def judge(path: str) -> str:
    stage = Usd.Stage.Open(path)
    assert stage.GetDefaultPrim() and UsdGeom.GetStageUpAxis(stage) == "Z" and UsdGeom.GetStageMetersPerUnit(stage) == 1
    prims = list(stage.Traverse())
    bodies = [prim for prim in prims if prim.HasAPI(UsdPhysics.RigidBodyAPI)]
    joints = [prim for prim in prims if prim.IsA(UsdPhysics.Joint)]
    assert all(prim.HasAPI(UsdPhysics.MassAPI) for prim in bodies)
    for joint in joints:
        for relation in (UsdPhysics.Joint(joint).GetBody0Rel(), UsdPhysics.Joint(joint).GetBody1Rel()):
            assert all(stage.GetPrimAtPath(target) in bodies for target in relation.GetTargets()), joint
    for prim in prims:  # every relation leads somewhere
        for relation in prim.GetRelationships():
            assert all(stage.GetPrimAtPath(target) for target in relation.GetTargets()), relation
    bolt = [prim for prim in joints if prim.IsA(UsdPhysics.PrismaticJoint)]
    latched = stage.GetDefaultPrim().GetAttribute("doorforge:latch:type").Get() != "none"
    assert len(bolt) == latched and len(bodies) == 3 + latched, path
    for joint in bolt:
        leader = stage.GetPrimAtPath(joint.GetRelationship("newton:mimicJoint").GetTargets()[0])
        assert leader.IsA(UsdPhysics.RevoluteJoint) and leader.GetName() == "handle_joint"
        drawn = joint.GetAttribute("newton:mimicCoef1").Get()
        assert drawn < 0 and abs(drawn + joint.GetAttribute("physxMimicJoint:rotX:gearing").Get()) < 1e-7
    assert stage.GetPrimAtPath(f"{stage.GetDefaultPrim().GetPath()}/handle/grasp")
    return f"{path.split('/')[-2]} usd-core {'.'.join(map(str, Usd.GetVersion()))}: {len(bodies)} bodies, {len(joints)} joints"


for model in sys.argv[1:]:
    print(judge(model))
