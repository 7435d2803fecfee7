"""The image of a world: its complete state as one flat array of numbers."""

from __future__ import annotations

from robots.sim.loop.snapshot import ArmSummary

TOOL_FIELDS = 4
"""Numbers of a tool's command; unused ones are 0."""
LOCK_FIELDS = 2
"""Numbers of a tool changer: its output is on; steps until its piston arrives. Its couplings are in the physics."""


class ImageLayout:
    """Where each quantity lies in an image.

    First the step count, then the physics state from MuJoCo, then where modules are, as in
    `robots.sim.loop.docked_modules`, then what is broken, as in `robots.sim.loop.bonds`, then for each arm its
    set point and reflex (1 or 0), and for each tool its command, as in `robots.sim.grip.mechanics.ToolMechanics`, for
    each tool changer its `locks`; last the motions and contacts of people, as in `robots.sim.people.people_loop`.
    """

    def __init__(
        self,
        arms: tuple[ArmSummary, ...],
        *,
        state_size: int,
        modules_size: int = 0,
        bonds_size: int = 0,
        people_size: int = 0,
    ) -> None:
        self.steps = 0
        self.physics = slice(1, 1 + state_size)
        self.modules = slice(self.physics.stop, self.physics.stop + modules_size)
        self.bonds = slice(self.modules.stop, self.modules.stop + bonds_size)
        at = self.bonds.stop
        self.set_points: dict[str, slice] = {}
        self.reflexes: dict[str, int] = {}
        self.tools: dict[str, slice] = {}
        self.locks: dict[str, slice] = {}
        for arm in arms:
            self.set_points[arm.name] = slice(at, at + len(arm.joints))
            self.reflexes[arm.name] = at + len(arm.joints)
            at += len(arm.joints) + 1
            if arm.tool is not None:
                self.tools[arm.name] = slice(at, at + TOOL_FIELDS)
                at += TOOL_FIELDS
            if arm.tool_changer:
                self.locks[arm.name] = slice(at, at + LOCK_FIELDS)
                at += LOCK_FIELDS
        self.people = slice(at, at + people_size)
        self.size = self.people.stop
