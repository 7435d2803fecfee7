"""The resources of the emulated Robot Web Services: paths, their JSON, and the actions on them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence

from robots.drivers.abb.emulation.controller_panel import ControllerPanel, PanelRefusal
from robots.drivers.abb.emulation.emulated_controller import EmulatedController
from robots.drivers.abb.emulation.emulated_signals import PATH as SIGNALS
from robots.drivers.abb.emulation.emulated_signals import EmulatedSignals

Resource = dict[str, object]
SERIAL, NAME, ROBOTWARE = "4600-501234", "IRC5_EMULATED", "6.15.0000"


class NoSuchResource(Exception):
    """The path is none."""


class RwsResources:
    """Answers requests that are authenticated.

    Args:
        controller: The one behind all ports.
        panel: Its panel.
        signals: Its digital inputs.
    """

    def __init__(self, controller: EmulatedController, panel: ControllerPanel, signals: EmulatedSignals) -> None:
        self._controller = controller
        self._panel = panel
        self._signals = signals
        self.symbols: dict[str, str] = {}
        """Values of RAPID data by `task/module/name`; what is written there acts at once."""
        self._readers: dict[str, Callable[[], Sequence[Resource]]] = {
            "/ctrl/identity": lambda: [
                {"_type": "ctrl-identity-info", "ctrl-name": NAME, "ctrl-id": SERIAL, "ctrl-type": "Virtual Controller"}
            ],
            "/rw/system": lambda: [{"_type": "sys-system", "name": "emulated", "rwversion": ROBOTWARE}],
            "/rw/panel/ctrlstate": lambda: [{"_type": "pnl-ctrlstate", "ctrlstate": panel.state}],
            "/rw/panel/opmode": lambda: [{"_type": "pnl-opmode", "opmode": panel.mode}],
            "/rw/panel/speedratio": lambda: [{"_type": "pnl-speedratio", "speedratio": str(panel.speed_percent)}],
            "/rw/rapid/execution": lambda: [
                {"_type": "rap-execution", "ctrlexecstate": panel.execution, "cycle": "forever"}
            ],
            "/rw/rapid/tasks": lambda: [
                self._task("T_ROB1", motion=True),
                self._task("ROS_MotionServer", motion=False),
            ],
            "/rw/elog/0": self._events,
            SIGNALS: signals.resources,
            "/rw/motionsystem/mechunits/ROB_1/jointtarget": lambda: [self._joints()],
        }

    def read(self, path: str) -> Sequence[Resource]:
        """Return a resource; raises NoSuchResource."""
        self._panel.note_changes()
        symbol = path.removeprefix("/rw/rapid/symbol/data/RAPID/")
        if symbol != path and symbol in self.symbols:
            return [{"_type": "rap-data", "value": self.symbols[symbol]}]
        if signal := self._signals.of(path.removeprefix(f"{SIGNALS}/")):
            return [signal.resource()]
        reader = self._readers.get(path.rstrip("/"))
        if reader is None:
            raise NoSuchResource(path)
        return reader()

    def act(self, path: str, action: str, values: Mapping[str, str]) -> None:
        """Do what was asked; raises NoSuchResource or PanelRefusal."""
        panel, symbol = self._panel, path.removeprefix("/rw/rapid/symbol/data/RAPID/")
        match path, action:
            case "/rw/panel/ctrlstate", "setctrlstate":
                panel.switch_motors(values.get("ctrl-state", ""))
            case "/rw/panel/speedratio", "setspeedratio":
                panel.set_speed(_percent(values.get("speed-ratio", "")))
            case "/rw/rapid/execution", "start":
                panel.start_program()
            case "/rw/rapid/execution", "stop":
                panel.stop_program()
            case "/rw/rapid/execution", "resetpp":
                panel.move_to_main()
            case _, "set" if signal := self._signals.of(path.removeprefix(f"{SIGNALS}/")):
                signal.on = values.get("lvalue", "0") == "1"
            case _, "set" if symbol in self.symbols:
                self.symbols[symbol] = values.get("value", "")
            case _:
                raise NoSuchResource(f"{path}?action={action}")
        panel.note_changes()

    def _task(self, name: str, *, motion: bool) -> Resource:
        return {
            "_type": "rap-task-li",
            "_title": name,
            "name": name,
            "type": "normal" if motion else "semistatic",
            "taskstate": "linked",
            "excstate": self._panel.execution if motion else "started",
            "active": "On",
            "motiontask": str(motion).upper(),
        }

    def _events(self) -> list[Resource]:
        in_reverse = reversed(self._panel.events)
        return [
            {
                "_type": "elog-message-li",
                "_title": f"/rw/elog/0/{event.number}",
                "msgtype": str(event.kind),
                "code": str(event.code),
                "src-name": "MC0",
                "tstamp": "2026-01-01 T  12:00:00",
                "argc": "0",
                "title": event.title,
                "desc": event.title,
                "conseqs": "",
                "causes": "",
                "actions": "",
            }
            for event in in_reverse
        ]

    def _joints(self) -> Resource:
        self._controller.advance()
        axes = {f"rax_{number}": f"{math.degrees(axis):.6f}" for number, axis in enumerate(self._controller.axes, 1)}
        return {"_type": "ms-jointtarget", **axes, **{f"eax_{letter}": "9E+09" for letter in "abcdef"}}


def _percent(text: str) -> int:
    try:
        return int(text)
    except ValueError as error:
        raise PanelRefusal(f"{text!r} is no speed ratio") from error
