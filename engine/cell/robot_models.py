"""The interface of robot and tool models: the models that a cell document may name, and the properties of its robots.

An installed package provides its models through the entry point `standard` of the group `flexcell.models`. Nothing is
connected or simulated.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Protocol

import msgspec

from engine.cell.camera_coverage import CameraCoverage
from engine.cell.mesh_defect import MeshDefect
from engine.cell.reach_map import ReachDirection, ReachLevel
from engine.cell.rest_contacts import RestContact
from engine.cell.tool_kind import ToolKind
from engine.cell.urdf_module import UrdfModule
from engine.document.cell import Cell
from engine.errors import RegistryError
from engine.skills.arm_target import StaticCell


class RobotSummary(msgspec.Struct, frozen=True, kw_only=True):
    """The properties of one robot of a cell, from its model, its tool and its options.

    `links` are those of arm and tool, `base_link` is their root. `joints` are the lower and upper position limits of
    the arm's joints in radians, in the order of its goals. `tool` is the kind of its tool, None for a bare flange.
    """

    base_link: str
    links: frozenset[str]
    joints: tuple[tuple[float, float], ...]
    tool: str | None
    digital_outputs: int
    digital_inputs: int = 0


class ModelNames(msgspec.Struct, frozen=True, kw_only=True):
    """The models that a cell document may name without a folder of its own."""

    robots: tuple[str, ...]
    tools: tuple[str, ...]


class RobotModels(Protocol):
    """The models and motion planners of an installed package."""

    def robots(self) -> tuple[str, ...]:
        """Return the names of the built-in robot models."""
        ...

    def tools(self) -> tuple[str, ...]:
        """Return the names of the built-in gripper models."""
        ...

    def tool_kinds(self) -> Mapping[str, ToolKind]:
        """Return the kinds of tools by name."""
        ...

    def planners(self) -> tuple[str, ...]:
        """Return the names of the motion planners."""
        ...

    def summary(self, cell: Cell, robot: str) -> RobotSummary:
        """Return the properties of a robot of the cell.

        Raises:
            CellError: there is no such model, or it has no such option.
            DocumentError: a document of a model folder, or a calibration file, is invalid.
        """
        ...

    def drawn(self, cell: Cell) -> StaticCell:
        """Return the static cell, in which targets of arms can be checked; it is built at the first check."""
        ...

    def camera_coverage(self, cell: Cell) -> CameraCoverage:
        """Return how much its cameras see of what they must see.

        Raises:
            CellError: the cell has no cameras with a map, or cannot be simulated.
            DocumentError: as `summary`.
        """
        ...

    def mesh_defects(self, file: Path, *, scale: float) -> tuple[MeshDefect, ...]:
        """Return what is wrong with a mesh file of a fixture, one unit of which is `scale` metres."""
        ...

    def urdf_module(self, file: Path, *, name: str) -> UrdfModule:
        """Return a module of the links of a URDF, which are all fixed to one another.

        Raises:
            CellError: it cannot be read, has a joint that moves, or a mesh is missing.
        """
        ...

    def reach(self, cell: Cell, robot: str, *, step_m: float, direction: ReachDirection) -> Iterator[ReachLevel]:
        """Yield where the tool centre point of an arm of the cell gets, coarse first, whatever else stands there.

        Raises:
            CellError: the cell has no such robot, or as `summary`.
            DocumentError: as `summary`.
        """
        ...

    def rest_contacts(self, cell: Cell) -> tuple[RestContact, ...]:
        """Return the bodies that touch with all arms at home, and arms that are nearly in contact.

        Raises:
            CellError: the scene of the cell cannot be built.
            DocumentError: as `summary`.
        """
        ...

    def write_scene(self, cell: Cell, file: Path) -> tuple[Path, ...]:
        """Write the scene of a cell for other programs, as MJCF, URDF or glTF by the name of the file.

        Returns:
            The written files, `file` first.

        Raises:
            CellError: the format is unknown, the cell cannot be simulated, or a file cannot be written.
            DocumentError: as `summary`.
        """
        ...


@cache
def robot_models() -> RobotModels | None:
    """Return the installed models; None when no package provides any, or a package that it needs is missing.

    Cached: loading takes 20 ms, and an editor checks after every change.
    """
    # Imported on demand: importlib.metadata imports parsers of mail headers and archives.
    from engine.registry import MODELS, load_factory

    try:
        return load_factory(MODELS, "standard")
    except RegistryError:
        return None


def tool_kinds() -> Mapping[str, ToolKind]:
    """Return the kinds of tools of the installed models by name; none without models, or when they fail to load."""
    models = robot_models()
    return models.tool_kinds() if models is not None else {}


def model_names() -> ModelNames:
    """Return the names of the installed models; none without models, or when they fail to load."""
    models = robot_models()
    return (
        ModelNames(robots=(), tools=()) if models is None else ModelNames(robots=models.robots(), tools=models.tools())
    )
