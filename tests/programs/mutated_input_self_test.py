# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""The oracle of mutated_input.py can fail: stand-in programs that misbehave are reported, one that behaves is not."""
import contextlib
import hashlib
import io
import json
import pathlib
import random
import struct
import sys
import tempfile
import unittest
import zipfile
import zlib

import mutators
from mutated_input import Campaign, Workers, parsed
from mutation_oracle import Case, Limits, judged
from mutation_targets import Target, all_targets
from sealing import crc32c, index_text, seal
from sound_inputs import grey_png, torch_file

# What the stand-in does; its arguments are the behaviour, the input and the output. `refuse` is how a sound program
# takes a damaged file.
STAND_IN = """#!{python}
import os, pathlib, signal, sys, time
behaviour, source, out = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
box = out.parents[1]
def refuse(text="tested_file.json: damaged"):
    print("doorforge: " + text, file=sys.stderr)
    sys.exit(3)
if behaviour == "refuse": refuse()
if behaviour == "answer": (out / "answer").write_text("1"); print('{{"a": 1}}')
if behaviour == "crash": os.kill(os.getpid(), signal.SIGSEGV)
if behaviour == "odd code": print("tested_file.json"); sys.exit(77)
if behaviour == "spin":
    while True: pass
if behaviour == "wait": time.sleep(600)
if behaviour == "child spins":
    if os.fork() == 0:
        while True: pass
    os.wait()
if behaviour == "grow": grown = b"x" * (300 << 20); refuse()
if behaviour == "grow and wait": grown = b"x" * (300 << 20); time.sleep(600)
if behaviour == "name nothing": refuse("something is wrong")
if behaviour == "library": refuse("tested_file.json: [json.exception.type_error.316] invalid UTF-8 byte")
if behaviour == "two documents": print('{{"a": 1}}'); print('{{"a": 2}}')
if behaviour == "no document": print("done")
if behaviour == "half a document": print('{{"a": '); refuse()
if behaviour == "change": (source / "other.json").write_text("changed")
if behaviour == "remove": (source / "other.json").unlink()
if behaviour == "outside": (box / "escaped").write_text("here")
if behaviour == "victim": (box / "around/victim/keep.txt").write_text("mine now")
if behaviour == "temporary": (out / ".answer.tmp-12-0-host").mkdir()
if behaviour == "temporary outside": (out.parent / "tmp/doorforge-1").write_text("left")
if behaviour == "read": (source / "tested_file.json").read_text(); sys.exit(0)
"""
LIMITS = Limits(cpu_seconds=20, wall_seconds=300, memory_mib=200)


class StandIn(unittest.TestCase):

    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.program = self.folder / "build/bin/doorforge"
        self.program.parent.mkdir(parents=True)
        self.program.write_text(STAND_IN.format(python=sys.executable))
        self.program.chmod(0o755)


class Oracle(StandIn):

    def faults(self, behaviour: str, *options: str, limits: Limits = LIMITS, **case: object) -> list[str]:
        box = pathlib.Path(tempfile.mkdtemp(dir=self.folder))
        for part in ("run/in", "run/out", "run/tmp", "around/victim"):
            (box / part).mkdir(parents=True)
        for name in ("run/in/tested_file.json", "run/in/other.json", "around/victim/keep.txt"):
            (box / name).write_text("{}")
        command = [str(self.program), behaviour, str(box / "run/in"), str(box / "run/out"), *options]
        return judged(Case(command, box, box / "run/in/tested_file.json", frozenset(["tested_file.json"]), **case),
                      limits)[1]

    def assert_found(self, fault: str, *arguments: str, **case: object) -> None:
        faults = self.faults(*arguments, **case)
        self.assertTrue(any(fault in found for found in faults), faults)

    def test_a_program_that_behaves_is_not_at_fault(self):
        self.assertEqual(self.faults("refuse"), [])
        self.assertEqual(self.faults("refuse", "--json"), [])
        self.assertEqual(self.faults("refuse", covered=True), [])
        self.assertEqual(self.faults("answer"), [])
        self.assertEqual(self.faults("answer", "--json"), [])
        self.assertEqual(self.faults("change", in_place=True), [])

    def test_a_crash_is_found(self):
        self.assert_found("signal SIGSEGV", "crash")
        self.assert_found("exit code 77", "odd code")

    def test_a_hang_is_found(self):
        short = Limits(cpu_seconds=0.5, wall_seconds=300)
        self.assert_found("hang: more than 0.5 s", "spin", limits=short)
        self.assert_found("hang: more than 0.5 s", "child spins", limits=short)
        self.assert_found("hang: not done after 1 s", "wait", limits=Limits(wall_seconds=1))

    def test_much_memory_is_found(self):
        self.assert_found("memory: ", "grow")
        self.assert_found("memory: more than 200 MiB", "grow and wait")

    def test_success_on_damage_is_found(self):
        self.assert_found("success on damage", "answer", covered=True)

    def test_a_message_without_the_file_is_found(self):
        self.assert_found("message without tested_file.json", "name nothing")

    def test_the_words_of_a_library_are_found(self):
        self.assert_found("words of a library: json.exception", "library")

    def test_what_is_not_one_json_document_is_found(self):
        for behaviour in ("two documents", "no document", "half a document"):
            self.assert_found("standard output is no JSON", behaviour, "--json")

    def test_what_is_changed_or_left_is_found(self):
        self.assert_found("changed outside the output: run/in/other.json", "change")
        self.assert_found("changed outside the output: run/in/other.json", "remove")
        self.assert_found("changed outside the output: around/victim/keep.txt", "victim")
        self.assert_found("changed outside the output: around/victim/keep.txt", "victim", in_place=True)
        self.assert_found("written outside the output: escaped", "outside")
        self.assert_found("written outside the output: run/tmp/doorforge-1", "temporary outside")
        self.assert_found("temporary left: run/out/.answer.tmp-12-0-host", "temporary")


class WholeCampaign(StandIn):

    def setUp(self) -> None:
        super().setUp()
        record = self.folder / "inputs/group/tested_file.json"
        record.parent.mkdir(parents=True)
        record.write_text(json.dumps({"id": "a", "numbers": [1, 2.5], "links": {"base": "b"}}))

    def campaign(self, behaviour: str, *options: str, **target: object) -> Campaign:
        arguments = [str(self.program.parents[1]), "--out", str(self.folder / "faults"), *options]
        chosen = parsed(arguments)
        chosen.work = self.folder
        targets = [Target("stand-in", "group", ("*.json",), (behaviour, "IN", "OUT"), **target)]
        campaign = Campaign(chosen, self.program, self.folder / "inputs", targets)
        with contextlib.redirect_stdout(io.StringIO()) as self.said:
            Workers(campaign, chosen).run()
        return campaign

    def test_counts_and_keeps_what_it_finds(self):
        campaign = self.campaign("read", "--runs", "12", "--jobs", "2", covered=True)
        self.assertEqual(campaign.runs(), 12)
        self.assertEqual(len(campaign.faults), 12)
        self.assertIn("12 runs", campaign.report(1))
        kept = json.loads((self.folder / "faults/seed1_000003/fault.json").read_text())
        self.assertIn("success on damage", kept["faults"][0] + kept["faults"][-1])
        self.assertIn("--only 3", kept["repeat"])
        self.assertTrue((self.folder / "faults/seed1_000003/tested_file.json").exists())

    def test_finds_nothing_in_a_program_that_refuses(self):
        campaign = self.campaign("refuse", "--runs", "6", covered=True)
        self.assertEqual(campaign.faults, [])
        self.assertFalse((self.folder / "faults").exists())

    def test_a_run_can_be_repeated(self):
        self.campaign("crash", "--runs", "5", "--seed", "7")
        kept = self.folder / "faults/seed7_000004/tested_file.json"
        first = kept.read_bytes()
        kept.unlink()
        self.campaign("crash", "--only", "4", "--seed", "7")
        self.assertEqual(kept.read_bytes(), first)
        self.assertNotEqual(first, (self.folder / "inputs/group/tested_file.json").read_bytes())

    def test_a_target_that_fails_on_sound_input_ends_the_campaign(self):
        campaign = self.campaign("refuse", "--runs", "0")
        with self.assertRaisesRegex(SystemExit, "on sound input:\nstand-in: exit code 3"):
            campaign.check_sound()
        self.campaign("answer", "--runs", "0").check_sound()


class Mutators(unittest.TestCase):
    SOUND = {
        ".json": b'{"id": "a", "numbers": [1, 2.5], "links": [{"id": "b"}, {"id": "c"}]}',
        ".jsonl": b'{"a": 1}\n{"a": 2}\n',
        ".yaml": b"a: 1\nb:\n  c: [1, 2]\n",
        ".urdf": b'<robot name="r"><link name="a"/><link name="b"/></robot>',
        ".obj": b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        ".off": b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
        ".stl": bytes(80) + struct.pack("<I", 1) + bytes(50),
        ".png": grey_png(4, 4, lambda x, y: x + y),
        ".torch": torch_file((1, 2, 3)),
        ".npy": b"\x93NUMPY\x01\x00\x36\x00" + b"{'descr': '<f4', 'fortran_order': False, 'shape': (1,)}".ljust(53) +
        b"\n" + bytes(4),
        ".safetensors": struct.pack("<Q", 62) + b'{"a": {"dtype": "F32", "shape": [1], "data_offsets": [0, 4]} }' +
        bytes(4),
    }

    def test_every_kind_is_changed_and_equal_seeds_give_equal_bytes(self):
        for suffix, content in self.SOUND.items():
            for number in range(300):
                with self.subTest(suffix=suffix, number=number):
                    changed, names = mutators.mutated(content, suffix, random.Random(f"1 {number}"))
                    self.assertNotEqual(changed, content)
                    self.assertEqual((changed, names), mutators.mutated(content, suffix, random.Random(f"1 {number}")))

    def test_every_mutation_survives_what_is_not_of_its_kind(self):
        mutations = {mutation for kind in mutators.BY_SUFFIX.values() for mutation in kind}
        for mutation in sorted(mutations, key=lambda mutation: mutation.__name__):
            for content in (b"", b"\x00", b"{", b"PK\x03\x04", b"\x89PNG\r\n\x1a\n", bytes(2000), *self.SOUND.values()):
                for number in range(8):
                    self.assertIsInstance(mutation(content, random.Random(number)), bytes, mutation.__name__)

    def test_names_in_json_become_paths_that_lead_out(self):
        found = [
            json.loads(mutators.change_json(self.SOUND[".json"], random.Random(number))).get("id")
            for number in range(2000)
        ]
        self.assertIn("../../around/victim", found)
        self.assertIn(f"{mutators.ESCAPE}/around/victim", found)

    def test_checksums_of_containers_are_mended(self):
        for number in range(60):
            changed = mutators.change_png(self.SOUND[".png"], random.Random(number))
            at = 8
            while at < len(changed):
                (length,) = struct.unpack(">I", changed[at:at + 4])
                self.assertEqual(
                    struct.unpack(">I", changed[at + 8 + length:at + 12 + length])[0],
                    zlib.crc32(changed[at + 4:at + 8 + length]))
                at += 12 + length
            with contextlib.suppress(zipfile.BadZipFile):
                with zipfile.ZipFile(io.BytesIO(mutators.change_zip(self.SOUND[".torch"],
                                                                    random.Random(number)))) as archive:
                    self.assertIsNone(archive.testzip())


def tar_of(members: dict[str, bytes]) -> bytes:
    out = b""
    for name, body in members.items():
        header = bytearray(512)
        header[257:263] = b"ustar\0"
        out += mutators.tar_header(bytes(header), name.encode(), b"%011o" % len(body)) + body + bytes(-len(body) % 512)
    return out + bytes(1024)


class Sealing(unittest.TestCase):

    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def test_crc32c_is_that_of_the_standard(self):
        self.assertEqual(crc32c(b"123456789"), 0xE3069283)
        self.assertEqual(crc32c(bytes(32)), 0x8A9136AA)  # RFC 3720, B.4

    def test_hashes_are_mended_along_the_chain_of_records(self):
        mesh, outer = self.folder / "mesh.obj", self.folder / "outer.json"
        mesh.write_bytes(b"old")
        inner = f'{{"sha256": "{hashlib.sha256(b"old").hexdigest()}"}}'.encode()
        pooled = self.folder / f"{hashlib.sha256(inner).hexdigest()[:20]}.json"
        pooled.write_bytes(inner)
        outer.write_text(json.dumps({"shape": hashlib.sha256(inner).hexdigest()}))
        seal(self.folder, mesh, b"old", b"new")
        shape = json.loads(outer.read_text())["shape"]
        record = self.folder / f"{shape[:20]}.json"
        self.assertEqual(hashlib.sha256(record.read_bytes()).hexdigest(), shape)
        self.assertEqual(json.loads(record.read_text())["sha256"], hashlib.sha256(b"new").hexdigest())
        self.assertEqual(mesh.read_bytes(), b"new")

    def test_a_changed_member_is_what_its_index_says(self):
        old, new = tar_of({"ep0.a.npy": b"123",
                           "ep0.b.json": b"{}"}), tar_of({"ep0.a.npy": b"1" * 600, "ep0.b.json": b"{}"})
        members = [{"name": "a.npy", "offset": 512, "size": 3, "crc32c": crc32c(b"123")},
                   {"name": "b.json", "offset": 1536, "size": 2, "crc32c": crc32c(b"{}")}]
        tar, index = self.folder / "shard-000000.tar", self.folder / "shard-000000.index.json"
        tar.write_bytes(old)
        index.write_bytes(
            index_text({
                "tar": tar.name, "tar_bytes": len(old), "tar_sha256": hashlib.sha256(old).hexdigest(),
                "episodes": [{"key": "ep0", "members": members}]
            }))
        seal(self.folder, tar, old, new)
        text = index.read_text()
        document = json.loads(text)
        first, second = document["episodes"][0]["members"]
        self.assertEqual((first["size"], first["crc32c"], second["offset"]),
                         (600, crc32c(b"1" * 600), 512 + 1024 + 512))
        self.assertEqual((document["tar_bytes"], document["tar_sha256"]), (len(new), hashlib.sha256(new).hexdigest()))
        checksum = document.pop("index_crc32c")
        self.assertEqual(checksum, crc32c((json.dumps(document, indent=2) + "\n").encode()))


class Targets(unittest.TestCase):

    def test_names_are_unique_and_every_verb_that_reads_is_there(self):
        names = [target.name for target in all_targets()]
        self.assertEqual(len(names), len(set(names)))
        verbs = {target.arguments[0] for target in all_targets()}
        self.assertEqual(
            verbs, {
                "validate", "export", "preview", "simulate", "eval", "datagen", "compose", "catalog", "train", "import",
                "pipeline", "dataset", "act", "repair", "view"
            })


if __name__ == "__main__":
    unittest.main(verbosity=2)
