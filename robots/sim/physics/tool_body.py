"""The body of a tool in the world: what its kind adds to the specification of an arm, and where that is found.

The URDF of a tool has its links, joints and shapes; motors, pads and faces are added here.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Protocol, cast

import numpy as np
from numpy.typing import NDArray

from robots.model.mechanism import PadBox
from robots.model.tool_model import ToolModel
from robots.port import Array
from robots.sim.physics.physics import mujoco
from robots.tool_kinds import kind_of_mechanism, load_simulation

Indices = NDArray[np.intp]

# Contact of surfaces that hold: measured best for holding without slip, with torsional friction (condim 4).
PAD_SOLREF = (0.004, 1.0)
PAD_SOLIMP = (0.95, 0.99, 0.001, 0.5, 2.0)
# Rods and joint limits are stiff; half a step more than the solver needs for stability.
ROD_SOLREF = (0.005, 1.0)
ROD_SOLIMP = (0.99, 0.999, 0.0005, 0.5, 2.0)


class ToolIndices(Protocol):
    """Addresses of a tool's joints, motors and bodies in a compiled world, as its kind needs them."""

    @property
    def qpos(self) -> Indices:
        """Addresses of the positions of its joints."""
        ...

    @property
    def home(self) -> Array:
        """The positions of these joints at the start."""
        ...


class ToolBody(Protocol):
    """How a kind of tool is built into the world."""

    def finish(self, spec: Any, tool: ToolModel) -> None:
        """Add what holds to the specification of an arm that carries the tool: pads, motors, tendons, faces."""
        ...

    def indices(self, model: Any, arm: str, tool: ToolModel, *, ferrous: Iterable[str]) -> ToolIndices:
        """Return its addresses in a compiled model; `ferrous` are the parts that can be attracted."""
        ...


def tool_body(tool: ToolModel) -> ToolBody:
    """Return how a tool is built."""
    return cast("ToolBody", load_simulation(kind_of_mechanism(tool.kind).name))


def add_motor(spec: Any, joint: str, limit: float) -> None:
    """Add a motor of at most `limit` newton or newton metre, named like its joint."""
    motor = spec.add_actuator(name=joint, target=joint, trntype=mujoco.mjtTrn.mjTRN_JOINT)
    motor.set_to_motor()
    motor.ctrllimited = True
    motor.ctrlrange = [-limit, limit]


def add_box(spec: Any, pad: PadBox, *, name: str, friction: tuple[float, float, float]) -> None:
    """Add a box that touches objects to the link of a pad."""
    spec.body(pad.link).add_geom(
        name=name,
        type=mujoco.mjtGeom.mjGEOM_BOX,
        pos=list(pad.xyz),
        size=[edge / 2 for edge in pad.size_m],
        density=0.0,
        condim=4,
        priority=1,
        friction=list(friction),
        solref=list(PAD_SOLREF),
        solimp=list(PAD_SOLIMP),
    )


def as_indices(values: Iterable[Any]) -> Indices:
    """Return numbers of the model as an array of indices."""
    return np.array([int(value) for value in values], dtype=np.intp)
