"""The scene of a cell as one file, made by another process: one at a time, and what is wrong with the cell is said."""

from __future__ import annotations

import asyncio
import io
import zipfile
from pathlib import Path

import pytest

from engine.cell import SceneFiles
from engine.errors import CellError, ControlError

CELL = "flexcell: 1\ncell: bench\nworld: {kind: mujoco}\nfixtures:\n  table: {shape: box, size_m: [1, 1, 0.1]}\n"


def cell_file(folder: Path, text: str = CELL) -> Path:
    (folder / "bench.yaml").write_text(text, encoding="utf-8")
    return folder / "bench.yaml"


async def test_a_scene_comes_in_each_format(tmp_path: Path) -> None:
    files, cell = SceneFiles(), cell_file(tmp_path)
    glb = await files.made(cell, "glb")
    assert (glb.name, glb.media_type, glb.content[:4]) == ("bench.glb", "model/gltf-binary", b"glTF")
    xml = await files.made(cell, "xml")
    assert (xml.name, xml.content[:7]) == ("bench.xml", b"<mujoco")
    urdf = await files.made(cell, "urdf")
    assert (urdf.name, urdf.media_type) == ("bench.zip", "application/zip")
    assert zipfile.ZipFile(io.BytesIO(urdf.content)).namelist() == ["bench.urdf"]


async def test_an_invalid_cell_is_refused_with_its_position(tmp_path: Path) -> None:
    cell = cell_file(tmp_path, CELL.replace("[1, 1, 0.1]", "[1, 1]"))
    with pytest.raises(CellError, match="the size of a box has 3 lengths, not 2") as error:
        await SceneFiles().made(cell, "glb")
    assert str(error.value.where) == f"{cell}:5:31"


async def test_one_scene_is_made_at_a_time(tmp_path: Path) -> None:
    files, cell = SceneFiles(), cell_file(tmp_path)
    first = asyncio.create_task(files.made(cell, "glb"))
    await asyncio.sleep(0)
    with pytest.raises(ControlError, match="a scene is being exported already"):
        await files.made(cell, "xml")
    assert (await first).name == "bench.glb"
    assert (await files.made(cell, "xml")).name == "bench.xml"


async def test_a_scene_that_takes_too_long_is_given_up(tmp_path: Path) -> None:
    files = SceneFiles(limit_s=0.01)
    with pytest.raises(CellError, match=r"the scene takes more than 0.01 s"):
        await files.made(cell_file(tmp_path), "glb")
    with pytest.raises(CellError, match="takes more than"):
        await files.made(cell_file(tmp_path), "glb")
