"""Messages between the server and the target check process: one line of JSON per message."""

from __future__ import annotations

from typing import Literal

import msgspec

from engine.library.behavior_library import FindingView


class TargetRequest(msgspec.Struct, frozen=True, kw_only=True):
    """Request: a text to check, as the content of `file` in `project`; both paths are absolute.

    Of a behavior the targets are checked, of a cell what touches at rest.
    """

    project: str
    file: str
    text: str
    of: Literal["behavior", "cell"] = "behavior"


class TargetFindings(msgspec.Struct, frozen=True, kw_only=True):
    """Response: targets that an arm cannot take, or what touches at rest; `problem` says why it was not checked."""

    findings: tuple[FindingView, ...] = ()
    problem: str = ""
