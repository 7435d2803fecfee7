"""The result of one run of a sweep."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from typing import Literal

import msgspec

from engine.errors import FlexcellError
from engine.sweep.design.configuration import Configuration
from engine.wording.suggestions import did_you_mean

_NUMBERS = re.compile(r"-?\d+(\.\d+)?([eE][-+]?\d+)?")
TrialStatus = Literal["finished", "stopped", "errored", "refused", "crashed", "hung"]
"""`refused`: this configuration cannot be executed; `crashed`, `hung`: its process ended or was ended."""


class NodeTime(msgspec.Struct, frozen=True, kw_only=True):
    """The activations of a node that ended in a run, and the seconds that they took on its clock."""

    visits: int
    total_s: float


class TrialResult(msgspec.Struct, frozen=True, kw_only=True):
    """How one configuration ended; everything but the costs is the same wherever it is executed."""

    configuration: Configuration
    status: TrialStatus
    outcome: str | None = None
    success: bool = False
    cause: str = ""
    """The chain of causes on one line, from the root cause outwards; empty for a success."""
    reason: str = ""
    """The message of the innermost cause."""
    reason_at: str = ""
    """The node, device or frame of the innermost cause."""
    duration_s: float = 0.0
    """On the clock of the run."""
    events: int = 0
    events_sha256: str = ""
    """The hash of the event log, as `flexcell run --json` prints it, with paths of files relative to the sweep."""
    nodes: Mapping[str, NodeTime] = {}
    """By path."""
    outputs: Mapping[str, float] = {}
    """Userdata at the end that are numbers."""
    measures: Mapping[str, float] = {}
    """Numbers that the run summed up while it went, by `OWNER.QUANTITY_REDUCTION_UNIT`, see `engine.messages.measures`.

    `run.duration_s`; of an arm `left.path_m`, `left.joint_path_rad`, `left.speed_max_m_s`, `left.force_max_n`,
    `left.torque_max_nm`, `left.tracking_error_max_rad`; of its tool `left.gripper.force_min_n` (while it holds),
    `left.gripper.force_max_n`, `left.gripper.slip_max_m`; of the world `cell.contacts`, `cell.contact_s`,
    `cell.contact_force_max_n`. What a run has nothing of (no grip, no end) is absent.
    """
    covered: str = ""
    """Hexadecimal bits of the coverage items of the behavior that the run executed, in document order."""
    wall_s: float = 0.0
    cpu_s: float = 0.0
    """Of its process and of ended child processes."""
    memory_bytes: int = 0
    """The largest resident size that its process had until then."""

    @property
    def label(self) -> str:
        """Its outcome, or its status where it has none."""
        return self.outcome or self.status

    @property
    def numbers(self) -> dict[str, float]:
        """What a search goes towards and a requirement limits: userdata at the end, measures and `duration_s`.

        A run whose process ended, or that could not begin, has none.
        """
        is_known = self.status == "finished" or self.events > 0
        return {**self.outputs, **self.measures, **({"duration_s": self.duration_s} if is_known else {})}

    @property
    def cause_key(self) -> tuple[str, str]:
        """What runs that failed alike have in common: the place and message of the root cause without its numbers."""
        return self.reason_at, _NUMBERS.sub("#", self.reason)

    @property
    def broken(self) -> bool:
        """Whether the process failed and not the behavior: another attempt may end differently."""
        return self.status in ("crashed", "hung")


def require_number(name: str, results: Iterable[TrialResult], *, where: object) -> None:
    """Reject a name of a number that none of these runs has, where there are any.

    Raises:
        FlexcellError: none of them has it; the hint names similar ones.
    """
    known = [each.numbers for each in results]
    if known and not any(name in each for each in known):
        hint = did_you_mean(name, {other for each in known for other in each})
        raise FlexcellError(f"no run has a number `{name}`", where=where, hint=hint)
