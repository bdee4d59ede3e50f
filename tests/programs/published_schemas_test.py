# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Every record that a program writes or prints has a published JSON Schema, which it fits and a damaged one does not."""
import copy
import json
import re
import unittest

import jsonschema
from programs import BINARY_DIR, SOURCE, ProgramTest, run
from record_samples import DOORS, collect_samples
from sound_inputs import box_obj

# Not JSON of their own: metadata of weights, the journal of a shard (whose lines have checksums), golden values of tests;
# an attribute of HDF5 files, and the name of a tool in other programs' reports.
WITHOUT = {"turned", "side", "familiar", "heights", "ppo", "dagger", "trajectories", "shard_journal", "golden_scenes", "robomimic", "validate"}
WRITTEN_SETTINGS = {"datagen_open": "whole_set/config.yaml", "eval": "evaluated/a/config.yaml",
                    "train_motion": "inputs/trained/tested_training/config.yaml",
                    "compose": "inputs/doors/tested_door/compose.json"}
WRONG = {"number": "text", "integer": 0.5, "string": 7, "boolean": "yes", "array": {}, "object": []}


def required_places(schema: dict, path: tuple = ()) -> list[tuple]:
    """The keys that must be there, by their path below objects that are themselves required."""
    places = []
    for key in schema.get("required", []):
        places.append((*path, key))
        places += required_places(schema["properties"][key], (*path, key))
    return places


def at(document: dict, path: tuple) -> object:
    for key in path:
        document = document[key]
    return document


class PublishedSchemas(ProgramTest):
    def refused(self, validator: jsonschema.Draft202012Validator, document: dict, why: object) -> None:
        self.assertFalse(validator.is_valid(document), why)

    def test_records_fit_and_damaged_ones_do_not(self):
        samples = collect_samples(BINARY_DIR / "bin/doorforge", self.folder)
        names = run("schema").stdout.split()
        for name, path in WRITTEN_SETTINGS.items():
            lines = [line for line in (self.folder / path).read_text().splitlines() if not line.startswith("#")]
            settings = json.loads("\n".join(lines))  # PyYAML takes 1e-05 for a word
            jsonschema.validate(settings, json.loads(run("schema", "settings_" + name).stdout))
        self.assertEqual(set(samples) - WITHOUT, set(samples) & set(names))
        for name in sorted(set(samples) - WITHOUT):
            schema = json.loads(run("schema", name).stdout)
            jsonschema.Draft202012Validator.check_schema(schema)
            validator = jsonschema.Draft202012Validator(schema)
            for document in samples[name]:
                faults = [f"{'/'.join(map(str, fault.absolute_path))}: {fault.message[:200]}" for fault in validator.iter_errors(document)]
                self.assertEqual(faults, [], name)
            document = samples[name][0]
            for path in required_places(schema):
                damaged = copy.deepcopy(document)
                del at(damaged, path[:-1])[path[-1]]
                self.refused(validator, damaged, (name, path, "left out"))
                kind = at(schema, sum((("properties", key) for key in path), ())).get("type")
                if kind in WRONG:
                    damaged = copy.deepcopy(document)
                    at(damaged, path[:-1])[path[-1]] = WRONG[kind]
                    self.refused(validator, damaged, (name, path, WRONG[kind]))
            self.refused(validator, {**document, "schema": "doorforge.other"}, name)
            self.refused(validator, {**document, "schema_version": document["schema_version"] + 1000}, name)

    def test_no_record_of_the_sources_is_without_a_schema(self):
        written = set()
        for room in ("core", "schemas", "asset_tools", "sim", "datagen", "train", "data"):
            for path in (SOURCE / room).rglob("*"):
                if path.suffix in (".cpp", ".h", ".yaml"):
                    written |= set(re.findall(r'(?:"|^schema: )doorforge\.([a-z_]+)', path.read_text(), re.MULTILINE))
        self.assertGreater(len(written), 40)
        self.assertEqual(written - WITHOUT - set(run("schema").stdout.split()), set())


    def test_settings_are_taken_where_their_schema_takes_them(self):
        door = self.folder / "door"
        self.assert_ends(run("compose", "--body", DOORS[2][0], "--handle", DOORS[2][1], "--out", door), 0)
        meshes, out = self.folder / "box.obj", self.folder / "out"
        meshes.write_text(box_obj())
        verbs = {
            "compose": ("compose", "--body", DOORS[2][0], "--handle", DOORS[2][1], "--out", out),
            "repair": ("repair", meshes, self.folder / "repaired.obj"),
            "import": ("import", meshes, "--category", "safe", "--out", out),
            "simulate": ("simulate", "--door", door), "eval": ("eval", "--opener", "expert", "--doors", door),
            **{f"datagen_{stage}": ("datagen", "plan", stage, "--doors", door, "--probe", 0) for stage in ("open", "handle", "grasp")}
        }
        for name, command in verbs.items():
            schema = json.loads(run("schema", "settings_" + name).stdout)
            key = next(key for key, field in schema["properties"].items() if field.get("type") in WRONG)
            for damaged in ({"no_such_key": 1}, {key: WRONG[schema["properties"][key]["type"]]}):
                self.refused(jsonschema.Draft202012Validator(schema), damaged, name)
                settings = self.folder / "settings.yaml"
                settings.write_text(json.dumps(damaged))
                result = run(*command, "--config", settings)
                self.assert_refused(result, 2)
                self.assertIn(settings.name, result.stderr)
            jsonschema.validate({}, schema)
            settings.write_text(json.dumps({key: schema["properties"][key]["default"]} if "default" in schema["properties"][key] else {}))
            self.assertNotIn(settings.name, run(*command, "--config", settings).stderr)


if __name__ == "__main__":
    unittest.main()
