"""What goes between the server and the process that puts arms to targets: one line of JSON each way."""

from __future__ import annotations

import msgspec

from engine.library.behavior_library import FindingView


class TargetRequest(msgspec.Struct, frozen=True, kw_only=True):
    """A text to look at, as if it stood in `file` of `project`; both are absolute."""

    project: str
    file: str
    text: str


class TargetFindings(msgspec.Struct, frozen=True, kw_only=True):
    """The targets that an arm cannot be at; `problem` says why they are not known."""

    findings: tuple[FindingView, ...] = ()
    problem: str = ""
