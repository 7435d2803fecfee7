"""Up to which speed MuJoCo's contacts slide on a sprung plate without losing it: no arm, no control.

`python -P benchmarks/contact_sliding.py` prints a table. A tool is drawn over a plate at a constant speed and pressed
down by a constant force; it touches with a dome (one contact) or with flat pads (four contacts each).

A friction that slides adds to the normal force of its contact what must be made up by a gap: contact is lost
above f R / (mu b), with the force f of one contact, its regularization R = (1 - d) / d A at first touch
(d is solimp[0], A the inverse of the inertia that it feels), the friction mu and the damping
b = 2 / (solimp[1] solref[0]). What is lost falls back, and so on, tens of times a second: it looks like chatter
of whatever controls the tool. More corners share the force, so flat pads are the worst.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from robots.port import Array
from robots.sim.physics.physics import mujoco

FORCE_N = 10.0
FRICTION = 0.3
SETTLING_S, MEASURING_S = 2.0, 2.0
STEP_S = 0.001
_WORLD = """
<mujoco>
  <option timestep="{step}" integrator="implicitfast" cone="elliptic" impratio="20" gravity="0 0 0"/>
  <worldbody>
    <body pos="0 0 -0.005">
      <joint type="slide" axis="0 0 1" stiffness="5000" damping="60"/>
      <geom type="box" size="30 30 0.005" mass="0.1" priority="2" condim="3" friction="{friction}"
            solref="{solref} 1" solimp="{touch} {widest} 0.001"/>
    </body>
    <body pos="0 0 0.01">
      <joint type="slide" axis="0 1 0" armature="1e6"/>
      <joint type="slide" axis="0 0 1" damping="100"/>
      <geom type="sphere" size="0.001" mass="3" contype="0" conaffinity="0"/>
      {shapes}
    </body>
  </worldbody>
</mujoco>
"""
_DOME = '<geom type="sphere" size="0.01" mass="0.01"/>'
_PAD = '<geom type="box" size="0.01 0.01 0.01" pos="{x} 0 0" mass="0.01"/>'


@dataclass(frozen=True, kw_only=True)
class Tool:
    """What touches the plate, and with how many contacts."""

    name: str
    shapes: str
    contacts: int


TOOLS = (
    Tool(name="dome", shapes=_DOME, contacts=1),
    Tool(name="one pad", shapes=_PAD.format(x=0.0), contacts=4),
    Tool(name="two pads", shapes=_PAD.format(x=-0.04) + _PAD.format(x=0.04), contacts=8),
)


@dataclass(frozen=True, kw_only=True)
class Contact:
    """What MuJoCo calls solref[0], in seconds, solimp[0] and solimp[1]."""

    name: str
    solref_s: float
    touch: float
    widest: float

    @property
    def damping_per_s(self) -> float:
        """How fast a contact is to lose its velocity, sliding or not."""
        return 2.0 / (self.widest * self.solref_s)


DEFAULT = Contact(name="MuJoCo's default", solref_s=0.02, touch=0.9, widest=0.95)
SKIN = Contact(name="what gives way, here", solref_s=0.02, touch=0.5, widest=0.95)
PAD = Contact(name="pads of grippers, here", solref_s=0.004, touch=0.95, widest=0.99)


@dataclass(frozen=True, kw_only=True)
class Slide:
    """Normal forces on the tool, one a step, once it has settled."""

    forces_n: Array

    @property
    def rms_n(self) -> float:
        """Root of the mean square of what differs from the force that presses."""
        return float(np.sqrt(np.mean((self.forces_n - FORCE_N) ** 2)))

    @property
    def lost(self) -> float:
        """Share of the time without any contact."""
        return float(np.mean(self.forces_n <= 0.0))


def world_of(tool: Tool, contact: Contact) -> Any:
    """Return the model of plate and tool."""
    numbers = {"solref": contact.solref_s, "touch": contact.touch, "widest": contact.widest}
    return mujoco.MjModel.from_xml_string(_WORLD.format(step=STEP_S, friction=FRICTION, shapes=tool.shapes, **numbers))


def fastest_m_s(tool: Tool, contact: Contact) -> float:
    """Return the speed above which contact is lost, by f R / (mu b)."""
    model = world_of(tool, contact)
    data = mujoco.MjData(model)
    data.qpos[2] = -1e-4
    mujoco.mj_forward(model, data)
    regularization = (1.0 - contact.touch) / contact.touch * float(data.efc_diagA[0])
    return FORCE_N / tool.contacts * regularization / (FRICTION * contact.damping_per_s)


def slide(tool: Tool, contact: Contact, *, speed_m_s: float) -> Slide:
    """Draw the tool over the plate."""
    model = world_of(tool, contact)
    data = mujoco.MjData(model)
    data.qvel[1] = speed_m_s
    data.qfrc_applied[2] = -FORCE_N
    forces: list[float] = []
    wrench = np.zeros(6)
    for _ in range(math.ceil((SETTLING_S + MEASURING_S) / STEP_S)):
        mujoco.mj_step(model, data)
        force = 0.0
        for number in range(data.ncon):
            mujoco.mj_contactForce(model, data, number, wrench)
            force += float(wrench[0])
        forces.append(force)
    return Slide(forces_n=np.array(forces[math.ceil(SETTLING_S / STEP_S) :]))


def row(cells: Sequence[str]) -> None:
    """Print one line of the table."""
    print("| " + " | ".join(cells) + " |")


def main() -> None:
    """Print the table."""
    row(("contact", "tool", "contacts", "limit m/s", "rms N at 0.9 ×", "lost", "rms N at 1.1 ×", "lost"))
    row(("---", "---", "---:", "---:", "---:", "---:", "---:", "---:"))
    for contact in (PAD, DEFAULT, SKIN):
        for tool in TOOLS:
            limit = fastest_m_s(tool, contact)
            below = slide(tool, contact, speed_m_s=0.9 * limit)
            above = slide(tool, contact, speed_m_s=1.1 * limit)
            figures = [f"{limit:.3f}"]
            for made in (below, above):
                figures += [f"{made.rms_n:.2f}", f"{made.lost * 100:.1f} %"]
            row((contact.name, tool.name, str(tool.contacts), *figures))


if __name__ == "__main__":
    main()
