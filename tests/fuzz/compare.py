# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Reads the inputs of a campaign with our readers and with those of others, and compares.

    compare.py [--build build/fuzz] [--work build/fuzz_campaign] [--mutants 200] [npy|tar|safetensors|json]...

To the inputs of the campaign come so many of each seed that tests/programs/mutators.py changes. Others are numpy, Python's tarfile and json, and safetensors where it is installed. What both read must be equal. What one
refuses is counted by the reason for it; a reason that is not expected below is a finding, and so is any difference. URDF is
compared with urdfdom within the fuzzer itself (target urdf_beside_urdfdom).
"""
import argparse
import collections
import importlib.util
import io
import json
import os
import pathlib
import random
import re
import subprocess
import sys
import tarfile

import numpy as np

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "tests/programs"))
import mutators  # noqa: E402

PROGRAM = {"npy": "records", "tar": "records", "safetensors": "records", "json": "readers"}


def ours(program: pathlib.Path, target: str, files: list[pathlib.Path]) -> list[dict]:
    environment = os.environ | {"DOORFORGE_FUZZ_TARGET": target, "DOORFORGE_FUZZ_TELL": "1"}
    answers = []
    for at in range(0, len(files), 500):
        # each input once: in search of leaks libFuzzer would repeat some
        done = subprocess.run([program, "-detect_leaks=0", *files[at:at + 500]], env=environment, capture_output=True, check=True)
        answers += [json.loads(line) for line in done.stdout.decode().split("\n") if line]
    assert len(answers) == len(files), f"{len(answers)} answers for {len(files)} inputs"
    return answers


class Refused(Exception):
    pass


def npy(content: bytes) -> dict:
    stream = io.BytesIO(content)
    try:
        version = np.lib.format.read_magic(stream)
        read = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
        if version not in ((1, 0), (2, 0)):
            raise Refused(f"version {version}")
        shape, fortran, kind = read(stream)
    except Refused:
        raise
    except Exception as error:  # whatever numpy raises is its refusal
        raise Refused(str(error)) from None
    if fortran:
        raise Refused("Fortran order")
    offset = stream.tell()
    if any(length < 0 for length in shape):
        raise Refused("a negative length")
    count = 1
    for length in shape:
        count *= length
    if count * kind.itemsize != len(content) - offset:
        raise Refused("another size than its shape says")
    return {"type": kind.str, "shape": list(shape), "offset": offset}


def tar(content: bytes) -> dict:
    try:
        with tarfile.open(fileobj=io.BytesIO(content), mode="r:") as archive:
            members = archive.getmembers()
    except Exception as error:
        raise Refused(str(error)) from None
    return {"members": [[m.name, m.offset_data, m.size] for m in members if m.isreg()]}


def safetensors(content: bytes) -> dict:
    from safetensors import SafetensorError, deserialize
    import struct
    try:
        tensors = deserialize(content)
    except (SafetensorError, Exception) as error:
        raise Refused(str(error)) from None
    size, = struct.unpack("<Q", content[:8])
    metadata = json.loads(content[8:8 + size]).get("__metadata__") or {}
    return {"tensors": {name: [t["dtype"], list(t["shape"])] for name, t in tensors}, "metadata": metadata}


def number_or_refusal(text: str) -> None:
    raise Refused(f"the constant {text}")


def pairs_once(pairs: list) -> dict:
    if len({key for key, _ in pairs}) < len(pairs):
        raise Refused("a key that is there twice")
    return dict(pairs)


def as_json(content: bytes) -> object:
    try:
        return json.loads(content.decode("utf-8"), parse_constant=number_or_refusal, object_pairs_hook=pairs_once)
    except Refused:
        raise
    except (ValueError, RecursionError) as error:
        raise Refused(str(error)) from None


THEIRS = {"npy": npy, "tar": tar, "safetensors": safetensors, "json": as_json}

# Why one side alone refuses, by a pattern of what it says.
ONLY_WE_REFUSE = {
    "npy": [r"type|descr", r"version|magic|begins", r"header", r"Fortran|fortran", r"bytes|size|shape|elements", r"align|64"],
    "tar": [r"no valid header", r"cut off"],  # tarfile stops there in silence
    "safetensors": [r"dtype|type", r"gap|overlap|cover|behind|begin|end", r"metadata", r"shape", r"header", r"JSON|nest|twice"],
    "json": [r"nest|deep|level", r"UTF-8", r"JSON", r"number"],
}
ONLY_THEY_REFUSE = {
    "npy": [], "tar": [], "safetensors": [],
    "json": [r"twice", r"BOM", r"constant"],  # names twice: the last one counts for us
}


def equal(target: str, mine: object, other: object) -> bool:
    if target == "tar":
        return [list(m) for m in mine["members"]] == other["members"]
    if target == "safetensors":
        return ({name: t[:2] for name, t in mine["tensors"].items()} == other["tensors"]
                and mine["metadata"] == other["metadata"])
    return mine == other


def compare(target: str, program: pathlib.Path, files: list[pathlib.Path]) -> int:
    counts: collections.Counter = collections.Counter()
    bad = []
    for file, answer in zip(files, ours(program, target, files), strict=True):
        refusal = answer.get("refused")
        try:
            other = THEIRS[target](file.read_bytes())
            their_refusal = None
        except Refused as why:
            their_refusal = str(why)
        if target == "tar" and refusal is None and not answer["read"]["complete"]:
            refusal = answer["read"]["fault"]
        if refusal is None and their_refusal is None:
            same = equal(target, answer["read"], other)
            counts["both read, equal" if same else "both read, DIFFERENT"] += 1
            if not same:
                bad.append((file, answer["read"], other))
        elif refusal is not None and their_refusal is not None:
            counts["both refuse"] += 1
        else:
            side, why, known = (("only we refuse", refusal, ONLY_WE_REFUSE) if refusal is not None else
                                ("only they refuse", their_refusal, ONLY_THEY_REFUSE))
            explained = any(re.search(pattern, why) for pattern in known[target])
            counts[side if explained else side + ", UNEXPLAINED"] += 1
            if not explained:
                bad.append((file, side, why))
    print(f"{target}: {len(files)} inputs; " + "; ".join(f"{count} {what}" for what, count in sorted(counts.items())))
    for entry in bad[:20]:
        print("  ", *entry)
    return len(bad)


def mutants(folder: pathlib.Path, seeds: list[pathlib.Path], target: str, count: int) -> list[pathlib.Path]:
    folder.mkdir(parents=True, exist_ok=True)
    files = []
    for number, seed in enumerate(seeds):
        source = random.Random(f"{target} {seed.name}")
        for i in range(count):
            content, _ = mutators.mutated(seed.read_bytes(), "." + target, source)
            files.append(folder / f"{number}_{i}")
            files[-1].write_bytes(content)
    return files


def main() -> int:
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--build", type=pathlib.Path, default=SOURCE / "build/fuzz")
    options.add_argument("--work", type=pathlib.Path, default=SOURCE / "build/fuzz_campaign")
    options.add_argument("--mutants", type=int, default=200)
    options.add_argument("targets", nargs="*", default=list(PROGRAM))
    chosen = options.parse_args()
    bad = 0
    for target in chosen.targets:
        if target == "safetensors" and importlib.util.find_spec("safetensors") is None:
            print("safetensors: not installed, not compared")
            continue
        files = sorted(p for kind in ("corpus", "seeds") for p in (chosen.work / kind / target).glob("*") if p.is_file())
        seeds = sorted((chosen.work / "seeds" / target).glob("*"))
        files += mutants(chosen.work / "mutants" / target, seeds, target, chosen.mutants)
        bad += compare(target, chosen.build / "bin" / f"fuzz_{PROGRAM[target]}", files)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
