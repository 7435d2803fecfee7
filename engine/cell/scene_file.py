"""The scene of a cell as one file for other programs, made by a process of its own: moving arms have priority.

The process reads the document of the cell as it is saved.
"""

from __future__ import annotations

import asyncio
import io
import os
import sys
import tempfile
import zipfile
from pathlib import Path
from typing import Literal

import msgspec

from engine.cell.robot_models import robot_models
from engine.document.cell import load_cell
from engine.errors import CellError, ControlError, FlexcellError

SceneFormat = Literal["glb", "xml", "urdf"]
"""glTF 2.0, MJCF, or URDF with its meshes in a ZIP file."""

LIMIT_S = 180.0
"""Maximum seconds that the process may take."""
_CODE = "from engine.cell.scene_file import main; main()"
_NICER_BY = 10
_ROOT = str(Path(__file__).resolve().parents[2])
_MEDIA_TYPES = {".glb": "model/gltf-binary", ".xml": "application/xml", ".zip": "application/zip"}


class SceneFile(msgspec.Struct, frozen=True, kw_only=True):
    """A file: its name, what it is, and its content."""

    name: str
    media_type: str
    content: bytes


class _Refusal(msgspec.Struct, frozen=True, kw_only=True):
    message: str
    where: str = ""
    hint: str = ""


class SceneFiles:
    """Makes one scene file after the other; `limit_s` is how long one may take."""

    def __init__(self, *, limit_s: float = LIMIT_S) -> None:
        self._limit_s = limit_s
        self._is_busy = False

    async def made(self, cell: Path, kind: SceneFormat) -> SceneFile:
        """Return the scene of a cell document.

        Raises:
            ControlError: another one is being made.
            CellError: the document or a model is invalid, or it takes too long.
        """
        if self._is_busy:
            raise ControlError("a scene is being exported already", hint="try again when it is there")
        self._is_busy = True
        try:
            with tempfile.TemporaryDirectory(prefix="flexcell-scene-") as folder:
                await self._run(cell, Path(folder) / f"{cell.stem}.{kind}")
                return await asyncio.to_thread(_collected, Path(folder), cell.stem, kind)
        finally:
            self._is_busy = False

    async def _run(self, cell: Path, out: Path) -> None:
        environment = {
            **os.environ,
            "PYTHONPATH": os.pathsep.join([_ROOT, *(path for path in sys.path if path)]),
            "OPENBLAS_NUM_THREADS": "1",
            "OMP_NUM_THREADS": "1",
        }
        process = await asyncio.create_subprocess_exec(
            *(sys.executable, "-P", "-c", _CODE, str(cell), str(out)),
            env=environment,
            stdin=asyncio.subprocess.DEVNULL,
            stdout=asyncio.subprocess.PIPE,
        )
        try:
            async with asyncio.timeout(self._limit_s):
                output, _ = await process.communicate()
        except TimeoutError as error:
            hint = "export it on the command line: flexcell cell export"
            raise CellError(f"the scene takes more than {self._limit_s:g} s", where=str(cell), hint=hint) from error
        finally:
            if process.returncode is None:
                process.kill()
                await process.wait()
        if process.returncode:
            refusal = _refusal(output, process.returncode)
            raise CellError(refusal.message, where=refusal.where or None, hint=refusal.hint or None)


def main() -> None:
    """Write the scene of the document that is the first argument to the file that is the second one."""
    os.nice(_NICER_BY)
    try:
        models = robot_models()
        if models is None:
            raise CellError("no installed package provides robot models", hint="install flexcell with its robots")
        models.write_scene(load_cell(sys.argv[1]), Path(sys.argv[2]))
    except FlexcellError as error:
        refusal = _Refusal(message=error.message, where=str(error.where or ""), hint=error.hint or "")
        sys.stdout.buffer.write(msgspec.json.encode(refusal))
        sys.exit(1)


def _refusal(output: bytes, code: int) -> _Refusal:
    try:
        return msgspec.json.decode(output, type=_Refusal)
    except msgspec.DecodeError:
        return _Refusal(message=f"the process that exports the scene has ended with {code}")


def _collected(folder: Path, stem: str, kind: SceneFormat) -> SceneFile:
    """Return what was written: the file itself, or a ZIP file of a URDF with its meshes."""
    file = folder / f"{stem}.{kind}"
    if kind != "urdf":
        return SceneFile(name=file.name, media_type=_MEDIA_TYPES[file.suffix], content=file.read_bytes())
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for each in sorted(path for path in folder.rglob("*") if path.is_file()):
            archive.write(each, each.relative_to(folder).as_posix())
    return SceneFile(name=f"{stem}.zip", media_type=_MEDIA_TYPES[".zip"], content=packed.getvalue())
