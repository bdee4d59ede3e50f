# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Any function can be judged: this one pulls straight back, as a hand without eyes would.

    python3 docs/examples/callable_policy.py doors/test
"""
import sys

import numpy as np

import doorforge


def pull_back(observation: dict[str, np.ndarray]) -> np.ndarray:
    """4 cm towards the robot's side (world x), the hand as it is."""
    x, y, z, w = observation["proprioception"][28:32].astype(float)
    rows = [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w),
            2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)]
    return np.array([0.04, 0, 0, *rows])


print(doorforge.evaluate(pull_back, sys.argv[1], observation=["proprioception"], seeds=1))
