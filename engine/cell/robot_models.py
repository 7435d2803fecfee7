"""The contract of robot and tool models: what a cell document may name, and what a robot made of it offers.

An installed package offers its models through the entry point `standard` of the group `flexcell.models`. Nothing is
connected or simulated to answer.
"""

from __future__ import annotations

from functools import cache
from typing import Literal, Protocol

import msgspec

from engine.document.cell import Cell
from engine.errors import RegistryError
from engine.skills.arm_target import StaticCell

ToolKind = Literal["gripper", "magnet", "hand"]
"""What a tool does: opens and closes fingers, is switched, or closes a hand of one motor."""


class RobotSummary(msgspec.Struct, frozen=True, kw_only=True):
    """What one robot of a cell offers, by its model, its tool and its options.

    `links` are those of arm and tool, `base_link` is the root of them. `joints` are the least and the greatest angle of
    each joint of the arm in radians, in the order of its goals. `tool` is None for a bare flange.
    """

    base_link: str
    links: frozenset[str]
    joints: tuple[tuple[float, float], ...]
    tool: ToolKind | None
    digital_outputs: int


class RobotModels(Protocol):
    """The models of an installed package, and the planners that plan for them."""

    def robots(self) -> tuple[str, ...]:
        """Return the names of the built-in robot models."""
        ...

    def tools(self) -> tuple[str, ...]:
        """Return the names of the built-in gripper models."""
        ...

    def planners(self) -> tuple[str, ...]:
        """Return the names of the motion planners."""
        ...

    def summary(self, cell: Cell, robot: str) -> RobotSummary:
        """Return what a robot of the cell offers.

        Raises:
            CellError: there is no such model, or it has no such option.
            DocumentError: a document of a model folder, or a calibration file, is wrong.
        """
        ...

    def drawn(self, cell: Cell) -> StaticCell:
        """Return the cell as it is drawn, in which arms can be put to targets; nothing is built before one is."""
        ...


@cache
def robot_models() -> RobotModels | None:
    """Return the models that are installed; None where no package offers any, or what it needs is missing.

    They are looked for once: that takes 20 ms, and an editor checks after every change.
    """
    # Imported where it is wanted: what tells which packages are installed parses mail headers and unpacks archives.
    from engine.registry import MODELS, load_factory

    try:
        return load_factory(MODELS, "standard")
    except RegistryError:
        return None
