"""The built-in models and planners: the entry point `standard` of `flexcell.models`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

from engine.cell import (
    CameraCoverage,
    MeshDefect,
    ReachDirection,
    ReachLevel,
    RestContact,
    RobotModels,
    RobotSummary,
    ToolKind,
    UrdfModule,
)
from engine.document import Cell
from engine.errors import CellError
from engine.skills.arm_target import StaticCell
from engine.wording import did_you_mean
from robots.tool_kinds import kind_of_mechanism, tool_kinds


class InstalledModels:
    """The built-in model folders and those that a cell references by path.

    Each answer loads what it needs: whoever asks for the states of the kinds of tools loads no model and no numpy.
    """

    def robots(self) -> tuple[str, ...]:
        """Return the names of the built-in arms."""
        from robots.model.registry import robot_names

        return robot_names()

    def tools(self) -> tuple[str, ...]:
        """Return the names of the built-in tools."""
        from robots.model.registry import tool_names

        return tool_names()

    def tool_kinds(self) -> Mapping[str, ToolKind]:
        """Return the kinds of tools of the table."""
        return tool_kinds()

    def planners(self) -> tuple[str, ...]:
        """Return the names of the motion planners."""
        from robots.planning.planner_names import PLANNERS

        return PLANNERS

    def summary(self, cell: Cell, robot: str) -> RobotSummary:
        """Return the capabilities of a robot of the cell; raises CellError or DocumentError for an invalid model."""
        from engine.cell.drivers import digital_inputs, digital_outputs
        from robots.model.mechanics.link_names import link_names
        from robots.model.registry import model_of_entry

        model = model_of_entry(cell.document.robots[robot], cell.resolve)
        return RobotSummary(
            base_link=model.base_link,
            links=link_names(model),
            joints=tuple(zip(model.limits.lower_rad, model.limits.upper_rad, strict=True)),
            tool=kind_of_mechanism(model.tool.kind).name if model.tool is not None else None,
            digital_outputs=digital_outputs(cell, robot, of_model=model.digital_outputs),
            digital_inputs=digital_inputs(cell, robot, of_model=model.digital_inputs),
        )

    def drawn(self, cell: Cell) -> StaticCell:
        """Return the static cell, in which targets of the arms are checked for reachability."""
        # A check without targets needs no collision library.
        from robots.planning.search.reachability import ReachabilityChecker

        return ReachabilityChecker(cell)

    def camera_coverage(self, cell: Cell) -> CameraCoverage:
        """Return how much the cameras of a cell see; raises CellError or DocumentError for an invalid cell."""
        from robots.vision.camera_coverage import camera_coverage

        return camera_coverage(cell)

    def mesh_defects(self, file: Path, *, scale: float) -> tuple[MeshDefect, ...]:
        """Return what is wrong with a mesh file of a fixture."""
        try:
            from robots.model.meshes.mesh_solids import inspect_mesh
        except ImportError as error:
            message, hint = (
                f"meshes need the package `{error.name}`, which is not installed",
                "pip install 'flexcell[sim]'",
            )
            return (MeshDefect(message=message, hint=hint, unusable=True),)
        return inspect_mesh(file, scale=scale)

    def urdf_module(self, file: Path, *, name: str) -> UrdfModule:
        """Return a module of the links of a URDF; raises CellError for one that is no fixed assembly."""
        from robots.model.urdf.urdf_fixtures import module_of_urdf

        return module_of_urdf(file, name=name)

    def reach(self, cell: Cell, robot: str, *, step_m: float, direction: ReachDirection) -> Iterator[ReachLevel]:
        """Yield where the tool of an arm gets; raises CellError or DocumentError for an unknown or invalid one."""
        from robots.model.inverse_kinematics.reach_map import reach_levels
        from robots.model.mechanics.kinematics import ArmKinematics
        from robots.model.registry import model_of_entry
        from robots.model.transform import RigidTransform

        entry = cell.document.robots.get(robot)
        if entry is None:
            hint = did_you_mean(robot, cell.document.robots)
            raise CellError(f"the cell has no robot `{robot}`", where=str(cell.file), hint=hint)
        base = RigidTransform.from_pose(entry.base.pose())
        kinematics = ArmKinematics(model_of_entry(entry, cell.resolve), base=base)
        return reach_levels(kinematics, step_m=step_m, direction=direction)

    def rest_contacts(self, cell: Cell) -> tuple[RestContact, ...]:
        """Return the bodies that touch at rest; raises CellError or DocumentError for an invalid cell."""
        from robots.planning.scene.rest_contacts import rest_contacts

        return rest_contacts(cell)

    def write_scene(self, cell: Cell, file: Path) -> tuple[Path, ...]:
        """Write the scene of a cell for other programs; raises CellError or DocumentError as its writer does."""
        from robots.scene_export.write_scene import write_scene

        return write_scene(cell, file)


MODELS: RobotModels = InstalledModels()
