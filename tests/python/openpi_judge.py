# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""openpi's own client against `doorforge serve-policy` (openpi-client of PyPI): openpi_judge.py BIN POLICY"""
import subprocess
import sys

import numpy as np
from openpi_client import websocket_client_policy

server = subprocess.Popen([f"{sys.argv[1]}/doorforge-serve-policy", sys.argv[2], "--port", "0"], stdout=subprocess.PIPE, text=True)
try:
    port = int(server.stdout.readline().split("ws://127.0.0.1:")[1].split(";")[0])
    client = websocket_client_policy.WebsocketClientPolicy("127.0.0.1", port)
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
    print("openpi's client: served")
finally:
    server.kill()
