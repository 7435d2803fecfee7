"""What a user interface shows of a failing run that is shrunk to the smallest change from nominal."""

from __future__ import annotations

from typing import Literal

import msgspec

from engine.sweep.design.configuration import Configuration
from engine.sweep.shrinking import ShrinkProgress, Shrunk

ShrinkStatus = Literal["idle", "running", "stopping"]


class ShrunkTrial(msgspec.Struct, frozen=True, kw_only=True):
    """The smallest change from nominal with which a run still fails."""

    subject: str
    """The hash of the versions that were executed."""
    failing: Configuration
    """The run."""
    shrunk: Shrunk


class Shrinking(msgspec.Struct, frozen=True, kw_only=True):
    """How far a failing run is shrunk, and what came of it; kept as long as the server runs."""

    status: ShrinkStatus = "idle"
    progress: ShrinkProgress | None = None
    """None until its first run has ended."""
    found: ShrunkTrial | None = None
    saved_as: str = ""
    """The path of the test case that it was saved as; empty without one."""
    problem: str = ""
    """Why it has ended without a result."""
