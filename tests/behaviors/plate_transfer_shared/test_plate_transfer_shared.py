"""A person reaches into the path of the plate: the arm goes around or waits, and meets the person at rest if at all."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import msgspec
import pytest

from engine.cell.open_cell import OpenCell
from engine.event import GoalFinished
from engine.messages import JointState
from engine.runtime.run import Run
from engine.skills.people import ContactCount, CountContacts, Reach
from engine.skills.planning import FreeMotionResult
from tests.behaviors.application import Application, causes, shipped_cell
from tests.behaviors.stopping import stop_in
from tests.tiers import nightly

BEHAVIOR = "plate_transfer_shared/plate_transfer_shared.yaml"
CELL = "irb4600_shared"
LEFT_M = (1.1, 0.7, 0.704)
REST_RAD_S = 0.02
MEETING_S = 0.0
"""When the hand sets out so that an arm at full speed, which only brakes before what it predicts, meets it."""
TRANSFER = "root/carry/transfer"
QUICK: dict[str, object] = {"line_speed_m_s": 0.4}
"""The straight ways are not what these tests are about."""
_LOOK_S = 0.01
# Beyond friction, noise and what a push against a resting arm does.
_MOVING_RAD_S = 0.05


class Contacts:
    """The physics' count of contacts with the person, to the end of a run.

    `in_motion` are those that began while the arm moved.
    """

    def __init__(self) -> None:
        self.last: ContactCount | None = None
        self.in_motion = 0

    async def __call__(self, run: Run, cell: OpenCell) -> None:
        speed_rad_s = 0.0
        while True:
            before, self.last = self.last, await cell.bus.call(CountContacts(person="visitor"), to="cell")
            if before is not None and speed_rad_s > _MOVING_RAD_S:
                self.in_motion += self.last.contacts - before.contacts
            joints = cell.bus.topic("arm/joint_state", JointState).latest
            speed_rad_s = max(map(abs, joints.velocity_rad_s)) if joints is not None else 0.0
            await cell.bus.clock.sleep(_LOOK_S)

    @property
    def number(self) -> int:
        """How often anything and the person began to touch."""
        assert self.last is not None
        return self.last.contacts


def free_motion(done: Application, path: str) -> FreeMotionResult:
    """What the last collision-free motion of a state took."""
    ends: Sequence[GoalFinished] = [
        event
        for event in done.log
        if isinstance(event, GoalFinished) and event.path == path and "replans" in (event.result or {})
    ]
    return msgspec.convert(ends[-1].result, FreeMotionResult)


@pytest.mark.parametrize("seed", [None, nightly(1)])
def test_a_hand_in_the_way_is_gone_around_and_the_plate_lies_straight_on_the_left_pedestal(
    tmp_path: Path, seed: int | None
) -> None:
    """Within 5 mm and 1 degree of the place, wherever it lay; the arm stopped for the hand and never touched it."""
    contacts = Contacts()
    done = Application(behavior=BEHAVIOR, cell=shipped_cell(CELL), seed=seed, meanwhile=contacts)
    result = done.run(tmp_path)
    assert (result.outcome, causes(result)) == ("finished", "")
    plate = done.last("plate")
    assert plate.xyz == pytest.approx(LEFT_M, abs=0.005)
    assert abs(plate.xyzw[2]) < 0.01
    went = free_motion(done, TRANSFER)
    assert went.stops >= 1
    assert went.replans + went.reused >= 1
    assert contacts.number == 0
    assert done.greatest_last_speed_rad_s < REST_RAD_S


@pytest.mark.parametrize("after_s", [MEETING_S, *map(nightly, (0.2, 0.5, 0.6, 0.7, 0.8, 1.0, 1.2))])
def test_whenever_a_person_comes_the_arm_drives_into_nobody(tmp_path: Path, after_s: float) -> None:
    """Braking alone is too late for some of these: the hand comes from the side into a path that was free."""
    contacts = Contacts()
    done = Application(
        behavior=BEHAVIOR, cell=shipped_cell(CELL), parameters={"person_after_s": after_s}, meanwhile=contacts
    )
    result = done.run(tmp_path)
    assert (result.outcome, causes(result)) == ("finished", "")
    assert contacts.in_motion == 0


def test_without_monitoring_of_the_distance_the_arm_drives_into_who_comes(tmp_path: Path) -> None:
    """Or the test above would show nothing."""
    contacts = Contacts()
    cell = shipped_cell(CELL)
    document = msgspec.structs.replace(cell.document, speed_and_separation_monitoring=None)
    done = Application(
        behavior=BEHAVIOR,
        cell=replace(cell, document=document),
        parameters={"person_after_s": MEETING_S},
        meanwhile=contacts,
    )
    done.run(tmp_path)
    assert contacts.in_motion > 0


def test_nobody_in_the_way_is_nothing_to_stop_for(tmp_path: Path) -> None:
    """The arm itself, its plate and the pedestals are no obstacles that the cameras see."""
    done = Application(behavior=BEHAVIOR, cell=shipped_cell(CELL), parameters={"person": "none", **QUICK})
    result = done.run(tmp_path)
    assert (result.outcome, causes(result)) == ("finished", "")
    motions = [
        free_motion(done, path) for path in ("root/home", "root/pick", TRANSFER, "root/place", "root/home_again")
    ]
    assert [(motion.stops, motion.replans) for motion in motions] == [(0, 0)] * 5


def test_a_hand_that_stays_over_the_place_is_waited_for_and_then_named(tmp_path: Path) -> None:
    """The arm stands still with its plate, nearer than where it set out, and touches nobody."""
    contacts = Contacts()
    waited = Application(
        behavior=BEHAVIOR,
        cell=shipped_cell(CELL),
        parameters={"person": "stays", "patience_s": 4.0, **QUICK},
        meanwhile=contacts,
    )
    result = waited.run(tmp_path)
    assert result.outcome == "blocked"
    assert "no path is free for 4 s" in causes(result)
    assert "an obstacle seen by the cameras" in causes(result)
    assert waited.left[-3:] == [f"{TRANSFER} blocked", "root/carry blocked", "root blocked"]
    assert waited.last("plate").xyz[2] > 0.75
    assert waited.greatest_last_speed_rad_s < REST_RAD_S
    assert contacts.number == 0


@pytest.mark.nightly
def test_a_hand_that_is_there_before_the_way_is_looked_for_is_waited_for_as_well(tmp_path: Path) -> None:
    """Over the left pedestal for some seconds from the start: at first there is no way to there."""
    contacts = Contacts()

    async def reach_early(run: Run, cell: OpenCell) -> None:
        await cell.bus.call(Reach(person="visitor", hand_m=(1.12, 0.6, 0.98), stay_s=7.0), to="cell")
        await contacts(run, cell)

    done = Application(
        behavior=BEHAVIOR, cell=shipped_cell(CELL), parameters={"person": "none", **QUICK}, meanwhile=reach_early
    )
    result = done.run(tmp_path)
    assert (result.outcome, causes(result)) == ("finished", "")
    transfer = free_motion(done, TRANSFER)
    assert (transfer.stops, transfer.waited_s > 0.5) == (0, True)
    assert contacts.number == 0


def test_stopped_while_it_goes_around_the_arm_rests_and_keeps_the_plate(tmp_path: Path) -> None:
    stopped = Application(behavior=BEHAVIOR, cell=shipped_cell(CELL), parameters=QUICK, meanwhile=stop_in(TRANSFER))
    result = stopped.run(tmp_path)
    assert result.status == "stopped"
    assert stopped.greatest_last_speed_rad_s < REST_RAD_S
    assert stopped.last("plate").xyz[2] > 0.75
