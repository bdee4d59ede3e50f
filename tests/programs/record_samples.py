# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""One of every kind of record that the programs write or print, in as many shapes as a minute allows: what the published
JSON Schemas are made of (scripts/record_schemas.py) and held to (published_schemas_test.py).
"""
import collections
import json
import pathlib
import subprocess

import yaml
from sound_inputs import SAFE_BODY, SAFE_HANDLES, SOURCE, make_inputs

# The first two are on the sides that the benchmark judges.
DOORS = (("interior_planked_01", "interior_lever_cranked_03", ()), ("storage_arched_corner_01", "storage_knob_ball_01", ()),
         ("interior_flush_01", "interior_lever_tube_01", ("hinge_side=right", "latch=bolt")),
         ("interior_louvred_02", "interior_round_egg_02", ("opening=push", "hinge_side=left")),
         ("storage_arched_hutch_01", "storage_pull_bow_01", ()))
YAML_RECORDS = ("catalog", "splits", "pipelines")  # folders of data/ whose files name a schema


class Samples:
    """Documents by the name of their schema, without "doorforge."."""

    def __init__(self, doorforge: pathlib.Path, folder: pathlib.Path):
        self.of = collections.defaultdict(list)
        self._doorforge = doorforge
        self._folder = folder

    def take(self, *command: object, codes: tuple[int, ...] = (0, 1)) -> None:
        """The document that a command prints."""
        answer = subprocess.run([str(self._doorforge), *map(str, command)], capture_output=True, text=True, timeout=600)
        if answer.returncode not in codes:
            raise SystemExit(f"{command}: exit code {answer.returncode}\n{answer.stderr}")
        if "--json" in command or command[0] in ("act", "conformance"):
            self.add(json.loads(answer.stdout))

    def add(self, document: object) -> None:
        if isinstance(document, dict) and str(document.get("schema", "")).startswith("doorforge."):
            self.of[document["schema"].removeprefix("doorforge.")].append(document)

    def add_files(self, folder: pathlib.Path) -> None:
        for path in sorted(folder.rglob("*.json")):
            self.add(json.loads(path.read_text()))
        for path in sorted(folder.rglob("*.jsonl")):
            for line in path.read_text().splitlines():
                self.add(json.loads(line))
        for path in sorted(folder.rglob("*.journal")):
            for line in path.read_text().splitlines():
                self.add(json.loads(line[9:]))


def compose(samples: Samples, folder: pathlib.Path) -> list[pathlib.Path]:
    doors = []
    for body, handle, settings in DOORS:
        options = [word for setting in settings for word in ("--set", setting)]
        doors.append(folder / "composed" / f"{body}__{handle}")
        samples.take("compose", "--body", body, "--handle", handle, *options, "--validate", "--out", doors[-1], "--json")
    return doors


def collect(samples: Samples, inputs: pathlib.Path, folder: pathlib.Path) -> None:
    door, data = inputs / "doors/tested_door", folder / "whole_set"
    samples.take("datagen", "plan", "open", "--doors", door, "--episodes", 4, "--probe", 0, "--json")
    samples.take("datagen", "open", "--doors", door, "--out", data, "--episodes", 3, "--set", "cloud.point_count=256", "--json")
    for verb in ("info", "verify", "status"):
        samples.take("dataset", verb, data, "--json")
    samples.take("dataset", "export", data, "--to", "robomimic", "--out", folder / "exported.hdf5", "--json")
    samples.take("datagen", "open", "--doors", door, "--out", folder / "task0", "--episodes", 4, "--set",
                 "cloud.point_count=256", "--task", "0/2", "--json")


def evaluate(samples: Samples, inputs: pathlib.Path, folder: pathlib.Path, doors: list[pathlib.Path]) -> None:
    policies = SOURCE / "data/policies"
    for name, options in (("a", ("--opener", "expert", "--films")), ("b", ("--opener", policies / "opener", "--handler", policies / "handler",
                                                                 "--grasper", policies / "grasper", "--set", f"grasp.finder={policies / 'finder'}",
                                                                 "--allow-seen"))):
        samples.take("eval", *options, "--doors", *doors[2:4], "--seeds", 1, "--set", "scene.physics.max_opening_actions=2",
                     "--out", folder / name, "--json")
    samples.take("report", folder / "a", folder / "b", "--json")
    samples.take("simulate", "--door", *doors[:2], "--json")
    sight = SOURCE / "data/sight/lever"
    for stage, options in (("open", ()), ("handle", ("--handler", policies / "handler", "--before", sight / "grasp/depth.png"))):
        samples.take("act", "--depth", sight / stage / "depth.png", "--camera", sight / stage / "camera.yaml", "--state",
                     sight / stage / "state.yaml", "--opener", policies / "opener", *options)
    samples.take("act", "--depth", sight / "grasp/depth.png", "--camera", sight / "grasp/camera.yaml", "--handle-mask",
                 sight / "grasp/mask.png", "--grasper", policies / "grasper")


def collect_samples(doorforge: pathlib.Path, folder: pathlib.Path) -> dict[str, list[dict]]:
    inputs, samples = folder / "inputs", Samples(doorforge, folder)
    make_inputs(doorforge, inputs)
    doors = compose(samples, folder)
    samples.take("catalog", "list", "--json")
    for part in (SAFE_BODY, SAFE_HANDLES[0], DOORS[0][1]):
        samples.take("catalog", "show", part, "--json")
    samples.take("catalog", "build", "--category", "refrigerator", "--out", folder / "built", "--json")
    samples.take("compose", "--all", "--parts", inputs / "parts", "--out", folder / "standalone", "--standalone", "--json")
    samples.take("import", inputs / "foreign/objects", "--category", "safe", "--out", folder / "imported", "--json")
    samples.take("repair", inputs / "meshes/tested_box.obj", folder / "repaired.obj", "--json")
    samples.take("export", *doors, "--to", "mjcf", "--out", folder / "exports", "--json")
    samples.take("validate", doors[0], inputs / "foreign/objects/plain/tested_object/tested.urdf", "--json")
    samples.take("validate", "--rules", "--json")
    collect(samples, inputs, folder)
    evaluate(samples, inputs, folder / "evaluated", doors)
    samples.take("pipeline", "plan", "quick", "--out", folder / "run", "--json")
    samples.take("benchmark", "plan", "quick", "--out", folder / "benchmark", "--json")
    samples.take("benchmark", "quick", "--out", folder / "benchmarked", "--doors", *doors[:2], "--rows", "expert", "gapartnet_clean",
                 "--set", "seeds=1", "--json")
    samples.take("conformance", doors[0], "--out", folder / "conformance", "--clients", "mujoco", "--format", "json", codes=(0, 1, 3))
    samples.take("doctor", "--json")
    samples.add_files(folder)
    for name in YAML_RECORDS:
        for path in sorted((SOURCE / "data" / name).rglob("*.yaml")):
            samples.add(yaml.safe_load(path.read_text()))
    return dict(samples.of)
