"""Findings for machines: the forms that CI systems read are well formed whatever the findings say."""

from __future__ import annotations

import json
from typing import Any

import jsonschema
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.check import CODES, Finding
from engine.check.finding import new_finding
from engine.cli.output.findings import as_github, as_json, as_sarif
from engine.errors import Position

SARIF: dict[str, Any] = {
    "type": "object",
    "required": ["version", "runs"],
    "properties": {
        "version": {"const": "2.1.0"},
        "runs": {
            "type": "array",
            "items": {
                "type": "object",
                "required": ["tool"],
                "additionalProperties": False,
                "properties": {
                    "columnKind": {"enum": ["utf16CodeUnits", "unicodeCodePoints"]},
                    "tool": {"$ref": "#/$defs/tool"},
                    "results": {"type": "array", "items": {"$ref": "#/$defs/result"}},
                },
            },
        },
    },
    "$defs": {
        "message": {"type": "object", "required": ["text"], "properties": {"text": {"type": "string", "minLength": 1}}},
        "level": {"enum": ["none", "note", "warning", "error"]},
        "tool": {
            "required": ["driver"],
            "properties": {
                "driver": {
                    "required": ["name"],
                    "properties": {
                        "semanticVersion": {"type": "string", "pattern": r"^\d+\.\d+\.\d+"},
                        "rules": {"type": "array", "uniqueItems": True, "items": {"$ref": "#/$defs/rule"}},
                    },
                }
            },
        },
        "rule": {
            "required": ["id", "shortDescription", "help"],
            "additionalProperties": False,
            "properties": {
                "id": {"type": "string"},
                "name": {"type": "string", "pattern": "^[A-Z][A-Za-z]+$"},
                "shortDescription": {"$ref": "#/$defs/message"},
                "help": {"$ref": "#/$defs/message"},
                "defaultConfiguration": {"properties": {"level": {"$ref": "#/$defs/level"}}},
                "properties": {"type": "object"},
            },
        },
        "result": {
            "required": ["message", "ruleId", "ruleIndex"],
            "additionalProperties": False,
            "properties": {
                "ruleId": {"type": "string"},
                "ruleIndex": {"type": "integer", "minimum": 0},
                "level": {"$ref": "#/$defs/level"},
                "message": {"$ref": "#/$defs/message"},
                "locations": {"type": "array", "items": {"$ref": "#/$defs/location"}},
            },
        },
        "location": {
            "additionalProperties": False,
            "properties": {
                "physicalLocation": {
                    "properties": {
                        "artifactLocation": {"properties": {"uri": {"type": "string", "pattern": "^[!-~]*$"}}},
                        "region": {
                            "required": ["startLine"],
                            "properties": {
                                "startLine": {"type": "integer", "minimum": 1},
                                "startColumn": {"type": "integer", "minimum": 1},
                            },
                        },
                    }
                },
                "logicalLocations": {
                    "items": {"properties": {"fullyQualifiedName": {"type": "string", "minLength": 1}}}
                },
            },
        },
    },
}
"""The rules of SARIF 2.1.0 for the parts that are used, closed to anything else."""

TEXTS = st.text(min_size=1, max_size=20)


def some_finding(code: str, message: str, path: str, file: str, line: int, hint: str) -> Finding:
    """Make a finding with anything in it."""
    return new_finding(code, message, path=path, position=Position(file=file, line=line, column=line), hint=hint)


FINDINGS = st.builds(
    some_finding,
    st.sampled_from(sorted(CODES)),
    TEXTS,
    st.sampled_from(["", "root", "root/go"]),
    TEXTS,
    st.integers(1, 10**6),
    st.just("") | TEXTS,
)


@given(st.lists(FINDINGS, max_size=5))
def test_a_sarif_log_keeps_to_the_standard(findings: list[Finding]) -> None:
    """Each result refers to its rule by name and by place in the list."""
    log = json.loads(as_sarif(findings))
    jsonschema.validate(log, SARIF)
    (run,) = log["runs"]
    rules = run["tool"]["driver"]["rules"]
    assert [rules[result["ruleIndex"]]["id"] for result in run["results"]] == [finding.code for finding in findings]
    assert [result["level"] for result in run["results"]] == [finding.severity for finding in findings]


@pytest.mark.parametrize("code", sorted(CODES))
def test_a_rule_brings_its_page(code: str) -> None:
    """So that a viewer shows it beside the result."""
    finding = new_finding(code, "something", path="root", position=Position(file="a b.yaml", line=1, column=1))
    (run,) = json.loads(as_sarif([finding]))["runs"]
    (rule,) = run["tool"]["driver"]["rules"]
    assert rule["help"]["markdown"].startswith(f"# `{code}`")
    assert rule["properties"] == {"page": f"docs/findings/{code}.md"}
    assert run["results"][0]["locations"][0]["physicalLocation"]["artifactLocation"]["uri"] == "a%20b.yaml"


@given(FINDINGS)
def test_a_workflow_command_is_one_line(finding: Finding) -> None:
    """Line breaks and separators inside are escaped."""
    line = as_github(finding)
    assert "\n" not in line
    assert "\r" not in line
    command, _, message = line.removeprefix("::").partition("::")
    assert command.startswith(f"{finding.severity} file=")
    assert command.count(",") == 3
    assert message


@given(st.lists(FINDINGS, max_size=3))
def test_json_has_everything(findings: list[Finding]) -> None:
    """One mapping for each finding, in order."""
    told = json.loads(as_json(findings))
    assert [(each["code"], each["message"], each["line"]) for each in told] == [
        (finding.code, finding.message, finding.position.line) for finding in findings
    ]
