# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Every verb that reads bytes from outside, with the files of its input that are changed."""
import dataclasses

from sound_inputs import BODY, COLLECT, TRAIN

# results that are no fault of the file's form; the record beside the output says what was behind them
NO_DATA = ("no episode succeeded",)
DIVERGED = ("training diverged",)


@dataclasses.dataclass(frozen=True)
class Target:
    """A verb, the inputs that it gets, and which of their files are changed."""
    name: str
    group: str  # of sound_inputs, copied for a run
    files: tuple[str, ...]  # globs below it; what is changed is one file of one of them
    arguments: tuple[str, ...]  # of `doorforge`; IN, OUT and CHANGED stand for the run's folders and the changed file
    covered: bool = False  # checksums or hashes that the input carries cover every byte of these files
    sealed: float = 0  # share of the runs in which these checksums are mended, so that what lies behind is reached
    in_place: bool = False  # the verb writes into its input
    weight: int = 1
    outcomes: tuple[str, ...] = ()  # words of messages that report a result instead of refusing the file
    environment: tuple[tuple[str, str], ...] = ()


def door_targets() -> list[Target]:
    record, shapes = ("tested_door/door.json",), ("tested_door/meshes/*/*.obj",)
    door = "IN/tested_door"
    simulate = ("simulate", "--door", door, "--seeds", "1")
    evaluate = ("eval", "--opener", "expert", "--doors", door, "--seeds", "1", "--set", "expert_reference=false",
                "--out", "OUT/report")
    collect = ("datagen", "open", "--episodes", "1", "--set", "preview=false", "--out", "OUT/set", "--doors")
    return [
        Target("validate", "doors", record + ("tested_door/model.urdf",), ("validate", "IN", "--json"), weight=3),
        Target("validate meshes", "doors", shapes, ("validate", "IN", "--json"), covered=True, sealed=0.7, weight=4),
        Target("validate --fix", "doors", record + shapes, ("validate", door, "--fix"), in_place=True),
        Target("validate openable", "doors", record, ("validate", door, "--profile", "openable")),
        Target("export", "doors", record,
               ("export", door, "--format", "mjcf,sdf,glb,usda,urdf", "--out", "OUT/e", "--overwrite"), weight=3),
        Target("export meshes", "doors", shapes, ("export", door, "--format", "mjcf", "--out", "OUT/e"), covered=True,
               sealed=0.5, weight=2),
        Target("preview", "doors", record, ("preview", door, "--out", "OUT/p.png")),
        Target("preview meshes", "doors", ("tested_door/meshes/visual/*.obj",),
               ("preview", door, "--out", "OUT/p.png"), covered=True, sealed=0.5),
        Target("view", "doors", record, ("view", door, "--out", "OUT/p.html")),
        Target("view meshes", "doors", shapes, ("view", door, "--out", "OUT/p.html"), covered=True, sealed=0.5),
        Target("view gallery", "doors", record + ("tested_door/meshes/visual/*.obj",), ("view", door, "--gallery", "--out", "OUT/g.html")),
        Target("simulate", "doors", record, simulate + ("--film", "OUT/film"), weight=2),
        Target("simulate meshes", "doors", ("tested_door/meshes/collision/*.obj",), simulate, covered=True, sealed=0.5,
               weight=2),
        Target("eval", "doors", record, evaluate + ("--json",)),
        Target("eval meshes", "doors", shapes, evaluate, covered=True, sealed=0.3),
        Target("datagen", "doors", record, collect + (door,), outcomes=NO_DATA),
        Target("datagen meshes", "doors", shapes, collect + (door,), covered=True, sealed=0.3, outcomes=NO_DATA),
        Target("pool plan", "pool", ("tested_doors/*/door.json", "tested_doors/*.json", "tested_doors/pool/*"),
               ("datagen", "plan", "open", "--doors", "IN/tested_doors", "--episodes", "4", "--probe", "0"),
               sealed=0.5),
        Target("pool validate", "pool", ("tested_doors/pool/*",), ("validate", "IN/tested_doors", "--json"),
               sealed=0.6, weight=2),
        Target("pool datagen", "pool", ("tested_doors/pool/*.obj", "tested_doors/*/door.json"),
               collect + ("IN/tested_doors",), sealed=0.5, outcomes=NO_DATA),
        Target("pool export", "pool", ("tested_doors/*/door.json", "tested_doors/pool/*.json"),
               ("export", "IN/tested_doors", "--format", "urdf", "--out", "OUT/e", "--overwrite"), sealed=0.5),
        Target("compose again", "pool", ("tested_doors/pool/*", "tested_doors/*.json"),
               ("compose", "--all", "--parts", "IN/parts", "--out", "IN/tested_doors"), in_place=True),
    ]


def part_targets() -> list[Target]:
    record, shapes = ("tested_part/part.json",), ("tested_part/**/*.obj",)
    compose = ("compose", "--body", "IN/other_body", "--handle", "IN/tested_part", "--out", "OUT/door")
    return [
        Target("part", "part", record, ("validate", "IN", "--json"), weight=2),
        Target("part meshes", "part", shapes, ("validate", "IN", "--json"), covered=True, sealed=0.7, weight=2),
        Target("compose part", "part", record, compose, weight=2),
        Target("compose part meshes", "part", shapes, compose, covered=True, sealed=0.6),
        Target("compose --all", "parts", ("*/part.json",),
               ("compose", "--all", "--parts", "IN", "--out", "OUT/doors", "--overwrite"), weight=2),
        Target("compose --all meshes", "parts", ("*/**/*.obj",),
               ("compose", "--all", "--parts", "IN", "--out", "OUT/doors"), sealed=0.6),
        Target("catalog", "catalogue", ("tested_data/**/*.yaml",), ("catalog", "build", "--out", "OUT/parts"),
               weight=2, environment=(("DOORFORGE_DATA", "IN/tested_data"),)),
        Target("catalog show", "catalogue", ("tested_data/catalog/**/*.yaml",), ("catalog", "list", "--json"),
               environment=(("DOORFORGE_DATA", "IN/tested_data"),)),
    ]


def config_targets() -> list[Target]:
    door = "IN/tested_door"
    return [
        Target("simulate --config", "configs", ("tested_scene.yaml",),
               ("simulate", "--door", door, "--seeds", "1", "--config", "IN/CHANGED"), weight=2),
        Target("datagen --config", "configs", ("tested_collection.yaml",),
               ("datagen", "plan", "open", "--doors", door, "--config", "IN/CHANGED", "--probe", "0"), weight=2),
        Target("train --config", "train", ("tested_training.yaml",),
               ("train", "open", "--data", "IN/tested_set", "--out", "OUT/policy", "--config", "IN/CHANGED",
                "--epochs", "1"),  # as many as a changed file asks for would be made, for hours and rightly
               outcomes=DIVERGED),
        Target("eval --config", "configs", ("tested_evaluation.yaml",),
               ("eval", "--opener", "expert", "--doors", door, "--config", "IN/CHANGED")),
        Target("compose --config", "configs", ("tested_door.yaml",),
               ("compose", "--config", "IN/CHANGED", "--out", "OUT/door"), weight=2),
        Target("import --config", "foreign", ("tested_import.yaml",),
               ("import", "IN/objects/plain/tested_object", "--category", "storagefurniture", "--out", "OUT/parts",
                "--config", "IN/CHANGED", "--json"), outcomes=("tested_object",)),
        Target("split", "configs", ("tested_split.yaml",),
               ("datagen", "plan", "open", "--doors", "IN/CHANGED:train", door, "--episodes", "2", "--probe", "0")),
        Target("pipeline", "configs", ("tested_pipeline.yaml",),
               ("pipeline", "plan", "IN/CHANGED", "--out", "OUT/run", "--json"), weight=2),
        Target("pipeline steps", "pipeline", ("tested_run/pipeline/*.json",),
               ("pipeline", "plan", "quick", "--out", "IN/tested_run")),
        Target("simulate --robot", "robots", ("tested_robot/*.urdf",),
               ("simulate", "--door", door, "--seeds", "1", "--robot", "IN/CHANGED"), weight=3),
        Target("robot meshes", "robots", ("tested_robot/meshes/*/*",),
               ("simulate", "--door", door, "--seeds", "1", "--robot", "IN/tested_robot/mobile_franka.urdf")),
    ]


def dataset_targets() -> list[Target]:
    everything, data = ("tested_set/**/*",), "IN/tested_set"
    return [
        Target("verify", "data", everything, ("dataset", "verify", data), covered=True, weight=6),
        Target("verify sealed", "data", ("tested_set/open/**/*",), ("dataset", "verify", data, "--json"), sealed=1,
               weight=4),
        Target("regenerate", "data", everything,
               ("dataset", "verify", data, "--regenerate", "50%", "--doors", "IN/tested_door"), sealed=0.5),
        Target("info", "data", everything, ("dataset", "info", data, "--json"), sealed=0.5, weight=2),
        Target("info page", "data", everything,
               ("dataset", "info", data, "--html", "OUT/page.html", "--png", "OUT/p.png"), sealed=0.5),
        Target("view data", "data", everything, ("view", data, "--doors", "IN/tested_door", "--out", "OUT/page.html"), sealed=0.5),
        Target("view report", "report", ("tested_report/report.json", "tested_report/films.jsonl"),
               ("view", "IN/tested_report", "--doors", "IN/tested_door", "--out", "OUT/page.html"), weight=2),
        Target("card", "data", everything, ("dataset", "card", data), in_place=True),
        Target("merge", "data", everything, ("dataset", "merge", "OUT/m", data), sealed=0.5, weight=2),
        Target("robomimic", "data", everything, ("dataset", "export", data, "--to", "robomimic", "--out", "OUT/e.hdf5"),
               sealed=0.6, weight=2),
        Target("re-observe", "data", everything,
               ("dataset", "re-observe", data, "--doors", "IN/tested_door", "--out", "OUT/r"), sealed=0.7, weight=3),
        Target("resume", "begun", ("tested_set/**/*", "tested_set/**/.*"),
               ("datagen", "open", "--doors", "IN/tested_door", "--out", data, *COLLECT), sealed=0.5, in_place=True,
               weight=2),
        Target("train", "train", everything, ("train", "open", "--data", data, "--out", "OUT/policy", *TRAIN),
               sealed=0.6, weight=2, outcomes=DIVERGED),
        Target("train --resume", "trained", ("tested_training/*", "tested_training/best/*"),
               ("train", "open", "--data", data, "--out", "IN/tested_training", "--resume", *TRAIN), in_place=True,
               sealed=0.5, weight=2, outcomes=DIVERGED),
        Target("train --from", "trained", ("tested_training/policy.*",),
               ("train", "open", "--data", data, "--out", "OUT/policy", "--from", "IN/tested_training", *TRAIN),
               sealed=0.5, outcomes=DIVERGED),
    ]


def act_targets() -> list[Target]:
    # the picture is a slanted plane, on which a policy rightly says hold
    sound = ("act", "--least-gain", "off", "--foreign-limit", "off", "--depth", "IN/tested_depth.png", "--camera",
             "IN/tested_camera.yaml")
    opener = sound + ("--state", "IN/tested_state.yaml", "--opener", "IN/tested_opener")
    handler = opener + ("--handler", "IN/tested_handler", "--stage", "handle", "--before", "IN/tested_before.png")
    grasper = sound + ("--handle-mask", "IN/tested_mask.png", "--grasper", "IN/tested_grasper")
    return [
        Target("act depth", "sight", ("tested_depth.png",), opener, weight=3),
        Target("act camera", "sight", ("tested_camera.yaml",), opener, weight=3),
        Target("act state", "sight", ("tested_state.yaml",), opener, weight=3),
        Target("act before", "sight", ("tested_before.png",), handler, weight=2),
        Target("act mask", "sight", ("tested_mask.png",), grasper, weight=2),
        Target("policy weights", "sight", ("tested_opener/policy.safetensors",), opener, covered=True, sealed=0.7,
               weight=2),
        Target("policy record", "sight", ("tested_opener/policy.json",), opener, weight=2),
        Target("handler", "sight", ("tested_handler/policy.*", "tested_handler/turned.safetensors"), handler,
               sealed=0.5),
        Target("grasper", "sight", ("tested_grasper/policy.*",), grasper, sealed=0.5, weight=2),
    ]


def mesh_targets() -> list[Target]:
    repair = ("repair", "IN/CHANGED", "OUT/o.obj")
    compose = ("compose", "--body", BODY, "--handle", "IN/CHANGED", "--handle-mechanism", "lever", "--out", "OUT/door")
    imported = ("import", "IN/objects", "--category", "interior", "--out", "OUT/parts")
    return [
        Target("repair obj", "meshes", ("tested_box.obj",), repair + ("--json",), weight=3),
        Target("repair mtl", "meshes", ("tested_box.mtl",), ("repair", "IN/tested_box.obj", "OUT/o.obj")),
        Target("repair stl", "meshes", ("*.stl",), repair, weight=3),
        Target("repair ply", "meshes", ("*.ply",), repair, weight=3),
        Target("repair off", "meshes", ("tested_box.off",), repair, weight=2),
        Target("repair dae", "meshes", ("tested_box.dae",), repair, weight=2),
        Target("repair glb", "meshes", ("tested_box.glb",), repair, weight=2),
        Target("compose --handle", "meshes", ("tested_box.*",), compose, weight=3),
        Target("validate urdf", "foreign", ("objects/*/*/*.urdf",), ("validate", "IN/objects", "--json"), weight=2),
        Target("validate mesh files", "meshes", ("tested_box.*", "*.stl", "*.ply"),
               ("validate", "IN/CHANGED", "--format", "sarif", "--ask", "none"), weight=2),
        Target("import urdf", "foreign", ("objects/*/*/*.urdf",), imported, weight=3),
        Target("import meshes", "foreign", ("objects/**/*.obj", "objects/**/*.stl"), imported, weight=3),
        Target("import records", "foreign", ("objects/**/*.json", "objects/**/*.txt"), imported + ("--json",),
               weight=2),
        Target("import torch", "foreign", ("objects/**/*.npy",), imported, weight=2),
    ]


def all_targets() -> list[Target]:
    return door_targets() + part_targets() + config_targets() + dataset_targets() + act_targets() + mesh_targets()
