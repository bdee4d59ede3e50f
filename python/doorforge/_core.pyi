# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
# Types of the extension. All arrays are copies; `Matrix` is float64 (4, 4), `a_from_b` maps b to a.
from typing import Any, Optional, Sequence, Union

import numpy as np
import numpy.typing as npt

Vector = npt.NDArray[np.float64]
Matrix = npt.NDArray[np.float64]
Mesh = tuple[npt.NDArray[np.float64], npt.NDArray[np.int32]]

def code_version() -> str: ...
def data_folder() -> Any: ...
def exit_code_of(name: str) -> int: ...

class Joint:
    """A turning joint at the child link's origin; axis (3,) unit, in the child's frame."""
    @property
    def name(self) -> str:
        """As in exports: "hinge" or "handle_joint"."""
    @property
    def lower_rad(self) -> float:
        """Lowest angle [rad]."""
    @property
    def upper_rad(self) -> float:
        """Highest angle [rad]."""
    @property
    def effort_limit_nm(self) -> float:
        """Largest torque [N m]."""
    @property
    def velocity_limit_rad_s(self) -> float:
        """[rad/s]."""
    @property
    def damping_nm_s(self) -> float:
        """Torque against the motion by its speed [N m s/rad]."""
    @property
    def axis(self) -> Vector:
        """float64 (3,), unit length, in the child link's frame; positive turns open or unlock."""
    @property
    def parent_from_child_at_zero(self) -> Matrix:
        """float64 (4, 4): maps the child link's frame to the parent's at angle 0."""

class Latch:
    """The latch as data, see docs/environment.md; type is "none", "effort" or "bolt"."""
    @property
    def type(self) -> str:
        """"none", "effort" or "bolt"."""
    @property
    def unlock_angle_rad(self) -> float:
        """Angle of the handle from which on the leaf is free [rad]."""
    @property
    def handle_done_angle_rad(self) -> float:
        """Angle at which the handle counts as turned [rad]; larger than that which unlocks."""
    @property
    def lock_effort_nm(self) -> float:
        """Largest torque that holds the closed leaf [N m]."""
    @property
    def hinge_spring_nm_per_rad(self) -> float:
        """Spring that closes the leaf [N m/rad]."""
    @property
    def handle_spring_nm_per_rad(self) -> float:
        """Spring that brings the handle back [N m/rad]."""
    @property
    def relatch(self) -> bool:
        """Whether it locks again whenever the handle returns, as by the paper's formula."""
    @property
    def unlocks_ajar(self) -> bool:
        """Whether a leaf that is pushed ajar counts as unlocked, as in the released code."""
    @property
    def bolt_throw_m(self) -> float:
        """How far the bolt reaches into its strike [m]; read for "bolt" alone."""

class Door:
    """A composed door: base (frame), leaf and handle, two joints, a latch. A value that nothing changes.

    Door frame: x out of the leaf towards who stands in front of the handle, z up, z = 0 the lowest point.
    """
    @property
    def id(self) -> str:
        """Its name, as in file names and reports."""
    @property
    def category(self) -> str:
        """Such as "interior", "safe" or "refrigerator"."""
    @property
    def mechanism(self) -> str:
        """Of the handle, such as "lever", "knob" or "pull"."""
    @property
    def hinge_side(self) -> str:
        """"left" or "right", seen from who stands in front of the handle."""
    @property
    def opening(self) -> str:
        """"pull" or "push", from there."""
    @property
    def license(self) -> str:
        """SPDX expression of what it was made from."""
    @property
    def body(self) -> str:
        """Id of the part that frame and leaf are of."""
    @property
    def handle(self) -> str:
        """Id of the handle's part."""
    @property
    def sha256(self) -> str:
        """Over everything that its files hold."""
    @property
    def hinge(self) -> Joint:
        """Between frame and leaf."""
    @property
    def handle_joint(self) -> Joint:
        """Between leaf and handle."""
    @property
    def latch(self) -> Latch:
        """What holds the closed leaf."""
    @property
    def handle_from_grasp(self) -> Matrix:
        """float64 (4, 4): where to hold, the tool's frame in the handle link's."""
    @property
    def links(self) -> dict[str, list[str]]:
        """Names of the meshes of each link, by the link's name."""
    def mass(self, link: str) -> dict[str, Any]:
        """{"mass_kg", "center_of_mass_m" (3,), "inertia_kg_m2" (3, 3) about it}, in the link's frame."""
    def mesh(self, name: str) -> Mesh:
        """Vertices (V, 3) [m] in the link's frame and triangles (T, 3), counter-clockwise from outside; closed."""
    def hulls(self, name: str) -> list[Mesh]:
        """The convex pieces that touch."""
    def color(self, name: str) -> Vector:
        """float64 (4,): red, green, blue and alpha of a mesh, in [0, 1]."""
    def label(self, name: str) -> str:
        """"body", "handle" or "frame": what points on the mesh are labelled."""
    def poses(self, hinge_rad: float = 0.0, handle_rad: float = 0.0) -> dict[str, Matrix]:
        """door_from_link by the link's name."""
    def change(self, *, id: Optional[str] = None, latch: dict[str, Any] = {}, hinge: dict[str, float] = {},
               handle_joint: dict[str, float] = {}) -> Door:
        """Another door, with numbers of latch, hinge and handle_joint changed; InvalidConfigError on unknown keys."""
    def save(self, folder: Any, *, overwrite: bool = False) -> None:
        """Writes the folder of the door. InvalidArgumentError if it is there and `overwrite` is not set."""
    def export(self, folder: Any, *formats: str, overwrite: bool = False) -> None:
        """Writes the door for other simulators: urdf, mjcf, sdf, glb, usda, all into one folder."""
    def _export(self, folder: Any, formats: list[str], overwrite: bool) -> None: ...

class Robot:
    """The robot of a URDF file; "": the built-in mobile Franka. base: "sliders", "fixed", "yaw" or "floating"."""
    def __init__(self, urdf: str = "", base: str = "sliders") -> None: ...
    @property
    def name(self) -> str:
        """Of the URDF; "" of the built-in one: the mobile Franka."""
    @property
    def base(self) -> str:
        """"sliders", "fixed", "yaw" or "floating"."""
    @property
    def joints(self) -> list[str]:
        """Names of the moving joints, in the order of every array of joints."""

class Action:
    """How far the hand goes in the world [m], and world_from_hand; `vector` is float32 (9,)."""
    def __init__(self, vector: Any) -> None: ...
    @property
    def position_delta_m(self) -> Vector:
        """float64 (3,): the hand's next place less the present one [m, world]."""
    @property
    def world_from_hand_rotation(self) -> Vector:
        """float64 (3, 3): the hand's next orientation."""
    @property
    def vector(self) -> npt.NDArray[np.float32]:
        """float32 (9,), as in data sets."""

class Observation:
    """What a policy sees at a decision, and what only the simulator knows. World: z up."""
    def __init__(self, arrays: dict[str, Any]) -> None: ...
    def arrays(self, names: Sequence[str]) -> dict[str, npt.NDArray[Any]]:
        """The arrays of these names: "cloud" float32 (points, 3) [m, world], "cloud_label" uint8 (points,),
        "proprioception" float32 (32,), "door_state" float64 (23,)."""
    @property
    def hinge_rad(self) -> float:
        """[rad]; a robot would not know."""
    @property
    def handle_rad(self) -> float:
        """[rad]; a robot would not know."""
    @property
    def world_from_hand(self) -> Matrix:
        """float64 (4, 4)."""
    @property
    def world_from_handle(self) -> Matrix:
        """float64 (4, 4); a robot would not know."""

class Scene:
    """Everything that decides an episode but the policies. World: z up, x out of the door towards the robot, floor z = 0."""
    @property
    def door_id(self) -> str:
        """Of whose door it is."""
    @property
    def seed(self) -> int:
        """It was drawn from."""
    @property
    def episode(self) -> int:
        """Its number among the seed's scenes of the door."""
    @property
    def world_from_door(self) -> Matrix:
        """float64 (4, 4): door's frame to world."""
    @property
    def world_from_robot_base(self) -> Matrix:
        """float64 (4, 4), with sliders at 0."""
    @property
    def world_from_camera(self) -> Matrix:
        """float64 (4, 4), OpenCV's axes: x right, y down, z forward."""
    @property
    def camera_matrix(self) -> Vector:
        """float64 (3, 3), pinhole [pixels]."""
    @property
    def latch(self) -> Latch:
        """The door's, as this scene varies it."""
    def to_dict(self) -> dict[str, Any]:
        """As in the records of data sets."""
    @staticmethod
    def from_dict(record: dict[str, Any]) -> Scene:
        """FormatError that names the key on a record that is none."""

class EpisodeImage:
    """An episode at an instant; Stepper.restore() goes back to it."""

class Stepper:
    def __init__(self, door: Door, robot: Robot, first: str, clouds: list[str], cameras: dict[str, Any]) -> None: ...
    def reset(self, scene: Scene) -> None: ...
    def step(self, action: Any) -> None: ...
    def save(self) -> EpisodeImage: ...
    def restore(self, image: EpisodeImage) -> None: ...
    def render(self, settings: dict[str, Any]) -> npt.NDArray[np.uint8]: ...
    def state(self) -> dict[str, Any]: ...
    def summary(self) -> dict[str, Any]: ...
    def arrays(self, names: Sequence[str]) -> dict[str, npt.NDArray[Any]]: ...
    @property
    def scene(self) -> Scene: ...
    @property
    def door(self) -> Door: ...
    @property
    def stage(self) -> str: ...
    @property
    def observation(self) -> Observation: ...
    @property
    def reward(self) -> float: ...
    @property
    def terminated(self) -> bool: ...
    @property
    def truncated(self) -> bool: ...
    @property
    def over(self) -> bool: ...
    @property
    def cause(self) -> Optional[str]: ...

class Policy:
    """A policy that opens or turns the handle; load_policy() makes it."""
    def __init__(self, word: str, stage: str, settings: Optional[dict[str, Any]]) -> None: ...
    def reset(self, before: Optional[npt.ArrayLike] = None) -> None:
        """Begins an episode. before: float32 (points, 3) [m, world], what the camera saw of the closed door before the
        robot came."""
    def act(self, observation: Union[Observation, dict[str, Any]]) -> Action:
        """What it does at an Observation, or a dict with "proprioception", "cloud" and, where that holds both looks,
        "remembered": True."""
    @property
    def looks(self) -> bool:
        """Whether act() reads the cloud."""
    @property
    def turned(self) -> Optional[bool]:
        """Of one that turns handles: whether the handle is turned once its actions were carried out; None: it does not say."""
    @property
    def remembered(self) -> dict[str, Any]:
        """What its clouds are joined with: {"finer", "within_m"}, for Stepper(remembered=...); finer 0: nothing."""

def read_door(folder: str) -> Door: ...
def compose(body: str, handle: str, settings: dict[str, Any]) -> Door: ...
def catalogue() -> list[dict[str, str]]: ...
def validate(paths: list[str], profile: str, threads: int) -> dict[str, Any]: ...
def validation_rules() -> dict[str, Any]: ...
def preview(folders: list[str], settings: dict[str, Any]) -> npt.NDArray[np.uint8]: ...
def find_doors(words: list[str], default_side: str, per_category: int) -> list[str]: ...
def split_sides(word: str) -> dict[str, list[str]]: ...
def environments() -> list[str]: ...
def environment(word: str) -> dict[str, Any]: ...
def sample_scene(door: Door, seed: int, episode: int, settings: Optional[dict[str, Any]], robot: Robot) -> Scene: ...
def advance(steppers: list[Stepper], jobs: Sequence[Any], threads: int = 0) -> None: ...
def require_observation_names(names: list[str]) -> None: ...
def latch_step(latch: Latch, locked: bool, handle_done: bool, hinge_rad: float,
               handle_rad: float) -> tuple[bool, bool, float, float]: ...
def bolt_of(door: Door) -> dict[str, Any]: ...
def bolt_is_caught(door: Door, hinge_rad: float, position_m: float) -> bool: ...
def policy_names(stage: str) -> list[str]: ...
def evaluate(request: dict[str, Any]) -> dict[str, Any]: ...
def simulate(doors: list[str], words: dict[str, str], settings: dict[str, Any]) -> dict[str, Any]: ...
