"""Reports against the schemas that their readers go by, and read by readers of others."""

import json
import re
from pathlib import Path

import jsonschema
import pytest
from junitparser import JUnitXml
from lxml import etree

from tests.conftest import FIXTURES
from tests.report.test_findings_formats import HOSTILE, HOSTILE_NAMES, NAMELESS, WHEELS
from urdftool.control_characters import escape_controls

SCHEMAS = Path(__file__).parent / "schemas"
SARIF = jsonschema.Draft4Validator(json.loads((SCHEMAS / "sarif-2.1.0-rtm.4.json").read_text()))
JUNIT = etree.XMLSchema(etree.parse(str(SCHEMAS / "junit-10.xsd")))

jsonschema.Draft4Validator.check_schema(SARIF.schema)


@pytest.fixture
def runs(urdftool, write, xacro_file):
    """Command lines that bring out every part of a report."""
    macro = xacro_file("r.urdf.xacro", WHEELS)
    nameless = write("nameless.urdf", NAMELESS)
    urdftool("lint", nameless, "--write-baseline", "known.json")
    excused = write(
        "excused.urdf",
        '<robot> <!-- urdftool-ignore[missing-name] a test --><link name="a"/></robot>',
    )
    hostile = [write(name, HOSTILE.format("<link/>")) for name in HOSTILE_NAMES]
    return [
        [macro],
        [nameless, macro, "--baseline", "known.json"],
        [excused, "absent.urdf", write("broken.urdf", "<robot>")],
        [xacro_file("macros.urdf.xacro", '<xacro:macro name="m"/>')],
        hostile,
        [FIXTURES / "robots" / "demo_arm", FIXTURES / "robots" / "laser_bot"],
        [*sorted((FIXTURES / "rules").glob("*/bad.*urdf"))[::8]],
    ]


def test_sarif_is_as_the_standard_has_it(runs, urdftool):
    parts = set()
    for words in runs:
        log = json.loads(urdftool("lint", *words, "--format", "sarif").out)
        errors = [f"{list(e.path)}: {e.message}" for e in SARIF.iter_errors(log)]
        assert errors == []
        (run,) = log["runs"]
        parts |= {key for result in run["results"] for key in result}
        for result in run["results"]:
            assert run["tool"]["driver"]["rules"][result["ruleIndex"]]["id"] == result["ruleId"]
            for location in (*result["locations"], *result.get("relatedLocations", ())):
                uri = location["physicalLocation"]["artifactLocation"]["uri"]
                assert re.fullmatch(r"[A-Za-z0-9._~:/?#\[\]@!$&'()*+,;=%-]+", uri)
    assert parts >= {"relatedLocations", "partialFingerprints", "suppressions", "locations"}


def test_the_schema_refuses_what_is_none():
    log = {"version": "2.1.0", "runs": [{"tool": {"driver": {}}}]}
    assert list(SARIF.iter_errors(log))
    assert list(SARIF.iter_errors({"version": "2.1.0"}))


def test_junit_is_as_jenkins_has_it(runs, urdftool):
    for words in runs:
        result = urdftool("lint", *words, "--format", "junit")
        assert JUNIT.validate(etree.fromstring(result.out.encode())), JUNIT.error_log
        read = JUnitXml.fromstring(result.out.encode())
        cases = [case for suite in read for case in suite]
        kinds = [type(r).__name__ for case in cases for r in case.result]
        assert (read.tests, read.failures, read.errors) == (
            *(len(cases), kinds.count("Failure"), kinds.count("Error")),
        )
        assert (result.code == 0) == (read.failures + read.errors == 0)


def unescaped(line):
    """An annotation as the runner of GitHub Actions reads it: properties, and the message."""
    match = re.fullmatch(r"::(error|warning|notice) ([^:]*)::(.*)", line)
    assert match is not None, line
    data = match[3].replace("%0D", "\r").replace("%0A", "\n").replace("%25", "%")
    properties = {}
    for pair in match[2].split(","):
        key, _, value = pair.partition("=")
        for code, text in (("%0D", "\r"), ("%0A", "\n"), ("%3A", ":"), ("%2C", ","), ("%25", "%")):
            value = value.replace(code, text)
        properties[key] = value
    return match[1], properties, data


def test_annotations_come_back_as_they_were(runs, urdftool):
    for words in runs:
        table = json.loads(urdftool("lint", *words, "--format", "json").out)
        lines = urdftool("lint", *words, "--format", "github").out.splitlines()
        unreadable = [line for line in lines if "title=not-checked" in line]
        assert len(unreadable) == len(table["summary"]["unreadable"])
        lines = [line for line in lines if line not in unreadable]
        assert len(lines) == len(table["findings"])
        for line, finding in zip(lines, table["findings"], strict=True):
            level, properties, message = unescaped(line)
            assert level == {"info": "notice"}.get(finding["severity"], finding["severity"])
            assert properties["title"] == finding["rule"]
            assert (properties["file"], properties["line"]) == (
                *(escape_controls(finding["path"], "\r\n"), str(finding["line"])),
            )
            first = re.sub(r" \(in \d+ expansions\)$", "", message.splitlines()[0])
            assert first.startswith(finding["message"][:20])
