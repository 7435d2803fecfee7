"""Fixtures and parts in the scene of franky-sim."""

from __future__ import annotations

import xml.etree.ElementTree as ET

import pytest

from engine.errors import CellError
from engine.messages import Pose
from robots.drivers.franka.emulation.scene_bodies import add_bodies, place_bases, soften_pads
from robots.drivers.franka.emulation.simulator_messages import RobotSetup
from robots.scene.sim_scene import FixtureBody, PartBody, SimScene

AT = Pose(xyz=(0.1, 0.2, 0.3), xyzw=(0.0, 0.0, 1.0, 0.0))


def scene() -> ET.Element:
    """A scene as franky-sim begins it."""
    return ET.fromstring(
        '<mujoco><option integrator="implicitfast"/><worldbody><geom name="ground" type="plane"/>'
        '<body name="robot0_fr3_link0"><geom class="fingertip_pad_collision_1"/><geom class="collision"/></body>'
        "</worldbody></mujoco>"
    )


def fixture(shape: str, *size_m: float, spring_n_m: float = 0.0) -> FixtureBody:
    return FixtureBody(name=shape, shape=shape, size_m=size_m, pose=AT, spring_n_m=spring_n_m)


def test_fixtures_are_fixed_parts_are_free_and_the_floor_is_that_of_the_cell() -> None:
    root = scene()
    part = PartBody(name="part", shape="cylinder", size_m=(0.04, 0.1), mass_kg=0.5, pose=AT)
    add_bodies(root, SimScene(fixtures=(fixture("box", 0.2, 0.4, 0.6), fixture("tray", 0.3, 0.2, 0.02)), parts=(part,)))
    bodies = {body.get("name"): body for body in root.iter("body")}
    box, free = bodies["box"], bodies["part"]
    assert [geom.get("size") for geom in box.iter("geom")] == ["0.1 0.2 0.3"]
    assert (box.get("pos"), box.get("quat"), box.find("freejoint")) == ("0.1 0.2 0.3", "0.0 0.0 0.0 1.0", None)
    assert len(list(bodies["tray"].iter("geom"))) == 5
    assert free.find("freejoint") is not None
    (geom,) = free.iter("geom")
    assert (geom.get("type"), geom.get("size"), geom.get("mass")) == ("cylinder", "0.02 0.05", "0.5")
    assert [geom for geom in root.iter("geom") if geom.get("name") == "ground"] == []


def test_a_slippery_part_is_slippery_at_the_pads_too() -> None:
    root = scene()
    part = PartBody(name="part", shape="sphere", size_m=(0.04,), mass_kg=0.5, pose=AT, friction=0.1)
    add_bodies(root, SimScene(parts=(part,)))
    soften_pads(root)
    pad, sphere = (next(geom for geom in root.iter("geom") if geom.get(*what)) for what in (("condim",), ("mass",)))
    assert (pad.get("class"), pad.get("priority")) == ("fingertip_pad_collision_1", "1")
    assert (sphere.get("friction"), sphere.get("priority")) == ("0.1 0.005 0.0001", "2")


@pytest.mark.parametrize(
    ("fixtures", "reason"),
    [
        (fixture("box", 0.1, 0.1, 0.1, spring_n_m=100.0), "no fixtures on springs"),
        (fixture("cylinder", 0.1), "cannot have the size"),
    ],
)
def test_what_franky_sim_has_not_is_refused(fixtures: FixtureBody, reason: str) -> None:
    with pytest.raises(CellError, match=reason):
        add_bodies(scene(), SimScene(fixtures=(fixtures,)))


def test_bases_are_turned() -> None:
    root = scene()
    place_bases(root, (RobotSetup(host="127.0.0.9", base=AT),))
    assert next(root.iter("body")).get("quat") == "0.0 0.0 0.0 1.0"
