"""Garbage on the wire while an arm moves: it keeps on its path or stops, and what ends a motion has a name."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractAsyncContextManager
from pathlib import Path

import pytest

from tests.robots.drivers.arms_in_garbage import guided_in_garbage, ur_in_garbage
from tests.robots.drivers.motions_in_garbage import MovedArm, move_in_garbage
from tests.tiers import nightly

# With the swing of the joints where set points end at once.
PATH_RAD = 0.05

REST_S = 0.6


@pytest.mark.timeout(600)
@pytest.mark.parametrize(
    ("arm", "motions", "share"),
    [(guided_in_garbage, 6, 0.05), nightly(guided_in_garbage, 20, 0.5), (ur_in_garbage, 3, 0.01)],
    ids=["egm", "egm-half", "rtde"],
)
async def test_an_arm_keeps_on_its_path_or_rests_and_the_end_has_a_name(
    tmp_path: Path, arm: Callable[..., AbstractAsyncContextManager[MovedArm]], motions: int, share: float
) -> None:
    async with arm(tmp_path, seed=5) as moved:
        outcome = await move_in_garbage(moved, motions, share=share)
    assert outcome.garbage > 1
    assert outcome.unnamed == 0
    assert outcome.off_rad < PATH_RAD, outcome
    assert outcome.fastest_share < 1.05
    assert max(outcome.rest_s, default=0.0) < REST_S, outcome
