# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""The Python package as built: PYTHONPATH holds it, the first argument is the build folder with the programs."""
import copy
import json
import os
import pathlib
import pickle
import shutil
import subprocess
import sys
import tempfile
import threading
import unittest

import numpy as np

import doorforge
from doorforge import latch as law

BUILD = pathlib.Path(sys.argv.pop(1)) if len(sys.argv) > 1 and os.path.isdir(sys.argv[1]) else None
BODY, HANDLE = "interior_flush_01", "interior_lever_tube_01"
POLICIES = pathlib.Path(__file__).parents[2] / "data" / "policies"
HANDLER = str(POLICIES / "handler")


def run(*words: str) -> subprocess.CompletedProcess:
    return subprocess.run([str(BUILD / "bin" / f"doorforge-{words[0]}"), *words[1:]], capture_output=True, text=True,
                          check=False, timeout=300)


def hold(observation: dict) -> np.ndarray:
    """Stays where it is, with the hand as it is."""
    x, y, z, w = observation["proprioception"][28:32].astype(float)
    rows = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)]]
    return np.concatenate([np.zeros(3), np.ravel(rows)])


def take_hold(look: dict) -> np.ndarray:
    """A lever from the front: the hand's z into the leaf, fingers above and below (they close along the hand's y)."""
    handle = look["cloud"][look["cloud_label"] == 1]
    contact = handle[np.linalg.norm(handle - handle.mean(axis=0), axis=1).argmin()]
    z, y = look["approach"], np.array([0.0, 0.0, 1.0])
    world_from_hand = np.stack([np.cross(y, z), y, z], axis=1)
    return np.concatenate([contact, world_from_hand[0], world_from_hand[1]])


class Doors(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.scratch.name)
        cls.door = doorforge.compose(BODY, HANDLE)
        cls.door.save(cls.folder / "door")

    @classmethod
    def tearDownClass(cls) -> None:
        cls.scratch.cleanup()

    def test_a_composed_door_is_the_command_lines_byte_by_byte(self) -> None:
        out = self.folder / "by_program"
        done = run("assets", "compose", "--body", BODY, "--handle", HANDLE, "--out", str(out))
        self.assertEqual(done.returncode, 0, done.stderr)
        ours = {path.relative_to(self.folder / "door"): path.read_bytes()
                for path in (self.folder / "door").rglob("*") if path.is_file()}
        theirs = {path.relative_to(out): path.read_bytes() for path in out.rglob("*") if path.is_file()}
        theirs.pop(pathlib.Path("compose.json"))
        self.assertEqual(ours, theirs)

    def test_meshes_are_closed_and_their_volume_gives_the_mass(self) -> None:
        vertices, triangles = self.door.mesh("leaf")
        self.assertEqual((vertices.dtype, triangles.dtype), (np.float64, np.int32))
        corners = vertices[triangles]
        volume = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6
        self.assertGreater(volume, 0)
        edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
        self.assertEqual(len(np.unique(np.sort(edges, axis=1), axis=0)) * 2, len(edges))
        density = self.door.mass("leaf")["mass_kg"] / volume
        self.assertTrue(20 < density < 3000, density)
        self.assertGreaterEqual(len(self.door.hulls("leaf")), 1)

    def test_links_turn_about_the_hinge(self) -> None:
        closed, ajar = self.door.poses()["leaf"], self.door.poses(hinge_rad=0.5)["leaf"]
        np.testing.assert_allclose(closed[:3, 3], ajar[:3, 3], atol=1e-12)
        turn = ajar[:3, :3] @ closed[:3, :3].T
        self.assertAlmostEqual(float(np.arccos((np.trace(turn) - 1) / 2)), 0.5, places=12)

    def test_a_change_gives_another_door_and_leaves_the_first(self) -> None:
        changed = self.door.change(id="stiff", latch={"lock_effort_nm": 300}, hinge={"damping_nm_s": 2})
        self.assertEqual((changed.id, changed.latch.lock_effort_nm, changed.hinge.damping_nm_s), ("stiff", 300, 2))
        self.assertEqual(self.door.latch.lock_effort_nm, 150)
        changed.save(self.folder / "changed")
        self.assertEqual(doorforge.read_door(self.folder / "changed").sha256, changed.sha256)

    def test_doors_go_through_pickle(self) -> None:
        self.assertEqual(pickle.loads(pickle.dumps(self.door)).sha256, self.door.sha256)
        self.assertIs(copy.deepcopy(self.door), self.door)

    def test_exports_are_the_command_lines(self) -> None:
        self.door.export(self.folder / "ours", "mjcf", "glb")
        run("assets", "export", str(self.folder / "door"), "--to", "mjcf,glb", "--out", str(self.folder / "theirs"))
        for name in ("model.xml", "model.glb"):
            self.assertEqual((self.folder / "ours" / name).read_bytes(),
                             (self.folder / "theirs" / self.door.id / name).read_bytes())

    def test_validation_names_what_was_broken(self) -> None:
        self.assertTrue(doorforge.validate(self.door).ok)
        broken = self.door.change(hinge={"effort_limit_nm": -1})
        self.assertIn("error", {finding.severity for finding in doorforge.validate(broken).findings})

    def test_errors_are_the_command_lines(self) -> None:
        done = run("assets", "compose", "--body", BODY, "--handle", "interior_lever_tube_0", "--out",
                   str(self.folder / "none"))
        with self.assertRaises(doorforge.MissingError) as raised:
            doorforge.compose(BODY, "interior_lever_tube_0")
        self.assertEqual(f"doorforge: {raised.exception}", done.stderr.strip())
        self.assertEqual(raised.exception.exit_code, done.returncode)
        for settings in ({"latsch": "bolt"}, {"handle_scale": 9}, {"leaf_width_m": float("nan")}, {"latch": "glue"}):
            with self.assertRaises(doorforge.InvalidConfigError, msg=settings):
                doorforge.compose(BODY, HANDLE, **settings)
        with self.assertRaises(doorforge.InvalidArgumentError):
            self.door.save(self.folder / "door")
        with self.assertRaises(doorforge.InvalidArgumentError):
            self.door.export(self.folder / "x", "fbx")
        with self.assertRaises(doorforge.InvalidArgumentError):
            self.door.mesh("knob")
        with self.assertRaises(doorforge.MissingError):
            doorforge.read_door(self.folder / "nowhere")

    def test_a_picture_shows_something(self) -> None:
        picture = doorforge.preview(self.door, width=160, focus="whole")
        self.assertEqual((picture.dtype, picture.ndim, picture.shape[2]), (np.uint8, 3, 3))
        self.assertGreater(picture.std(), 5)

    def test_a_split_of_the_catalogue_is_doors(self) -> None:
        pool = doorforge.doors.DoorPool("full:train")
        self.assertGreater(len(pool), 100)
        self.assertEqual(pool.number_of(pool[3].id), 3)
        for words, error in (("full:trainn", doorforge.InvalidArgumentError), ("ful:train", doorforge.MissingError)):
            with self.assertRaises(error):
                doorforge.doors.DoorPool(words)


class Episodes(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = str(pathlib.Path(cls.scratch.name) / "door")
        cls.door = doorforge.compose(BODY, HANDLE)
        cls.door.save(cls.folder)

    @classmethod
    def tearDownClass(cls) -> None:
        cls.scratch.cleanup()

    def opened(self, seed: int, episode: int) -> doorforge.Stepper:
        stepper = doorforge.Stepper(self.door)
        stepper.reset(doorforge.sample_scene(self.door, seed, episode))
        expert = doorforge.load_policy("expert")
        expert.reset()
        while not stepper.over:
            stepper.step(expert.act(stepper.observation))
        return stepper

    def test_states_are_those_of_the_command_line_bit_by_bit(self) -> None:
        done = run("simulate", "--door", self.folder, "--seed", "5", "--episodes", "2", "--json")
        rows = json.loads(done.stdout)["episodes"]
        for episode, row in enumerate(rows):
            summary = self.opened(5, episode).summary()
            self.assertEqual((summary["state_sha256"], summary["cause"]), (row["state_sha256"], row["outcome"]))
        self.assertEqual([row["state_sha256"] for row in doorforge.simulate(self.folder, seed=5, episodes=2)["episodes"]],
                         [row["state_sha256"] for row in rows])

    def test_an_episode_comes_back(self) -> None:
        stepper = doorforge.Stepper(self.door)
        stepper.reset(doorforge.sample_scene(self.door, 2))
        image, ends = stepper.save(), []
        for _ in range(2):
            stepper.restore(image)
            for _ in range(3):
                stepper.step(hold(stepper.arrays(["proprioception"])))
            ends.append(stepper.state()["robot_position"].tobytes())
        self.assertEqual(ends[0], ends[1])

    def test_many_at_once_are_each_alone(self) -> None:
        held = [doorforge.Stepper(self.door) for _ in range(3)]
        scenes = [doorforge.sample_scene(self.door, 5, episode) for episode in range(3)]
        core = doorforge._engine.core
        core.advance([one._held for one in held], scenes, 2)
        experts = [doorforge.load_policy("expert") for _ in held]
        while not all(one.over for one in held):
            core.advance([one._held for one in held],
                         [None if one.over else expert.act(one.observation) for one, expert in zip(held, experts)], 2)
        self.assertEqual([one.summary()["state_sha256"] for one in held],
                         [self.opened(5, episode).summary()["state_sha256"] for episode in range(3)])

    def test_wrong_actions_are_refused_and_change_nothing(self) -> None:
        stepper = doorforge.Stepper(self.door)
        with self.assertRaises(doorforge.InvalidArgumentError):
            stepper.step(np.zeros(9))
        stepper.reset(doorforge.sample_scene(self.door, 5))
        before = stepper.state()["time_s"]
        for action in (np.zeros(8), np.full(9, np.nan), np.full(9, np.inf), "left", None, np.zeros((2, 9))):
            with self.assertRaises(doorforge.InvalidArgumentError):
                stepper.step(action)
        self.assertEqual(stepper.state()["time_s"], before)
        with self.assertRaises(doorforge.InvalidConfigError):
            doorforge.sample_scene(self.door, 1, 0, {"randomisation": "wild"})

    def test_clouds_and_pictures_have_the_shapes_that_are_promised(self) -> None:
        stepper = doorforge.Stepper(self.door, clouds=["open"], cloud={"point_count": 512})
        stepper.reset(doorforge.sample_scene(self.door, 5))
        arrays = stepper.arrays(["cloud", "cloud_label", "proprioception", "door_state"])
        self.assertEqual({name: (array.shape, array.dtype.str) for name, array in arrays.items()},
                         {"cloud": ((512, 3), "<f4"), "cloud_label": ((512,), "|u1"), "proprioception": ((32,), "<f4"),
                          "door_state": ((23,), "<f8")})
        self.assertLessEqual(set(arrays["cloud_label"]), set(range(5)))
        self.assertEqual(stepper.render(width=64, height=48).shape, (48, 64, 3))

    def test_a_handler_that_remembers_acts_as_in_an_evaluation(self) -> None:
        handler = doorforge.load_policy(HANDLER, "handle")
        expert = doorforge.load_policy("expert")
        stepper = doorforge.Stepper(self.door, first="handle", clouds=["handle"], remembered=handler.remembered)
        stepper.reset(doorforge.sample_scene(self.door, 1))
        handler.reset()
        expert.reset()
        while not stepper.over:
            stepper.step((handler if stepper.stage == "handle" else expert).act(stepper.observation))
        row = doorforge.evaluate("expert", self.folder, handler=HANDLER, allow_seen=True,
                                 seeds=1,
                                 config={"switch": "privileged", "expert_reference": False}).episodes[0]
        summary = stepper.summary()
        self.assertEqual((summary["state_sha256"], summary["cause"]), (row["state_sha256"], row["outcome"]))

    def test_a_handler_that_remembers_says_what_it_needs(self) -> None:
        handler = doorforge.load_policy(HANDLER, "handle")
        self.assertEqual(handler.remembered["finer"], 2)
        scene = doorforge.sample_scene(self.door, 1)
        steppers = [doorforge.Stepper(self.door, first="handle", clouds=["handle"], remembered=remembered)
                    for remembered in (None, handler.remembered)]
        for stepper in steppers:
            stepper.reset(scene)
        shown = steppers[1].arrays(["cloud", "proprioception"])
        for unjoined in (steppers[0].observation, shown):
            with self.assertRaises(doorforge.InvalidArgumentError) as raised:
                handler.act(unjoined)
            self.assertIn("before", str(raised.exception))
        for before, told in ((shown["cloud"][:, :2], "(points, 3)"), (shown["cloud"][:0], "without a point")):
            with self.assertRaises(doorforge.InvalidArgumentError) as raised:
                handler.reset(before=before)
            self.assertIn(told, str(raised.exception))
        handler.reset()
        wanted = handler.act(steppers[1].observation).vector
        handler.reset()
        np.testing.assert_array_equal(handler.act({**shown, "remembered": True}).vector, wanted)
        # what is visible now lies far from the hand, so that the joined cloud is what was seen before
        handler.reset(before=shown["cloud"])
        np.testing.assert_array_equal(handler.act({**shown, "cloud": shown["cloud"] + 10}).vector, wanted)

    def test_each_episode_begins_with_a_hinge_on_the_left_where_nobody_has_looked(self) -> None:
        opener = doorforge.load_policy(POLICIES / "opener", config={"side": "auto"})
        stepper = doorforge.Stepper(self.door, clouds=["open"])
        stepper.reset(doorforge.sample_scene(self.door, 3))
        left = doorforge.load_policy(POLICIES / "opener").act(stepper.observation).vector
        for _ in range(2):
            opener.reset()
            np.testing.assert_array_equal(opener.act(stepper.observation).vector, left)

    def test_pythons_lock_is_free_meanwhile(self) -> None:
        ticks, stop = [0], threading.Event()

        def tick() -> None:
            while not stop.wait(0.001):
                ticks[0] += 1

        thread = threading.Thread(target=tick)
        thread.start()
        doorforge.simulate(self.folder, episodes=2, threads=1)
        stop.set()
        thread.join()
        self.assertGreater(ticks[0], 20)

    def test_ctrl_c_stops_a_long_call_and_python_goes_on(self) -> None:
        program = f"""
import os, signal, threading, time
import doorforge
threading.Timer(1.5, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
begin = time.time()
try:
    doorforge.simulate({self.folder!r}, episodes=100000, threads=1)
except KeyboardInterrupt:
    print("stopped", time.time() - begin < 20)
print(len(doorforge.simulate({self.folder!r}, episodes=1)["episodes"]))
"""
        done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=120, check=False)
        self.assertEqual(done.stdout.split(), ["stopped", "True", "1"], done.stderr)


class Evaluation(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = str(pathlib.Path(cls.scratch.name) / "door")
        doorforge.compose(BODY, HANDLE).save(cls.folder)

    @classmethod
    def tearDownClass(cls) -> None:
        cls.scratch.cleanup()

    def test_a_callable_is_judged_as_the_command_line_judges(self) -> None:
        out = os.path.join(self.scratch.name, "report")
        report = doorforge.evaluate(hold, self.folder, observation=["proprioception"], seeds=2, out=out)
        self.assertEqual(report.record, json.loads(pathlib.Path(out, "report.json").read_text()))
        self.assertTrue(os.path.exists(os.path.join(out, "report.html")))
        self.assertEqual(report.success["overall"]["episodes"], 2)
        self.assertEqual(sum(report.causes.values()), 2)

    def test_the_expert_by_name_is_the_command_lines(self) -> None:
        done = run("eval", "--opener", "expert", "--doors", self.folder, "--seeds", "2", "--json")
        ours = doorforge.evaluate("expert", self.folder, seeds=2)
        self.assertEqual(ours.episodes, json.loads(done.stdout)["episodes"])

    def test_a_policy_that_fails_costs_its_episode_alone(self) -> None:
        class Fails:
            """Has one action for each episode, and in every second one not even that."""

            def __init__(self) -> None:
                self.episodes, self.actions = 0, 0

            def reset(self) -> None:
                self.episodes, self.actions = self.episodes + 1, 0

            def __call__(self, observation: dict) -> np.ndarray:
                self.actions += 1
                if self.episodes == 2:
                    raise RuntimeError("no more ideas")
                return np.full(9, np.nan) if self.episodes == 3 else (
                    np.zeros((7, 7)) if self.episodes == 4 else hold(observation))

        report = doorforge.evaluate(Fails(), self.folder, observation=["proprioception"], seeds=4,
                                    config={"expert_reference": False})
        details = [row["detail"] for row in report.episodes]
        self.assertEqual(report.causes["policy_failed"], 3)
        self.assertIn("no more ideas", details[1])
        self.assertIn("nan", details[2])
        self.assertIn("(7, 7)", details[3])

    def test_a_door_that_is_gone_costs_its_episodes_alone(self) -> None:
        folder = pathlib.Path(self.scratch.name) / "vanishing"
        for name in ("a", "b", "c"):
            doorforge.compose(BODY, HANDLE, id=name).save(folder / name)

        class Deletes:
            """Somebody tidies up while it opens its first door."""

            def reset(self) -> None:
                shutil.rmtree(folder / "b", ignore_errors=True)

            def __call__(self, observation: dict) -> np.ndarray:
                return hold(observation)

        out = pathlib.Path(self.scratch.name) / "report_of_vanishing"
        report = doorforge.evaluate(Deletes(), folder, observation=["proprioception"], seeds=2, out=out)
        self.assertEqual([row["door_id"] for row in report.episodes], ["a", "a", "b", "b", "c", "c"])
        self.assertEqual(report.causes["door_gone"], 2)
        for row in report.episodes[2:4]:
            self.assertRegex(row["detail"], "the door is gone: .*vanishing/b")
        self.assertIn("Door gone", (out / "report.html").read_text())
        with self.assertRaises(doorforge.MissingError) as raised:
            doorforge.evaluate(hold, folder / "b")
        self.assertIn("vanishing/b", str(raised.exception))

    def test_a_grasper_in_python_takes_hold(self) -> None:
        looks = []

        def noting(look: dict) -> np.ndarray:
            looks.append(look)
            return take_hold(look)

        report = doorforge.evaluate("expert", self.folder, grasper=noting, seeds=3, config={"expert_reference": False})
        self.assertEqual(report.success["overall"]["rate"], 1, report.episodes)
        self.assertEqual(report.record["provenance"]["grasper_sha256"], "own")
        cloud, label = looks[0]["cloud"], looks[0]["cloud_label"]
        self.assertEqual((cloud.dtype, cloud.shape, label.dtype), (np.float32, (len(label), 3), np.uint8))
        self.assertGreater(np.count_nonzero(label == 1), 10)
        self.assertAlmostEqual(float(np.linalg.norm(looks[0]["approach"])), 1, places=12)
        self.assertEqual(looks[0]["hand_from_tcp"].shape, (4, 4))

    def test_a_grasper_that_fails_costs_its_episode_alone(self) -> None:
        answers = iter([ValueError("no fingers"), np.zeros(7), np.full(9, np.inf), None])

        def fails(look: dict) -> np.ndarray:
            answer = next(answers, take_hold(look))
            if isinstance(answer, Exception):
                raise answer
            return answer

        report = doorforge.evaluate("expert", self.folder, grasper=fails, seeds=5, threads=1,
                                    config={"expert_reference": False})
        details = [row["detail"] for row in report.episodes]
        self.assertEqual(report.causes["policy_failed"], 3, details)
        for detail, told in zip(details, ("no fingers", "(7,)", "inf")):
            self.assertIn(told, detail)
        self.assertFalse(details[3].startswith("the policy failed"), details)
        self.assertEqual(report.success["overall"]["rate"], 0.2, details)

    def test_an_episode_that_ends_before_a_policys_turn_is_not_blamed_on_it(self) -> None:
        answers = iter([take_hold])

        def takes_hold_once(look: dict) -> object:
            return next(answers, lambda look: None)(look)

        def fails(observation: dict) -> np.ndarray:
            raise RuntimeError("always")

        report = doorforge.evaluate(fails, self.folder, grasper=takes_hold_once, observation=["proprioception"], seeds=2,
                                    threads=1, config={"expert_reference": False})
        self.assertIn("always", report.episodes[0]["detail"])
        self.assertNotIn("always", report.episodes[1]["detail"])

    def test_numbers_are_not_rounded_on_their_way(self) -> None:
        door = doorforge.read_door(self.folder)
        expert = doorforge.load_policy("expert")
        stepper = doorforge.Stepper(door)
        stepper.reset(doorforge.sample_scene(door, 3))
        action = expert.act(stepper.observation)
        again = doorforge.Action(np.concatenate([action.position_delta_m, action.world_from_hand_rotation[0],
                                                 action.world_from_hand_rotation[1]]))
        np.testing.assert_array_equal(again.position_delta_m, action.position_delta_m)
        np.testing.assert_array_equal(again.world_from_hand_rotation[:2], action.world_from_hand_rotation[:2])

    def test_what_cannot_be_evaluated_is_refused(self) -> None:
        with self.assertRaises(doorforge.MissingError):
            doorforge.evaluate(hold, os.path.join(self.scratch.name, "gone"))
        with self.assertRaises(doorforge.InvalidArgumentError):
            doorforge.evaluate(hold, self.folder, observation=["colour"])
        with self.assertRaises(doorforge.InvalidArgumentError):
            doorforge.evaluate(7, self.folder)
        with self.assertRaises(doorforge.InvalidConfigError):
            doorforge.evaluate(hold, self.folder, config={"seed": 3})


class Latches(unittest.TestCase):
    """doorforge.latch, numpy alone, against the law in C++."""

    def test_the_effort_law_is_that_of_cpp(self) -> None:
        core = doorforge._engine.core
        random = np.random.default_rng(5)
        door = doorforge.compose(BODY, HANDLE)
        variants = [door, door.change(latch={"relatch": True}), door.change(latch={"unlocks_ajar": True}),
                    door.change(latch={"type": "none"}), door.change(latch={"hinge_spring_nm_per_rad": 7.5})]
        for variant in variants:
            ours = law.EffortLaw.of_door(variant)
            locked, done = variant.latch.type != "none", variant.latch.type == "none"
            hinge = handle = 0.0
            for _ in range(3000):
                hinge = float(np.clip(hinge + random.normal(0, 0.01), -0.02, 1.2))
                handle = float(np.clip(handle + random.normal(0, 0.1), -0.1, 1.0))
                locked, done, on_hinge, on_handle = core.latch_step(variant.latch, locked, done, hinge, handle)
                torques = ours.torque(hinge, handle)
                self.assertEqual((bool(ours.locked), bool(ours.handle_done)), (locked, done))
                self.assertLess(abs(torques[0] - on_hinge), 1e-12)
                self.assertLess(abs(torques[1] - on_handle), 1e-12)

    def test_many_environments_are_each_alone(self) -> None:
        one, many = law.EffortLaw(0.5), law.EffortLaw(0.5)
        many.reset((64,))
        random = np.random.default_rng(6)
        path = random.uniform(-0.02, 0.8, (50, 64, 2))
        together = [many.torque(at[:, 0], at[:, 1])[0] for at in path]
        for number in (0, 17, 63):
            one.reset()
            alone = [float(one.torque(*at[number])[0]) for at in path]
            self.assertEqual(alone, [float(row[number]) for row in together])

    def test_the_bolt_law_is_that_of_cpp(self) -> None:
        core = doorforge._engine.core
        random = np.random.default_rng(7)
        for settings in ({}, {"hinge_side": "right"}, {"opening": "push"}, {"bolt_throw_m": 0.02}):
            door = doorforge.compose(BODY, HANDLE, latch="bolt", **settings)
            ours, record = law.BoltLaw.of_door(door), core.bolt_of(door)
            with tempfile.TemporaryDirectory() as scratch:
                door.save(os.path.join(scratch, "door"))
                read = law.BoltLaw.of_door(os.path.join(scratch, "door"))
            for one in (ours, read):
                np.testing.assert_allclose(one.tip_in_leaf_m, record["tip_in_leaf_m"], rtol=0, atol=1e-12)
                np.testing.assert_allclose(one.corner_in_base_m, record["base_from_strike"][:3, 3], rtol=0, atol=1e-12)
            handles = random.uniform(0, door.handle_joint.upper_rad, 4000)
            np.testing.assert_allclose(ours.drawn(handles), -np.minimum(record["travel_m_per_rad"] * handles,
                                                                       record["throw_m"]), rtol=0, atol=1e-12)
            hinges = random.uniform(-0.01, 0.05, 4000)
            caught = ours.is_caught(hinges, ours.drawn(handles))
            wanted = [core.bolt_is_caught(door, hinge, float(bolt)) for hinge, bolt in zip(hinges, ours.drawn(handles))]
            self.assertEqual(caught.tolist(), wanted)
            self.assertTrue(200 < sum(wanted) < 3800, sum(wanted))
            closed = ours.torque(0.008, 0.0)[0], ours.torque(0.008, door.latch.unlock_angle_rad * 1.1)[0]
            self.assertLess(closed[0], -100)
            self.assertGreater(closed[1], -1)


class Package(unittest.TestCase):
    def test_an_import_loads_little_and_takes_less_than_a_third_of_a_second(self) -> None:
        program = ("import doorforge, resource, sys\n"
                   "used = resource.getrusage(resource.RUSAGE_SELF)\n"
                   "libraries = {line.split()[-1] for line in open('/proc/self/maps') if '.so' in line}\n"
                   "print(used.ru_utime + used.ru_stime, len(libraries))\n"
                   "print(*sorted({'numpy', 'torch', 'gymnasium', 'ctypes'} & set(sys.modules)))")
        runs = [subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout.split("\n")
                for _ in range(3)]
        self.assertLess(min(float(run[0].split()[0]) for run in runs), 0.3)  # of the processor, the interpreter's own included
        self.assertLess(int(runs[0][0].split()[1]), 60)
        self.assertEqual(runs[0][1], "")

    def test_the_extension_has_nothing_of_cgal_and_every_library_has_its_package(self) -> None:
        extension = doorforge._engine.core.__file__
        needed = subprocess.run(["readelf", "-d", extension], capture_output=True, text=True, check=True).stdout
        sonames = {line.split("[")[1].split("]")[0] for line in needed.splitlines() if "NEEDED" in line}
        base = {"libc.so.6", "libm.so.6", "libgcc_s.so.1", "libstdc++.so.6", "ld-linux-x86-64.so.2"}
        sanitizers = {name for name in sonames if name.startswith(("libasan", "libubsan", "libtsan"))}
        self.assertEqual(sonames - base - sanitizers, set(doorforge._engine.SHARED_LIBRARIES))
        self.assertNotIn(b"CGAL", pathlib.Path(extension).read_bytes())

    def test_help_tells_of_every_class_and_member(self) -> None:
        for described in (doorforge.Door, doorforge.doors.Joint, doorforge.doors.Latch, doorforge.Scene, doorforge.Observation,
                          doorforge.Action, doorforge.Robot, doorforge.policies.Policy):
            for name, member in vars(described).items():
                if name.startswith("_"):
                    continue
                with self.subTest(f"{described.__name__}.{name}"):
                    told = member.__doc__ if isinstance(member, property) else described.__doc__.partition(f"\n{name}(")[2]
                    self.assertGreater(len(told or ""), 5)
        self.assertIn("float64 (4, 4)", doorforge.Scene.world_from_camera.__doc__)

    def test_data_and_latch_need_no_extension(self) -> None:
        source = pathlib.Path(__file__).parents[2] / "python"
        program = ("import warnings; warnings.simplefilter('ignore'); import doorforge, doorforge.latch, "
                   "doorforge.datasets, doorforge.lerobot, doorforge_reader\n"
                   "assert doorforge.datasets.Dataset is doorforge_reader.Dataset\n"
                   "assert issubclass(doorforge.lerobot.ExportError, doorforge_reader.DatasetError)\n"
                   "try: doorforge.compose\nexcept ImportError as error: print(error)")
        done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False,
                              env={**os.environ, "PYTHONPATH": str(source)})
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("pip install .", done.stdout)

    def test_missing_libraries_are_named_with_the_command(self) -> None:
        program = ("import ctypes, importlib, warnings\n"
                   "real = ctypes.CDLL\n"
                   "def without(name, *rest):\n"
                   "    if 'embree' in str(name) or 'Bullet' in str(name): raise OSError(name)\n"
                   "    return real(name, *rest)\n"
                   "ctypes.CDLL = without\n"
                   "load = importlib.import_module\n"
                   "def fails(name, *rest):\n"
                   "    if name == 'doorforge._core': raise ImportError('libembree3.so.3: cannot open')\n"
                   "    return load(name, *rest)\n"
                   "importlib.import_module = fails\n"
                   "with warnings.catch_warnings(record=True) as told:\n"
                   "    warnings.simplefilter('always'); import doorforge\n"
                   "print(told[0].message)")
        done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
        self.assertIn("apt-get install libbullet3.24 libembree3-3\n", done.stdout)


if __name__ == "__main__":
    unittest.main()
