"""The commands of the dashboard of a controller, with its words."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from robots.drivers.universal_robots.emulator.controller_safety import UrSafetyMode
from robots.drivers.universal_robots.emulator.controller_state import ControllerState, UrRuntimeState
from robots.drivers.universal_robots.emulator.ur_models import ControllerSeries

BANNER = "Connected: Universal Robots Dashboard Server"
SERIAL_NUMBER = "20265000001"
_LOCAL_REFUSAL = "Command is not allowed due to local control"


class DashboardCommands:
    """Answers one line at a time."""

    def __init__(self, controller: ControllerState, series: ControllerSeries, *, model: str) -> None:
        self._controller = controller
        self._series = series
        self._model = model
        self._queries: Mapping[str, Callable[[], str]] = {
            "polyscopeversion": lambda: series.dashboard_version,
            "version": lambda: series.dashboard_version,
            "robotmode": lambda: f"Robotmode: {controller.safety.robot_mode.name}",
            "safetymode": lambda: f"Safetymode: {controller.safety.safety_mode.name}",
            "safetystatus": lambda: f"Safetystatus: {controller.safety.safety_mode.name}",
            "running": lambda: f"Program running: {str(self._is_playing).lower()}",
            "programstate": self._program_state,
            "get robot model": lambda: model.upper().removesuffix("E"),
            "get serial number": lambda: SERIAL_NUMBER,
            "is in remote control": lambda: str(controller.is_remote).lower(),
            "get loaded program": lambda: "No program loaded",
            "isprogramsaved": lambda: f"false {controller.program_name}",
            "close popup": lambda: "closing popup",
            "close safety popup": lambda: "closing safety popup",
            "quit": lambda: "Disconnected",
        }
        self._commands: Mapping[str, Callable[[], str]] = {
            "stop": self._stop,
            "pause": self._pause,
            "play": self._play,
            "power on": self._power_on,
            "power off": self._power_off,
            "shutdown": self._power_off,
            "brake release": self._release_brakes,
            "unlock protective stop": self._unlock,
            "restart safety": self._restart_safety,
        }

    def answer(self, line: str) -> str:
        """Return the answer to a line."""
        command = line.lower()
        if command in self._queries:
            return self._queries[command]()
        if command in self._commands:
            # On an e-Series controller only who has the control may command; a stop is taken from everybody.
            if not self._controller.is_remote and command != "stop":
                return _LOCAL_REFUSAL
            return self._commands[command]()
        for prefix, reply in (("popup ", "showing popup"), ("addtolog ", "Added log message")):
            if command.startswith(prefix):
                self._controller.messages.append(line[len(prefix) :])
                return reply
        if command.startswith("load "):
            return f"File not found: {line[5:]}"
        if command.startswith("setuserrole "):
            return f"Setting user role: {line[12:]}"
        return f"could not understand: '{line}'"

    @property
    def _is_playing(self) -> bool:
        return self._controller.runtime_state is UrRuntimeState.PLAYING

    def _program_state(self) -> str:
        return f"{self._controller.runtime_state.name} {self._controller.program_name or '<unnamed>'}"

    def _stop(self) -> str:
        # Also where none runs: the client library stops its script first, and needs this answer.
        self._controller.stop_program()
        return "Stopped"

    def _pause(self) -> str:
        if not self._is_playing:
            return "Failed to execute: pause"
        self._controller.is_paused = True
        return "Pausing program"

    def _play(self) -> str:
        if self._controller.program is None or not self._controller.is_paused:
            return "Failed to execute: play"
        self._controller.is_paused = False
        return "Starting program"

    def _power_on(self) -> str:
        self._controller.safety.power_on()
        return "Powering on"

    def _power_off(self) -> str:
        self._controller.power_off()
        return "Powering off"

    def _release_brakes(self) -> str:
        self._controller.safety.release_brakes()
        return "Brake releasing"

    def _unlock(self) -> str:
        safety = self._controller.safety
        if safety.safety_mode is UrSafetyMode.PROTECTIVE_STOP and not safety.can_unlock(self._controller.time_s):
            return (
                "Cannot unlock protective stop until 5s after occurrence. "
                "Always inspect cause of protective stop before unlocking"
            )
        if safety.safety_mode is UrSafetyMode.PROTECTIVE_STOP:
            safety.unlock()
        return "Protective stop releasing"

    def _restart_safety(self) -> str:
        self._controller.power_off()
        return "Restarting safety"
