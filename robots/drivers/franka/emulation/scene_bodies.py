"""Fixtures and parts of a cell in the scene of franky-sim, and finger pads that hold parts by friction."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Sequence

from engine.errors import CellError
from engine.messages import Pose
from robots.drivers.franka.emulation.simulator_messages import RobotSetup
from robots.scene.sim_scene import SimScene
from robots.sim.physics.cell_model import tray_boxes
from robots.sim.physics.tool_body import PAD_SOLIMP, PAD_SOLREF

_PAD = "fingertip_pad"
# Rubber on plastic, with torsional friction.
_PAD_FRICTION = (1.0, 0.02, 0.0001)
_EDGES = {"box": 3, "cylinder": 2, "sphere": 1}


def add_bodies(scene: ET.Element, cell: SimScene) -> None:
    """Add fixtures and parts, and contacts as the world of the engine has them, before the simulator starts.

    Raises:
        CellError: a fixture has a spring or is a mesh, or a shape has another size.
    """
    option, world = scene.find("option"), scene.find("worldbody")
    assert option is not None
    assert world is not None
    option.attrib |= {"cone": "elliptic", "impratio": "20"}
    for ground in [geom for geom in world.findall("geom") if geom.get("name") == "ground"]:
        world.remove(ground)
    for fixture in cell.fixtures:
        if fixture.spring_n_m > 0.0:
            raise CellError("franky-sim has no fixtures on springs", where=fixture.name)
        if fixture.mesh is not None:
            raise CellError("franky-sim has no meshes", where=fixture.name, hint="emulate the arm with `driver: sim`")
        body = _body(world, fixture.name, fixture.pose)
        if fixture.shape == "tray":
            for centre, size in tray_boxes(fixture):
                _geom(body, "box", size, pos=_numbers(centre))
        else:
            _geom(body, fixture.shape, fixture.size_m)
    for part in cell.parts:
        body = _body(world, part.name, part.pose)
        ET.SubElement(body, "freejoint", {"name": part.name})
        friction = {} if part.friction is None else {"friction": f"{part.friction} 0.005 0.0001", "priority": "2"}
        _geom(body, part.shape, part.size_m, mass=str(part.mass_kg), condim="4", **friction)


def soften_pads(scene: ET.Element) -> None:
    """Let the finger pads hold what they press on."""
    for geom in scene.iter("geom"):
        if geom.get("class", "").startswith(_PAD):
            geom.attrib |= {
                "condim": "4",
                "priority": "1",
                "friction": _numbers(_PAD_FRICTION),
                "solref": _numbers(PAD_SOLREF),
                "solimp": _numbers(PAD_SOLIMP),
            }


def place_bases(scene: ET.Element, robots: Sequence[RobotSetup]) -> None:
    """Turn the bases of the robots, which franky-sim only shifts."""
    bodies = {body.get("name"): body for body in scene.iter("body")}
    for number, robot in enumerate(robots):
        bodies[f"robot{number}_fr3_link0"].set("quat", _wxyz(robot.base))


def _body(world: ET.Element, name: str, pose: Pose) -> ET.Element:
    return ET.SubElement(world, "body", {"name": name, "pos": _numbers(pose.xyz), "quat": _wxyz(pose)})


def _geom(body: ET.Element, shape: str, size_m: Sequence[float], **more: str) -> None:
    if _EDGES.get(shape) != len(size_m):
        raise CellError(f"a {shape} cannot have the size {list(size_m)}", where=body.get("name", ""))
    ET.SubElement(body, "geom", {"type": shape, "size": _numbers([edge / 2.0 for edge in size_m]), **more})


def _wxyz(pose: Pose) -> str:
    x, y, z, w = pose.xyzw
    return _numbers((w, x, y, z))


def _numbers(values: Sequence[float]) -> str:
    return " ".join(repr(float(value)) for value in values)
