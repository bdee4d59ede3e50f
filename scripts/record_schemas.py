#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Writes the JSON Schemas of the records that have no codec to make them from (schemas/json), from what the programs write:

    scripts/record_schemas.py build/dev

A key that all samples have is required, and one that none has is allowed. What samples do not show is said here: objects
whose keys are names (MAPS), words of a closed set (WORDS). Look at the difference before it is committed.
"""
import json
import pathlib
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests/programs"))
from record_samples import collect_samples  # noqa: E402

JSON_SCHEMA = "https://json-schema.org/draft/2020-12/schema"
SHA256 = "^[0-9a-f]{64}$"
UNITS = (("_nm_per_rad", "N m/rad"), ("_nm_s", "N m s/rad"), ("_rad_s", "rad/s"), ("_rad", "rad"), ("_kg", "kg"), ("_m", "m"),
         ("_nm", "N m"), ("_n", "N"), ("_s", "s"), ("_px", "pixels"), ("_bytes", "bytes"))
CATEGORIES = ["interior", "window", "car", "safe", "storagefurniture", "refrigerator"]
WORDS = {
    "category": CATEGORIES, "mechanism": ["none", "lever", "round", "key", "valve", "flap"], "role": ["body", "handle"],
    "hinge_side": ["left", "right"], "opening": ["pull", "push"], "stage": ["open", "handle", "grasp"],
    "severity": ["error", "warning", "info"]
}
# Objects whose keys are names, by schema and path: all values are alike. "*" stands for the items of lists and maps.
BY_GROUP = ("success", "handle_success", "effort", "over_seeds", "over_angle", "within_force")
MAPS = {
    "benchmark": ("/rows/*/success/success", "/rows/*/paper", "/rows/*/success/doors"),
    "catalog_part": ("/recipe",),
    "collection_forecast": ("/doors_by_category", "/episodes_by_category"),
    "collection_status": ("/failures",),
    "collection_task": ("/failures",),
    "conformance": ("/engines/*/loader",),
    "dataset_description": ("/failures", *(f"/stages/*/{name}" for name in ("by_category", "by_mechanism", "by_split", "episodes_by_decisions")),
                            *(f"/stages/*{name}/causes" for name in ("/all", "/by_category/*", "/by_mechanism/*", "/by_split/*"))),
    "dataset_findings": ("/counts",),
    "film": ("/robot",),
    "part_report": ("/settings",),
    "pipeline": ("/settings", "/steps/*/core_seconds", "/steps/*/mebibytes", "/steps/*/replace"),
    "pipeline_plan": ("/settings",),
    "pipeline_step": ("/inputs",),
    "policy": ("/provenance/config",),
    "recipe": ("/parameters",),
    "repair_report": ("/config",),
    "report": (*(f"{of}/{name}" for of in ("", "/expert") for name in BY_GROUP), "/causes", "/expert/causes", "/provenance/config"),
    "simulate": ("/success", "/success/*/outcomes"),
    "trainings": ("/success",),
}
# What is settings, whose schemas are their own, or text of many kinds.
ANYTHING = {("catalog_part", "/recipe/*"), ("film", "/robot/*"), ("part_report", "/settings/*"), ("pipeline", "/settings/*"),
            ("pipeline_plan", "/settings/*"), ("policy", "/provenance/config/*"), ("recipe", "/parameters/*"),
            ("repair_report", "/config/*"), ("report", "/provenance/config/*"), ("conformance", "/engines/*/loader/*")}
# Rows of engines that come from elsewhere than Debian: docs/conformance.md.
ENGINE_ROW = {"client": "", "format": "", "door": "", "latched": True, "loads": True, "problem": "", "mass_error": 0.5,
              "limit_error_rad": 0.5, "held_deg": 0.5, "unlock_deg": 0.5, "law_unlock_deg": 0.5, "open_s": 0.5, "held": True,
              "opened": True}
SHOWN = {"conformance": [{"schema": "", "schema_version": 1, "engines": [], "rows": [ENGINE_ROW, {**ENGINE_ROW, **dict.fromkeys(
    ("mass_error", "limit_error_rad", "held_deg", "unlock_deg", "law_unlock_deg", "open_s"))}]}]}
TITLES = {
    "authored_handles": "handles.json of an imported body: where its object's handle was",
    "benchmark": "The table of `doorforge benchmark`",
    "catalog": "`doorforge catalog list --json`",
    "catalog_build": "`doorforge catalog build --json`",
    "catalog_part": "`doorforge catalog show --json`",
    "collection_forecast": "`doorforge datagen plan --json`",
    "collection_status": "`doorforge dataset status --json`",
    "collection_task": "`doorforge datagen --json`",
    "compose": "compose.json beside composed doors",
    "conformance": "`doorforge conformance --format json`",
    "dataset_description": "`doorforge dataset info --json`",
    "dataset_export": "`doorforge dataset export --json`",
    "dataset_findings": "`doorforge dataset verify --json`",
    "decision": "An answer of `doorforge act`",
    "doctor": "`doorforge doctor --json`",
    "door": "door.json of a composed door",
    "door_index": "door_index.json beside the folders of doors",
    "export": "`doorforge export --json`",
    "exported_door": "export.json of an exported door",
    "film": "A line of films.jsonl: the course of an episode",
    "import": "import.json beside imported parts",
    "losses": "losses.json of a training",
    "mesh_pool": "pool.json of a folder of meshes that doors share",
    "part": "part.json of a body or a handle",
    "part_report": "repair.json of a part",
    "pipeline": "A pipeline, in YAML",
    "pipeline_plan": "`doorforge pipeline plan --json`",
    "pipeline_step": "The record of a step of a pipeline",
    "policy": "policy.json of a trained stage",
    "recipe": "A part of the catalogue, in YAML",
    "repair_report": "The report of `doorforge repair`",
    "report": "report.json of an evaluation",
    "shape": "A shape in a pool of meshes",
    "simulate": "`doorforge simulate --json`",
    "split": "A split of parts, in YAML",
    "trainings": "`doorforge report --json`: several trainings",
}


def is_number(value: object) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def unit_of(name: str) -> str:
    return next((unit for ending, unit in UNITS if name.endswith(ending)), "")


def object_schema(samples: list[dict], maps: tuple[str, ...], path: str) -> dict:
    keys = dict.fromkeys(key for sample in samples for key in sample)
    if path in maps:
        values = [value for sample in samples for value in sample.values()]
        return {"type": "object", "additionalProperties": schema_of(values, maps, path + "/*", "") if values else True}
    return {
        "type": "object",
        "properties": {
            key: schema_of([sample[key] for sample in samples if key in sample], maps, f"{path}/{key}", key)
            for key in keys
        }, "required": [key for key in keys if all(key in sample for sample in samples)]
    }


def text_schema(samples: list[str], name: str) -> dict:
    if name.endswith("sha256") and all(len(text) == 64 for text in samples):
        return {"type": "string", "pattern": SHA256}
    if name in WORDS and set(samples) <= set(WORDS[name]):
        return {"type": "string", "enum": WORDS[name]}
    return {"type": "string"}


def schema_of(samples: list, maps: tuple[str, ...], path: str, name: str) -> dict:
    """What all of `samples` are."""
    if "anything " + path in maps:
        return {}
    kinds = []
    objects = [sample for sample in samples if isinstance(sample, dict)]
    if objects:
        kinds.append(object_schema(objects, maps, path))
    lists = [sample for sample in samples if isinstance(sample, list)]
    if lists:
        items = [item for sample in lists for item in sample]
        kinds.append({"type": "array", **({"items": schema_of(items, maps, path + "/*", name)} if items else {})})
    texts = [sample for sample in samples if isinstance(sample, str)]
    if texts:
        kinds.append(text_schema(texts, name))
    if any(isinstance(sample, bool) for sample in samples):
        kinds.append({"type": "boolean"})
    numbers = [sample for sample in samples if is_number(sample)]
    if numbers:
        whole = all(isinstance(number, int) for number in numbers) and not unit_of(name)
        kinds.append({"type": "integer" if whole else "number"})
    if any(sample is None for sample in samples):
        kinds.append({"type": "null"})
    schema = kinds[0] if len(kinds) == 1 else {"anyOf": kinds}
    return {**schema, "description": "unit: " + unit_of(name)} if numbers and unit_of(name) else schema


def record_schema(name: str, samples: list[dict]) -> dict:
    anything = tuple("anything " + path for of, path in ANYTHING if of == name)
    schema = schema_of([*samples, *SHOWN.get(name, [])], MAPS.get(name, ()) + anything, "", "")
    schema["required"] = ["schema", "schema_version", *(key for key in schema["required"] if not key.startswith("schema"))]
    schema["properties"]["schema"] = {"const": "doorforge." + name}
    if name == "policy":  # a finder's is no stage of an episode
        schema["properties"]["stage"]["enum"] = [*WORDS["stage"], "find"]
    newest = max(sample["schema_version"] for sample in samples)
    schema["properties"]["schema_version"] = {"type": "integer", "minimum": 1, "maximum": newest}
    return {"$schema": JSON_SCHEMA, "title": TITLES[name], **schema}


def main() -> None:
    build = pathlib.Path(sys.argv[1]).resolve()
    target = ROOT / "schemas/json"
    with tempfile.TemporaryDirectory() as folder:
        samples = collect_samples(build / "bin/doorforge", pathlib.Path(folder))
    for name in sorted(TITLES):
        (target / f"{name}.schema.json").write_text(json.dumps(record_schema(name, samples[name]), indent=2) + "\n")


if __name__ == "__main__":
    main()
