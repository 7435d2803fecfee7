"""A cell with an arm that is not simulated: what it publishes is measured."""

from __future__ import annotations

from pathlib import Path
from types import TracebackType
from typing import Any, Self

import pytest

import engine.cell.drivers.driver_registry
from engine.bus import SkillBus
from engine.cell.drivers import DeviceContext, Driver, DriverOptions
from engine.cell.open_cell import OpenCell
from engine.clock import Clock
from engine.document.cell import load_cell
from engine.robot import DeviceStatus
from tests.engine.measures.published_arm import RATE_RAD_S, describe, press, turn

CELL = "flexcell: 1\ncell: c\nrobots: {left: {model: panda, driver: {kind: other}}}\n"


class OtherOptions(DriverOptions, frozen=True, kw_only=True, tag="other"):
    """None."""


class PublishingArm:
    """A driver's arm; implements `Robot`."""

    status = DeviceStatus.READY

    def __init__(self, options: OtherOptions, *, name: str, clock: Clock, context: DeviceContext) -> None:
        self.name = name

    def register(self, bus: SkillBus) -> None:
        describe(bus, self.name)

    async def stop(self) -> None:
        """It does not move."""

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Nothing to close."""


class MeasuringArm(PublishingArm):
    """One that measures by itself, better than its topics tell; implements `MeasurePort`, too."""

    def measures(self) -> dict[str, float]:
        return {f"{self.name}.force_max_n": 7.0}


@pytest.mark.virtual
@pytest.mark.parametrize(("kind", "force_n"), [(PublishingArm, 5.0), (MeasuringArm, 7.0)])
async def test_a_real_arm_is_measured_by_its_topics(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, kind: type[PublishingArm], force_n: float
) -> None:
    """By the names of a simulated one; what its driver measures itself counts instead."""

    driver = Driver(
        kind="other",
        drives="arm",
        options=OtherOptions,
        capabilities=frozenset({"trajectory"}),
        ports={},
        proven="nothing",
        page="nowhere",
        device=f"{__name__}:{kind.__name__}",
    )

    def load(group: str, name: str) -> Any:
        return driver

    monkeypatch.setattr(engine.cell.drivers.driver_registry, "load_factory", load)
    (tmp_path / "cell.yaml").write_text(CELL, encoding="utf-8")
    async with OpenCell(load_cell(tmp_path / "cell.yaml")) as cell:
        turn(cell.bus, 0.0)
        turn(cell.bus, 1.0)
        press(cell.bus, 5.0, 0.3)
        found = cell.measures()
    assert found == {
        "left.joint_path_rad": pytest.approx(RATE_RAD_S),
        "left.force_max_n": pytest.approx(force_n),
        "left.torque_max_nm": pytest.approx(0.3),
    }
