"""A model folder that anybody wrote is refused in words before a library reads it: paths, entities, sizes, numbers."""

from __future__ import annotations

import struct
from collections.abc import Callable
from pathlib import Path

import pytest

from engine.errors import CellError, DocumentError
from robots.model.registry import robot_model
from robots.model.urdf.mesh_file import MAX_BYTES, MAX_TRIANGLES, verify_mesh_file
from robots.model.urdf.urdf_validation import MAX_LINKS
from tests.robots.model.folder.test_model_folder import BODY, ROBOT, URDF, written

LAUGHS = "".join(f'<!ENTITY l{n} "{f"&l{n - 1};" * 10}">' for n in range(1, 12))
BOMB = f'<!DOCTYPE robot [<!ENTITY l0 "ha">{LAUGHS}]>'
MESH = '<visual><geometry><mesh filename="{}"/></geometry></visual>'
SECRET = '<!DOCTYPE robot [<!ENTITY s SYSTEM "file:///etc/hostname">]>'


def with_mesh(name: str) -> str:
    return URDF.replace(BODY, BODY + MESH.format(name), 1)


def stl(triangles: int, *, said: int | None = None) -> bytes:
    return bytes(80) + struct.pack("<I", triangles if said is None else said) + bytes(50) * triangles


@pytest.mark.parametrize(
    ("urdf", "said"),
    [
        (BOMB + URDF.replace('name="two"', 'name="&l11;"'), "document type"),
        (SECRET + URDF.replace('name="two"', 'name="&s;"'), "document type"),
        (URDF.replace("</robot>", "<a>" * 100 + "</a>" * 100 + "</robot>"), "more than 64 levels"),
        (URDF.replace("</robot>", "<a/>" * 50_001 + "</robot>"), "more than 50000 elements"),
        (URDF.replace("</robot>", " " * 9_000_000 + "</robot>"), "more than 8388608 bytes"),
        (URDF.replace("</robot>", "".join(f'<link name="l{n}"/>' for n in range(MAX_LINKS)) + "</robot>"), "links"),
        (URDF.replace('name="arm"', 'name="base"', 1), "two links base"),
        (URDF.replace('<link name="arm">', "<link>"), "a link has no name"),
        (URDF.replace("continuous", "floating"), "the type of the joint turn is not one of fixed"),
        (URDF.replace('<child link="arm"/>', ""), "does not connect one parent link to another child link"),
        (URDF.replace('<child link="arm"/>', '<child link="base"/>'), "its own ancestor"),
        (URDF.replace("</robot>", '<link name="alone"/></robot>'), "do not form one tree"),
        (URDF.replace("</robot>", "".join(f"<p{n}:a/>" for n in range(99)) + "</robot>"), "99 prefixes"),
        (URDF.replace('value="1"', 'value="nan"', 1), "is not a number"),
        (URDF.replace('value="1"', 'value="1e400"', 1), "is not a number"),
        (URDF.replace('value="1"', 'value="-1"', 1), "is negative"),
        (URDF.replace('value="1"', "", 1), "a `mass` has no `value`"),
        (URDF.replace('xyz="0 0 1"', 'xyz="0 0"'), "is not 3 numbers"),
        (with_mesh("/etc/hostname"), "is outside"),
        (with_mesh("file:///etc/hostname"), "is outside"),
        (with_mesh("../outside.stl"), "is outside"),
        (with_mesh("package://../outside.stl"), "is outside|no mesh file"),
        (with_mesh("package://m/../outside.stl"), "is outside"),
        (with_mesh("link.stl"), "is outside"),
        (with_mesh("pipe.stl"), "no mesh file"),
        (with_mesh("a\x01.stl"), "cannot be read"),
        (with_mesh("nowhere.stl"), "no mesh file"),
        (with_mesh("two.urdf"), r"file type is not one of \.stl"),
    ],
)  # fmt: skip
def test_a_urdf_that_cannot_be_relied_on_is_refused(tmp_path: Path, urdf: str, said: str) -> None:
    (tmp_path / "outside.stl").write_bytes(stl(1))
    folder = tmp_path / "m"
    name = written(folder, urdf=urdf)
    (folder / "link.stl").symlink_to(tmp_path / "outside.stl")
    (folder / "pipe.stl").mkdir()
    with pytest.raises(CellError, match=said):
        robot_model(name, gripper=None)


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("urdf: {file: ../outside.urdf}", r"\.\./outside\.urdf is outside the model folder"),
        ("urdf: {file: /etc/hostname}", "/etc/hostname is outside the model folder"),
        ("urdf: {file: link.urdf}", r"link\.urdf is outside the model folder"),
        ("urdf: {file: two.urdf, collision_file: ../outside.urdf}", "is outside the model folder"),
        ("urdf: {file: two.urdf}\ncollisions: {srdf: {file: ../outside.urdf}}", "is outside the model folder"),
        ("urdf: {file: two.urdf}\ncollisions: {srdf: {file: bad.srdf}}", "no `link1` or no `link2`"),
        ("urdf: {file: two.urdf}\ncollisions: {srdf: {file: bomb.srdf}}", "the SRDF cannot be read: .*document type"),
    ],
)
def test_a_document_names_only_files_of_its_folder(tmp_path: Path, line: str, said: str) -> None:
    (tmp_path / "outside.urdf").write_text(URDF)
    folder = tmp_path / "m"
    name = written(folder, robot=ROBOT.replace("urdf: {file: two.urdf}", line))
    (folder / "link.urdf").symlink_to(tmp_path / "outside.urdf")
    (folder / "bad.srdf").write_text('<robot><disable_collisions link1="a"/></robot>')
    (folder / "bomb.srdf").write_text(BOMB + "<robot/>")
    with pytest.raises((CellError, DocumentError), match=said):
        robot_model(name, gripper=None)


def test_the_licence_is_a_file_of_the_folder(tmp_path: Path) -> None:
    name = written(tmp_path / "m", robot=ROBOT.replace("CC0-1.0, file: two.urdf", "CC0-1.0, file: /etc/hostname"))
    with pytest.raises(CellError, match="/etc/hostname is outside the model folder"):
        robot_model(name, gripper=None)


MESHES: dict[str, tuple[str, Callable[[], bytes], str]] = {
    "short": ("a.stl", lambda: b"x" * 20, "not an STL file"),
    "says more": ("a.stl", lambda: stl(2, said=2**31), "states 2147483648 triangles"),
    "says less": ("a.stl", lambda: stl(2, said=1), "states 1 triangles"),
    "too many": ("a.stl", lambda: stl(MAX_TRIANGLES + 1), "more than 1000000"),
    "polygons": ("a.obj", lambda: b"f" + b" 1" * (3 * MAX_TRIANGLES + 1), "more than 1000000 triangles"),
    "materials": ("a.obj", lambda: b"mtllib ../../secret.mtl\n", "materials outside"),
    "laughs": ("a.dae", (BOMB + "<COLLADA/>").encode, "document type"),
    "hidden": ("a.dae", lambda: (BOMB + "<COLLADA/>").encode("utf-16"), "document type"),
    "no text": ("a.dae", lambda: b"<a>\xff\xfe</a>", "utf-8"),
    "blend": ("a.blend", lambda: b"", "is not one of"),
}


@pytest.mark.parametrize("name", MESHES)
def test_a_mesh_file_is_checked_before_it_is_read(tmp_path: Path, name: str) -> None:
    file, content, said = MESHES[name]
    (tmp_path / file).write_bytes(content())
    with pytest.raises(CellError, match=rf"{file}: the mesh cannot be used: .*{said}"):
        verify_mesh_file(tmp_path / file)


def test_a_mesh_file_may_be_so_large_and_no_larger(tmp_path: Path) -> None:
    with (tmp_path / "a.obj").open("wb") as stream:
        stream.truncate(MAX_BYTES + 1)
    with pytest.raises(CellError, match=f"more than {MAX_BYTES}"):
        verify_mesh_file(tmp_path / "a.obj")


def test_meshes_within_the_limits_are_used(tmp_path: Path) -> None:
    folder = tmp_path / "m"
    name = written(folder, urdf=with_mesh("package://m/a.stl"))
    (folder / "a.stl").write_bytes(stl(12))
    assert "package://m/a.stl" in robot_model(name, gripper=None).urdf_text
