"""Checks a behavior written in a test with the standard states and returns its findings in short form."""

from __future__ import annotations

from pathlib import Path
from textwrap import dedent

from engine.check import Finding, check_behavior, check_file
from engine.document import parse_behavior
from engine.registry import load_states

CATALOGUE = load_states()
HEAD = "flexcell: 1\nname: test\noutcomes: [good, bad]\nsuccess: [good]\n"


def findings_in(text: str) -> tuple[Finding, ...]:
    """Check a document; text without `flexcell:` gets a head, without findings about unused outcomes."""
    body = dedent(text)
    whole = body if "flexcell:" in body else HEAD + body
    found = check_behavior(parse_behavior(whole, file="test.yaml"), CATALOGUE)
    return tuple(finding for finding in found if finding.code != "unused-outcome")


def code_paths(text: str) -> list[str]:
    """Check a document and return `code path` of each finding."""
    return [f"{finding.code} {finding.path}" for finding in findings_in(text)]


def message_of(text: str) -> str:
    """Check a document with exactly one finding and return its message."""
    (finding,) = findings_in(text)
    return finding.message


def findings_in_files(folder: Path, **files: str) -> tuple[Finding, ...]:
    """Write documents into a folder and check the one named `main`."""
    for name, text in files.items():
        body = dedent(text)
        (folder / f"{name}.yaml").write_text(body if "flexcell:" in body else HEAD + body, encoding="utf-8")
    found = check_file(folder / "main.yaml", CATALOGUE)
    return tuple(finding for finding in found if finding.code != "unused-outcome")
