"""The solids of fixtures and parts, for formats that know boxes, cylinders and balls."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from engine.messages import Pose, Vector3
from engine.messages.shapes import AT_ORIGIN
from robots.scene.sim_scene import FixtureBody, PartBody
from robots.sim.physics.cell_model import tray_boxes


@dataclass(frozen=True, kw_only=True)
class BodySolid:
    """A solid with its pose in the frame of its body; sizes in metres as in `robots.scene.sim_scene`."""

    shape: str
    size_m: tuple[float, ...]
    pose: Pose = AT_ORIGIN


def solids_of(body: FixtureBody | PartBody) -> Iterator[BodySolid]:
    """Yield the solids of a body: one, the floor and the walls of a tray, or a plate and what a tool has beside it.

    A mesh has none.
    """
    if isinstance(body, FixtureBody) and body.mesh is not None:
        return
    if isinstance(body, FixtureBody) and body.shape == "tray":
        for centre_m, size_m in tray_boxes(body):
            yield BodySolid(shape="box", size_m=size_m, pose=Pose(xyz=centre_m))
        return
    yield BodySolid(shape=body.shape, size_m=body.size_m)
    for one in body.tool.shapes if isinstance(body, PartBody) and body.tool is not None else ():
        yield BodySolid(shape=one.shape, size_m=one.size_m, pose=one.at.pose())


def inertia_kg_m2(part: PartBody) -> Vector3:
    """Return the principal inertias of a part, about its centre along its axes."""
    mass, size = part.mass_kg, part.size_m
    if part.shape == "box":
        xx, yy, zz = (edge * edge for edge in size)
        return (mass * (yy + zz) / 12.0, mass * (xx + zz) / 12.0, mass * (xx + yy) / 12.0)
    if part.shape == "cylinder":
        radius, length = size[0] / 2.0, size[1]
        across = mass * (3.0 * radius**2 + length**2) / 12.0
        return (across, across, mass * radius**2 / 2.0)
    ball = 0.4 * mass * (size[0] / 2.0) ** 2
    return (ball, ball, ball)
