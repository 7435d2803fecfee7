"""A fault that a driver is tested with, and what is expected of it: test and documentation read it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from engine.bus import GoalHandle


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
        at_device: What a person does about it at the device, for the table.
        meanwhile: What the fingers or the arm do.
    """

    name: str
    do: str
    values: dict[str, object] = field(default_factory=dict[str, object])
    cause: tuple[str, ...]
    lost: bool
    restore: tuple[str, dict[str, object]] = ("restore", {})
    meanwhile: str
    at_device: str = ""


def recovery(case: FaultCase) -> str:
    """Return what a person does after the cause is cleared."""
    first = "`flexcell cell connect`, then " if case.lost else ""
    at_device = f"{case.at_device}, then " if case.at_device else ""
    return f"{at_device}{first}`enable_device`"


async def refusal_of(handle: GoalHandle[Any, Any]) -> str:
    """Return why a goal failed; empty if it did not."""
    end = await handle.result()
    return end.cause.chain()[-1].message if end.cause is not None else ""
