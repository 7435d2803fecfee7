"""Serves an emulated board on one line, and its faults on the side channel, until it is cancelled."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping

from engine.cell.drivers import Ready
from robots.drivers.emulation.byte_stream import PtyStream, TcpStream
from robots.drivers.emulation.plant import ALONE, Plant
from robots.drivers.emulation.serve_emulator import execute_wire_fault, serve_emulator
from robots.drivers.emulation.side_channel import Request
from robots.drivers.emulation.wire_faults import WireFaults
from robots.drivers.servo_arm.emulation.board_session import BoardPower, BoardSession
from robots.drivers.servo_arm.emulation.driven_servos import drive_servos
from robots.drivers.servo_arm.emulation.emulated_board import EmulatedBoard
from robots.drivers.servo_arm.emulation.servo_arm_emulator import ServoArmEmulatorOptions

_HOME_DEG = (0.0, 160.0)
_READY = b"READY flexcell_servo_arm 1\n"


class BoardFaults:
    """Executes the requests of the side channel: `do` names what, further keys its values.

    Faults of the wire as `execute_wire_fault`. unplug: the line is gone; plug: there is one again, at the returned
    place. reset: the board starts anew. error: each line is refused with `words`, empty for none. state: the true
    state.
    """

    def __init__(
        self,
        board: EmulatedBoard,
        power: BoardPower,
        stream: TcpStream | PtyStream,
        faults: WireFaults,
        *,
        boot_s: float,
        answers: bool,
    ) -> None:
        self._board = board
        self._power = power
        self._stream = stream
        self._faults = faults
        self._boot_s = boot_s
        self._answers = answers

    async def execute(self, request: Request) -> Mapping[str, object]:
        """Execute one request; raises KeyError, TypeError or ValueError for what is not one."""
        board = self._board
        board.advance()
        match str(request["do"]):
            case "unplug":
                await self._stream.unplug()
            case "plug":
                place = await self._stream.open()
                self.reset()
                return {"ok": True, **place}
            case "reset":
                self.reset()
            case "error":
                board.defect = str(request["words"])
            case "state":
                return self._state()
            case _:
                await execute_wire_fault(request, self._faults, self._stream)
        return {"ok": True}

    def reset(self) -> None:
        """Start the board, which says READY after a while."""
        self._power.on = False
        self._board.restart()
        asyncio.get_running_loop().call_later(self._boot_s, self._start)

    def _start(self) -> None:
        self._power.on = True
        if self._answers:
            self._stream.send(_READY)

    def _state(self) -> Mapping[str, object]:
        board = self._board
        return {
            "time_s": board.now_s(),
            "moving": board.moving,
            "angles_deg": board.written_deg[:-1],
            "claw_deg": board.written_deg[-1],
            "halt": board.halt,
            "travel": board.travel,
            "commands": board.commands,
            "moved_s": board.moved_s,
            "clients": self._stream.clients,
        }


async def serve_board(options: ServoArmEmulatorOptions, ready: Ready, plant: Plant = ALONE) -> None:
    """Serve until this is cancelled; `ready` receives where. Servos and claw are those of the plant, if it has some."""
    faults, power = WireFaults(), BoardPower()
    answers = options.sketch == "flexcell"
    watchdog_s = options.watchdog_s if answers else 0.0
    board = EmulatedBoard(plant.clock.now_s, home_deg=_HOME_DEG, max_deg_s=options.max_deg_s, watchdog_s=watchdog_s)

    def new_session() -> BoardSession:
        return BoardSession(board, power, answers=answers)

    stream = (
        PtyStream(new_session, faults)
        if options.connection == "serial"
        else TcpStream(new_session, faults, host=options.host, port=options.port)
    )
    board_faults = BoardFaults(board, power, stream, faults, boot_s=options.boot_s, answers=answers)
    if isinstance(stream, TcpStream):
        # Opening the line resets the board, as DTR does; a pty has no such signal.
        stream.when_connected(board_faults.reset)
    async with asyncio.TaskGroup() as group:
        servos = group.create_task(drive_servos(board, plant))
        try:
            await serve_emulator(
                stream,
                board_faults.execute,
                ready,
                connection=options.connection,
                host=options.host,
                side_port=options.side_port,
            )
        finally:
            servos.cancel()
