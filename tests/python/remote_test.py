# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""`doorforge eval` with policies of other processes, and `doorforge serve-policy`; the first argument is the build folder."""
import asyncio
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import unittest

import msgpack
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import policy_peers

BUILD = pathlib.Path(sys.argv.pop(1))
PEER = str(pathlib.Path(policy_peers.__file__))
POLICY = pathlib.Path(__file__).parents[2] / "data" / "policies"


def run(program: str, *words: str, **settings) -> subprocess.CompletedProcess:
    return subprocess.run([str(BUILD / "bin" / f"doorforge-{program}"), *words], capture_output=True, text=True, check=False,
                          timeout=300, **settings)


class Served:
    """A process that prints a port, or an address, in its first line."""

    def __init__(self, *words: str) -> None:
        self.process = subprocess.Popen(words, stdout=subprocess.PIPE, text=True)
        self.first = self.process.stdout.readline()

    def __enter__(self) -> str:
        return self.first

    def __exit__(self, *unused) -> None:
        self.process.kill()
        self.process.wait()
        self.process.stdout.close()


class Remote(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.scratch.name)
        done = run("assets", "compose", "--body", "interior_flush_01", "--handle", "interior_lever_tube_01", "--out",
                   str(cls.folder / "door"))
        assert done.returncode == 0, done.stderr

    @classmethod
    def tearDownClass(cls) -> None:
        cls.scratch.cleanup()

    def evaluate(self, *words: str, seeds: int = 1, **settings) -> dict:
        done = run("eval", "--doors", str(self.folder / "door"), "--seeds", str(seeds), "--threads", "1", "--json",
                   "--set", "expert_reference=false", *words, **settings)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout)

    def test_a_server_and_a_program_are_judged_alike(self) -> None:
        with Served(sys.executable, PEER, "serve", "sound") as port:
            served = self.evaluate("--policy", f"ws://127.0.0.1:{port.strip()}", "--out", str(self.folder / "report"), seeds=2)
        asked = self.evaluate("--policy-command", f"{sys.executable} {PEER} command sound", seeds=2)
        self.assertEqual(served["episodes"], asked["episodes"])
        self.assertEqual(served["provenance"]["policy"], "server")
        self.assertGreater(served["episodes"][0]["opening_actions"], 3)
        self.assertNotIn("policy_failed", served["causes"])
        self.assertIn("ws://127.0.0.1", (self.folder / "report" / "report.html").read_text())

    def test_whatever_a_server_does_costs_its_episode_alone(self) -> None:
        for kind, told in (("hangs", "no answer within"), ("text", "dtype"), ("shape", "(7,)"), ("nan", "nan"),
                           ("empty", "(0, 9)"), ("half", "float32"), ("list", "array of numpy"), ("nonsense", "MessagePack"),
                           ("torn", "too early"),
                           ("raises", "no more ideas")):
            with self.subTest(kind), Served(sys.executable, PEER, "serve", kind) as port:
                words = ["--opener", f"ws://127.0.0.1:{port.strip()}", "--policy-timeout", "1"]
                if kind == "hangs":  # it hangs for whoever connects as well
                    report = self.evaluate(*words, seeds=2)
                    rows = report["episodes"]
                    self.assertEqual(report["causes"].get("policy_failed"), 1)
                else:
                    report = self.evaluate(*words, seeds=3)
                    rows = report["episodes"]
                    self.assertEqual(report["causes"].get("policy_failed"), 1, rows)
                    self.assertFalse(rows[2]["detail"].startswith("the policy failed"), rows[2])
                self.assertIn(told, rows[1]["detail"])

    def test_whatever_a_program_does_costs_its_episode_alone(self) -> None:
        for kind, told in (("dies", "it has ended"), ("hangs", "no answer within"), ("text", "dtype")):
            with self.subTest(kind):
                marker = self.folder / f"episodes_{kind}"
                report = self.evaluate("--policy-command", f"exec {sys.executable} {PEER} command {kind}",
                                       "--policy-timeout", "3", seeds=3, env={**os.environ, "PEER_EPISODES": str(marker)})
                self.assertEqual(report["causes"].get("policy_failed"), 1, report["episodes"])
                self.assertIn(told, report["episodes"][1]["detail"])

    def test_a_server_that_is_gone_for_good_is_a_cause(self) -> None:
        with Served(sys.executable, PEER, "serve", "dies") as port:
            report = self.evaluate("--opener", f"ws://127.0.0.1:{port.strip()}", "--policy-timeout", "2", seeds=4)
        self.assertEqual(report["causes"]["policy_failed"], 3)
        self.assertIn("no server answers", report["episodes"][3]["detail"])

    def test_wrong_use_is_told_before_any_work(self) -> None:
        doors = ["--doors", str(self.folder / "door")]
        for words, code, told in (
                (["--policy", "ws://127.0.0.1:1"], 3, "start the policy's server first"),
                (["--policy", "ws://nowhere"], 2, "such as ws://127.0.0.1:8000"),
                (["--policy", "ws://127.0.0.1:1", "--opener", "expert"], 2, "give one of them"),
                (["--policy-command", "true", "--policy-timeout", "-1"], 2, "--policy-timeout"),
                (["--policy-command", "true", "--policy-chunk", "0"], 2, "--policy-chunk")):
            done = run("eval", *doors, *words)
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertIn(told, done.stderr)

    def test_a_served_policy_acts_as_it_does_here(self) -> None:
        opener = POLICY / "opener"
        with Served(str(BUILD / "bin" / "doorforge-serve-policy"), str(opener), "--port", "0") as line:
            address = line.split(" at ")[1].split(";")[0]
            far = self.evaluate("--opener", address, seeds=2)
            asyncio.run(self.talk(address))
        near = self.evaluate("--opener", str(opener), "--allow-seen", seeds=2)
        self.assertEqual(far["episodes"], near["episodes"])

    def test_a_served_handler_turns_and_says_so_as_it_does_here(self) -> None:
        handler = POLICY / "handler"
        pull = self.folder / "pull"
        done = run("assets", "compose", "--body", "interior_flush_01", "--handle", "interior_lever_blade_01",
                   "--set", "latch=none", "--out", str(pull))
        self.assertEqual(done.returncode, 0, done.stderr)
        words = ["--opener", "expert", "--doors", str(pull)]
        with Served(str(BUILD / "bin" / "doorforge-serve-policy"), str(handler), "--stage", "handle", "--port", "0") as line:
            far = self.evaluate("--handler", line.split(" at ")[1].split(";")[0], *words, seeds=2)
            told = self.evaluate("--handler", line.split(" at ")[1].split(";")[0], "--switch", "privileged", *words, seeds=2)
            asyncio.run(self.ask_with_a_look_and_without(line.split(" at ")[1].split(";")[0]))
        near = self.evaluate("--handler", str(handler), "--allow-seen", *words, seeds=2)
        self.assertEqual(far["episodes"], near["episodes"])
        self.assertEqual({row["door_id"] for row in far["episodes"]}, {f"interior_flush_01__interior_lever_{end}" for end in ("blade_01", "tube_01")})
        self.assertNotEqual(told["episodes"], near["episodes"], "the simulator says it at another time")

    def test_who_turns_says_when_it_is_done_or_leaves_it_to_the_simulator(self) -> None:
        causes = {}
        for kind in ("sound", "turned", "never", "unsure"):
            with Served(sys.executable, PEER, "serve", kind) as port:
                report = self.evaluate("--handler", f"ws://127.0.0.1:{port.strip()}", "--opener", "expert")
            causes[kind] = report["episodes"][0]["detail"]
        self.assertNotIn("switch", causes["sound"])  # the hand holds still: the simulator sees no turn
        self.assertIn("the switch came with the handle at", causes["turned"])
        self.assertIn("no switch came, opening was tried", causes["never"])
        self.assertIn("turned: expected true or false", causes["unsure"])

    async def talk(self, address: str) -> None:
        """A client of others: what it does wrong is told in text, and the connection goes on."""
        import websockets

        async with websockets.connect(address, compression=None, max_size=None) as socket:
            self.assertEqual(msgpack.unpackb(await socket.recv())["stage"], "open")
            sound = {"proprioception": np.zeros(32, np.float32), "cloud": np.random.rand(4096, 3).astype(np.float32)}
            for wrong, told in ((b"\xc1", "MessagePack"), (msgpack.packb({}), "proprioception"),
                                (self.packed({**sound, "cloud": np.zeros((5, 2), np.float32)}), "(points, 3)"),
                                (self.packed({**sound, "proprioception": np.zeros(31)}), "31"),
                                (self.packed({**sound, "cloud": np.array(["x"])}), "cloud"),
                                (self.packed({**sound, "cloud": np.zeros((7, 3), np.float32)}), "4096")):
                await socket.send(wrong)
                answer = await socket.recv()
                self.assertIsInstance(answer, str)
                self.assertIn(told, answer)
            await socket.send(self.packed(sound))
            answer = msgpack.unpackb(await socket.recv(), object_hook=policy_peers.unpack_array)
            self.assertEqual((answer["actions"].shape, answer["actions"].dtype), ((1, 9), np.float64))
            self.assertTrue(np.isfinite(answer["actions"]).all())

    async def ask_with_a_look_and_without(self, address: str) -> None:
        """A robot's software asks a handler that remembers the closed door."""
        import websockets

        random = np.random.default_rng(1)
        hand = np.zeros(32, np.float32)
        hand[25:32] = (0.3, 0.4, 0.9, 0, 0, 0, 1)
        near = (hand[25:28] + random.uniform(-0.1, 0.1, (5000, 3))).astype(np.float32)
        asked = {"cloud": near[:1000], "proprioception": hand, "stage": "handle", "episode_start": True}
        async with websockets.connect(address, compression=None, max_size=None) as socket:
            self.assertEqual(msgpack.unpackb(await socket.recv())["remembered"]["finer"], 2)
            for given, told in (({}, "before the robot came"), ({"before": near[:, :2]}, "(points, 3)"),
                                ({"before": near[:0]}, "without a point")):
                await socket.send(self.packed({**asked, **given}))
                self.assertIn(told, await socket.recv())
            for given in ({"before": near[1000:]}, {"episode_start": False}, {"cloud": near[:4096], "remembered": True}):
                await socket.send(self.packed({**asked, **given}))
                answer = msgpack.unpackb(await socket.recv(), object_hook=policy_peers.unpack_array)
                self.assertTrue(np.isfinite(answer["actions"]).all())

    @staticmethod
    def packed(value: dict) -> bytes:
        return msgpack.packb(value, default=policy_peers.pack_array)

    def test_serving_ends_by_a_signal(self) -> None:
        served = Served(str(BUILD / "bin" / "doorforge-serve-policy"), str(POLICY / "opener"), "--port", "0")
        served.process.send_signal(signal.SIGINT)
        self.assertEqual(served.process.wait(10), 128 + signal.SIGINT)
        served.process.stdout.close()
        done = run("serve-policy", str(self.folder), "--port", "0")
        self.assertEqual(done.returncode, 3, done.stderr)


if __name__ == "__main__":
    unittest.main()
