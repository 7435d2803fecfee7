"""The scene as one URDF: the arms with their tools, fixtures, parts and frames below the link `world`.

URDF knows no free bodies that all programs agree on: parts are fixed where they start, with their mass and inertia.
Mesh files are copied as they are. Names of links and joints are those of the cell, `left/panda_link1`.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Mapping
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from engine.errors import CellError
from engine.messages import Pose
from robots.model.robot_model import RobotModel
from robots.model.urdf.description import resolve_uri
from robots.scene.sim_scene import ArmPlacement, FixtureBody, MeshBody, PartBody, Rgba, SimScene
from robots.scene_export.body_shapes import BodySolid, inertia_kg_m2, solids_of

_WORLD = "world"
_NAMED = {"joint": ("name",), "link": ("name",), "parent": ("link",), "child": ("link",), "mimic": ("joint",)}
"""The attributes that name links and joints, by element."""


def urdf_of(scene: SimScene, name: str) -> Mapping[str, bytes]:
    """Return the file `NAME.urdf` and the mesh files that it refers to, in the folder `NAME_meshes`.

    Raises:
        CellError: a mesh file is missing or cannot be read.
    """
    robot, meshes = ET.Element("robot", name=name), _Meshes(f"{name}_meshes")
    ET.SubElement(robot, "link", name=_WORLD)
    for arm in scene.arms:
        _add_arm(robot, arm, meshes)
    for body in (*scene.fixtures, *scene.parts):
        _add_body(robot, body, meshes)
    for frame, pose in scene.frames.items():
        ET.SubElement(robot, "link", name=frame)
        _fix(robot, frame, pose)
    ET.indent(robot)
    text = ET.tostring(robot, encoding="utf-8", xml_declaration=True)
    return {f"{name}.urdf": text + b"\n", **meshes.contents}


class _Meshes:
    """The copied mesh files; two files of one name keep apart."""

    def __init__(self, folder: str) -> None:
        self._folder = folder
        self._names: dict[Path, str] = {}
        self.contents: dict[str, bytes] = {}

    def name_of(self, path: Path) -> str:
        """Return the name of a mesh beside the URDF, and take its content."""
        if path not in self._names:
            taken = set(self._names.values())
            name, number = f"{self._folder}/{path.name}", 1
            while name in taken:
                number += 1
                name = f"{self._folder}/{path.stem}_{number}{path.suffix}"
            try:
                self.contents[name] = path.read_bytes()
            except OSError as error:
                raise CellError(f"the mesh cannot be read: {error.strerror}", where=str(path)) from error
            self._names[path] = name
        return self._names[path]

    def name_of_surface(self, name: str, surface: Any) -> str:
        """Return the name beside the URDF of a mesh of trimesh, which is written as STL."""
        file = f"{self._folder}/{name.replace('/', '_')}.stl"
        self.contents[file] = surface.export(file_type="stl")
        return file


def _add_arm(robot: ET.Element, arm: ArmPlacement, meshes: _Meshes) -> None:
    model = arm.robot()
    for element in ET.fromstring(model.urdf_text):  # noqa: S314 - our composed URDF
        if element.tag not in ("link", "joint"):
            continue
        for each in element.iter():
            for attribute in _NAMED.get(each.tag, ()):
                if attribute in each.attrib:
                    each.attrib[attribute] = f"{arm.name}/{each.attrib[attribute]}"
        for mesh in element.iter("mesh"):
            mesh.attrib["filename"] = meshes.name_of(_mesh_file(mesh.attrib["filename"], model))
        robot.append(element)
    _fix(robot, f"{arm.name}/{model.base_link}", arm.base)


def _mesh_file(uri: str, model: RobotModel) -> Path:
    return resolve_uri(uri, package_dirs=model.package_dirs, relative_to=Path())


def _add_body(robot: ET.Element, body: FixtureBody | PartBody, meshes: _Meshes) -> None:
    link = ET.SubElement(robot, "link", name=body.name)
    if isinstance(body, PartBody):
        inertial = ET.SubElement(link, "inertial")
        ET.SubElement(inertial, "mass", value=_number(body.mass_kg))
        xx, yy, zz = (_number(value) for value in inertia_kg_m2(body))
        ET.SubElement(inertial, "inertia", ixx=xx, ixy="0", ixz="0", iyy=yy, iyz="0", izz=zz)
    if isinstance(body, FixtureBody) and body.mesh is not None:
        _add_mesh(link, body, body.mesh, meshes)
    for solid in solids_of(body):
        looks, touches = ET.SubElement(link, "visual"), ET.SubElement(link, "collision")
        for element in (looks, touches):
            ET.SubElement(element, "origin", xyz=_numbers(solid.pose.xyz), rpy=_rpy(solid.pose))
            _add_geometry(element, solid)
        _add_colour(looks, f"{body.name}_colour", body.rgba)
    _fix(robot, body.name, body.pose)


def _add_mesh(link: ET.Element, body: FixtureBody, mesh: MeshBody, meshes: _Meshes) -> None:
    """Add how a mesh looks, and its convex pieces as what is touched."""
    # Slow to import; its types are incomplete.
    trimesh: Any = import_module("trimesh")
    for number, look in enumerate(mesh.looks):
        points = np.frombuffer(look.vertices, np.float32).reshape(-1, 3)
        faces = np.frombuffer(look.faces, np.uint32).reshape(-1, 3)
        surface = trimesh.Trimesh(vertices=points, faces=faces, process=False)
        visual = ET.SubElement(link, "visual")
        name = meshes.name_of_surface(f"{body.name}_look_{number}", surface)
        ET.SubElement(ET.SubElement(visual, "geometry"), "mesh", filename=name)
        _add_colour(visual, f"{body.name}_colour_{number}", look.rgba)
    for number, piece in enumerate(mesh.pieces):
        surface = trimesh.Trimesh(vertices=np.array(piece)).convex_hull
        name = meshes.name_of_surface(f"{body.name}_piece_{number}", surface)
        ET.SubElement(ET.SubElement(ET.SubElement(link, "collision"), "geometry"), "mesh", filename=name)


def _add_geometry(element: ET.Element, solid: BodySolid) -> None:
    geometry, size = ET.SubElement(element, "geometry"), solid.size_m
    match solid.shape:
        case "box":
            ET.SubElement(geometry, "box", size=_numbers(size))
        case "cylinder":
            ET.SubElement(geometry, "cylinder", radius=_number(size[0] / 2.0), length=_number(size[1]))
        case _:
            ET.SubElement(geometry, "sphere", radius=_number(size[0] / 2.0))


def _add_colour(visual: ET.Element, name: str, rgba: Rgba) -> None:
    ET.SubElement(ET.SubElement(visual, "material", name=name), "color", rgba=_numbers(rgba))


def _fix(robot: ET.Element, link: str, pose: Pose) -> None:
    joint = ET.SubElement(robot, "joint", name=f"{_WORLD}_to_{link}", type="fixed")
    ET.SubElement(joint, "parent", link=_WORLD)
    ET.SubElement(joint, "child", link=link)
    ET.SubElement(joint, "origin", xyz=_numbers(pose.xyz), rpy=_rpy(pose))


def _rpy(pose: Pose) -> str:
    return _numbers(tuple(Rotation.from_quat(np.array(pose.xyzw)).as_euler("xyz").tolist()))


def _number(value: float) -> str:
    return f"{value:.12g}"


def _numbers(values: tuple[float, ...]) -> str:
    return " ".join(_number(value) for value in values)
