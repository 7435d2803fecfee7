"""An arm pulls its own base along a rail and back; loose, stuck and airless brakes are found, and what cannot be."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.cell.open_cell import OpenCell
from engine.document import load_cell
from engine.document.faults import load_faults
from engine.errors import DocumentError
from engine.runtime.run import Run
from engine.skills.arm_control import SetLoad
from engine.skills.linear_units import ReadLinearUnit
from tests.behaviors.application import BEHAVIORS, Application, causes, shipped_cell
from tests.tiers import nightly

BEHAVIOR = "linear_unit/there_and_back.yaml"


class Watch:
    """Where the carriage was, as the world has it, in metres."""

    def __init__(self, *, load_kg: float = 0.0) -> None:
        self.places: list[float] = []
        self._load_kg = load_kg

    async def look(self, _run: Run, cell: OpenCell) -> None:
        """Look every tenth of a second of the virtual clock."""
        if self._load_kg:
            await cell.bus.call(SetLoad(mass_kg=self._load_kg, com_m=(0.0, 0.0, 0.0)), to="arm")
        while True:
            self.places.append((await cell.bus.call(ReadLinearUnit(place="south"), to="rail")).place_m)
            await cell.bus.clock.sleep(0.1)


def with_fault(name: str, watch: Watch) -> Application:
    """Return the application with a fault file that ships with it."""
    faults = load_faults(BEHAVIORS / "linear_unit" / "faults" / f"{name}.yaml")
    return Application(behavior=BEHAVIOR, cell=shipped_cell("linear_unit"), seed=1, faults=faults, meanwhile=watch.look)


@pytest.mark.parametrize(
    ("seed", "by"), [(1, "scale"), nightly(1, "arm"), *(nightly(seed, "scale") for seed in range(2, 21))]
)
def test_the_base_goes_along_the_rail_and_back_within_a_millimetre(tmp_path: Path, seed: int, by: str) -> None:
    """With the errors of a typical arm; the world has the carriage 0.8 m away in between."""
    watch = Watch()
    cell = shipped_cell("linear_unit")
    done = Application(behavior=BEHAVIOR, cell=cell, seed=seed, parameters={"measured_by": by}, meanwhile=watch.look)
    result = done.run(tmp_path)
    assert (result.outcome, causes(result)) == ("back", "")
    assert {"root/there/root/check at_place", "root/return/root/check at_place"} <= set(done.left)
    there = watch.places[len(watch.places) // 2]
    assert abs(there - 0.8) < 0.001
    assert abs(watch.places[-1]) < 0.001


def test_brakes_that_do_not_hold_are_found_by_the_arm_before_it_lets_go(tmp_path: Path) -> None:
    watch = Watch()
    done = with_fault("loose_brakes", watch)
    assert done.run(tmp_path).outcome == "loose"
    assert {"root/there/root/pull reached", "root/there/root/press no_contact"} <= set(done.left)


def test_an_arm_pulls_in_vain_at_brakes_that_are_stuck(tmp_path: Path) -> None:
    watch = Watch()
    done = with_fault("stuck_brakes", watch)
    result = done.run(tmp_path)
    assert result.outcome == "failed"
    assert "arm did not pull its base" in causes(result)
    assert max(abs(place) for place in watch.places) < 0.001


def test_brakes_without_air_stay_closed(tmp_path: Path) -> None:
    watch = Watch()
    done = with_fault("no_air", watch)
    result = done.run(tmp_path)
    assert result.outcome == "failed"
    assert "the pressure switch air is off" in causes(result)
    assert max(abs(place) for place in watch.places) < 0.0001


def test_an_arm_that_carries_too_much_does_not_pull(tmp_path: Path) -> None:
    watch = Watch(load_kg=3.5)
    cell = shipped_cell("linear_unit")
    done = Application(behavior=BEHAVIOR, cell=cell, seed=1, meanwhile=watch.look)
    result = done.run(tmp_path)
    assert result.outcome == "refused"
    assert "root/there/root/pull refused" in done.left
    assert max(abs(place) for place in watch.places) < 0.0001


def test_a_place_beyond_the_travel_is_refused_by_the_check(tmp_path: Path) -> None:
    cell = (BEHAVIORS / "cells" / "linear_unit.yaml").read_text(encoding="utf-8")
    (tmp_path / "cell.yaml").write_text(cell.replace("north: 0.8", "north: 0.86"), encoding="utf-8")
    with pytest.raises(DocumentError, match=r"at the place `north`, the carriage would be 10\.0 mm beyond its travel"):
        load_cell(tmp_path / "cell.yaml")
