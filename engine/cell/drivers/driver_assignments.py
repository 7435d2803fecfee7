"""Which devices of a cell document have a driver of their own: arms, equipment, and tools also of simulated arms."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, Literal, get_args

from engine.cell.drivers.driver import Driver, DriverOptions
from engine.cell.drivers.driver_registry import driver_options, installed_driver
from engine.document import Cell, DataPath
from engine.errors import CellError, FlexcellError

DeviceKind = Literal["arm", "tool", "equipment"]
_WORDS: dict[DeviceKind, str] = {"arm": "an arm", "tool": "a tool", "equipment": "equipment"}
_PLURALS: dict[DeviceKind, str] = {"arm": "arms", "tool": "tools", "equipment": "equipment"}


def driven_kind(driver: Driver) -> DeviceKind:
    """Return what a driver is for: a tool of whatever kind is a tool."""
    return next((kind for kind in get_args(DeviceKind) if kind == driver.drives), "tool")


@dataclass(frozen=True, kw_only=True)
class AssignedDriver:
    """One device with a driver; `path` leads to `driver` in the document, `model` is that of the arm or tool.

    `robot` is the name of the arm, of the arm that has the tool, or of the equipment, which has no model.
    """

    cell: Cell
    robot: str
    kind: str
    model: str
    path: DataPath
    device: DeviceKind

    @property
    def written_name(self) -> str:
        """The name of the device in the document: `left`, `vice`, or `left/gripper` of any tool."""
        return f"{self.robot}/gripper" if self.device == "tool" else self.robot

    @property
    def words(self) -> str:
        """What it is, for messages: `robot left`, `tool of robot left`, `equipment vice`."""
        prefix = {"arm": "robot", "tool": "tool of robot", "equipment": "equipment"}[self.device]
        return f"{prefix} {self.robot}"

    def driver(self) -> Driver:
        """Return the driver.

        Raises:
            RegistryError: there is none of this name, or it cannot be loaded.
            CellError: it drives something else than this device.
        """
        driver = installed_driver(self.kind)
        problem = self._misfit(driver)
        if problem:
            hint = f"see {driver.page}"
            raise CellError(problem, where=self.cell.source.position((*self.path, "kind")), hint=hint)
        return driver

    def options(self, driver: Driver) -> DriverOptions:
        """Return its options; raises DocumentError with the position of what is wrong."""
        return driver_options(driver, self.cell.source, self.path)

    def device_name(self, driver: Driver) -> str:
        """Return the bus namespace of the device: `left`, `vice`, or `left/gripper` of a tool."""
        return f"{self.robot}/{driver.drives}" if self.device == "tool" else self.robot

    def _misfit(self, driver: Driver) -> str:
        driven = driven_kind(driver)
        if driven != self.device:
            return f"the driver {driver.kind} drives {_PLURALS[driven]}, and this is {_WORDS[self.device]}"
        name = self.model.rstrip("/").rpartition("/")[2]
        if driver.models and name not in driver.models:
            return f"the driver {driver.kind} drives {', '.join(sorted(driver.models))}, not {self.model}"
        return ""


def assigned_drivers(cell: Cell) -> Iterator[AssignedDriver]:
    """Yield the devices of a cell that are not simulated and have a driver, in the order of the document."""
    yield from (each for each in written_drivers(cell) if each.written_name not in cell.simulated)


def written_drivers(cell: Cell) -> Iterator[AssignedDriver]:
    """Yield the devices for which the document names a driver, also those that are simulated instead."""
    kinds = {**cell.document.real_devices, **cell.simulated}
    for name, robot in cell.document.robots.items():
        if name in kinds:
            path: DataPath = ("robots", name, "driver")
            yield AssignedDriver(cell=cell, robot=name, kind=kinds[name], model=robot.model, path=path, device="arm")
        gripper, tool = robot.gripper, f"{name}/gripper"
        if gripper is not None and tool in kinds:
            path = ("robots", name, "gripper", "driver")
            yield AssignedDriver(cell=cell, robot=name, kind=kinds[tool], model=gripper.model, path=path, device="tool")
    for name in cell.document.equipment:
        if name in kinds:
            path = ("equipment", name, "driver")
            yield AssignedDriver(cell=cell, robot=name, kind=kinds[name], model="", path=path, device="equipment")


def digital_outputs(cell: Cell, robot: str, *, of_model: int) -> int:
    """Return how many digital outputs the controller of a robot has.

    Its driver says it, also while the robot is simulated instead; without a driver, or with one that leaves it to the
    model or cannot be loaded, it is `of_model`.
    """
    return _count_of_driver(cell, robot, lambda driver: driver.digital_outputs, of_model)


def digital_inputs(cell: Cell, robot: str, *, of_model: int) -> int:
    """Return how many digital inputs the controller of a robot has, as `digital_outputs`."""
    return _count_of_driver(cell, robot, lambda driver: driver.digital_inputs, of_model)


def _count_of_driver(
    cell: Cell, robot: str, count: Callable[[Driver], Callable[[Any], int] | None], of_model: int
) -> int:
    kind = {**cell.document.real_devices, **cell.simulated}.get(robot, "")
    if not kind:
        return of_model
    try:
        driver = installed_driver(kind)
        count_of = count(driver)
        if count_of is None:
            return of_model
        return count_of(driver_options(driver, cell.source, ("robots", robot, "driver")))
    except FlexcellError:
        return of_model  # the check of the cell reports why
