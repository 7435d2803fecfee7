"""Who has made an arm creep for a second is named, and so is who keeps an arm at rest from starting."""

from __future__ import annotations

import pytest

from engine.messages.separation import SeparationState
from robots.workspace.monitored_separation import MonitoredSeparation

REST_M = 0.48


def _measured(time_s: float, *, distance_m: float | None, share: float, monitoring: bool = True) -> SeparationState:
    return SeparationState(
        time_s=time_s, monitoring=monitoring, distance_m=distance_m, nearest="left/hand", permitted_share=share
    )


def _crept(until_s: float) -> MonitoredSeparation:
    separation = MonitoredSeparation(REST_M)
    for index in range(round(until_s / 0.02) + 1):
        separation.record("left", _measured(index * 0.02, distance_m=0.6, share=0.1))
    return separation


def test_who_makes_an_arm_creep_for_a_second_is_named_with_distance_and_body() -> None:
    assert _crept(0.9).slow_reason("left", for_s=1.0) == ""
    assert _crept(1.1).slow_reason("left", for_s=1.0) == (
        "an obstacle seen by the cameras is 0.60 m from left/hand: separation monitoring permits hardly any motion"
        " there, and none below 0.48 m"
    )
    assert _crept(1.1).slow_reason("left", for_s=2.0) == ""
    assert _crept(1.1).slow_reason("right", for_s=1.0) == ""


@pytest.mark.parametrize(
    "state",
    [
        _measured(1.2, distance_m=0.9, share=0.5),
        _measured(1.2, distance_m=None, share=0.0),
        _measured(1.2, distance_m=0.6, share=0.1, monitoring=False),
    ],
    ids=["gets on", "nobody is seen", "has no motion"],
)
def test_an_arm_does_not_creep_that(state: SeparationState) -> None:
    separation = _crept(1.1)
    separation.record("left", state)
    assert separation.slow_reason("left", for_s=1.0) == ""


def test_an_arm_that_begins_anew_has_not_crept_yet() -> None:
    separation = _crept(1.1)
    separation.begin("left")
    assert separation.slow_reason("left", for_s=1.0) == ""
    separation.record("left", _measured(1.2, distance_m=0.6, share=0.1))
    assert separation.slow_reason("left", for_s=1.0) == ""
    separation.record("left", _measured(2.3, distance_m=0.6, share=0.1))
    assert separation.slow_reason("left", for_s=1.0)


def test_nothing_starts_beside_somebody_and_voxels_that_flicker() -> None:
    separation = MonitoredSeparation(REST_M)
    assert separation.near_reason("left") == ""
    for distance_m, near in ((0.40, True), (0.50, True), (0.52, False), (None, False)):
        separation.record("left", _measured(0.0, distance_m=distance_m, share=0.0))
        assert bool(separation.near_reason("left")) is near, distance_m
    separation.record("left", _measured(0.0, distance_m=0.4, share=0.0, monitoring=False))
    assert separation.near_reason("left") == ""


def test_a_new_path_keeps_away_but_asks_for_no_more_than_the_arm_has() -> None:
    separation = MonitoredSeparation(REST_M)
    assert separation.apart_m("left") == pytest.approx(REST_M + 0.15)
    separation.record("left", _measured(0.0, distance_m=0.58, share=0.1))
    assert separation.apart_m("left") == pytest.approx(0.55)
    separation.record("left", _measured(0.0, distance_m=0.0, share=0.0))
    assert separation.apart_m("left") == 0.0
