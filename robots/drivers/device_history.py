"""What a real device was enabled for, and what has stopped it since: the part of its state that is kept."""

from __future__ import annotations

import time
from collections.abc import Callable

from msgspec.structs import replace

from engine.messages.device_state import DeviceMode, DeviceState


class DeviceHistory:
    """Belongs to one device; `unix_s` is the wall clock."""

    def __init__(self, *, unix_s: Callable[[], float] = time.time) -> None:
        self._unix_s = unix_s
        self._cause = ""
        self._cause_unix_s = 0.0
        self._by = ""
        self._reason = ""
        self._was_enabled = False
        self._known: tuple[DeviceMode, str] = ("reading", "")

    def enabled(self, *, by: str, reason: str) -> None:
        """Note that a person has enabled it."""
        self._by, self._reason = one_line(by), one_line(reason)

    def complete(self, state: DeviceState) -> DeviceState:
        """Return a state with its mode and what is kept."""
        self._was_enabled = self._was_enabled or state.enabled
        mode = self._mode(state)
        cause = "" if mode in {"reading", "enabled"} else state.problem
        # The reason of a loss may name how long it has lasted: it is the same loss.
        if (mode, cause) != self._known and (mode != "lost" or self._known[0] != "lost"):
            self._known = (mode, cause)
            if cause:
                self._cause, self._cause_unix_s = cause, self._unix_s()
        return replace(
            state,
            mode=mode,
            last_cause=self._cause,
            last_cause_unix_s=self._cause_unix_s,
            enabled_by=self._by,
            enabled_for=self._reason,
        )

    def _mode(self, state: DeviceState) -> DeviceMode:
        if not state.connected:
            return "lost"
        if state.enabled:
            return "enabled"
        if state.fault:
            return "fault"
        return "stopped" if self._was_enabled else "reading"


def one_line(text: str) -> str:
    """Return a text of a person without line ends and control characters: it could look like other lines of the log."""
    return " ".join("".join(each if each.isprintable() else " " for each in text).split())
