"""Why a packet is refused: one error with one of a few names, which the counters of the server use."""

from __future__ import annotations

from typing import Literal, get_args

from engine.errors import FlexcellError

RefusalName = Literal[
    "wrong port",
    "wrong size",
    "not finite",
    "wrong mode byte",
    "out of range",
    "not the commander",
    "no data",
    "incomplete parameters",
    "mode not selected",
    "direct control is off",
    "busy",
    "leased",
    "cell is stopped",
    "not supported",
    "rejected by the arm",
    "failed",
    "silent commander",
]

REFUSALS: tuple[str, ...] = get_args(RefusalName)


class PacketRefused(FlexcellError):
    """A packet is not executed; `name` is what it is counted as."""

    def __init__(self, name: RefusalName, message: str, *, where: str = "", hint: str | None = None) -> None:
        super().__init__(f"{name}: {message}", where=where or None, hint=hint)
        self.name: RefusalName = name
