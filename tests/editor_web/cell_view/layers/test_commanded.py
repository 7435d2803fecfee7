"""Set points of real arms: a ghost where the arm is measured elsewhere, else for pages that ask for it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import viser

from editor_web.cell_view.layers.commanded import DEVIATION_RAD, CommandedLayer
from editor_web.cell_view.rendering.latest_messages import LatestMessages
from engine.messages import JointSetPoint
from tests.editor_web.fake_scene import frames_at, new_scene
from tests.editor_web.fake_sights import description

FAR, NEAR = "/cell/commanded/left", "/commanded/left"


@pytest.fixture
def messages() -> LatestMessages:
    made = LatestMessages()
    for name, message in (("left", description("left")), ("cell", new_scene()), ("cell", frames_at(0.0))):
        made.put(name, message)
    return made


def set_point(angle_rad: float, *, deviation_rad: float) -> JointSetPoint:
    names = description("left").joint_names
    return JointSetPoint(time_s=0.0, names=names, position_rad=(angle_rad,) * len(names), deviation_rad=deviation_rad)


def visible(server: viser.ViserServer, node: str) -> bool:
    drawn: Any = server.scene.get_handle_by_name(node)
    return drawn is not None and bool(drawn.visible)


def test_a_ghost_stands_where_an_arm_is_commanded_to_be_once_it_is_measured_elsewhere(
    server: viser.ViserServer, messages: LatestMessages
) -> None:
    layer = CommandedLayer(server)
    messages.put("left", set_point(0.1, deviation_rad=DEVIATION_RAD / 2))
    layer.draw(messages, is_shown=False)
    assert server.scene.get_handle_by_name(FAR) is None

    messages.put("left", set_point(0.2, deviation_rad=DEVIATION_RAD * 2))
    layer.draw(messages, is_shown=False)
    assert (visible(server, FAR), visible(server, NEAR)) == (True, False)
    link: Any = server.scene.get_handle_by_name(f"{FAR}/fore")
    before = link.wxyz.copy()
    messages.put("left", set_point(0.6, deviation_rad=DEVIATION_RAD * 4))
    layer.draw(messages, is_shown=False)
    assert not np.allclose(link.wxyz, before)

    messages.put("left", set_point(0.6, deviation_rad=0.0))
    layer.draw(messages, is_shown=False)
    assert not visible(server, FAR)


def test_pages_that_ask_for_it_see_every_set_point_once(server: viser.ViserServer, messages: LatestMessages) -> None:
    layer = CommandedLayer(server)
    messages.put("left", set_point(0.1, deviation_rad=0.0))
    layer.draw(messages, is_shown=True)
    assert (visible(server, FAR), visible(server, NEAR)) == (False, True)
    messages.put("left", set_point(0.1, deviation_rad=1.0))
    layer.draw(messages, is_shown=True)
    assert (visible(server, FAR), visible(server, NEAR)) == (True, False)


def test_an_arm_that_is_not_connected_has_no_ghost(server: viser.ViserServer, messages: LatestMessages) -> None:
    layer = CommandedLayer(server)
    messages.put("left", set_point(0.1, deviation_rad=1.0))
    layer.draw(messages, is_shown=True)
    messages.put("left", JointSetPoint(time_s=0.0, names=(), position_rad=()))
    layer.draw(messages, is_shown=True)
    assert (visible(server, FAR), visible(server, NEAR)) == (False, False)
