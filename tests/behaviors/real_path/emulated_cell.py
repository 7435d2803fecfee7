"""A shipped cell with drivers, its emulator as a program of its own, and behaviors that run against it."""

from __future__ import annotations

import json
import math
import socket
import subprocess
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from tests.behaviors.application import BEHAVIORS, changed_cell
from tests.engine.cli.command import FLEXCELL
from tests.robots.own_address import own_address

# A machine that is shared with others falls behind for seconds; nothing here is about how long anything takes.
PATIENT_WORLD = "step_s: 0.001, engine_silence_s: 10.0, world_silence_s: 10.0"
_PATIENT_IRC5 = "stale_s: 5.0, timeout_s: 5.0, patience_s: 300.0"
PATIENT_FR3 = "stale_s: 5.0, process_silence_s: 10.0, path_tolerance_rad: 0.4"
PATIENT_2F_85 = "stale_s: 5.0, timeout_s: 2.0, patience_s: 300.0"
PATIENT_HAND = "stale_s: 5.0, timeout_s: 5.0, patience_s: 300.0"
_PATIENT_BOARD = "stale_s: 5.0, process_silence_s: 10.0, path_tolerance_rad: 1.0"
# Nothing reports the end of a switch: a world that is slower than real time gets time for it.
_PATIENT_SWITCH = "hold_s: 4.0, release_s: 4.0"
_START_S = 120.0


@dataclass(frozen=True)
class RealPath:
    """An application: its behavior, below `behaviors/`, its cell, and how that gets its drivers at an address.

    `parameters` are those of the behavior, where devices that report nothing need slower motions on a slow machine.
    """

    name: str
    behavior: str
    cell: str
    with_drivers: Callable[[str, str], str]
    parameters: tuple[str, ...] = ()

    def write_cell(self, folder: Path, host: str) -> Path:
        """Write the shipped cell with drivers to a folder."""

        def change(text: str) -> str:
            return self.with_drivers(text.replace("step_s: 0.001", PATIENT_WORLD), host)

        changed_cell(self.cell, folder, cell=change)
        return folder / "cells" / f"{self.cell}.yaml"


def _ur10(text: str, host: str) -> str:
    arm = f"{{kind: universal_robots, host: {host}, stale_s: 5.0, watchdog_hz: 1.0, process_silence_s: 10.0}}"
    line = f"{{kind: modbus_tcp, host: {host}, port: 15020}}"
    gripper = f"driver: {{kind: robotiq, connection: {line}, {PATIENT_2F_85}}}"
    return text.replace("driver: sim", f"driver: {arm}").replace(
        "{model: robotiq_2f85}", f"{{model: robotiq_2f85, {gripper}}}"
    )


def _irb4600(text: str, host: str) -> str:
    gripper = "{reply: any, reply_s: 5.0}"
    rws = "{port: 8080, inputs: [diPlate], timeout_s: 5.0, stale_s: 20.0}"
    arm = f"{{kind: abb_irc5, host: {host}, gripper: {gripper}, rws: {rws}, loads: defined_there, {_PATIENT_IRC5}}}"
    magnet = f"driver: {{kind: switched_magnet, sensor: {{input: 0}}, {_PATIENT_SWITCH}}}"
    return text.replace("driver: sim", f"driver: {arm}").replace("{model: magnet}", f"{{model: magnet, {magnet}}}")


def _servo_arm(text: str, host: str) -> str:
    arm = f'{{kind: servo_arm, device: "socket://{host}:5002", {_PATIENT_BOARD}}}'
    claw = f"driver: {{kind: switched_gripper, assume_held: true, {_PATIENT_SWITCH}}}"
    return text.replace("driver: sim", f"driver: {arm}").replace(
        "{model: servo_claw}", f"{{model: servo_claw, {claw}}}"
    )


def _dual_fr3(text: str, host: str) -> str:
    """Pandas have another interface: FR3 with the same links and hands stand in their places."""
    first, second, third, fourth = host.split(".")
    for number, robot in enumerate(("left", "right")):
        own = f"host: {first}.{second}.{third}.{int(fourth) + number}"
        arm = f"driver: {{kind: franka, {own}, real_time: ignore, {PATIENT_FR3}}}"
        hand = f"{{model: panda_hand, driver: {{kind: franka_hand, {own}, {PATIENT_HAND}}}}}"
        assert f"  {robot}:\n    model: panda\n    driver: sim\n" in text
        text = text.replace("    model: panda\n    driver: sim\n", f"    model: fr3\n    {arm}\n", 1)
        text = text.replace("{model: panda_hand}", hand, 1)
    return text


TWO_ARM_TRANSFER = RealPath(
    "Transfer: two FR3 and their hands", "reconcycle/two_arm_transfer.yaml", "dual_panda", _dual_fr3
)
TEST_CYLINDER = RealPath(
    "A4: servo arm and claw", "test_cylinder/test_cylinder.yaml", "servo_arm", _servo_arm, ("speed=0.04",)
)
PLATE_TRANSFER = RealPath("A3: IRB 4600 and magnet", "plate_transfer/plate_transfer.yaml", "irb4600", _irb4600)
PICK_AND_PLACE = RealPath("A2: UR10 and Robotiq 2F-85", "pick_and_place/pick_and_place.yaml", "ur10", _ur10)


class EmulatedCell:
    """`flexcell emulate cell`, from its ready line to the end of the block."""

    def __init__(self, path: RealPath, folder: Path, *, seed: int | None = None) -> None:
        self._path = path
        self._folder = folder
        self._seed = seed
        self.cell = path.write_cell(folder, own_address())

    def __enter__(self) -> Self:
        options = [f"file={self.cell}", *([f"seed={self._seed}"] if self._seed is not None else [])]
        self._process = subprocess.Popen([FLEXCELL, "emulate", "cell", *options], stdout=subprocess.PIPE, text=True)
        assert self._process.stdout is not None
        line = self._process.stdout.readline()
        assert line, f"the emulator has ended with exit code {self._process.wait()}"
        self._place: Mapping[str, Any] = json.loads(line)["ready"]
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self._process.terminate()
        code = self._process.wait(_START_S)
        assert self._process.stdout is not None
        self._process.stdout.close()
        assert error is not None or code == 0

    def run(self, *options: str, limit_s: float) -> subprocess.CompletedProcess[str]:
        """Run the shipped behavior in the cell."""
        return run_in(self.cell, self._path, *options, limit_s=limit_s)

    def state(self) -> Mapping[str, Any]:
        """Return where everything is in the world of the emulators."""
        with socket.create_connection((self._place["host"], self._place["side_port"]), timeout=_START_S) as side:
            side.sendall(b'{"do": "state"}\n')
            return json.loads(side.makefile().readline())

    def part(self, name: str) -> tuple[float, float, float]:
        """Return the centre of a part there."""
        x, y, z = self.state()["parts"][name]["xyz"]
        return x, y, z

    def tilt_rad(self, name: str) -> float:
        """Return how far the z axis of a part is from up there."""
        x, y, _, _ = self.state()["parts"][name]["xyzw"]
        return math.acos(max(-1.0, min(1.0, 1.0 - 2.0 * (x * x + y * y))))


def run_in(cell: Path, path: RealPath, *options: str, limit_s: float) -> subprocess.CompletedProcess[str]:
    """Run the shipped behavior of an application in a cell."""
    folder = cell.parent
    given = ["--cell", cell, "--store", folder / "store.db", "--journal", "none", *options]
    given += [word for parameter in path.parameters for word in ("-p", parameter)]
    return subprocess.run(
        [FLEXCELL, "run", BEHAVIORS / path.behavior, *given],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
        timeout=limit_s,
    )
