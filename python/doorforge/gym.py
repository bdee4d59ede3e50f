# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Doors as environments of Gymnasium (an extra: pip install "doorforge[gymnasium]").

    import gymnasium

    env = gymnasium.make("doorforge/OpenDoor-v0", doors="full:train", observation=("cloud", "proprioception"))
    observation, info = env.reset(seed=7)
    observation, reward, terminated, truncated, info = env.step(env.action_space.sample())

Observations, by the names in `observation` (one name alone: its array instead of a dict):

| name | array | what |
|---|---|---|
| "cloud" | float32 (4096, 3) | what the camera sees [m, world]; point 0 is the one nearest to the hand; zeros where nothing is seen |
| "cloud_label" | uint8 (4096,) | 0 body, 1 handle, 2 frame, 3 robot, 4 other; a robot would not know |
| "proprioception" | float32 (32,) | 11 joints in [-1, 1], their speeds, base and hand [m], hand's quaternion xyzw; world |
| "door_state" | float64 (23,) | hinge and handle [rad], poses (xyz, xyzw) of handle and hand, and of the hand in the handle's frame at the grasp; a robot would not know |

Actions, one a 1/6 s. control="pose": float32 (9,), how far the hand goes in the world [m] and the first two rows of
world_from_hand, as in the data sets. control="delta": float32 (6,) in [-1, 1], 6 cm and 0.25 rad of turn each, about
the world's axes. At stage="grasp" an action is the contact point in the world [m] and the same two rows.

Reward: the angle gained [rad], of the hinge at "open", of the handle at "handle"; info["cause"] at the end, as in
docs/step.md. info names door, seed and episode: `doorforge simulate --door DOOR --seed SEED` runs the same scene.
"""
from __future__ import annotations

from typing import Any, Optional, Sequence, Union

import numpy as np

try:
    import gymnasium
except ImportError as error:
    raise ImportError("doorforge.gym needs Gymnasium: pip install \"doorforge[gymnasium]\"") from error

import doorforge_envs

from . import _engine
from .doors import DoorPool
from .errors import IncompleteError, InvalidArgumentError
from .scenes import environment, robot_of, sample_scene
from .simulation import Stepper

_core = _engine.require()

DELTA_M = 0.06  #: control="delta": an action of 1 moves the hand so far along an axis,
DELTA_RAD = 0.25  #: and turns it so far about one.
MOST_SKIPS = 100  #: Scenes in which the rules before your stage may fail, one after the other.

_POINTS = 4096


class _Task:
    """What one environment plays: its spaces, and which scene comes next."""

    def __init__(self, doors: Any, observation: Union[str, Sequence[str]], stage: str, control: str,
                 config: Optional[dict[str, Any]], cloud: Optional[dict[str, Any]], preset: Optional[str]) -> None:
        if preset is not None:
            begun = environment(preset)
            config, cloud = _over(begun.get("scene", {}), config), _over(begun.get("cloud", {}), cloud)
        if control not in ("pose", "delta"):
            raise InvalidArgumentError(f"control: there is no \"{control}\"; there are pose, delta")
        if control == "delta" and stage == "grasp":
            raise InvalidArgumentError("control: a grasp is a place in the world; take control=\"pose\" with it")
        self.doors = doors if isinstance(doors, DoorPool) else DoorPool(doors)
        self.single = isinstance(observation, str)
        self.names = [observation] if isinstance(observation, str) else list(observation)
        _core.require_observation_names(self.names)
        self.stage, self.control = stage, control
        self.config, self.cloud = config, cloud
        self.robot = robot_of(config)
        self.points = (cloud or {}).get("point_count", _POINTS)
        self.shapes: dict[str, tuple[tuple[int, ...], Any]] = {
            "cloud": ((self.points, 3), np.float32), "cloud_label": ((self.points,), np.uint8),
            "proprioception": ((32,), np.float32), "door_state": ((23,), np.float64)}

    def observation_space(self) -> gymnasium.Space[Any]:
        spaces: dict[str, gymnasium.Space[Any]] = {}
        for name in self.names:
            shape, dtype = self.shapes[name]
            low, high = (0.0, 4.0) if dtype is np.uint8 else (-np.inf, np.inf)
            spaces[name] = gymnasium.spaces.Box(low, high, shape, dtype)
        return spaces[self.names[0]] if self.single else gymnasium.spaces.Dict(spaces)

    def action_space(self) -> gymnasium.spaces.Box:
        if self.control == "delta":
            return gymnasium.spaces.Box(-1, 1, (6,), np.float32)
        reach = [3.0] * 3 if self.stage == "grasp" else [0.1] * 3
        bound = np.array(reach + [1.0] * 6, np.float32)
        return gymnasium.spaces.Box(-bound, bound, dtype=np.float32)

    def stepper(self, door: Any) -> Stepper:
        looks = any(name.startswith("cloud") for name in self.names)
        return Stepper(door, self.robot, first=self.stage, clouds=[self.stage] if looks else [], cloud=self.cloud)

    def observe(self, stepper: Stepper) -> Any:
        arrays = stepper.arrays(self.names)
        for name, array in arrays.items():
            shape, dtype = self.shapes[name]
            if array.shape != shape:  # nothing was in view, or the episode ended without a look
                arrays[name] = np.zeros(shape, dtype)
        return arrays[self.names[0]] if self.single else arrays

    def action(self, stepper: Stepper, action: Any) -> Any:
        if isinstance(action, _core.Action):
            return action
        numbers = np.asarray(action, np.float64)
        if self.control == "pose":
            return numbers
        if numbers.shape != (6,) or not np.isfinite(numbers).all():
            raise InvalidArgumentError(f"action: found {numbers!r}, expected 6 finite numbers of control=\"delta\"")
        hand = stepper.observation.world_from_hand[:3, :3]
        turned = _rotation(DELTA_RAD * numbers[3:]) @ hand
        return np.concatenate([DELTA_M * numbers[:3], turned[0], turned[1]])


def _over(base: dict[str, Any], changes: Optional[dict[str, Any]]) -> dict[str, Any]:
    """The settings of `base` with those of `changes` in their place."""
    merged = dict(base)
    for key, value in (changes or {}).items():
        held = merged.get(key)
        merged[key] = _over(held, value) if isinstance(held, dict) and isinstance(value, dict) else value
    return merged


def _rotation(vector: np.ndarray) -> np.ndarray:
    angle = float(np.linalg.norm(vector))
    if angle < 1e-12:
        return np.eye(3)
    x, y, z = vector / angle
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


class _Player:
    """One environment's episodes: whose turn it is, and where it stands."""

    def __init__(self, task: _Task) -> None:
        self.task = task
        self.seed = 0
        self.stepper: Optional[Stepper] = None
        self._visits: dict[int, int] = {}
        self._place: dict[str, Any] = {}
        self._skipped: dict[str, int] = {}

    @property
    def held(self) -> Stepper:
        """The episode, which next_scene() has begun."""
        assert self.stepper is not None
        return self.stepper

    def reseed(self, seed: int) -> None:
        self.seed, self._visits = seed, {}

    def begin(self) -> None:
        self._skipped = {}

    def next_scene(self, random: np.random.Generator, options: dict[str, Any]) -> Any:
        """Takes the door for the next episode into hand, and gives its scene."""
        wanted = options.get("door")
        if wanted is None:
            number = int(random.integers(len(self.task.doors)))
        else:
            number = wanted if isinstance(wanted, int) else self.task.doors.number_of(str(wanted))
        door = self.task.doors[number]
        visit = int(options.get("episode", self._visits.get(number, 0)))
        self._visits[number] = visit + 1
        scene = options.get("scene") or sample_scene(door, self.seed, visit, self.task.config, self.task.robot)
        if self.stepper is None or self.stepper.door.id != door.id:
            self.stepper = self.task.stepper(door)
        # not "episode": wrappers and Stable-Baselines3 keep their statistics there
        self._place = {"door": door.id, "seed": scene.seed, "episode_index": scene.episode}
        return scene

    def skip(self) -> None:
        """The rules failed before the first decision."""
        assert self.stepper is not None
        cause = str(self.stepper.cause)
        self._skipped[cause] = self._skipped.get(cause, 0) + 1
        if sum(self._skipped.values()) >= MOST_SKIPS:
            raise IncompleteError(f"reset: in {MOST_SKIPS} scenes the rules before the stage \"{self.task.stage}\" failed: "
                                  f"{self._skipped}; the last was {self._place}; give doors that `doorforge validate "
                                  "--profile openable` passes")

    def info(self) -> dict[str, Any]:
        assert self.stepper is not None
        seen = self.stepper.observation
        info = {**self._place, "stage": self.stepper.stage, "cause": self.stepper.cause, "hinge_rad": seen.hinge_rad,
                "handle_rad": seen.handle_rad, "is_success": self.stepper.cause == "opened",
                "skipped": sum(self._skipped.values())}
        if self.stepper.over:
            info.update(self.stepper.summary())
        return info


class OpenDoorEnv(gymnasium.Env[Any, Any]):
    """Doors to open, one episode after the other; see the module for observations, actions and rewards.

    `doors`: doors, folders of doors, or a split such as "full:train" of the catalogue. `stage`: from where on the
    actions are yours. `preset`: an environment of others to begin with, such as "doorgym"; `config`: settings of the
    scene, {"randomisation": "strong", ...}; `cloud`: of the cloud.

    reset(seed=7) seeds as `doorforge simulate --seed 7` does; the door is drawn, and a door's episodes count from 0. Scenes
    in which the rules before your stage fail are left out, info["skipped"] of them. options={"door": id or number,
    "episode": n} picks.
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 6}

    def __init__(self, doors: Any = "full:train", observation: Union[str, Sequence[str]] = ("cloud", "proprioception"),
                 stage: str = "open", control: str = "pose", config: Optional[dict[str, Any]] = None,
                 cloud: Optional[dict[str, Any]] = None, render_mode: Optional[str] = None,
                 width: int = 480, height: int = 360, preset: Optional[str] = None) -> None:
        if render_mode not in (None, "rgb_array"):
            raise InvalidArgumentError(f"render_mode: there is no \"{render_mode}\"; there is rgb_array")
        self._task = _Task(doors, observation, stage, control, config, cloud, preset)
        self._player = _Player(self._task)
        self.observation_space = self._task.observation_space()
        self.action_space = self._task.action_space()
        self.render_mode = render_mode
        self._size = {"width": width, "height": height}
        self._seeded = False

    @property
    def stepper(self) -> Stepper:
        """The episode itself, to save, restore and look into."""
        if self._player.stepper is None:
            raise InvalidArgumentError("stepper: there is no episode yet; call reset() first")
        return self._player.stepper

    @property
    def doors(self) -> DoorPool:
        return self._task.doors

    def reset(self, *, seed: Optional[int] = None, options: Optional[dict[str, Any]] = None) -> tuple[Any, dict[str, Any]]:
        super().reset(seed=seed)
        if seed is not None or not self._seeded:
            self._player.reseed(seed if seed is not None else int(self.np_random.integers(2**31)))
            self._seeded = True
        self._player.begin()
        scene = self._player.next_scene(self.np_random, options or {})
        self.stepper.reset(scene)
        while self.stepper.over:
            self._player.skip()
            scene = self._player.next_scene(self.np_random, {"door": (options or {}).get("door")})
            self.stepper.reset(scene)
        return self._task.observe(self.stepper), self._player.info()

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        stepper = self.stepper
        stepper.step(self._task.action(stepper, action))
        return (self._task.observe(stepper), float(stepper.reward), stepper.terminated, stepper.truncated,
                self._player.info())

    def render(self) -> Optional[np.ndarray]:  # type: ignore[override]
        if self.render_mode is None:
            return None
        return self.stepper.render(**self._size)

    def close(self) -> None:
        self._player.stepper = None


class VectorEnv(gymnasium.vector.VectorEnv[Any, Any, Any]):
    """Many OpenDoorEnv at once, on `threads` threads of C++ (0: all processors).

    Each has the bits that it would have alone: environment i of reset(seed=s) is OpenDoorEnv's reset(seed=s + i),
    whatever the number of threads. An environment whose episode is over begins the next one in the following step().
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 6,
                "autoreset_mode": gymnasium.vector.AutoresetMode.NEXT_STEP}

    def __init__(self, doors: Any = "full:train", num_envs: int = 16, *, threads: int = 0,
                 observation: Union[str, Sequence[str]] = ("cloud", "proprioception"), stage: str = "open",
                 control: str = "pose", config: Optional[dict[str, Any]] = None, cloud: Optional[dict[str, Any]] = None,
                 render_mode: Optional[str] = None, preset: Optional[str] = None) -> None:
        if num_envs < 1:
            raise InvalidArgumentError(f"num_envs: {num_envs}, expected 1 or more")
        self._task = _Task(doors, observation, stage, control, config, cloud, preset)
        self._players = [_Player(self._task) for _ in range(num_envs)]
        self._randoms: list[np.random.Generator] = []
        self._threads = threads
        self.num_envs = num_envs
        self.render_mode = render_mode
        self.single_observation_space = self._task.observation_space()
        self.single_action_space = self._task.action_space()
        self.observation_space = gymnasium.vector.utils.batch_space(self.single_observation_space, num_envs)
        self.action_space = gymnasium.vector.utils.batch_space(self.single_action_space, num_envs)
        self._to_reset = np.zeros(num_envs, bool)

    def reset(self, *, seed: Union[int, Sequence[Optional[int]], None] = None,
              options: Optional[dict[str, Any]] = None) -> tuple[Any, dict[str, Any]]:
        if isinstance(seed, (int, np.integer)):
            seeds: list[Optional[int]] = [int(seed) + i for i in range(self.num_envs)]
        else:
            seeds = list(seed) if seed is not None else [None] * self.num_envs
        first = not self._randoms
        if first:
            self._randoms = [np.random.Generator(np.random.PCG64())] * self.num_envs
        for i, player in enumerate(self._players):
            seed_here = seeds[i]
            if seed_here is not None or first:
                self._randoms[i], _ = gymnasium.utils.seeding.np_random(seed_here)
                player.reseed(seed_here if seed_here is not None else int(self._randoms[i].integers(2**31)))
        mask = (options or {}).get("reset_mask", np.ones(self.num_envs, bool))
        jobs: dict[int, Any] = {i: self._begin(i, options or {}) for i in np.flatnonzero(mask).tolist()}
        self._advance(jobs)
        self._to_reset[mask] = False
        return self._observe(), self._infos(range(self.num_envs))

    def step(self, actions: Any) -> tuple[Any, np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        if len(actions) != self.num_envs:
            raise InvalidArgumentError(f"actions: {len(actions)} for {self.num_envs} environments")
        if not self._randoms:
            raise InvalidArgumentError("step: there is no episode yet; call reset() first")
        jobs = {}
        for i, player in enumerate(self._players):
            if not self._to_reset[i]:
                jobs[i] = self._task.action(player.held, actions[i])
                _core.Action(jobs[i]) if not isinstance(jobs[i], _core.Action) else None  # refused before anything moves
        begun = np.flatnonzero(self._to_reset).tolist()
        jobs.update({i: self._begin(i, {}) for i in begun})
        self._advance(jobs)
        held = [player.held for player in self._players]
        rewards = np.array([stepper.reward for stepper in held])
        terminated = np.array([stepper.terminated for stepper in held])
        truncated = np.array([stepper.truncated for stepper in held])
        rewards[begun] = 0.0
        self._to_reset = terminated | truncated
        return self._observe(), rewards, terminated, truncated, self._infos(range(self.num_envs))

    def _begin(self, index: int, options: dict[str, Any]) -> Any:
        self._players[index].begin()
        return self._players[index].next_scene(self._randoms[index], options)

    def _advance(self, jobs: dict[int, Any]) -> None:
        """Carries out the jobs; what was begun and is over before its first decision is begun anew."""
        # whole beginnings of episodes first: a long job that comes last leaves the other threads idle
        order = sorted(jobs, key=lambda i: (not isinstance(jobs[i], _core.Scene), i))
        while order:
            _core.advance([self._players[i].held._held for i in order], [jobs[i] for i in order], self._threads)
            again = [i for i in order if isinstance(jobs[i], _core.Scene) and self._players[i].held.over]
            for i in again:
                self._players[i].skip()
                jobs[i] = self._players[i].next_scene(self._randoms[i], {})
            order = again

    def _observe(self) -> Any:
        each = [self._task.observe(player.held) for player in self._players]
        if self._task.single:
            return np.stack(each)
        return {name: np.stack([one[name] for one in each]) for name in self._task.names}

    def _infos(self, which: Any) -> dict[str, Any]:
        infos: dict[str, Any] = {}
        for i in which:
            infos = self._add_info(infos, self._players[i].info(), i)
        return infos

    def render(self) -> Optional[tuple[np.ndarray, ...]]:
        if self.render_mode is None:
            return None
        return tuple(player.stepper.render() for player in self._players if player.stepper is not None)

    def close_extras(self, **_: Any) -> None:
        for player in self._players:
            player.stepper = None


doorforge_envs.register_envs()

__all__ = ["DELTA_M", "DELTA_RAD", "OpenDoorEnv", "VectorEnv"]
