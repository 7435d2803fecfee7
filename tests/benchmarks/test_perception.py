"""Tests that the perception benchmark measures what it says, in small."""

from __future__ import annotations

import pytest

from benchmarks.perception import arm_seen, robot_voxels


@pytest.fixture(autouse=True)
def by_rays(monkeypatch: pytest.MonkeyPatch) -> None:
    """Make images without graphics, which every machine can."""
    monkeypatch.setenv("FLEXCELL_DEPTH", "rays")


def test_the_irb4600_leaves_no_voxel_of_its_own() -> None:
    assert "random configurations, two cameras: 0 in all" in robot_voxels(5)


def test_two_cameras_see_most_of_a_persons_arm_and_nothing_else() -> None:
    _, cameras, mean, least, farthest, _ = (cell.strip() for cell in arm_seen(2, 3).split("|"))
    assert cameras == "2"
    assert float(mean.removesuffix("%")) > 60.0
    assert float(least.removesuffix("%")) > 40.0
    assert float(farthest) < 35.0
