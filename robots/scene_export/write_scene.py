"""Writes the scene of a cell document in the format of the file's name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

from msgspec.structs import replace

from engine.document import Cell
from engine.errors import CellError
from robots.scene.docked_scene import with_modules
from robots.scene.scene_builder import build_scene
from robots.scene.sim_scene import SimScene
from robots.scene_export.gltf import gltf_of
from robots.scene_export.mjcf import mjcf_of
from robots.scene_export.urdf import urdf_of

# Each returns the contents of files by their names beside the file itself.
_FORMATS: Mapping[str, Callable[[SimScene, str], Mapping[str, bytes]]] = {
    ".xml": mjcf_of,
    ".urdf": urdf_of,
    ".glb": gltf_of,
}


def write_scene(cell: Cell, file: Path) -> tuple[Path, ...]:
    """Write the scene of a cell, with all parts where the document places them and all arms at home.

    The arms are those of their models, without the errors of `realism`. Modules that are not plugged, people and bodies
    that nobody knows of are left out.

    Args:
        cell: The cell.
        file: `.xml` is MJCF, `.urdf` is URDF, with meshes in a folder beside it, `.glb` is glTF 2.0.

    Returns:
        The written files, `file` first.

    Raises:
        CellError: the format is unknown, the cell has no world or an invalid body, or a file cannot be written.
        DocumentError: a model folder or a calibration file is invalid.
    """
    write = _FORMATS.get(file.suffix.lower())
    if write is None:
        raise CellError(
            f"{file} is no scene", hint=f"give a name that ends in {', '.join(_FORMATS)}: MJCF, URDF or glTF"
        )
    contents = write(_nominal(cell), file.stem)
    written: list[Path] = []
    # The file itself comes last: it refers to the others.
    for name, content in reversed(list(contents.items())):
        path = file if name == file.name else file.parent / name
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)
        except OSError as error:
            reason = error.strerror or type(error).__name__
            raise CellError(f"it cannot be written: {reason}", where=str(path), hint="choose another place") from error
        written.append(path)
    return tuple(reversed(written))


def _nominal(cell: Cell) -> SimScene:
    scene = with_modules(build_scene(cell.document, resolve=cell.resolve), cell)
    away = {module.name for module in scene.modules if not module.plugged}

    def is_there(name: str) -> bool:
        return name.partition("/")[0] not in away

    return replace(
        scene,
        realism="ideal",
        arms=tuple(replace(arm, driven=False, driven_tool=False) for arm in scene.arms),
        fixtures=tuple(body for body in scene.fixtures if is_there(body.name)),
        parts=tuple(body for body in scene.parts if is_there(body.name)),
        frames={name: pose for name, pose in scene.frames.items() if is_there(name)},
        people=(),
        unknown_fixtures=(),
        unknown_parts=(),
    )
