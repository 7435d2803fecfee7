"""A finding: what is wrong with a behavior, where, and what to do; `CODES` lists all kinds.

Each kind has a page, `docs/findings/<code>.md`, with what it means and how to mend it.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Literal

import msgspec

from engine.errors import DocumentError, Position

Severity = Literal["error", "warning"]

CODES: Mapping[str, tuple[Severity, str]] = {
    "invalid-document": ("error", "the file cannot be read as a behavior"),
    "circular-behavior": ("error", "behaviors refer to one another in a circle"),
    "invalid-cell": ("error", "the cell that the behavior names, or its entries, cannot be read"),
    "unknown-state": ("error", "no state has this name, or its class is broken"),
    "module-not-allowed": ("error", "a document names a class of a module that the project does not allow"),
    "broken-behaviour": ("error", "a py_trees behaviour cannot be loaded, or is none"),
    "unknown-parameter": ("error", "the state or behavior has no such parameter"),
    "missing-parameter": ("error", "a parameter without default is not given"),
    "bad-parameter": ("error", "a given parameter has the wrong type or is out of range"),
    "unknown-input": ("error", "the state or behavior has no such input key"),
    "unknown-output": ("error", "the state or behavior has no such output key"),
    "undefined-key": ("error", "a userdata key is read that nothing has defined by then"),
    "maybe-undefined-key": ("warning", "a userdata key is read that some path does not define"),
    "type-mismatch": ("error", "a value is of a kind that its reader does not take"),
    "maybe-type-mismatch": ("warning", "on some path a value is of a kind that its reader does not take"),
    "parallel-writers": ("warning", "branches that run side by side write one userdata key"),
    "sibling-read": ("warning", "a branch reads a userdata key that a branch beside it writes"),
    "bad-expression": ("error", "an expression is not well formed"),
    "undeclared-name": ("error", "an expression uses a name that is no parameter or userdata key"),
    "missing-entry": ("warning", "a named entry is not in the entries that are known, or of another kind"),
    "unknown-in-cell": ("error", "the cell has nothing of this kind and name"),
    "maybe-unknown-in-cell": ("warning", "a name that the cell does not have, on some way or until a run adds it"),
    "unreachable-joints": ("error", "an arm of the cell has other joints, or cannot have these angles"),
    "unreachable-target": ("warning", "an arm of the cell cannot reach a target"),
    "target-in-collision": ("warning", "an arm at a target would be in itself or in a fixture of the cell as drawn"),
    "missing-unit": ("warning", "a parameter without a unit is handed on to where a unit is due"),
    "unit-mismatch": ("warning", "a parameter is handed on to where another unit is due"),
    "suspect-unit": ("warning", "a number is so large that it seems to be in another unit"),
    "range-too-wide": ("warning", "a parameter may be given values that are refused where it is handed on to"),
    "unknown-model": ("error", "no robot or gripper model has this name, or its folder cannot be used"),
    "unknown-driver": ("error", "no driver has this name"),
    "bad-declaration": ("error", "a parameter of the behavior contradicts itself"),
    "required-parameter": ("warning", "a parameter of the behavior has no default, so each run must give it"),
    "unused-parameter": ("warning", "nothing uses a parameter of the behavior"),
    "unknown-success": ("error", "`success` names an outcome that is not declared"),
    "unknown-outcome": ("error", "an outcome is used that the node does not have"),
    "unknown-target": ("error", "a transition leads to something that does not exist"),
    "unconnected-outcome": ("error", "an outcome of a node leads nowhere"),
    "ambiguous-target": ("error", "a name is a state of a machine and an outcome of it"),
    "missing-initial": ("error", "the initial state of a machine does not exist"),
    "unreachable-node": ("warning", "nothing leads to a node"),
    "no-path-to-outcome": ("warning", "from a node no outcome of the machine can be reached"),
    "instant-loop": ("error", "a loop in which no time passes and nothing changes"),
    "never-ends": ("error", "a part of a tree that cannot end, however its child ends"),
    "restarted-children": ("warning", "a parallel runs children again that have succeeded, until all succeed at once"),
    "unwatched-check": ("warning", "nothing asks a check again while what stands behind it is at work"),
    "idle-every": ("warning", "an `every` that is never used"),
    "unused-outcome": ("warning", "an outcome is declared or connected that nothing leads to"),
    "unknown-child": ("error", "a condition names a child that does not exist"),
    "preempts-itself": ("error", "a condition preempts a child that has ended when it holds"),
    "uncovered-combination": ("error", "all children may finish so that no condition holds"),
    "combinations-not-checked": ("warning", "there are too many combinations of child outcomes to check"),
    "shared-resource": ("error", "nodes that run side by side command the same device"),
    "constant-guard": ("warning", "a guard is always open or always closed"),
    "idle-retry": ("warning", "a retry that never happens"),
    "autonomy-never-passes": ("warning", "an outcome requires so much autonomy that it never passes by itself"),
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
    """Return what sorts findings by where they are."""
    return finding.position.file, finding.position.line, finding.position.column


def new_finding(code: str, message: str, *, path: str, position: Position, hint: str = "") -> Finding:
    """Make a finding with the severity that belongs to its code."""
    return Finding(severity=CODES[code][0], code=code, message=message, path=path, position=position, hint=hint)


def invalid_document_finding(error: DocumentError, path: Path | str) -> Finding:
    """Make the finding of a mistake in the document at `path`."""
    position = error.where if isinstance(error.where, Position) else Position(file=str(path), line=1, column=1)
    return new_finding("invalid-document", error.message, path="", position=position, hint=error.hint or "")


def require_no_errors(findings: Iterable[Finding]) -> None:
    """Refuse a document that has errors.

    Raises:
        DocumentError: it has; the first one, `where` is its position.
    """
    for finding in findings:
        if finding.severity == "error":
            raise DocumentError(finding.message, where=finding.position, hint=finding.hint or None)
