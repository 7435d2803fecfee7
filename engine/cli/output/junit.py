"""Writes JUnit XML (xunit2), readable by Jenkins, GitLab and GitHub."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from engine.errors import FlexcellError

_ILLEGAL = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
"""Characters that XML 1.0 cannot represent, not even escaped; a message of a state may contain any of them."""


@dataclass(frozen=True, kw_only=True)
class JunitProblem:
    """Why a case did not pass: a `failure` is an unexpected outcome, an `error` is a run without outcome."""

    kind: Literal["failure", "error"]
    type: str
    message: str
    """One line."""
    text: str = ""


@dataclass(frozen=True, kw_only=True)
class JunitCase:
    """One test case; the dotted `classname` groups cases."""

    name: str
    classname: str
    time_s: float
    problem: JunitProblem | None = None


@dataclass(frozen=True, kw_only=True)
class JunitSuite:
    """A group of cases, with properties that describe it."""

    name: str
    file: str
    cases: Sequence[JunitCase]
    properties: Mapping[str, str] = field(default_factory=dict[str, str])


def write_junit(path: Path, suites: Iterable[JunitSuite]) -> None:
    """Write the file.

    Raises:
        FlexcellError: the file cannot be written.
    """
    try:
        path.write_bytes(junit_xml(suites))
    except OSError as error:
        reason = error.strerror or str(error)
        raise FlexcellError(f"the JUnit file cannot be written: {reason}", where=path) from error


def junit_xml(suites: Iterable[JunitSuite]) -> bytes:
    """Return the XML."""
    root = ET.Element("testsuites", name="flexcell")
    for suite in suites:
        _add_suite(root, suite)
    ET.indent(root)
    return ET.tostring(root, encoding="utf-8", xml_declaration=True) + b"\n"


def class_name(path: Path | str) -> str:
    """Return a file's path as a class name: `behaviors/pick.yaml` → `behaviors.pick`."""
    return ".".join(part for part in Path(path).with_suffix("").parts if part not in ("/", ".", ".."))


def _add_suite(root: ET.Element, suite: JunitSuite) -> None:
    element = ET.SubElement(
        root,
        "testsuite",
        name=_legal(suite.name),
        tests=str(len(suite.cases)),
        failures=str(_count(suite.cases, "failure")),
        errors=str(_count(suite.cases, "error")),
        skipped="0",
        time=f"{sum(case.time_s for case in suite.cases):.3f}",
        file=_legal(suite.file),
    )
    if suite.properties:
        properties = ET.SubElement(element, "properties")
        for name, value in suite.properties.items():
            ET.SubElement(properties, "property", name=_legal(name), value=_legal(value))
    for case in suite.cases:
        _add_case(element, case)


def _add_case(suite: ET.Element, case: JunitCase) -> None:
    element = ET.SubElement(
        suite, "testcase", classname=_legal(case.classname), name=_legal(case.name), time=f"{case.time_s:.3f}"
    )
    problem = case.problem
    if problem is not None:
        report = ET.SubElement(element, problem.kind, type=problem.type, message=_legal(problem.message))
        report.text = _legal(problem.text or problem.message)


def _count(cases: Sequence[JunitCase], kind: str) -> int:
    return sum(case.problem is not None and case.problem.kind == kind for case in cases)


def _legal(text: str) -> str:
    return _ILLEGAL.sub("\ufffd", text)
