"""Going along a proposed path on one page, and turning its camera."""

from __future__ import annotations

import numpy as np
import pytest

from editor_web.cell_view.page_cameras import DISTANCE_M, camera_position
from editor_web.cell_view.view import CellView
from engine.skills.planning import PathPreview
from tests.editor_web.fake_backend import FakeBackend

PROPOSED = PathPreview(
    robot="left",
    state="proposed",
    joint_names=("a", "b"),
    joints=((0.0, 0.0), (1.0, 0.0), (1.0, 1.0)),
    tool_path=((0.0, 0.0, 0.0), (0.1, 0.0, 0.0), (0.1, 0.1, 0.0)),
)


class _View(CellView):
    """A view that tells which ghosts it would draw."""

    def __init__(self) -> None:
        super().__init__(FakeBackend())
        self.ghosts: list[tuple[str, PathPreview]] = []

    def propose(self, preview: PathPreview) -> None:
        """Take this as the latest path of its arm."""
        self._latest.paths[preview.robot] = preview

    def show_ghost(self, page: str, preview: PathPreview, *, place: int = 0) -> None:
        """Keep it."""
        self.ghosts.append((page, preview))


@pytest.mark.parametrize(
    ("share", "joints"), [(0.0, (0.0, 0.0)), (0.25, (0.5, 0.0)), (0.75, (1.0, 0.5)), (1.0, (1.0, 1.0))]
)
def test_the_arm_stands_where_the_path_is_at_a_share_of_it(share: float, joints: tuple[float, float]) -> None:
    """Measured by the joint that moves most; the line of the whole path stays."""
    view = _View()
    view.propose(PROPOSED)
    view.scrub_path("page", "left", share)
    ((page, ghost),) = view.ghosts
    assert (page, ghost.joints, ghost.tool_path) == ("page", (joints,), PROPOSED.tool_path)


@pytest.mark.parametrize(("robot", "share"), [("left", None), ("right", 0.5)])
def test_without_a_proposed_path_or_a_share_there_is_no_ghost(robot: str, share: float | None) -> None:
    view = _View()
    view.propose(PROPOSED)
    view.scrub_path("page", robot, share)
    assert view.ghosts == [("page", PathPreview(robot=robot, state="none"))]


@pytest.mark.parametrize("before", [(2.0, 0.0, 3.0), (0.1, 0.2, -5.0), (0.1, 0.2, 0.3)])
def test_the_camera_comes_near_from_its_side_and_never_from_below(before: tuple[float, float, float]) -> None:
    at = (0.1, 0.2, 0.3)
    found = np.asarray(camera_position(np.asarray(before), at)) - at
    assert np.linalg.norm(found) == pytest.approx(DISTANCE_M)
    assert found[2] > 0
    towards = np.asarray(before) - at
    if towards[2] > 0:
        assert np.dot(found, towards) == pytest.approx(DISTANCE_M * np.linalg.norm(towards))
