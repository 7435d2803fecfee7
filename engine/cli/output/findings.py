"""Formats findings for other programs: JSON, GitHub annotations, SARIF 2.1.0."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from importlib.metadata import version
from urllib.parse import quote

import msgspec

from engine.check import CODES, Finding, page_name, page_text
from engine.errors import FlexcellError


def as_json(findings: Sequence[Finding]) -> str:
    """Return the findings as a JSON list."""
    return msgspec.json.encode(
        [
            {
                "file": finding.position.file,
                "line": finding.position.line,
                "column": finding.position.column,
                "severity": finding.severity,
                "code": finding.code,
                "path": finding.path,
                "message": finding.message,
                "hint": finding.hint,
                "page": page_name(finding.code),
            }
            for finding in findings
        ]
    ).decode()


def as_github(finding: Finding) -> str:
    """Return one finding as a GitHub workflow command, escaped as the format requires."""
    position = finding.position
    place = (
        f"file={_property(position.file)},line={position.line},col={position.column},title={_property(finding.code)}"
    )
    return f"::{finding.severity} {place}::{_data(_text(finding))}"


def as_sarif(findings: Sequence[Finding]) -> str:
    """Return the findings as one SARIF 2.1.0 log, with the reference page of each finding code in it."""
    codes = sorted({finding.code for finding in findings})
    numbers = {code: number for number, code in enumerate(codes)}
    driver = {
        "name": "flexcell",
        "version": version("flexcell"),
        "semanticVersion": version("flexcell"),
        "rules": [_rule(code) for code in codes],
    }
    run = {
        "tool": {"driver": driver},
        # Columns count characters; by default, readers interpret them as UTF-16 code units.
        "columnKind": "unicodeCodePoints",
        "results": [_result(finding, numbers) for finding in findings],
    }
    log = {"$schema": "https://json.schemastore.org/sarif-2.1.0.json", "version": "2.1.0", "runs": [run]}
    return msgspec.json.encode(log).decode()


def _rule(code: str) -> dict[str, object]:
    severity, meaning = CODES[code]
    return {
        "id": code,
        "name": "".join(word.capitalize() for word in code.split("-")),
        "shortDescription": {"text": meaning},
        "defaultConfiguration": {"level": severity},
        "help": _help(code),
        # `helpUri` must be absolute, but each project serves the pages at a different address.
        "properties": {"page": page_name(code)},
    }


def _help(code: str) -> dict[str, str]:
    brief = f"{CODES[code][1]}; see {page_name(code)}, or `flexcell check --explain {code}`"
    try:
        return {"text": brief, "markdown": page_text(code)}
    except FlexcellError:
        return {"text": brief}


def _result(finding: Finding, numbers: Mapping[str, int]) -> dict[str, object]:
    position = finding.position
    place: dict[str, object] = {
        "physicalLocation": {
            "artifactLocation": {"uri": quote(position.file.replace("\\", "/"))},
            "region": {"startLine": position.line, "startColumn": position.column},
        }
    }
    if finding.path:
        place["logicalLocations"] = [{"fullyQualifiedName": finding.path, "kind": "member"}]
    return {
        "ruleId": finding.code,
        "ruleIndex": numbers[finding.code],
        "level": finding.severity,
        "message": {"text": _text(finding)},
        "locations": [place],
    }


def _text(finding: Finding) -> str:
    return f"{finding.message} ({finding.hint})" if finding.hint else finding.message


def _data(text: str) -> str:
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _property(text: str) -> str:
    return _data(text).replace(":", "%3A").replace(",", "%2C")
