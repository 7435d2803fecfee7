"""The lines of text between a controller and the board of a servo arm; knows no serial line.

To the board: angles of all servos in degrees (`45.0 120.0`), `?`, `GO`, `STOP`, `pick`, `place`. From it: `READY …`
after a start; `OK 45.0 120.0 place` with the angles that are written to the servos and the last request to the claw;
`HALT boot 45.0 120.0 place` where it takes no set points, and why; `ERR words` for a line that it did not execute.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

ASK, GO, STOP = b"?\n", b"GO\n", b"STOP\n"
PICK, PLACE = b"pick\n", b"place\n"
HALTS = {
    "boot": "the board has started and is not enabled: where its servos are is not known",
    "stop": "the board was stopped",
    "watchdog": "the watchdog of the board: no line came for too long",
}
"""Why the board takes no set points, by its word."""
_CLAW = {"pick": True, "place": False}
_LONGEST = 80


@dataclass(frozen=True, kw_only=True)
class BoardReply:
    """One line of the board; `angles_deg` is empty where it has none, `halt` and `error` where there is nothing.

    `claw_closes` is None where the board says nothing of a claw.
    """

    angles_deg: tuple[float, ...] = ()
    claw_closes: bool | None = None
    halt: str = ""
    error: str = ""
    started: bool = False


def encode_set_point(angles_deg: Sequence[float], *, decimals: int) -> bytes:
    """Return the line of a set point.

    Raises:
        ValueError: an angle is not finite.
    """
    if not all(math.isfinite(angle) for angle in angles_deg):
        raise ValueError(f"{list(angles_deg)} are no angles")
    # Adding zero turns -0.0 into 0.0.
    return (" ".join(f"{round(angle, decimals) + 0.0:.{decimals}f}" for angle in angles_deg) + "\n").encode()


def decode_reply(line: bytes, *, servos: int) -> BoardReply | None:
    """Return the meaning of a line without its end; None if it has none."""
    if len(line) > _LONGEST or not line.isascii():
        return None
    word, *rest = line.decode().split() or [""]
    match word:
        case "READY":
            return BoardReply(started=True)
        case "ERR":
            return BoardReply(error=" ".join(rest) or "no reason")
        case "OK":
            return _state(rest, servos, halt="")
        case "HALT" if rest:
            return _state(rest[1:], servos, halt=HALTS.get(rest[0], rest[0]))
        case _:
            return None


def _state(words: Sequence[str], servos: int, *, halt: str) -> BoardReply | None:
    """Return the state in words; None if they are none."""
    claw = words[-1] if words and words[-1] in _CLAW else ""
    angles = _angles(words[:-1] if claw else words, servos)
    return BoardReply(angles_deg=angles, claw_closes=_CLAW.get(claw), halt=halt) if angles else None


def _angles(words: Sequence[str], servos: int) -> tuple[float, ...]:
    """Return the angles in words; empty if they are not those of all servos."""
    try:
        angles = tuple(float(word) for word in words)
    except ValueError:
        return ()
    return angles if len(angles) == servos and all(math.isfinite(angle) for angle in angles) else ()
