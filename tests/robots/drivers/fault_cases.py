"""The faults that a gripper driver is tested with, and what is expected of each: test and documentation read them."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True, kw_only=True)
class FaultCase:
    """One fault in the middle of a motion.

    Attributes:
        name: In words, for the table.
        do: The request on the side channel.
        values: Its values.
        cause: One of these is in the cause of the failed motion.
        lost: Whether the connection is lost, so that a person must accept it with `flexcell cell connect`.
        restore: The request that ends the fault.
        fingers: What the fingers do meanwhile.
    """

    name: str
    do: str
    values: dict[str, object] = field(default_factory=dict[str, object])
    cause: tuple[str, ...]
    lost: bool
    restore: tuple[str, dict[str, object]] = ("restore", {})
    fingers: str


_GO_ON = "end the motion that the gripper has received, then rest"
CASES = (
    FaultCase(name="connection cut", do="cut", cause=("no fresh reading",), lost=True, fingers=_GO_ON),
    FaultCase(name="device does not answer", do="freeze", cause=("no valid answer within",), lost=True, fingers=_GO_ON),
    FaultCase(
        name="answers too slow",
        do="slow",
        values={"seconds": 1.0},
        cause=("no valid answer within",),
        lost=True,
        fingers=_GO_ON,
    ),
    FaultCase(
        name="garbage",
        do="garbage",
        cause=("but bytes that are no answer", "was answered with", "is not that of a 2F gripper", "has no end"),
        lost=True,
        fingers=_GO_ON,
    ),
    FaultCase(
        name="requests refused",
        do="refuse",
        cause=("Modbus exception 4", "was answered with b'?'"),
        lost=True,
        fingers=_GO_ON,
    ),
    FaultCase(
        name="device restarted",
        do="restart",
        cause=("the gripper is not activated",),
        lost=False,
        fingers="stop where they are",
    ),
    FaultCase(
        name="over-temperature",
        do="fault",
        values={"code": 8},
        cause=("over-temperature",),
        lost=False,
        restore=("fault", {"code": 0}),
        fingers="stop where they are",
    ),
    FaultCase(
        name="over-current (needs a reset)",
        do="fault",
        values={"code": 14},
        cause=("over-current",),
        lost=False,
        fingers="stop where they are",
    ),
    FaultCase(
        name="second client",
        do="foreign",
        values={"position": 90},
        cause=("another client commands the gripper",),
        lost=False,
        fingers="go where the other client says",
    ),
)


def recovery(case: FaultCase) -> str:
    """Return what a person does after the cause is cleared."""
    first = "`flexcell cell connect`, then " if case.lost else ""
    return f"{first}`enable_device`"
