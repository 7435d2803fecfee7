"""A finding: a defect of a behavior, its position, and what to do; `CODES` lists all kinds.

Each kind has a page, `docs/findings/<code>.md`, with its meaning and how to fix it.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Literal

import msgspec

from engine.errors import DocumentError, Position

Severity = Literal["error", "warning"]

CODES: Mapping[str, tuple[Severity, str]] = {
    "invalid-document": ("error", "the file is not a valid behavior document"),
    "circular-behavior": ("error", "behaviors refer to each other in a cycle"),
    "invalid-cell": ("error", "the cell of the behavior, or its entries, cannot be read"),
    "unknown-state": ("error", "no state has this name, or its class is invalid"),
    "outdated-state": (
        "warning",
        "the file of a state class has changed and cannot be loaded; the class from before is used",
    ),
    "module-not-allowed": ("error", "a document names a class of a module that the project does not allow"),
    "broken-behaviour": ("error", "a py_trees behaviour cannot be loaded, or is not a behaviour class"),
    "unknown-parameter": ("error", "the state or behavior has no such parameter"),
    "missing-parameter": ("error", "a required parameter is missing"),
    "bad-parameter": ("error", "a given parameter has the wrong type or is out of range"),
    "unknown-input": ("error", "the state or behavior has no such input key"),
    "unknown-output": ("error", "the state or behavior has no such output key"),
    "undefined-key": ("error", "a userdata key is read before it is defined"),
    "maybe-undefined-key": ("warning", "a userdata key is read that is undefined on some path"),
    "type-mismatch": ("error", "a value has a type that its reader does not accept"),
    "maybe-type-mismatch": ("warning", "on some path a value has a type that its reader does not accept"),
    "parallel-writers": ("warning", "concurrent branches write the same userdata key"),
    "sibling-read": ("warning", "a branch reads a userdata key that a concurrent branch writes"),
    "bad-expression": ("error", "an expression is malformed or too expensive"),
    "undeclared-name": ("error", "an expression uses a name that is neither a parameter nor a userdata key"),
    "missing-entry": ("warning", "a named entry is not among the known entries, or has another kind"),
    "unknown-in-cell": ("error", "the cell has no item of this kind and name"),
    "maybe-unknown-in-cell": ("warning", "a name is not in the cell, on some path or until a run adds it"),
    "unreachable-joints": ("error", "joint angles do not match the number of joints or the joint limits of the arm"),
    "unreachable-target": ("warning", "an arm of the cell cannot reach a target"),
    "target-in-collision": ("warning", "an arm at a target collides with itself or with a fixture of the cell"),
    "collision-at-rest": ("warning", "bodies of a cell touch, or an arm nearly does, before anything has moved"),
    "missing-unit": ("warning", "a parameter without a unit is passed to one that has a unit"),
    "unit-mismatch": ("warning", "a parameter is passed to one that has another unit"),
    "suspect-unit": ("warning", "a number is so large that its unit is probably wrong"),
    "range-too-wide": ("warning", "a parameter allows values that the parameter it is passed to refuses"),
    "unknown-model": ("error", "no robot or gripper model has this name, or its folder cannot be used"),
    "unusable-mesh": ("error", "the mesh of a fixture is not there, cannot be read, or has no volume"),
    "suspect-mesh": ("warning", "a mesh is open, or so large or small that its unit is probably wrong"),
    "person-beyond-map": ("warning", "separation monitoring does not measure a person who stands beyond the map"),
    "unseen-space-accepted": ("warning", "motions may pass through space that no camera of the cell has seen"),
    "unknown-driver": ("error", "no driver has this name"),
    "unfit-driver": ("error", "the driver drives another kind of device or another model"),
    "bad-driver-option": ("error", "an option of a driver is unknown, missing or invalid"),
    "beyond-driver": ("error", "a state needs more than the driver of its device can do"),
    "bad-declaration": ("error", "a parameter of the behavior is declared inconsistently"),
    "required-parameter": ("warning", "a parameter of the behavior has no default, so each run must set it"),
    "unused-parameter": ("warning", "a parameter of the behavior is not used"),
    "unknown-success": ("error", "`success` names an outcome that is not declared"),
    "unknown-outcome": ("error", "the node does not have this outcome"),
    "unknown-target": ("error", "a transition leads to a name that does not exist"),
    "unconnected-outcome": ("error", "an outcome of a node is not connected"),
    "ambiguous-target": ("error", "a name is both a state and an outcome of a machine"),
    "missing-initial": ("error", "the initial state of a machine does not exist"),
    "unreachable-node": ("warning", "no transition leads to a node"),
    "no-path-to-outcome": ("warning", "from a node no outcome of the machine can be reached"),
    "instant-loop": ("error", "a loop in which no time passes and nothing changes"),
    "never-ends": ("error", "a part of a tree never ends, whatever the status of its child"),
    "restarted-children": ("warning", "a parallel restarts children that have succeeded until all succeed in one tick"),
    "unwatched-check": ("warning", "a check is not repeated while the action behind it runs"),
    "idle-every": ("warning", "`every` has no effect"),
    "unused-outcome": ("warning", "a declared or connected outcome never occurs"),
    "unknown-child": ("error", "a condition names a child that does not exist"),
    "preempts-itself": ("error", "a condition preempts a child that has already ended when it holds"),
    "uncovered-combination": ("error", "all children may end in a combination that no condition covers"),
    "combinations-not-checked": ("warning", "there are too many combinations of child outcomes to check"),
    "shared-resource": ("error", "concurrent nodes command the same device"),
    "constant-guard": ("warning", "a guard is always open or always closed"),
    "idle-retry": ("warning", "`retry` has no effect"),
    "autonomy-never-passes": ("warning", "an outcome requires so much autonomy that it always waits for the operator"),
    "all-disabled": ("warning", "everything in a container is disabled"),
    "bad-resume": ("error", "`resume` is neither `rerun`, `ask` nor an outcome of the node"),
}
"""Every code a finding can have: its severity and what it means."""


class Finding(msgspec.Struct, frozen=True, kw_only=True, gc=False):
    """One finding; `code` is stable, `path` is the node path `root/approach/left`."""

    severity: Severity
    code: str
    message: str
    path: str
    position: Position
    hint: str = ""

    def __str__(self) -> str:
        advice = f" ({self.hint})" if self.hint else ""
        return f"{self.position}: {self.severity}: {self.message}{advice} [{self.code}]"


def finding_sort_key(finding: Finding) -> tuple[str, int, int]:
    """Return the sort key that orders findings by position."""
    return finding.position.file, finding.position.line, finding.position.column


def new_finding(code: str, message: str, *, path: str, position: Position, hint: str = "") -> Finding:
    """Return a finding with the severity of its code."""
    return Finding(severity=CODES[code][0], code=code, message=message, path=path, position=position, hint=hint)


def invalid_document_finding(error: DocumentError, path: Path | str) -> Finding:
    """Return the finding for an error in the document at `path`."""
    position = error.where if isinstance(error.where, Position) else Position(file=str(path), line=1, column=1)
    return new_finding("invalid-document", error.message, path="", position=position, hint=error.hint or "")


def require_no_errors(findings: Iterable[Finding]) -> None:
    """Refuse a document that has errors.

    Raises:
        DocumentError: there is an error; the first one, `where` is its position.
    """
    for finding in findings:
        if finding.severity == "error":
            raise DocumentError(finding.message, where=finding.position, hint=finding.hint or None)
