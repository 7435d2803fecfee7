"""Whether the control program of this session runs, from what it and its controller report."""

from __future__ import annotations

from collections.abc import Mapping
from typing import cast

from robots.drivers.universal_robots.control_program import STATE_OUTPUTS, ControlState
from robots.drivers.universal_robots.rtde_codec import RtdeValue

PROGRAM_RUNS = 1 << 1
"""Bit of `robot_status_bits`."""
_PAUSED = 4
# By the clock of the controller: a program that runs counts its cycles.
_SILENT_S = 0.1
_END_WORDS = {
    ControlState.RUNNING: "another program has ended it, or a person",
    ControlState.ENDED_BY_REQUEST: "it was asked to end",
    ControlState.NO_SET_POINT: "no set point arrived in time",
    ControlState.TOO_FAR: "a set point was too far off the arm",
}


class ProgramWatch:
    """Follows one session at a time; before the first one nothing runs."""

    def __init__(self) -> None:
        self.session = 0
        self.set_point = self.settings = self.output = 0
        self.is_paused = False
        self._state = 0
        self._cycles = 0
        self._cycles_changed_s = 0.0
        self._time_s = 0.0
        self._is_ours = self._is_playing = False

    def begin(self, session: int) -> None:
        """Follow the program of a new session."""
        self.__init__()
        self.session = session

    def update(self, values: Mapping[str, RtdeValue]) -> None:
        """Take what was measured."""
        session, state, cycles, *numbers = (cast("int", values[name]) for name in STATE_OUTPUTS)
        self._time_s = cast("float", values["timestamp"])
        self._is_playing = bool(cast("int", values["robot_status_bits"]) & PROGRAM_RUNS)
        self.is_paused = self._is_playing and values["runtime_state"] == _PAUSED
        # Registers keep what an earlier session has written.
        self._is_ours = session == self.session != 0
        if not self._is_ours:
            return
        self._state = state
        self.set_point, self.settings, self.output = numbers
        if cycles != self._cycles:
            self._cycles, self._cycles_changed_s = cycles, self._time_s

    @property
    def runs(self) -> bool:
        """Whether it executes its cycles, and would follow a set point."""
        is_silent = self._time_s - self._cycles_changed_s > _SILENT_S
        return self.is_loaded and self._state == ControlState.RUNNING and not self.is_paused and not is_silent

    @property
    def is_loaded(self) -> bool:
        """Whether it may be the program that the controller executes or has paused."""
        return self._is_ours and self._is_playing

    @property
    def has_ended(self) -> bool:
        """Whether it has begun in this session, and is over."""
        return self._is_ours and not (self._is_playing and self._state == ControlState.RUNNING)

    def end_words(self) -> str:
        """Return why it does not run any more."""
        if not self._is_ours:
            return "another program writes its registers"
        return _END_WORDS.get(ControlState(self._state), "") if self._state in set(ControlState) else "it does not run"
