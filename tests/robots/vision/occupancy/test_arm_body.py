"""The balls of an arm are where its links are."""

from __future__ import annotations

import numpy as np
import pytest

from engine.messages import Pose
from robots.scene.sim_scene import ArmPlacement
from robots.vision.known_geometry import ArmConfiguration
from robots.vision.occupancy.arm_body import ArmBody

TILTED = Pose(xyz=(0.4, -0.2, 0.9), xyzw=(0.0, 0.38268343, 0.0, 0.92387953))


@pytest.mark.parametrize("model", ["panda", "irb4600"])
def test_each_ball_keeps_its_place_in_its_link(model: str) -> None:
    body = ArmBody(ArmPlacement(name="arm", model=model, base=TILTED))
    random, places = np.random.default_rng(3), list[dict[str, np.ndarray]]()
    for _ in range(5):
        at = ArmConfiguration(joints=tuple(random.uniform(-1.0, 1.0, 7 if model == "panda" else 6).tolist()))
        balls = body.link_balls(at)
        assert (np.vstack(list(balls.values())) == body.balls(at)).all()
        poses = {link: body.link_pose(at, link) for link in balls}
        places.append({link: (one[:, :3] - poses[link].xyz) @ poses[link].rotation for link, one in balls.items()})
    assert tuple(places[0]) == body.links
    for link, first in places[0].items():
        assert all(np.allclose(first, other[link], atol=1e-9) for other in places[1:])
