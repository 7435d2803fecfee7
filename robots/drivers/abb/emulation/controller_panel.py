"""The panel of the emulated controller: safeguards, mode selector, motors, speed, RAPID execution, event log."""

from __future__ import annotations

from robots.drivers.abb.emulation.emulated_controller import EmulatedController
from robots.drivers.abb.rws.rws_state import ERROR_EVENT, ControllerEvent
from robots.drivers.abb.simple_message import OperatingMode

_INFORMATION = 1
_MOST_EVENTS = 50


class PanelRefusal(Exception):
    """The controller does not do what it was asked."""


class ControllerPanel:
    """What Robot Web Services say of the one controller behind all ports, and do with it.

    Attributes:
        guard_open: Whether a safeguard is open.
        unconfirmed: Whether an emergency stop is released and not confirmed yet.
        manual_mode: What the mode selector says when it is not in automatic.
        refuses: Why the controller does nothing that it is asked; empty if it does.
        asked: What was asked, oldest first.
    """

    def __init__(self, controller: EmulatedController) -> None:
        self._controller = controller
        self.guard_open = False
        self.unconfirmed = False
        self.manual_mode = "MANR"
        self.refuses = ""
        self.asked: list[str] = []
        self.events: list[ControllerEvent] = []
        self._logged_state = ""
        self.log(_INFORMATION, 10010, "Motors OFF state")

    @property
    def state(self) -> str:
        """The controller state."""
        controller = self._controller
        if controller.e_stopped:
            return "emergencystop"
        if self.unconfirmed:
            return "emergencystopreset"
        if self.guard_open:
            return "guardstop"
        return "motoron" if controller.drives_on else "motoroff"

    @property
    def mode(self) -> str:
        """The mode selector."""
        return "AUTO" if self._controller.mode is OperatingMode.AUTO else self.manual_mode

    @property
    def execution(self) -> str:
        """Whether the normal tasks run."""
        controller = self._controller
        runs = controller.program_runs and controller.mode is OperatingMode.AUTO and self.state == "motoron"
        return "running" if runs and not controller.error_code else "stopped"

    @property
    def speed_percent(self) -> int:
        """The speed of the panel."""
        return round(100.0 * self._controller.speed_share)

    def set_emergency_stop(self, *, pressed: bool) -> None:
        """Press or release the button."""
        self.unconfirmed = not pressed
        self._stop_by(motors=True)
        self._controller.e_stopped = pressed

    def set_guard(self, *, is_open: bool) -> None:
        """Open or close a safeguard."""
        self.guard_open = is_open
        if is_open:
            self._stop_by(motors=True)

    def set_mode(self, mode: str) -> None:
        """Turn the mode selector: `AUTO`, `MANR` or `MANF`."""
        self._stop_by(motors=False)
        self._controller.mode = OperatingMode.AUTO if mode == "AUTO" else OperatingMode.MANUAL
        if mode != "AUTO":
            self.manual_mode = mode

    def set_speed(self, percent: int) -> None:
        """Set the speed of the panel; raises PanelRefusal."""
        self._require("speed ratio out of range", allowed=0 <= percent <= 100)
        self.asked.append(f"speed {percent}")
        self._controller.advance()
        self._controller.speed_share = percent / 100.0

    def confirm_all(self) -> None:
        """Do what an operator does to make the controller ready."""
        self.guard_open = self.unconfirmed = False
        self.refuses = ""
        self._controller.advance()
        self._controller.speed_share = 1.0

    def switch_motors(self, state: str) -> None:
        """Switch the motors `motoron` or `motoroff`; raises PanelRefusal."""
        self.asked.append(state)
        self._require("unknown controller state", allowed=state in ("motoron", "motoroff"))
        self._require(
            "not allowed in current state", allowed=self.mode == "AUTO" and self.state in ("motoron", "motoroff")
        )
        if state == "motoron" and self._controller.drives_on:
            return
        # A program that runs stops with the motors, and does not start with them.
        self._stop_by(motors=state == "motoroff")
        self._controller.drives_on = state == "motoron"

    def start_program(self) -> None:
        """Start the normal tasks; raises PanelRefusal."""
        self.asked.append("start")
        self._require("not allowed in current state", allowed=self.mode == "AUTO" and self.state == "motoron")
        self._controller.advance()
        self._controller.program_runs = True

    def stop_program(self) -> None:
        """Stop the normal tasks."""
        self.asked.append("stop")
        self._stop_by(motors=False)

    def move_to_main(self) -> None:
        """Move the program pointers to main, which forgets the path; raises PanelRefusal."""
        self.asked.append("resetpp")
        self._require("not allowed while executing", allowed=self.execution == "stopped" and self.mode == "AUTO")
        self._controller.forget_path()

    def note_changes(self) -> None:
        """Log what has stopped the controller since this was called last."""
        self._controller.advance()
        code = self._controller.error_code
        state = f"{self.state} {code}"
        if state == self._logged_state:
            return
        self._logged_state = state
        if code:
            self.log(ERROR_EVENT, code, "Motion error")
        elif self.state == "emergencystop":
            self.log(ERROR_EVENT, 20202, "Emergency stop open")
        elif self.state == "guardstop":
            self.log(ERROR_EVENT, 20205, "Auto stop open")
        else:
            self.log(_INFORMATION, 10011, f"State {self.state}")

    def log(self, kind: int, code: int, title: str) -> None:
        """Add an event."""
        number = self.events[-1].number + 1 if self.events else 1
        self.events.append(ControllerEvent(number=number, kind=kind, code=code, title=title))
        del self.events[:-_MOST_EVENTS]

    def _stop_by(self, *, motors: bool) -> None:
        self._controller.advance()
        self._controller.program_runs = False
        if motors:
            self._controller.drives_on = False

    def _require(self, why: str, *, allowed: bool) -> None:
        if self.refuses or not allowed:
            raise PanelRefusal(self.refuses or why)
