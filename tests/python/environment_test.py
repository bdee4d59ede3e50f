# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""The environments of Gymnasium; needs gymnasium, which Debian does not have: judges.sh runs it."""
import pathlib
import tempfile
import unittest

import gymnasium
import numpy as np
from gymnasium.utils.env_checker import check_env

import doorforge
import doorforge.gym

BODY, HANDLE = "interior_flush_01", "interior_lever_tube_01"


class Environments(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.doors = [doorforge.compose(BODY, HANDLE), doorforge.compose(BODY, HANDLE, latch="bolt", id="bolted")]

    def test_gymnasiums_checker_has_nothing_to_say(self) -> None:
        for settings in ({}, {"observation": ("cloud", "cloud_label", "door_state")},
                         {"observation": "door_state", "control": "delta"}, {"stage": "handle"}, {"stage": "grasp"}):
            with self.subTest(settings):
                env = gymnasium.make("doorforge/OpenDoor-v0", doors=self.doors, render_mode="rgb_array", **settings)
                check_env(env.unwrapped)
                env.close()

    def test_gymnasiums_checker_has_nothing_to_say_of_any_name(self) -> None:
        import doorforge_envs

        for name, settings in doorforge_envs.ENVIRONMENTS.items():
            with self.subTest(name):
                if "doors" in settings:
                    self.assertGreater(len(gymnasium.make(name).unwrapped.doors), 0)
                env = gymnasium.make(name, doors=self.doors[:1], render_mode="rgb_array")
                check_env(env.unwrapped)
                env.close()

    def test_gymnasiums_checker_has_nothing_to_say_of_the_environments_of_others(self) -> None:
        import doorforge_envs

        presets = {settings["preset"]: name for name, settings in doorforge_envs.ENVIRONMENTS.items() if "preset" in settings}
        self.assertEqual(sorted(presets), doorforge.environments())
        for preset, name in presets.items():
            with self.subTest(name):
                env = gymnasium.make(name, doors=self.doors[:1], render_mode="rgb_array")
                check_env(env.unwrapped)
                scene = env.unwrapped.stepper.scene.to_dict()
                wanted = doorforge.environment(preset)["scene"]
                self.assertEqual(scene["physics"].get("base", "sliders"), wanted["physics"]["base"])
                self.assertEqual(scene["latch"]["type"] == "none", wanted["latch"] == "none")
                self.assertEqual(scene["episode_limits"]["open_angle_rad"], wanted["episode"]["open_angle_rad"])
                env.close()

    def test_a_preset_can_be_changed(self) -> None:
        env = gymnasium.make("doorforge/DoorGym-v0", doors=self.doors[:1], config={"physics": {"base": "sliders"}})
        env.reset(seed=1)
        scene = env.unwrapped.stepper.scene.to_dict()
        self.assertEqual((scene["physics"].get("base", "sliders"), scene["episode_limits"]["open_angle_rad"]), ("sliders", 0.2))

    def test_a_seed_is_the_command_lines(self) -> None:
        env = gymnasium.make("doorforge/OpenDoor-v0", doors=self.doors[:1], observation="door_state").unwrapped
        expert = doorforge.load_policy()
        env.reset(seed=5)
        expert.reset()
        over = False
        while not over:
            _, _, terminated, truncated, info = env.step(expert.act(env.stepper.observation))
            over = terminated or truncated
        stepper = doorforge.Stepper(self.doors[0])
        stepper.reset(doorforge.sample_scene(self.doors[0], 5, 0))
        expert.reset()
        while not stepper.over:
            stepper.step(expert.act(stepper.observation))
        self.assertEqual((info["state_sha256"], info["cause"], info["is_success"]),
                         (stepper.summary()["state_sha256"], "opened", True))

    def test_a_vector_is_its_environments_bit_by_bit(self) -> None:
        settings = {"observation": "door_state", "control": "delta"}
        actions = np.random.default_rng(3).uniform(-1, 1, (40, 3, 6)).astype(np.float32)
        together = []
        for threads in (1, 2):
            vector = doorforge.VectorEnv(self.doors, 3, threads=threads, **settings)
            rows = [vector.reset(seed=11)[0]]
            for row in actions:
                rows.append(vector.step(row)[0])
            together.append(np.array(rows))
        np.testing.assert_array_equal(together[0], together[1])
        for number in range(3):
            env = gymnasium.make("doorforge/OpenDoor-v0", doors=self.doors, **settings).unwrapped
            seen, over = [env.reset(seed=11 + number)[0]], False
            for row in actions:
                if over:
                    seen.append(env.reset()[0])
                    over = False
                    continue
                observation, _, terminated, truncated, _ = env.step(row[number])
                seen.append(observation)
                over = terminated or truncated
            np.testing.assert_array_equal(np.array(seen), together[0][:, number])

    def test_wrappers_have_their_own_place_in_info(self) -> None:
        env = gymnasium.make("doorforge/OpenDoor-v0", doors=self.doors[:1], observation="door_state", control="delta")
        wrapped = gymnasium.wrappers.RecordEpisodeStatistics(env)
        _, info = wrapped.reset(seed=2)
        self.assertNotIn("episode", info)
        over = False
        while not over:
            _, _, terminated, truncated, info = wrapped.step(np.zeros(6, np.float32))
            over = terminated or truncated
        self.assertEqual((set(info["episode"]), info["episode_index"]), ({"r", "l", "t"}, 0))

    def test_wrong_use_is_refused_by_name(self) -> None:
        for settings in ({"observation": "colour"}, {"stage": "close"}, {"control": "torque"}, {"doors": []},
                         {"stage": "grasp", "control": "delta"}):
            with self.subTest(settings), self.assertRaises(doorforge.InvalidArgumentError):
                doorforge.gym.OpenDoorEnv(**{"doors": self.doors, **settings}).reset(seed=1)
        env = doorforge.gym.OpenDoorEnv(self.doors)
        with self.assertRaises(doorforge.InvalidArgumentError):
            env.step(np.zeros(9))
        env.reset(seed=1)
        for action in (np.full(9, np.nan), np.zeros(6)):
            with self.assertRaises(doorforge.InvalidArgumentError):
                env.step(action)
        vector = doorforge.VectorEnv(self.doors, 2, observation="door_state", control="delta")
        vector.reset(seed=1)
        times = [player.stepper.state()["time_s"] for player in vector._players]
        with self.assertRaises(doorforge.InvalidArgumentError):
            vector.step(np.array([np.zeros(6), np.full(6, np.nan)]))
        self.assertEqual(times, [player.stepper.state()["time_s"] for player in vector._players])
        with self.assertRaises(doorforge.MissingError):
            doorforge.gym.OpenDoorEnv("nowhere/at/all")

    def test_a_door_that_is_gone_is_named(self) -> None:
        with tempfile.TemporaryDirectory() as scratch:
            self.doors[0].save(pathlib.Path(scratch, "door"))
            env = doorforge.gym.OpenDoorEnv(scratch, observation="door_state")
            vector = doorforge.VectorEnv(scratch, 2, observation="door_state")
        for environment in (env, vector):
            with self.assertRaises(doorforge.MissingError) as raised:
                environment.reset(seed=1)
            self.assertIn(scratch, str(raised.exception))


if __name__ == "__main__":
    unittest.main()
