"""Serves an emulated controller on its three ports, and its faults on the side channel, until it is cancelled."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from typing import Any, Protocol, cast

import numpy as np

from engine.cell.drivers import Ready
from engine.errors import FlexcellError
from robots.drivers.abb.emulation.abb_emulator import AbbEmulatorOptions
from robots.drivers.abb.emulation.controller_panel import ControllerPanel
from robots.drivers.abb.emulation.controller_sessions import (
    EmulatedGripperSwitch,
    GripperSession,
    MotionSession,
    StateSession,
)
from robots.drivers.abb.emulation.egm_source import EgmFaults, EgmSource
from robots.drivers.abb.emulation.emulated_controller import AXES, EmulatedController
from robots.drivers.abb.emulation.emulated_signals import EmulatedSignals
from robots.drivers.abb.emulation.rws_resources import RwsResources
from robots.drivers.abb.emulation.rws_server import RwsServer
from robots.drivers.abb.emulation.single_client_server import SingleClientServer
from robots.drivers.abb.simple_message import (
    END_DOWNLOAD,
    JOINTS,
    START_DOWNLOAD,
    TrajectoryPoint,
)
from robots.drivers.emulation.input_wires import InputWires
from robots.drivers.emulation.plant import ALONE, Plant
from robots.drivers.emulation.side_channel import Request, SideChannel
from robots.drivers.emulation.wire_faults import WireFaults

_MODES = {"auto": "AUTO", "manual": "MANR", "manual_full": "MANF"}


class EmulatedPort(Protocol):
    """A port of the controller, which can be closed and opened again."""

    @property
    def port(self) -> int:
        """Its number."""
        ...

    @property
    def clients(self) -> int:
        """Number of connections."""
        ...

    async def open(self) -> object:
        """Listen, if it does not."""
        ...

    async def close(self) -> None:
        """Stop listening and drop all connections."""
        ...


_CYCLE_S = 0.004


class ControllerFaults:
    """Executes the requests of the side channel: `do` names what, further keys its values.

    cut, freeze, garbage, refuse: as `WireFaults`. slow: `seconds`. close_port: `port`, that is `motion`, `state`,
    `gripper` or `rws`. drop: the client of `port`. rws_fault: `fault`, one of these of RWS alone. egm_fault: `fault`,
    one of these, deaf or repeats, of EGM alone. restore: no fault of the wire. estop, guard, drives, program: `on`.
    signal: `name`, `on`, and `valid`, whether its device is there. mode: `manual`, `manual_full` or `auto`. speed:
    `percent`. rws_refuse: RWS refuses all actions with `text`. error: `code`. unknown: the status says nothing.
    restart: the controller restarts with drives off. go_on: an operator clears everything and starts the program.
    foreign: another program moves to `joints_rad` in `seconds`. gripper_reply: `text`. state: the true state.
    """

    def __init__(
        self,
        controller: EmulatedController,
        gripper: EmulatedGripperSwitch,
        ports: Mapping[str, EmulatedPort],
        faults: WireFaults,
        *,
        panel: ControllerPanel,
        rws: RwsServer,
        egm: EgmSource,
        signals: EmulatedSignals,
    ) -> None:
        self._controller = controller
        self._gripper = gripper
        self._ports = ports
        self._faults = faults
        self._panel = panel
        self._rws = rws
        self._egm = egm
        self._signals = signals

    async def execute(self, request: Request) -> Mapping[str, object]:
        """Execute one request; raises KeyError, TypeError or ValueError for what is not one."""
        self._controller.advance()
        do = str(request["do"])
        if not await self._wire(do, request) and not self._change(do, request):
            if do != "state":
                raise ValueError(f"{do} is not known")
            return self._state()
        self._panel.note_changes()
        return {"ok": True}

    async def _wire(self, do: str, request: Request) -> bool:
        """Execute what concerns the wire; false if it does not."""
        faults = self._faults
        match do:
            case "cut":
                faults.cut = True
                await self._close()
            case "close_port":
                await self._ports[str(request["port"])].close()
            case "drop":
                await self._ports[str(request["port"])].close()
                await self._ports[str(request["port"])].open()
            case "freeze":
                faults.frozen = True
            case "garbage":
                faults.garbage = True
            case "refuse":
                faults.refuse = True
            case "slow":
                faults.slow_s = _number(request["seconds"])
            case "restore":
                faults.cut = faults.frozen = faults.garbage = faults.refuse = False
                faults.slow_s = 0.0
                self._rws.own_faults = WireFaults()
                self._egm.own_faults = EgmFaults(WireFaults())
                await self._open()
            case "rws_fault":
                self._rws.own_faults = _own_faults(str(request["fault"]))
            case "egm_fault":
                fault = str(request["fault"])
                if fault in ("deaf", "repeats"):
                    self._egm.own_faults = EgmFaults(WireFaults(), deaf=fault == "deaf", repeats=fault == "repeats")
                else:
                    self._egm.own_faults = EgmFaults(_own_faults(fault))
            case "restart":
                self._controller.switch_off()
                await self._close()
                await self._open()
            case _:
                return False
        return True

    def _change(self, do: str, request: Request) -> bool:
        """Execute what concerns the controller; false if it does not."""
        controller = self._controller
        match do:
            case "estop":
                self._panel.set_emergency_stop(pressed=bool(request["on"]))
            case "guard":
                self._panel.set_guard(is_open=bool(request["on"]))
            case "speed":
                self._panel.set_speed(int(_number(request["percent"])))
            case "rws_refuse":
                self._panel.refuses = str(request["text"])
            case "drives":
                controller.drives_on = bool(request["on"])
            case "program":
                controller.program_runs = bool(request["on"])
            case "mode":
                self._panel.set_mode(_MODES[str(request["mode"])])
            case "error":
                controller.error_code = int(_number(request["code"]))
            case "unknown":
                controller.unknown = True
            case "go_on":
                self._panel.confirm_all()
                controller.go_on()
            case "foreign":
                self._move(np.array(cast("Any", request["joints_rad"]), dtype=float), _number(request["seconds"]))
            case "signal":
                signal = self._signals.of(str(request["name"]))
                if signal is None:
                    raise ValueError(f"there is no signal {request['name']}")
                signal.on = bool(request.get("on", signal.on))
                signal.valid = bool(request.get("valid", signal.valid))
            case "gripper_reply":
                self._gripper.reply = str(request["text"])
            case _:
                return False
        return True

    async def _close(self) -> None:
        for port in self._ports.values():
            await port.close()

    async def _open(self) -> None:
        for port in self._ports.values():
            await port.open()

    def _move(self, axes: np.ndarray[Any, Any], seconds: float) -> None:
        for sequence in (START_DOWNLOAD, END_DOWNLOAD):
            joints = (*axes.tolist(), *(0.0,) * (JOINTS - AXES))
            self._controller.take(TrajectoryPoint(sequence=sequence, joints_rad=joints, duration_s=seconds))

    def _state(self) -> Mapping[str, object]:
        controller = self._controller
        return {
            "time_s": controller.now_s(),
            "joints_rad": controller.plant.measured()[0].tolist(),
            "in_motion": controller.in_motion,
            "downloaded": controller.downloaded,
            "started": controller.started,
            "travel_rad": controller.travel_rad,
            "stop_requests": controller.stop_requests,
            "rested_s": controller.rested_s,
            "warnings": controller.warnings,
            "gripper_on": self._gripper.on,
            "switched": self._gripper.switched,
            "asked": self._panel.asked,
            "egm": self._egm.state,
            "rws_requests": self._rws.requests,
            "clients": {name: port.clients for name, port in self._ports.items()},
        }


async def serve_irc5(options: AbbEmulatorOptions, ready: Ready, plant: Plant = ALONE) -> None:
    """Serve until this is cancelled; `ready` receives where. The axes are those of the plant, if it has some."""
    faults, host, clock = WireFaults(), options.host, plant.clock
    controller = EmulatedController(
        clock.now_s, axes=_axes(options.joints_rad), stop_s=options.stop_s, plant=plant.arm, load_kg=options.load_kg
    )
    gripper = EmulatedGripperSwitch(options.gripper_reply, plant.on_output)

    def new_motion_session() -> MotionSession:
        controller.forget_download()
        return MotionSession(controller, faults, byte_order=options.byte_order)

    state = StateSession(controller, byte_order=options.byte_order)
    panel = ControllerPanel(controller)
    signals = EmulatedSignals([name for name in options.signals.split(",") if name])
    rws = RwsServer(
        RwsResources(controller, panel, signals),
        faults,
        host=host,
        port=options.rws_port,
        user=options.rws_user,
        password=options.rws_password,
    )
    ports: dict[str, EmulatedPort] = {
        "motion": SingleClientServer(new_motion_session, faults, host=host, port=options.motion_port),
        "state": SingleClientServer(lambda: state, faults, host=host, port=options.state_port, messages=state.messages),
        "gripper": SingleClientServer(lambda: GripperSession(gripper), faults, host=host, port=options.gripper_port),
        "rws": rws,
    }
    egm = EgmSource(
        controller,
        panel,
        faults,
        client=_client(options.egm_client),
        clock=clock,
        stop_s=options.stop_s,
        comm_timeout_s=options.comm_timeout_s,
    )
    executed = ControllerFaults(
        controller, gripper, ports, faults, panel=panel, rws=rws, egm=egm, signals=signals
    ).execute
    side = SideChannel(executed, host=host, port=options.side_port)
    try:
        for port in ports.values():
            await port.open()
        await egm.open(host)
        places = {f"{name}_port": port.port for name, port in ports.items()}
        ready({"host": host, **places, "side_port": await side.open()})
        # Axes of its own follow when somebody asks; those of a world need their set points.
        wires = InputWires(plant.inputs, signals.set)
        while plant.arm is not None:
            controller.advance()
            wires.follow()
            await clock.sleep_until(clock.now_s() + _CYCLE_S)
        await asyncio.Event().wait()
    finally:
        side.close()
        egm.close()
        for port in ports.values():
            await port.close()


def _client(text: str) -> tuple[str, int] | None:
    if not text:
        return None
    host, _, port = text.rpartition(":")
    if not host or not port.isdecimal():
        raise FlexcellError(f"egm_client is {text!r}", hint="write HOST:PORT")
    return host, int(port)


def _axes(text: str) -> np.ndarray[Any, Any]:
    try:
        axes = np.array([float(word) for word in text.split(",")])
    except ValueError:
        axes = np.zeros(0)
    if axes.shape != (AXES,) or not np.isfinite(axes).all():
        raise FlexcellError(f"joints_rad is {text!r}", hint=f"write {AXES} numbers with commas")
    return axes


def _own_faults(fault: str) -> WireFaults:
    faults = {
        "cut": WireFaults(cut=True),
        "freeze": WireFaults(frozen=True),
        "garbage": WireFaults(garbage=True),
        "refuse": WireFaults(refuse=True),
    }
    return faults[fault]


def _number(value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise TypeError(f"{value!r} is no number")
    return float(value)
