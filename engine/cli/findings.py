"""Prints findings for machines: JSON, GitHub annotations, SARIF 2.1.0."""

from __future__ import annotations

from collections.abc import Sequence
from importlib.metadata import version

import msgspec

from engine.check import Finding


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
            }
            for finding in findings
        ]
    ).decode()


def as_github(finding: Finding) -> str:
    """Return one finding as a workflow command, with the escapes that those ask for."""
    position = finding.position
    place = (
        f"file={_property(position.file)},line={position.line},col={position.column},title={_property(finding.code)}"
    )
    text = f"{finding.message} ({finding.hint})" if finding.hint else finding.message
    return f"::{finding.severity} {place}::{_data(text)}"


def as_sarif(findings: Sequence[Finding]) -> str:
    """Return the findings as one SARIF 2.1.0 log."""
    rules = [{"id": code} for code in sorted({finding.code for finding in findings})]
    log = {
        "$schema": "https://json.schemastore.org/sarif-2.1.0.json",
        "version": "2.1.0",
        "runs": [
            {
                "tool": {"driver": {"name": "flexcell", "version": version("flexcell"), "rules": rules}},
                "results": [_sarif_result(finding) for finding in findings],
            }
        ],
    }
    return msgspec.json.encode(log).decode()


def _sarif_result(finding: Finding) -> dict[str, object]:
    position = finding.position
    return {
        "ruleId": finding.code,
        "level": finding.severity,
        "message": {"text": f"{finding.message} ({finding.hint})" if finding.hint else finding.message},
        "locations": [
            {
                "physicalLocation": {
                    "artifactLocation": {"uri": position.file},
                    "region": {"startLine": position.line, "startColumn": position.column},
                },
                "logicalLocations": [{"fullyQualifiedName": finding.path}],
            }
        ],
    }


def _data(text: str) -> str:
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _property(text: str) -> str:
    return _data(text).replace(":", "%3A").replace(",", "%2C")
