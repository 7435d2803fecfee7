"""The model of a tool at the flange, as data: joints, links, tool centre point and mechanism."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

from robots.model.mechanism import Mechanism

M = TypeVar("M", bound=Mechanism)


@dataclass(frozen=True, kw_only=True)
class ToolModel:
    """One tool on its arm: names have the prefix of the composed URDF.

    `links` and `joints` are all of its links and moving joints; `root_link` is fixed to the flange;
    `mass_kg` is the sum over its links. `kind` is that of its mechanism. The tool centre point is the arm's
    `RobotModel.tool_link`.
    """

    name: str
    kind: str
    root_link: str
    links: tuple[str, ...]
    joints: tuple[str, ...]
    mass_kg: float
    mechanism: Mechanism
    licence: str
    licence_file: Path

    def mechanism_as(self, kind: type[M]) -> M:
        """Return the mechanism, which the table of tool kinds says is a `kind`."""
        if not isinstance(self.mechanism, kind):
            raise TypeError(f"the mechanism of {self.name} is a {type(self.mechanism).__name__}, not a {kind.__name__}")
        return self.mechanism
