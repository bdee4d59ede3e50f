# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Policies of other processes for remote_test.py, by msgpack and websockets of others, and ways in which they fail.

    policy_peers.py serve KIND      a server; prints its port
    policy_peers.py command KIND    a program that is asked over standard input and output
"""
import asyncio
import os
import struct
import sys
import time

import msgpack
import numpy as np


def pack_array(value):
    if isinstance(value, np.ndarray):
        return {b"__ndarray__": True, b"data": value.tobytes(), b"dtype": value.dtype.str, b"shape": value.shape}
    return value


def unpack_array(value):
    if b"__ndarray__" in value:
        return np.ndarray(buffer=value[b"data"], dtype=np.dtype(value[b"dtype"]), shape=value[b"shape"])
    return value


def hold(seen: dict) -> np.ndarray:
    x, y, z, w = seen["proprioception"][28:32].astype(float)
    return np.array([0, 0, 0, 1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w),
                     2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)], np.float32)


class Peer:
    """Holds still, and says of the handle what `says` has; or fails in its way in every second episode."""

    says = {"turned": True, "never": False, "unsure": "maybe"}

    def __init__(self, kind: str) -> None:
        self.kind, self.episodes, self.questions = kind, 0, 0

    def answer(self, message: bytes) -> bytes:
        seen = msgpack.unpackb(message, object_hook=unpack_array)
        assert seen["cloud"].shape == (4096, 3) and seen["cloud"].dtype == np.float32, seen["cloud"].shape
        assert seen["proprioception"].shape == (32,) and seen["stage"] in ("open", "handle")
        self.episodes += seen["episode_start"]
        self.questions = 1 if seen["episode_start"] else self.questions + 1
        action = hold(seen)
        if self.kind in self.says:
            return msgpack.packb({"actions": action, "turned": self.says[self.kind]}, default=pack_array)
        if self.kind != "sound" and self.episodes % 2 == 0 and self.questions == 2:
            return self.failure(action)
        return msgpack.packb({"actions": action[None]}, default=pack_array)

    def failure(self, action: np.ndarray) -> bytes:
        if self.kind == "dies":
            os._exit(1)
        if self.kind == "hangs":
            time.sleep(60)
        wrong = {"text": np.array(["left"] * 9), "shape": action[:7], "nan": np.full(9, np.nan), "empty": np.zeros((0, 9)),
                 "half": action.astype(np.float16), "list": action.tolist()}
        if self.kind == "nonsense":
            return b"\xc1\xff\x00"
        if self.kind == "torn":
            return msgpack.packb({"actions": action}, default=pack_array)[:-5]
        return msgpack.packb({"actions": wrong[self.kind]}, default=pack_array)


async def serve(kind: str) -> None:
    import websockets

    peer = Peer(kind)

    async def talk(socket, path=None):
        await socket.send(msgpack.packb({"who": "policy_peers"}))
        async for message in socket:
            if kind == "raises" and peer.episodes % 2 == 1 and msgpack.unpackb(message)["episode_start"]:
                peer.episodes += 1  # also at an episode's first question: what was told is not asked again
                await socket.send("Traceback (most recent call last):\nRuntimeError: no more ideas")
                await socket.close()
                return
            await socket.send(peer.answer(message))

    async with websockets.serve(talk, "127.0.0.1", 0, compression=None, max_size=None) as server:
        print(server.sockets[0].getsockname()[1], flush=True)
        await asyncio.Future()


def command(kind: str) -> None:
    peer = Peer(kind)
    marker = os.environ.get("PEER_EPISODES")
    if marker and os.path.exists(marker):  # a program that is started again goes on counting
        peer.episodes = int(open(marker).read())
    while head := sys.stdin.buffer.read(4):
        message = sys.stdin.buffer.read(struct.unpack(">I", head)[0])
        if marker:
            begun = msgpack.unpackb(message)["episode_start"]
            with open(marker, "w") as file:
                file.write(str(peer.episodes + begun))
        answer = peer.answer(message)
        sys.stdout.buffer.write(struct.pack(">I", len(answer)) + answer)
        sys.stdout.buffer.flush()


if __name__ == "__main__":
    if sys.argv[1] == "serve":
        asyncio.run(serve(sys.argv[2]))
    else:
        command(sys.argv[2])
