"""Planned ways: a line, and a ghost that goes along a proposed one and waits at the end of the others."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import msgspec
import numpy as np
import pytest
import viser
from hypothesis import given
from hypothesis import strategies as st

from editor_web.cell_view.layers.path_view import REST_S, TRAVEL_S, PathLayer, interpolate_joints
from editor_web.cell_view.rendering.latest_messages import LatestMessages
from tests.editor_web.fake_scene import frames_at, new_scene
from tests.editor_web.fake_sights import description, planned_path

rows = st.lists(st.tuples(*[st.floats(-3, 3)] * 3), min_size=1, max_size=6).map(tuple)


@pytest.fixture
def messages() -> LatestMessages:
    """The fake cell with what its left arm says of itself."""
    made = LatestMessages()
    for name, message in (("left", description("left")), ("cell", new_scene()), ("cell", frames_at(0.0))):
        made.put(name, message)
    return made


@pytest.fixture
def node(server: viser.ViserServer) -> Callable[[str], Any]:
    """What is drawn of the left arm's way, None where nothing is."""
    return lambda name: server.scene.get_handle_by_name(f"/paths/left/{name}")


@given(rows, st.floats(0, 1))
def test_a_share_of_the_way_lies_on_it(joints: tuple[tuple[float, ...], ...], share: float) -> None:
    found = np.array(interpolate_joints(joints, share))
    assert interpolate_joints(joints, 1.0) == pytest.approx(joints[-1])
    legs = zip(joints, joints[1:] or joints, strict=False)
    gaps: list[float] = []
    for begin, end in ((np.array(a), np.array(b)) for a, b in legs):
        length = float(np.dot(end - begin, end - begin))
        at = 0.0 if length == 0.0 else float(np.clip(np.dot(found - begin, end - begin) / length, 0.0, 1.0))
        gaps.append(float(np.abs(begin + at * (end - begin) - found).max()))
    assert min(gaps) < 1e-9


def test_a_proposed_way_has_a_line_and_a_ghost_that_goes_along_it(
    server: viser.ViserServer, messages: LatestMessages, node: Callable[[str], Any]
) -> None:
    ways, preview = PathLayer(server), planned_path("left")
    messages.put("left", preview)
    assert ways.draw(messages, 0.0, is_shown=True) is not None
    assert node("line").points.shape == (len(preview.tool_path) - 1, 2, 3)
    assert np.allclose(node("goal").position, preview.tool_path[-1])
    assert node("ghost").visible
    ways.draw(messages, TRAVEL_S + REST_S / 2, is_shown=True)
    at_the_goal = node("ghost/fore").wxyz.copy()
    ways.draw(messages, TRAVEL_S + REST_S, is_shown=True)
    assert not np.allclose(node("ghost/fore").wxyz, at_the_goal)
    # Whoever does not look costs nothing.
    assert ways.draw(messages, TRAVEL_S * 2, is_shown=False) is None


def test_the_ghost_of_a_way_that_an_arm_goes_stands_at_the_goal_in_the_colour_of_its_state(
    server: viser.ViserServer, messages: LatestMessages, node: Callable[[str], Any]
) -> None:
    ways = PathLayer(server)
    colours: list[tuple[int, ...]] = []
    for state in ("proposed", "moving", "blocked"):
        messages.put("left", planned_path("left", state))
        ways.draw(messages, 0.0, is_shown=True)
        colours.append(tuple(node("goal").color))
    assert len(set(colours)) == 3
    assert ways.draw(messages, 1.0, is_shown=True) is None
    ghost = node("ghost/fore")
    messages.put("cell", frames_at(1.0))
    ways.draw(messages, 2.0, is_shown=True)
    assert node("ghost/fore") is ghost


def test_a_way_that_is_over_vanishes_and_the_meshes_are_kept_for_the_next_one(
    server: viser.ViserServer, messages: LatestMessages, node: Callable[[str], Any]
) -> None:
    ways = PathLayer(server)
    messages.put("left", planned_path("left"))
    ways.draw(messages, 0.0, is_shown=True)
    body = node("ghost/fore")
    messages.put("left", planned_path("left", "none"))
    assert ways.draw(messages, 1.0, is_shown=True) is None
    assert (node("line"), node("goal"), node("ghost").visible) == (None, None, False)
    messages.put("left", planned_path("left", "moving"))
    ways.draw(messages, 2.0, is_shown=True)
    assert node("ghost/fore") is body
    assert node("ghost").visible


@pytest.mark.parametrize("urdf", ["no XML", "<robot/>"])
def test_without_a_description_that_can_be_read_the_line_alone_is_drawn(
    server: viser.ViserServer, messages: LatestMessages, node: Callable[[str], Any], urdf: str
) -> None:
    messages.put("left", msgspec.structs.replace(description("left"), urdf=urdf))
    messages.put("left", planned_path("left"))
    PathLayer(server).draw(messages, 0.0, is_shown=True)
    assert node("line") is not None
    assert node("ghost") is None


def test_a_way_of_numbers_that_are_none_is_not_drawn(
    server: viser.ViserServer, messages: LatestMessages, node: Callable[[str], Any]
) -> None:
    path = ((0.0, 0.0, 0.0), (float("nan"), 0.0, 0.0))
    messages.put("left", msgspec.structs.replace(planned_path("left"), tool_path=path, joints=()))
    assert PathLayer(server).draw(messages, 0.0, is_shown=True) is None
    assert node("line") is None
