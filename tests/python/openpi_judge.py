# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Others' clients against `doorforge serve-policy`, and their servers against `doorforge eval`.

    python tests/python/openpi_judge.py BIN POLICY DOOR

Needs openpi-client, openpi-server and policy-websocket of PyPI. Each server asks the served policy through its own client,
so that the episodes must be those of the policy itself, bit by bit.
"""
import asyncio
import json
import pathlib
import socket
import subprocess
import sys
import threading

import numpy as np
import openpi_client.websocket_client_policy
import openpi_server
import policy_websocket
import websockets.asyncio.server

BIN, POLICY, DOOR = (pathlib.Path(word) for word in sys.argv[1:4])
PEERS = {"openpi": (openpi_client.websocket_client_policy.WebsocketClientPolicy, openpi_server.WebsocketPolicyServer),
         "policy-websocket": (policy_websocket.WebsocketClientPolicy, policy_websocket.WebsocketPolicyServer)}


class Relay:
    """A policy as openpi has them; raises in every second episode if it is told to."""

    def __init__(self, client, fails: bool = False) -> None:
        self.client, self.fails, self.episodes = client, fails, 0

    def infer(self, seen: dict) -> dict:
        self.episodes += seen["episode_start"]
        if self.fails and self.episodes % 2 == 0:
            raise RuntimeError("out of ideas")
        return dict(self.client.infer(dict(seen)))

    def reset(self) -> None:
        pass


def free_port() -> int:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        return taken.getsockname()[1]


def evaluate(*words: str) -> dict:
    done = subprocess.run([str(BIN / "doorforge-eval"), "--doors", str(DOOR), "--seeds", "2", "--threads", "1", "--json",
                           "--set", "expert_reference=false", *words], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(done.stderr)
    return json.loads(done.stdout)


def judge_client(client) -> None:
    assert client.get_server_metadata()["stage"] == "open", client.get_server_metadata()
    seen = {"cloud": np.random.rand(4096, 3).astype(np.float32), "proprioception": np.zeros(32, np.float32)}
    answer = client.infer(seen)
    assert answer["actions"].shape == (1, 9) and np.isfinite(answer["actions"]).all(), answer
    np.testing.assert_array_equal(client.infer({**seen, "episode_start": True})["actions"], answer["actions"])
    try:
        client.infer({"cloud": seen["cloud"]})
        raise SystemExit("a request without proprioception was answered")
    except RuntimeError as error:
        assert "proprioception" in str(error)


async def run_server(handler, port: int) -> None:
    """As both servers' serve_forever(), one of which sets signals as the main thread alone may."""
    async with websockets.asyncio.server.serve(handler, "127.0.0.1", port, compression=None, max_size=None) as server:
        await server.serve_forever()


def serve(kind, client, fails: bool) -> str:
    """Starts a server that ends with this program; its address."""
    port = free_port()
    server = kind(Relay(client, fails), "127.0.0.1", port)
    threading.Thread(target=asyncio.run, args=(run_server(server._handler, port),), daemon=True).start()
    while True:
        with socket.socket() as probe:
            if probe.connect_ex(("127.0.0.1", port)) == 0:
                return f"ws://127.0.0.1:{port}"


def main() -> None:
    served = subprocess.Popen([str(BIN / "doorforge-serve-policy"), str(POLICY), "--port", "0"], stdout=subprocess.PIPE, text=True)
    try:
        port = int(served.stdout.readline().split("ws://127.0.0.1:")[1].split(";")[0])
        own = evaluate("--opener", str(POLICY), "--allow-seen")
        for name, (client_kind, server_kind) in PEERS.items():
            judge_client(client_kind("127.0.0.1", port))
            print(f"{name}: its client was served")
            client = client_kind("127.0.0.1", port)
            relayed = evaluate("--policy", serve(server_kind, client, False))
            assert relayed["episodes"] == own["episodes"], (relayed["episodes"], own["episodes"])
            print(f"{name}: its server was judged, episodes equal to the policy's own")
            failing = evaluate("--policy", serve(server_kind, client, True))
            assert failing["causes"].get("policy_failed") == 1, failing["causes"]
            assert "out of ideas" in failing["episodes"][1]["detail"], failing["episodes"]
            print(f"{name}: an exception in it cost its episode alone")
    finally:
        served.kill()


if __name__ == "__main__":
    main()
