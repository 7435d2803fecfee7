"""An arm reconfigures two hexapods for a product; loose brakes, lost air and poses out of reach are found."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest

from engine.cell.open_cell import OpenCell
from engine.document import load_cell
from engine.document.faults import load_faults
from engine.errors import DocumentError
from engine.messages import Pose
from engine.runtime.run import Run
from engine.skills.hexapods import HexapodReading, ReadHexapod
from states.equipment.hexapod_error import HexapodError
from tests.behaviors.application import BEHAVIORS, Application, causes, shipped_cell
from tests.tiers import nightly

BEHAVIOR = "hexapods/new_product.yaml"


class Watch:
    """Where the platforms were when it last looked."""

    def __init__(self, **poses: str) -> None:
        self.poses = poses
        self.last: dict[str, HexapodReading] = {}

    async def look(self, _run: Run, cell: OpenCell) -> None:
        """Look every tenth of a second."""
        while True:
            for jig, pose in self.poses.items():
                self.last[jig] = await cell.bus.call(ReadHexapod(pose=pose), to=f"{jig}/legs")
            await asyncio.sleep(0.1)

    def error(self, jig: str) -> HexapodError:
        """Return how far a platform was from its pose."""
        return HexapodError.between(self.last[jig].platform, self.last[jig].target)


def with_fault(name: str, watch: Watch) -> Application:
    """Return the application with a fault file that ships with it."""
    faults = load_faults(BEHAVIORS / "hexapods" / "faults" / f"{name}.yaml")
    return Application(behavior=BEHAVIOR, cell=shipped_cell("hexapods"), seed=1, faults=faults, meanwhile=watch.look)


@pytest.mark.parametrize("seed", [1, *map(nightly, range(2, 21))])
def test_both_platforms_stand_where_the_product_needs_them(tmp_path: Path, seed: int) -> None:
    """With the errors of a typical arm: the world has them within 0.5 mm and 0.2°, and no leg is beyond its limits."""
    watch = Watch(north_jig="tilted", south_jig="aside")
    done = Application(behavior=BEHAVIOR, cell=shipped_cell("hexapods"), seed=seed, meanwhile=watch.look)
    result = done.run(tmp_path)
    assert (result.outcome, causes(result)) == ("ready", "")
    for jig in watch.poses:
        assert watch.error(jig).within(0.0005, 0.0035)
        assert all(0.15 < length < 0.23 for length in watch.last[jig].lengths_m)
    assert {"root/north/root/pull contact", "root/south/root/pull contact"} <= set(done.left)


def test_brakes_that_do_not_hold_are_found_by_the_arm_before_it_lets_go(tmp_path: Path) -> None:
    watch = Watch(north_jig="tilted")
    done = with_fault("loose_brakes", watch)
    assert done.run(tmp_path).outcome == "loose"
    assert {"root/north/root/move reached", "root/north/root/pull no_contact"} <= set(done.left)
    assert watch.error("north_jig").error_m > 0.001


def test_brakes_without_air_stay_closed(tmp_path: Path) -> None:
    watch = Watch(north_jig="level")
    done = with_fault("no_air", watch)
    result = done.run(tmp_path)
    assert result.outcome == "failed"
    assert "the pressure switch air is off" in causes(result)
    assert watch.error("north_jig").error_m < 0.0001


def test_a_pose_that_no_leg_reaches_is_refused_by_the_check(tmp_path: Path) -> None:
    module = (BEHAVIORS / "modules" / "hexapod" / "module.yaml").read_text(encoding="utf-8")
    (tmp_path / "hexapod").mkdir()
    (tmp_path / "hexapod" / "module.yaml").write_text(
        module.replace("high: {xyz: [0, 0, 0.205]}", "high: {xyz: [0, 0, 0.26]}"), encoding="utf-8"
    )
    cell = (BEHAVIORS / "cells" / "hexapods.yaml").read_text(encoding="utf-8")
    (tmp_path / "cell.yaml").write_text(cell.replace("../modules/hexapod", "hexapod"), encoding="utf-8")
    with pytest.raises(DocumentError, match=r"at the pose `high`, leg 1 would be 2\d\.\d mm longer than its 230\.0 mm"):
        load_cell(tmp_path / "cell.yaml")


def test_nothing_of_the_cell_is_touched_while_one_is_moved(tmp_path: Path) -> None:
    """The south jig stands still while the arm works at the north one."""
    watch = Watch(south_jig="level")
    done = Application(
        behavior="hexapods/reconfigure.yaml",
        cell=shipped_cell("hexapods"),
        seed=3,
        parameters={"jig": "north_jig", "pose": "turned"},
        meanwhile=watch.look,
    )
    assert done.run(tmp_path).outcome == "at_pose"
    south: Pose = watch.last["south_jig"].platform
    assert south.xyz == pytest.approx((0.6, -0.35, 0.19), abs=5e-5)
