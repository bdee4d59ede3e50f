# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Many environments at once; see doorforge.gym."""
from .gym import VectorEnv

__all__ = ["VectorEnv"]
