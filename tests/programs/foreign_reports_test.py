# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Reports of `doorforge validate` for other programs, settings and baselines, each judged by a reader of its own."""
import base64
import html.parser
import json
import pathlib
import re
import unittest
import xml.etree.ElementTree
import zlib

import jsonschema
import yaml

import foreign_samples as samples
from programs import SOURCE, ProgramTest, run

# What SARIF 2.1.0 (OASIS) demands of the objects that are written, by its sections 3.13 to 3.54.
SARIF = {
    "type": "object", "required": ["version", "runs"],
    "properties": {
        "version": {"const": "2.1.0"}, "$schema": {"type": "string", "format": "uri"},
        "runs": {"type": "array", "items": {
            "type": "object", "required": ["tool", "results"],
            "additionalProperties": False,
            "properties": {
                "tool": {"type": "object", "required": ["driver"], "properties": {"driver": {
                    "type": "object", "required": ["name"], "properties": {
                        "name": {"type": "string"}, "version": {"type": "string"},
                        "rules": {"type": "array", "uniqueItems": True, "items": {
                            "type": "object", "required": ["id"], "properties": {
                                "id": {"type": "string"}, "shortDescription": {"$ref": "#/$defs/message"},
                                "help": {"$ref": "#/$defs/message"}, "properties": {"type": "object"},
                                "defaultConfiguration": {"type": "object", "properties": {"level": {"$ref": "#/$defs/level"}}}},
                            "additionalProperties": False}}},
                    "additionalProperties": False}}},
                "columnKind": {"enum": ["utf16CodeUnits", "unicodeCodePoints"]},
                "invocations": {"type": "array", "items": {
                    "type": "object", "required": ["executionSuccessful"],
                    "properties": {"executionSuccessful": {"type": "boolean"}, "toolExecutionNotifications": {"type": "array"}},
                    "additionalProperties": False}},
                "results": {"type": "array", "items": {
                    "type": "object", "required": ["message"], "additionalProperties": False,
                    "properties": {
                        "ruleId": {"type": "string"}, "ruleIndex": {"type": "integer", "minimum": -1},
                        "level": {"$ref": "#/$defs/level"}, "message": {"$ref": "#/$defs/message"},
                        "partialFingerprints": {"type": "object", "additionalProperties": {"type": "string"}},
                        "locations": {"type": "array", "items": {"type": "object", "additionalProperties": False, "properties": {
                            "physicalLocation": {"type": "object", "required": ["artifactLocation"], "additionalProperties": False,
                                                 "properties": {
                                "artifactLocation": {"type": "object", "properties": {"uri": {
                                    "type": "string", "pattern": r"^([A-Za-z0-9._~/:-]|%[0-9A-F]{2})+$"}}},
                                "region": {"type": "object", "required": ["startLine"], "additionalProperties": False, "properties": {
                                    "startLine": {"type": "integer", "minimum": 1}, "startColumn": {"type": "integer", "minimum": 1}}}}},
                            "logicalLocations": {"type": "array", "items": {"type": "object", "properties": {
                                "fullyQualifiedName": {"type": "string"}}}}}}}}}}}}}},
    "$defs": {"level": {"enum": ["none", "note", "warning", "error"]},
              "message": {"type": "object", "required": ["text"], "properties": {"text": {"type": "string", "minLength": 1}}}},
}


class Page(html.parser.HTMLParser):
    def __init__(self, text: str):
        super().__init__()
        self.tags, self.text = [], []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))

    def handle_data(self, data):
        self.text.append(data)


class ForeignReports(ProgramTest):
    def setUp(self) -> None:
        super().setUp()
        self.good = self.write("good gate.urdf", samples.URDF)
        bad = samples.URDF.replace('mass value="20"', 'mass value="-20"').replace('axis xyz="0 0 -1"', 'axis xyz="0 0 -2"')
        self.bad = self.write("bad.urdf", bad)

    def write(self, name: str, text: str) -> pathlib.Path:
        (self.folder / "meshes").mkdir(exist_ok=True)
        (self.folder / "meshes/box.obj").write_text(samples.OBJ)
        (self.folder / "meshes/box.stl").write_text(samples.STL)
        (self.folder / name).write_text(text)
        return self.folder / name

    def report(self, form: str, code: int = 1, *more: object) -> str:
        result = run("validate", self.folder, "--format", form, *more)
        self.assert_ends(result, code)
        return result.stdout

    def schema(self, name: str) -> dict:
        result = run("schema", name)
        self.assert_ends(result, 0)
        return json.loads(result.stdout)

    def test_text_lists_what_passed(self):
        text = self.report("text")
        self.assertIn("good gate.urdf: urdf, passed", text)
        self.assertIn("2 files: 1 error, 1 warning", text)
        self.assertRegex(text, r"INR001 error +\S+/bad.urdf:14:13: /robot/link\[@name='leaf'\]/inertial/mass/@value")

    def test_json_follows_its_schema(self):
        report = json.loads(self.report("json"))
        jsonschema.validate(report, self.schema("validation"))
        self.assertEqual([item["status"] for item in report["items"]], ["failed", "passed"])
        finding = next(f for f in report["items"][0]["findings"] if f["code"] == "JNT002")
        self.assertEqual((finding["value"], finding["limit"]), (2, 0.001))
        rules = json.loads(run("validate", "--rules", "--json").stdout)
        jsonschema.validate(rules, self.schema("validation_rules"))

    def test_sarif_follows_the_standard(self):
        sarif = json.loads(self.report("sarif"))
        jsonschema.validate(sarif, SARIF)
        results = sarif["runs"][0]["results"]
        rules = sarif["runs"][0]["tool"]["driver"]["rules"]
        self.assertEqual([(r["ruleId"], r["level"]) for r in results], [("JNT002", "warning"), ("INR001", "error")])
        for result in results:
            self.assertEqual(rules[result["ruleIndex"]]["id"], result["ruleId"])
        # a line more above moves the finding and not its fingerprint
        self.bad.write_text(self.bad.read_text().replace("<robot", "<!-- a line\n more -->\n<robot", 1))
        moved = json.loads(self.report("sarif"))["runs"][0]["results"]
        self.assertEqual([r["partialFingerprints"] for r in moved], [r["partialFingerprints"] for r in results])
        lines = [[r["locations"][0]["physicalLocation"]["region"]["startLine"] for r in part] for part in (results, moved)]
        self.assertEqual([line + 2 for line in lines[0]], lines[1])

    def test_junit_has_a_case_an_item(self):
        suite = xml.etree.ElementTree.fromstring(self.report("junit")).find("testsuite")
        self.assertEqual((suite.get("tests"), suite.get("failures")), ("2", "1"))
        cases = suite.findall("testcase")
        self.assertEqual([len(case.findall("failure")) for case in cases], [1, 0])
        self.assertIn("JNT002", self.report("json"))
        self.assertIn("Axes have unit length", cases[0].find("system-out").text)
        strict = xml.etree.ElementTree.fromstring(self.report("junit", 1, "--fail-on", "warning"))
        self.assertEqual(len(strict.findall(".//failure")), 2)

    def test_github_marks_lines(self):
        lines = self.report("github").splitlines()
        command = re.compile(r"::(error|warning|notice) file=([^,:]+),line=(\d+),col=(\d+),title=([A-Z]{3}\d{3})::.+")
        found = [command.fullmatch(line) for line in lines]
        self.assertEqual([match[5] for match in found], ["JNT002", "INR001"])
        for match in found:
            self.assertTrue(pathlib.Path(match[2]).exists())

    def test_html_is_a_page_without_requests(self):
        evil = samples.URDF.replace('name="leaf"', 'name="&lt;script&gt;alert(1)&lt;/script&gt;"').replace('link="leaf"', 'link="lef"')
        self.write("evil.urdf", evil)
        text = self.report("html")
        page = Page(text)
        policy = next(attributes["content"] for tag, attributes in page.tags if attributes.get("http-equiv") == "Content-Security-Policy")
        self.assertTrue(policy.startswith("default-src 'none';"), policy)
        self.assertFalse([attributes for _, attributes in page.tags if "src" in attributes or attributes.get("href", "data:,") != "data:,"])
        content = zlib.decompress(base64.b64decode(re.search(r'id="content">([^<]*)<', text)[1]))
        document = json.loads(content[4:4 + int.from_bytes(content[:4], "little")])
        self.assertEqual(document["kind"], "findings")
        findings = [finding for item in document["items"] for finding in item["findings"]]
        self.assertIn("INR001", [finding["code"] for finding in findings])
        self.assertTrue([finding for finding in findings if "lef" in finding["measured"] + finding["where"]])

    def test_fail_on_ignore_and_severity(self):
        for arguments, code in (([], 1), (["--fail-on", "never"], 0), (["--ignore", "INR001"], 0), (["--ignore", "INR"], 0),
                                (["--ignore", "INR001", "--fail-on", "warning"], 1), (["--severity", "INR001=info"], 0),
                                (["--ignore", "INR001", "--severity", "JNT002=error"], 1), (["--expect", "2"], 1),
                                (["--expect", "3"], 4)):
            self.assert_ends(run("validate", self.folder, *arguments), code)
        for arguments in (["--ignore", "INR999"], ["--severity", "INR001=bad"], ["--fail-on", "x"], ["--format", "xml"],
                          ["--ask", "someone"], ["--package", "name"]):
            self.assert_refused(run("validate", self.folder, *arguments), 2)

    def test_the_nearest_settings_count(self):
        settings = {"ignore": ["INR001"], "exclude": ["old"], "fail_on": "warning", "ask": []}
        jsonschema.validate(settings, self.schema("validation_settings"))
        (self.folder / ".doorforge-validate.yaml").write_text(yaml.safe_dump(settings))
        (self.folder / "old").mkdir()
        (self.folder / "old/worse.urdf").write_text("<robot/>")
        report = json.loads(self.report("json"))
        self.assertEqual([finding["code"] for finding in report["findings"]], ["JNT002"])
        self.assertIn("urdfdom was not asked", report["items"][0]["notes"])
        for text in ("ignore: [INR999]", "ignor: [INR001]", "fail_on: sometimes", "- a list"):
            (self.folder / ".doorforge-validate.yaml").write_text(text)
            result = run("validate", self.folder)
            self.assert_refused(result, 2)
            self.assertIn(".doorforge-validate.yaml", result.stderr)

    def test_a_baseline_hides_what_is_known_and_nothing_new(self):
        baseline = self.folder / "known.json"
        self.report("json", 1, "--write-baseline", baseline)
        jsonschema.validate(json.loads(baseline.read_text()), self.schema("validation_baseline"))
        self.assertIn("2 findings of the baseline left out", self.report("text", 0, "--baseline", baseline))
        self.bad.write_text(self.bad.read_text().replace('effort="30"', 'effort="-30"'))
        report = json.loads(self.report("json", 1, "--baseline", baseline))
        self.assertEqual([finding["code"] for finding in report["findings"]], ["JNT007"])

    def test_second_opinions_take_what_passes(self):
        (self.folder / "gate.mjcf").write_text(samples.MJCF)
        items = {pathlib.Path(item["path"]).name: item for item in json.loads(self.report("json"))["items"]}
        self.assertTrue(any(re.fullmatch(r"urdfdom \S+ takes it", note) for note in items["good gate.urdf"]["notes"]))
        self.assertTrue(any(re.fullmatch(r"MuJoCo \S+ takes it", note) for note in items["gate.mjcf"]["notes"]))
        (self.folder / "gate.mjcf").write_text(samples.MJCF.replace("<geom ", '<geom smell="x" ', 1))
        items = {pathlib.Path(item["path"]).name: item for item in json.loads(self.report("json"))["items"]}
        self.assertEqual([finding["code"] for finding in items["gate.mjcf"]["findings"]], ["EXT002"])
        self.assertIn("MuJoCo", items["gate.mjcf"]["findings"][0]["measured"])

    def test_hinge_and_handle_are_named_or_found_and_said(self):
        notes = json.loads(self.report("json"))["items"][1]["notes"]
        self.assertTrue(any('the hinge is joint "hinge"' in note for note in notes))
        self.assertTrue(any('the handle is link "lever"' in note for note in notes))
        result = run("validate", self.good, "--hinge", "none", "--format", "json")
        self.assertEqual([finding["code"] for finding in json.loads(result.stdout)["findings"]], ["TRE011"])
        self.assert_ends(run("validate", self.good, "--hinge", "hinge", "--handle", "lever"), 0)

    def test_hook_and_action_call_what_there_is(self):
        hook = yaml.safe_load((SOURCE / ".pre-commit-hooks.yaml").read_text())[0]
        self.assertEqual(hook["entry"], "doorforge validate")
        self.assertTrue(re.search(hook["files"], "robots/gate.urdf") and re.search(hook["files"], "doors/a/door.json"))
        action = yaml.safe_load((SOURCE / "action.yml").read_text())
        text = action["runs"]["steps"][0]["run"]
        help_text = run("validate", "--help").stdout
        for option in re.findall(r"--[a-z-]+", text):
            self.assertIn(option, help_text)
        # pre-commit hands files over one by one, a door's record among them
        self.assert_ends(run("validate", self.good, self.bad), 1)


if __name__ == "__main__":
    unittest.main()
