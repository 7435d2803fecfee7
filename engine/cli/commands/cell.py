"""`flexcell cell`: connection of the devices of a running server's cell, and what the cameras of a cell see."""

from __future__ import annotations

import asyncio
import math
import re
import sys
from pathlib import Path
from typing import Annotated

import typer

from engine.cell.camera_coverage import RegionCoverage
from engine.cell.cell_connection import CellConnection
from engine.cell.reach_map import ReachDirection, ReachLevel
from engine.cell.remote_cell import connect_remote_cell, remote_cell_connection
from engine.cell.robot_models import RobotModels, robot_models
from engine.cli.exit_code import ExitCode
from engine.cli.output.reach import reach_json, reach_ply, reach_table
from engine.document.cell import load_cell
from engine.errors import CellError, FlexcellError
from engine.host.state_folder_names import STATE_FOLDER
from engine.messages import Vector3

_NEW_CELL = """\
flexcell: 1
cell: {name}

world: {{kind: mujoco}}

fixtures:
  floor: {{shape: box, size_m: [3, 3, 0.04], at: {{xyz: [0, 0, -0.02]}}, color: "#d8d5cf"}}
"""

app = typer.Typer(
    help="Show or restore the connection to the devices of a running server's cell; show what the cameras of a cell"
    " see and where its arms get; import meshes into it and export its scene; begin a new one.",
    no_args_is_help=True,
)

Folder = Annotated[Path, typer.Option("--server", help="Folder in which `flexcell serve` keeps its state.")]
_STATE = Path(STATE_FOLDER)


@app.command("status")
def status(server: Folder = _STATE) -> None:
    """Show whether every device is connected; exit code 1 if the connection to one is lost."""
    _print_connection(asyncio.run(remote_cell_connection(server)))


@app.command("connect")
def connect(server: Folder = _STATE) -> None:
    """Reconnect lost devices without restarting the server; rejected while a run is active.

    `flexcell cell connect`
    """
    _print_connection(asyncio.run(connect_remote_cell(server)))


@app.command("coverage")
def coverage(
    file: Annotated[Path, typer.Argument(help="Cell document.", show_default=False)],
    fail_under: Annotated[
        float, typer.Option(min=0.0, max=100.0, help="Exit code 1 if less than so many percent of a region are seen.")
    ] = 0.0,
) -> None:
    """Print how much of each region of `must_cover` the cameras see, together and alone, with the arms at home.

    `flexcell cell coverage behaviors/cells/irb4600_shared.yaml`
    """
    found = _models().camera_coverage(load_cell(file))
    for region in (*found.regions, found.whole):
        sys.stdout.write(f"{_region_line(region)}\n")
    if any(100.0 * region.seen < fail_under for region in found.regions or (found.whole,)):
        raise typer.Exit(ExitCode.OTHER_OUTCOME)


@app.command("new")
def new(file: Annotated[Path, typer.Argument(help="The document to write.", show_default=False)]) -> None:
    """Write the document of a cell with a floor and nothing else, to build the cell from in the browser.

    `flexcell cell new cells/press.yaml`, then `flexcell serve --cell cells/press.yaml`
    """
    if file.suffix not in (".yaml", ".yml"):
        raise FlexcellError(f"{file} is no YAML file", hint="give a name that ends in .yaml")
    name = re.sub(r"[^a-z0-9_]+", "_", file.stem.lower()).strip("_")
    if not name[:1].isalpha():
        name = f"cell_{name}".rstrip("_")
    text = _NEW_CELL.format(name=name)
    if file.exists():
        raise FlexcellError(f"{file} exists already", hint="choose another name, or edit that file")
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        with file.open("x", encoding="utf-8") as written:
            written.write(text)
    except OSError as error:
        raise FlexcellError(f"{file} cannot be written: {error.strerror}", hint="choose another folder") from error
    sys.stdout.write(f"{file}\nBuild it in the browser: flexcell serve --cell {file}, then press *Edit the cell*.\n")


@app.command("import")
def import_files(
    files: Annotated[list[Path], typer.Argument(help="Meshes (.stl, .obj, .dae) and URDF files.", show_default=False)],
    cell: Annotated[Path, typer.Option("--cell", help="The cell document that takes them.", show_default=False)],
    name: Annotated[
        str | None, typer.Option(help="Its name in the cell, for one file; that of the file by default.")
    ] = None,
    scale: Annotated[
        float, typer.Option(min=1e-6, help="Metres for one unit of the meshes: 0.001 for millimetres.")
    ] = 1.0,
) -> None:
    """Take meshes into a cell as fixtures, and URDF files without moving joints as modules; say what is left out.

    `flexcell cell import housing.stl --scale 0.001 --cell cells/press.yaml`
    """
    from engine.check.cell.mesh_checks import inspected_mesh
    from engine.editing.cells.scene_import import import_file

    if name is not None and len(files) > 1:
        raise FlexcellError("--name is for one file", hint="import the files one after the other")
    for file in files:
        made = import_file(file, cell, _models(), name=name, scale=scale)
        sys.stdout.write(f"{made.kind} {made.name}: {', '.join(str(each) for each in made.files)}\n")
        for line in made.left_out:
            sys.stdout.write(f"left out: {line}\n")
        for defect in inspected_mesh(file, scale) if made.kind == "fixture" else ():
            sys.stderr.write(f"{file}: warning: {defect.message} ({defect.hint})\n")
        if made.kind == "module":
            sys.stdout.write(f"dock it: `modules: {{{made.name}: {{module: modules/{made.name}, connector: NAME}}}}`\n")


@app.command("export")
def export(
    file: Annotated[Path, typer.Argument(help="Cell document.", show_default=False)],
    output: Annotated[
        Path,
        typer.Option(
            "-o", "--output", help="The file to write: .xml (MJCF), .urdf, or .glb (glTF).", show_default=False
        ),
    ],
) -> None:
    """Write the scene of a cell for other programs: its arms at home, fixtures, parts and frames. Nothing is connected.

    `flexcell cell export behaviors/cells/ur10.yaml -o ur10.glb`
    """
    for written in _models().write_scene(load_cell(file), output):
        sys.stdout.write(f"{written}\n")


@app.command("reach")
def reach(
    file: Annotated[Path, typer.Argument(help="Cell document.", show_default=False)],
    robot: Annotated[str, typer.Argument(help="Name of the arm in the cell.", show_default=False)],
    step: Annotated[float, typer.Option(min=0.02, max=0.5, help="Distance of the points, in metres.")] = 0.1,
    direction: Annotated[
        ReachDirection, typer.Option(help="Directions of the tool's z axis: twelve on a sphere, or downwards only.")
    ] = "any",
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", help="Write the points: .ply (coloured by share) or .json.", show_default=False),
    ] = None,
) -> None:
    """Print where the tool centre point of an arm gets, in layers by height; whatever else stands in the cell.

    `flexcell cell reach behaviors/cells/ur10.yaml arm --direction down -o reach.ply`
    """
    if output is not None and output.suffix not in (".ply", ".json"):
        raise FlexcellError(f"{output} has an unknown ending", hint="end it in .ply or .json")
    level: ReachLevel | None = None
    for level in _models().reach(load_cell(file), robot, step_m=step, direction=direction):
        sys.stderr.write(f"{level.searched} points looked at, {level.left} to go: {len(level.points)} reached\n")
    if level is None:
        return
    sys.stdout.writelines(f"{line}\n" for line in reach_table(level))
    if output is not None:
        try:
            output.write_text(reach_ply(level) if output.suffix == ".ply" else reach_json(level), encoding="utf-8")
        except OSError as error:
            raise FlexcellError(
                f"{output} cannot be written: {error.strerror}", hint="choose another folder"
            ) from error
        sys.stdout.write(f"{output}\n")


def _models() -> RobotModels:
    models = robot_models()
    if models is None:
        raise CellError("no installed package provides robot models", hint="install flexcell with its robots")
    return models


def _region_line(region: RegionCoverage) -> str:
    alone = ", ".join(f"{camera} {_percent(share)}" for camera, share in region.by_camera.items())
    line = f"{region.name}: {_percent(region.seen)} seen ({alone})"
    if region.unseen_low_m is None or region.unseen_high_m is None:
        return line
    return f"{line}, unseen within {_point(region.unseen_low_m)} to {_point(region.unseen_high_m)} m"


def _percent(share: float) -> str:
    # Rounded down: what is printed as 100 % is all of it.
    return f"{math.floor(1000.0 * share) / 10.0:.1f} %"


def _point(values: Vector3) -> str:
    return f"({', '.join(f'{value:.2f}' for value in values)})"


def _print_connection(connection: CellConnection) -> None:
    sys.stdout.write(("connected" if connection.connected else "lost") + "\n")
    if connection.reason:
        sys.stderr.write(f"{connection.reason}\n")
    if not connection.connected:
        raise typer.Exit(ExitCode.OTHER_OUTCOME)
