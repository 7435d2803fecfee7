"""The arm puts a board into a cutter and takes its battery away; what is not cut comes along, and is found so."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.document.cell import load_cell
from engine.document.faults import load_faults
from tests.behaviors.application import BEHAVIORS, Application, causes, shipped_cell
from tests.tiers import nightly

BEHAVIOR = "cutter/cut_battery.yaml"


@pytest.mark.parametrize("seed", [1, *map(nightly, range(2, 21))])
def test_the_cutter_cuts_the_battery_off_and_the_arm_takes_it_away_alone(tmp_path: Path, seed: int) -> None:
    done = Application(behavior=BEHAVIOR, cell=shipped_cell("cutter"), seed=seed)
    result = done.run(tmp_path)
    assert (result.outcome, causes(result)) == ("separated", "")
    carried = [one.parts for one in done.seen if one.parts.poses["board"].xyz[2] > 0.2]
    assert carried
    assert all(parts.joined == {"battery": ("board",), "board": ("battery",)} for parts in carried)
    assert done.seen[-1].parts.joined == {}
    assert done.last("battery").xyz == pytest.approx((0.3, -0.45, 0.13), abs=0.004)
    assert done.last("board").xyz == pytest.approx((0.4745, 0.3, 0.13), abs=0.01)


def test_solder_that_is_too_hard_is_found_by_the_board_that_comes_along(tmp_path: Path) -> None:
    """The blades press with 120 N, and with 137 N as they arrive; no sensor of the cutter can tell."""
    text = (BEHAVIORS / "cells" / "cutter.yaml").read_text(encoding="utf-8")
    assert "cut_n: 60, jitter: 0.2" in text
    file = tmp_path / "cutter.yaml"
    file.write_text(
        text.replace("cut_n: 60, jitter: 0.2", "cut_n: 150").replace("../modules", str(BEHAVIORS / "modules")),
        encoding="utf-8",
    )
    done = Application(behavior=BEHAVIOR, cell=load_cell(file), seed=1)
    assert done.run(tmp_path).outcome == "still_joined"
    assert {"root/cut reached", "root/take picked", "root/look elsewhere"} <= set(done.left)


@pytest.mark.parametrize(
    ("name", "left", "reason"),
    [
        ("no_air", "root/cut no_air", "the pressure switch air is off"),
        ("stuck_blade", "root/cut stuck", "on_part is off, is_open is on after 2 s; nothing has changed"),
        ("stuck_blade_untold", "root/cut stuck", "on_part is off after 2 s; it left its place"),
        ("wrong_sensor", "root/cut sensor_contradicts", "is_open and on_part of the axis left are both on"),
    ],
)
def test_each_fault_is_an_outcome_with_its_cause_and_a_blade_that_does_not_press_cuts_nothing(
    tmp_path: Path, name: str, left: str, reason: str
) -> None:
    """With a wrong sensor the blades cut all the same."""
    faults = load_faults(BEHAVIORS / "cutter" / "faults" / f"{name}.yaml")
    done = Application(behavior=BEHAVIOR, cell=shipped_cell("cutter"), seed=1, faults=faults)
    result = done.run(tmp_path)
    assert (result.outcome, left in done.left) == ("equipment_failed", True)
    assert reason in causes(result)
    assert bool(done.seen[-1].parts.joined) is (name != "wrong_sensor")
