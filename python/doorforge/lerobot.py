# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Exports a data set to LeRobot's format, for which `pip install "doorforge[lerobot]"` brings pyarrow and PyAV.

    python -m doorforge.lerobot data --out data_lerobot

    doorforge.lerobot.export("data", "data_lerobot", doorforge.lerobot.Options(images="video", points=0))

The same names as the one-file module `doorforge_lerobot`, which needs doorforge_reader.py beside it and nothing else of doorforge.
"""
import sys

from doorforge_lerobot import Export, ExportError, Options, export, main

__all__ = ["Export", "ExportError", "Options", "export", "main"]

if __name__ == "__main__":
    sys.exit(main())
