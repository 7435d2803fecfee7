"""Messages between the server and the target check process: one line of JSON per message."""

from __future__ import annotations

import msgspec

from engine.library.behavior_library import FindingView


class TargetRequest(msgspec.Struct, frozen=True, kw_only=True):
    """Request: a text to check, as the content of `file` in `project`; both paths are absolute."""

    project: str
    file: str
    text: str


class TargetFindings(msgspec.Struct, frozen=True, kw_only=True):
    """Response: the targets that an arm cannot take; `problem` says why they could not be checked."""

    findings: tuple[FindingView, ...] = ()
    problem: str = ""
