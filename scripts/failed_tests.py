#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""What the tests said that failed in ctest's last run: the end of each one's output, where a log is read from its end.

    scripts/failed_tests.py build/dev
"""
import pathlib
import re
import sys

LINES = 60

folder = pathlib.Path(sys.argv[1]) / "Testing/Temporary"
failed = folder / "LastTestsFailed.log"
names = {line.partition(":")[2].strip() for line in failed.read_text().splitlines()} if failed.exists() else set()
parts = re.split(r"(?m)^\d+/\d+ Testing: (.+)$", (folder / "LastTest.log").read_text(errors="replace"))
for name, said in zip(parts[1::2], parts[2::2]):
    if name.strip() in names:
        print(f"---- {name}, its last lines ----")
        print("\n".join(said.rstrip().splitlines()[-LINES:]))
