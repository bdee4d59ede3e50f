# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Sound objects in each format that `doorforge validate` reads, written for the tests of damage."""
import json
import struct

BOX_CORNERS = [(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]
BOX_FACES = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4),
             (1, 5, 7), (1, 7, 3)]

OBJ = "\n".join(["# a box of one metre"] + [f"v {x} {y} {z}" for x, y, z in BOX_CORNERS]
                + [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in BOX_FACES]) + "\n"

STL = "solid box\n" + "".join(
    "facet normal 0 0 0\n outer loop\n" + "".join("  vertex {} {} {}\n".format(*BOX_CORNERS[i]) for i in face)
    + " endloop\nendfacet\n" for face in BOX_FACES) + "endsolid box\n"

BINARY_STL = bytes(80) + struct.pack("<I", len(BOX_FACES)) + b"".join(
    struct.pack("<12fH", 0, 0, 0, *[n for i in face for n in BOX_CORNERS[i]], 0) for face in BOX_FACES)

PLY = ("ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\nelement face 12\n"
       "property list uchar int vertex_indices\nend_header\n" + "".join("{} {} {}\n".format(*c) for c in BOX_CORNERS)
       + "".join("3 {} {} {}\n".format(*f) for f in BOX_FACES))

OFF = "OFF\n8 12 18\n" + "".join("{} {} {}\n".format(*c) for c in BOX_CORNERS) + "".join(
    "3 {} {} {}\n".format(*f) for f in BOX_FACES)

URDF = """<?xml version="1.0"?>
<robot name="gate">
  <material name="oak"><color rgba="0.6 0.4 0.2 1"/></material>
  <link name="post">
    <visual>
      <geometry><box size="0.1 0.1 2.0"/></geometry>
      <material name="oak"/>
    </visual>
    <collision><geometry><cylinder radius="0.05" length="2"/></geometry></collision>
  </link>
  <link name="leaf">
    <inertial>
      <origin xyz="0 0.5 0"/>
      <mass value="20"/>
      <inertia ixx="8" ixy="0" ixz="0" iyy="6.5" iyz="0" izz="1.7"/>
    </inertial>
    <visual>
      <origin xyz="0 0.5 0"/>
      <geometry><mesh filename="meshes/box.obj" scale="0.04 1 2"/></geometry>
    </visual>
    <collision>
      <origin xyz="0 0.5 0"/>
      <geometry><mesh filename="meshes/box.stl" scale="0.04 1 2"/></geometry>
    </collision>
  </link>
  <link name="lever">
    <inertial>
      <mass value="0.3"/>
      <inertia ixx="0.0004" ixy="0" ixz="0" iyy="0.0001" iyz="0" izz="0.0004"/>
    </inertial>
    <visual><geometry><box size="0.06 0.12 0.02"/></geometry></visual>
    <collision><geometry><sphere radius="0.03"/></geometry></collision>
  </link>
  <link name="follower">
    <inertial>
      <mass value="0.2"/>
      <inertia ixx="0.0004" ixy="0" ixz="0" iyy="0.0001" iyz="0" izz="0.0004"/>
    </inertial>
    <visual><geometry><box size="0.02 0.1 0.02"/></geometry></visual>
  </link>
  <joint name="hinge" type="revolute">
    <parent link="post"/>
    <child link="leaf"/>
    <origin xyz="0 0.05 0"/>
    <axis xyz="0 0 -1"/>
    <limit lower="0" upper="1.5" effort="30" velocity="2"/>
    <dynamics damping="0.1" friction="0.1"/>
  </joint>
  <joint name="turn" type="revolute">
    <parent link="leaf"/>
    <child link="lever"/>
    <origin xyz="0.05 0.9 0"/>
    <axis xyz="1 0 0"/>
    <limit lower="0" upper="0.8" effort="5" velocity="3"/>
  </joint>
  <joint name="slide" type="prismatic">
    <parent link="leaf"/>
    <child link="follower"/>
    <origin xyz="0 0.95 0.1"/>
    <axis xyz="0 1 0"/>
    <limit lower="0" upper="0.02" effort="5" velocity="1"/>
    <mimic joint="turn" multiplier="0.02"/>
  </joint>
</robot>
"""

MJCF = """<mujoco model="gate">
  <compiler angle="radian" autolimits="true" meshdir="meshes"/>
  <default>
    <default class="metal"><geom rgba="0.7 0.7 0.7 1"/></default>
  </default>
  <asset>
    <mesh name="leaf" file="box.obj" scale="0.04 1 2"/>
    <material name="oak" rgba="0.6 0.4 0.2 1"/>
  </asset>
  <worldbody>
    <geom name="post" type="box" size="0.05 0.05 1"/>
    <body name="leaf" pos="0 0.05 0">
      <inertial pos="0 0.5 0" mass="20" diaginertia="8 6.5 1.7"/>
      <joint name="hinge" type="hinge" axis="0 0 -1" range="0 1.5" damping="0.1"/>
      <geom name="panel" type="mesh" mesh="leaf" pos="0 0.5 0" material="oak"/>
      <body name="lever" pos="0.05 0.9 0">
        <joint name="turn" type="hinge" axis="1 0 0" range="0 0.8" frictionloss="0.1"/>
        <geom name="grip" class="metal" type="capsule" size="0.01 0.06" mass="0.3"/>
      </body>
    </body>
  </worldbody>
  <actuator>
    <motor joint="turn" ctrlrange="-1 1" ctrllimited="true"/>
  </actuator>
</mujoco>
"""

SDF = """<?xml version="1.0"?>
<sdf version="1.7">
  <model name="gate">
    <link name="post">
      <collision name="shape"><geometry><box><size>0.1 0.1 2</size></box></geometry></collision>
    </link>
    <link name="leaf">
      <pose>0 0.05 0 0 0 0</pose>
      <inertial>
        <pose>0 0.5 0 0 0 0</pose>
        <mass>20</mass>
        <inertia><ixx>8</ixx><iyy>6.5</iyy><izz>1.7</izz></inertia>
      </inertial>
      <collision name="shape">
        <pose>0 0.5 0 0 0 0</pose>
        <geometry><mesh><uri>meshes/box.stl</uri><scale>0.04 1 2</scale></mesh></geometry>
      </collision>
    </link>
    <joint name="hinge" type="revolute">
      <parent>post</parent>
      <child>leaf</child>
      <axis>
        <xyz>0 0 -1</xyz>
        <limit><lower>0</lower><upper>1.5</upper><effort>30</effort><velocity>2</velocity></limit>
        <dynamics><damping>0.1</damping></dynamics>
      </axis>
    </joint>
    <joint name="anchor" type="fixed"><parent>world</parent><child>post</child></joint>
  </model>
</sdf>
"""

USDA = """#usda 1.0
(
    defaultPrim = "gate"
    metersPerUnit = 1
    upAxis = "Z"
)

def Xform "gate" (
    prepend apiSchemas = ["PhysicsArticulationRootAPI"]
)
{
    def Xform "post" (
        prepend apiSchemas = ["PhysicsRigidBodyAPI", "PhysicsMassAPI"]
    )
    {
        float physics:mass = 40
        def Cube "shape" (
            prepend apiSchemas = ["PhysicsCollisionAPI"]
        )
        {
            double size = 0.2
        }
    }
    def Xform "leaf" (
        prepend apiSchemas = ["PhysicsRigidBodyAPI", "PhysicsMassAPI"]
    )
    {
        float physics:mass = 20
        point3f physics:centerOfMass = (0, 0.5, 0)
        float3 physics:diagonalInertia = (8, 6.5, 1.7)
        def Mesh "panel"
        {
            point3f[] points = [(-0.02, 0, -1), (0.02, 0, -1), (0.02, 1, -1), (-0.02, 1, 1)]
            int[] faceVertexCounts = [3, 3, 3, 3]
            int[] faceVertexIndices = [0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2]
        }
    }
    def PhysicsRevoluteJoint "hinge"
    {
        rel physics:body0 = </gate/post>
        rel physics:body1 = </gate/leaf>
        uniform token physics:axis = "Z"
        float physics:lowerLimit = 0
        float physics:upperLimit = 85
    }
}
"""


def glb(document: dict, binary: bytes) -> bytes:
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary += bytes(-len(binary) % 4)
    return (struct.pack("<III", 0x46546C67, 2, 28 + len(text) + len(binary)) + struct.pack("<II", len(text), 0x4E4F534A) + text
            + struct.pack("<II", len(binary), 0x004E4942) + binary)


def gltf_gate() -> tuple[dict, bytes]:
    """A post and a leaf as exports of this project say them in `extras`."""
    document, binary = gltf_box()
    mass = {"mass_kg": 20, "center_of_mass_m": [0, 0.5, 0], "inertia_xx_yy_zz_kg_m2": [8, 6.5, 1.7], "inertia_xy_xz_yz_kg_m2": [0, 0, 0]}
    joint = {"name": "hinge", "type": "revolute", "parent": "post", "axis": [0, 0, 1], "lower_rad": 0, "upper_rad": 1.5,
             "effort_limit_nm": 30, "velocity_limit_rad_s": 2, "damping_nm_s": 0.1}
    document["nodes"] = [
        {"name": "gate", "rotation": [-0.5 ** 0.5, 0, 0, 0.5 ** 0.5], "children": [1], "extras": {"category": "interior", "latch": {"type": "none"}}},
        {"name": "post", "children": [2, 3], "extras": {"mass": mass}},
        {"name": "leaf", "translation": [0, 0.05, 0], "rotation": [0, 0, 0, 1], "children": [4], "extras": {"mass": mass, "joint": joint}},
        {"name": "post_shape", "mesh": 0}, {"name": "leaf_shape", "mesh": 0}]
    return document, binary


def gltf_box() -> tuple[dict, bytes]:
    positions = b"".join(struct.pack("<3f", *corner) for corner in BOX_CORNERS)
    indices = b"".join(struct.pack("<3H", *face) for face in BOX_FACES)
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"children": [1]}, {"mesh": 0, "translation": [0, 0, 0.5]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
        "materials": [{"name": "oak"}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3", "min": [-0.5] * 3, "max": [0.5] * 3},
            {"bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteLength": 96}, {"buffer": 0, "byteOffset": 96, "byteLength": 72}],
        "buffers": [{"byteLength": 168}]}
    return document, positions + indices
