"""The side channel of the emulator: JSON lines that cause faults, wait for states, and read the true state.

`{"do": "protective_stop"}` is answered with `{"ok": true}`, `{"do": "state"}` with the state, and what is not
understood with `{"error": …}`. `{"do": "wait", "until": "at_rest"}` is answered when it is so.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
from typing import Literal

import msgspec

from robots.drivers.universal_robots.emulator.controller_state import ControllerState, UrRuntimeState
from robots.drivers.universal_robots.emulator.link_faults import LinkFaults

_READ_LIMIT_BYTES = 65_536


class EmulatorRequest(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One line of the side channel."""

    do: Literal[
        "state", "wait", "protective_stop", "emergency_stop", "release_emergency_stop", "digital_input", "contact",
        "force", "remote", "freeze", "drop", "cut", "slow", "slow_start", "garbage",
        "restore",
    ]  # fmt: skip
    until: Literal["", "moving", "at_rest", "playing", "stopped", "unlockable"] = ""
    bit: int = 0
    value: float = 0.0
    force_n: tuple[float, float, float, float, float, float] = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


class ControllerSideChannel:
    """Answers one connection per line, while a cycle goes on for the others."""

    def __init__(self, controller: ControllerState, faults: LinkFaults) -> None:
        self._controller = controller
        self._faults = faults
        self._waiting: list[tuple[Callable[[], bool], asyncio.Future[None]]] = []

    def after_cycle(self) -> None:
        """Answer the requests that wait for a state that has come."""
        for condition, future in self._waiting:
            if not future.done() and condition():
                future.set_result(None)
        self._waiting = [waiting for waiting in self._waiting if not waiting[1].done()]

    async def serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """Answer the lines of one connection."""
        try:
            while line := await reader.readline():
                writer.write(msgspec.json.encode(await self._answer(line)) + b"\n")
        except (ConnectionError, ValueError):
            pass  # the client has ended, or its line has no end
        except asyncio.CancelledError:
            pass  # the emulator ends: asyncio would report this as an error of the handler
        finally:
            writer.close()

    async def _answer(self, line: bytes) -> Mapping[str, object]:
        try:
            request = msgspec.json.decode(line, type=EmulatorRequest)
        except (msgspec.DecodeError, UnicodeDecodeError) as error:
            return {"error": str(error)}
        if request.do == "state":
            return self.state()
        if request.do == "wait":
            return await self._wait(request)
        self._apply(request)
        return {"ok": True}

    async def _wait(self, request: EmulatorRequest) -> Mapping[str, object]:
        controller = self._controller
        conditions: Mapping[str, Callable[[], bool]] = {
            "moving": lambda: not controller.arm.is_at_rest,
            "at_rest": lambda: controller.arm.is_at_rest,
            "playing": lambda: controller.runtime_state is UrRuntimeState.PLAYING,
            "stopped": lambda: controller.runtime_state is UrRuntimeState.STOPPED,
            "unlockable": lambda: controller.safety.can_unlock(controller.time_s),
        }
        if request.until not in conditions:
            return {"error": f"`until` is one of {', '.join(conditions)}"}
        condition = conditions[request.until]
        if not condition():
            future = asyncio.get_running_loop().create_future()
            self._waiting.append((condition, future))
            await future
        return self.state()

    def _apply(self, request: EmulatorRequest) -> None:
        controller = self._controller
        match request.do:
            case "protective_stop":
                controller.protective_stop("by the side channel")
            case "emergency_stop":
                controller.emergency_stop()
            case "release_emergency_stop":
                controller.safety.release_emergency_stop()
            case "digital_input":
                bit = 1 << min(max(request.bit, 0), 17)
                controller.digital_inputs = controller.digital_inputs & ~bit | (bit if request.value else 0)
            case "contact":
                controller.contact_steps = int(request.value)
            case "force":
                controller.tcp_force_n = request.force_n
            case "remote":
                controller.is_remote = bool(request.value)
            case "freeze":
                self._faults.freeze()
            case "drop" | "cut":
                self._faults.cut(stay=request.do == "cut")
            case "slow":
                self._faults.delay_s = max(0.0, request.value)
            case "slow_start":
                controller.start_delay_s = max(0.0, request.value)
            case "garbage":
                self._faults.garbles = True
            case _:
                controller.start_delay_s = 0.0
                self._faults.restore()

    def state(self) -> Mapping[str, object]:
        """Return what the controller knows, and no client may be told otherwise."""
        controller = self._controller
        return {
            "time_s": controller.time_s,
            "written_s": controller.written_s,
            "q": controller.arm.measured_q.tolist(),
            "qd": controller.arm.measured_qd.tolist(),
            "tcp_pose": controller.arm.measured_tcp_pose(),
            "tcp_offset": controller.arm.tcp_offset,
            "robot_mode": controller.safety.robot_mode.name,
            "safety_mode": controller.safety.safety_mode.name,
            "runtime_state": controller.runtime_state.name,
            "program": controller.program_name,
            "speed_fraction": controller.speed_fraction,
            "payload_kg": controller.payload_kg,
            "digital_outputs": controller.digital_outputs,
            "digital_inputs": controller.digital_inputs,
            "is_remote": controller.is_remote,
            "connections": self._faults.connections,
            "messages": list(controller.messages),
        }
