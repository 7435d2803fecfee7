"""Makes a module of a URDF whose links are all fixed to one another: fixtures, frames and mesh files."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from engine.cell import UrdfModule
from engine.document import Placement
from engine.errors import CellError, Position
from engine.messages import Pose, Vector3
from engine.messages.shapes import AT_ORIGIN
from robots.model.transform import RigidTransform
from robots.model.urdf.description import resolve_uri
from robots.model.urdf.mesh_file import verify_mesh_file
from robots.model.urdf.untrusted_xml import parse_xml, read_text
from robots.model.urdf.urdf_tree import Element, ends_of, joints_of, links_of, root_of
from robots.model.urdf.urdf_validation import verify_urdf

_PACKAGE_LEVELS = 6
_PLAIN = "#b0b0b0"
_MESHES = "meshes"


def module_of_urdf(file: Path, *, name: str) -> UrdfModule:
    """Return a module of the fixed links of a URDF.

    The visual shapes of a link are its fixtures, the collision shapes where it has no others; a link without shapes is
    a frame. Masses are left out: fixtures do not move.

    Args:
        file: The URDF; `package://` is looked for in the folders above it.
        name: The name of the module.

    Raises:
        CellError: it cannot be read, has a joint that moves, or a mesh is missing or too large.
    """
    text = read_text(file, what="URDF")
    robot = parse_xml(text, what="URDF", where=file)
    for element in list(robot):
        if element.tag not in ("link", "joint", "material"):
            robot.remove(element)
    verify_urdf(robot, where=file)
    return _Reader(file, text, robot).module(name)


class _Reader:
    """Collects the lines of a module document while it goes through the links."""

    def __init__(self, file: Path, text: str, robot: Element) -> None:
        self._file, self._text, self._robot = file, text, robot
        self._meshes: dict[str, Path] = {}
        self._left_out: list[tuple[int, str]] = []
        self._names: set[str] = {"world"}
        self._colours = {each.get("name", ""): each for each in robot.findall("material")}

    def module(self, name: str) -> UrdfModule:
        poses, root = self._poses(), root_of(self._robot)
        fixtures: list[str] = []
        frames: list[str] = []
        for link, element in links_of(self._robot).items():
            made = list(self._fixtures(link, element, poses[link]))
            fixtures += made
            if not made and link != root:
                frames.append(f"  {self._free(link)}: {{{_at(poses[link])}}}\n")
            self._note_masses(link, element)
        body = "fixtures:\n" + "".join(fixtures) if fixtures else ""
        body += "frames:\n" + "".join(frames) if frames else ""
        text = f"flexcell: 1\nmodule: {name}\ndescription: Made of {self._file.name}.\n{body}"
        lines = tuple(f"{self._file.name}:{line}: {what}" for line, what in sorted(self._left_out))
        return UrdfModule(text=text, meshes=self._meshes, left_out=lines)

    def _poses(self) -> dict[str, RigidTransform]:
        """Return the poses of all links in the root."""
        joints = joints_of(self._robot)
        for joint, element in joints.items():
            kind = element.get("type", "")
            if kind != "fixed":
                where = Position(file=str(self._file), line=self._line("joint", joint), column=1)
                raise CellError(
                    f"the joint `{joint}` is {kind}, and a module of a URDF has fixed joints only",
                    where=str(where),
                    hint="a robot is a folder with a `robot.yaml`: docs/how-to/add-a-robot.md",
                )
        poses = {root_of(self._robot): RigidTransform.from_pose(AT_ORIGIN)}
        open_ends = [(*ends_of(element), element) for element in joints.values()]
        while open_ends:
            ready = [each for each in open_ends if each[0] in poses]
            for parent, child, element in ready:
                poses[child] = poses[parent].then(_origin(element))
            open_ends = [each for each in open_ends if each[1] not in poses]
        return poses

    def _fixtures(self, link: str, element: Element, pose: RigidTransform) -> list[str]:
        shapes = element.findall("visual")
        collisions = element.findall("collision")
        if shapes and collisions:
            self._leave_out("link", link, "its collision shapes: bodies touch what is seen")
        lines: list[str] = []
        for shape in shapes or collisions:
            written = self._shape(link, shape)
            if written is not None:
                at = _at(pose.then(_origin(shape)))
                lines.append(f'  {self._free(link)}: {{{written}, {at}, color: "{self._colour(shape)}"}}\n')
        return lines

    def _shape(self, link: str, shape: Element) -> str | None:
        """Return the keys of a shape; None for one that is left out."""
        for each in shape.findall("geometry/*"):
            if each.tag == "box":
                return f"shape: box, size_m: [{', '.join(_number(v) for v in _values(each.attrib['size']))}]"
            if each.tag == "cylinder":
                diameter = 2.0 * float(each.attrib["radius"])
                return f"shape: cylinder, size_m: [{_number(diameter)}, {_number(float(each.attrib['length']))}]"
            if each.tag == "mesh":
                return self._mesh(link, each)
            self._leave_out("link", link, f"a {each.tag}: fixtures are boxes, cylinders and meshes")
        return None

    def _mesh(self, link: str, mesh: Element) -> str | None:
        scale = _values(mesh.get("scale", "1 1 1"))
        if min(scale) <= 0.0 or max(scale) - min(scale) > 1e-9 * max(scale):
            self._leave_out("link", link, f"a mesh with the scale {mesh.get('scale')}: scale it in its own program")
            return None
        folders = list(self._file.resolve().parents)[:_PACKAGE_LEVELS]
        file = resolve_uri(mesh.attrib["filename"], package_dirs=folders, relative_to=self._file.parent).resolve()
        verify_mesh_file(file)
        name, number = f"{_MESHES}/{_plain(file.stem)}{file.suffix.lower()}", 1
        while self._meshes.setdefault(name, file) != file:
            number += 1
            name = f"{_MESHES}/{_plain(file.stem)}_{number}{file.suffix.lower()}"
        factor = f", scale: {_number(scale[0])}" if scale[0] != 1.0 else ""
        return f"shape: mesh, file: {name}{factor}"

    def _colour(self, shape: Element) -> str:
        material = shape.find("material")
        if material is None:
            return _PLAIN
        colour = material.find("color")
        if colour is None:
            named = self._colours.get(material.get("name", ""))
            colour = named.find("color") if named is not None else None
        if colour is None:
            return _PLAIN
        return "#" + "".join(f"{round(255 * min(max(v, 0.0), 1.0)):02x}" for v in _values(colour.attrib["rgba"])[:3])

    def _note_masses(self, link: str, element: Element) -> None:
        if element.find("inertial") is not None:
            self._leave_out("link", link, "its mass: fixtures do not move")

    def _leave_out(self, tag: str, name: str, what: str) -> None:
        self._left_out.append((self._line(tag, name), f"{tag} `{name}`: {what}"))

    def _line(self, tag: str, name: str) -> int:
        found = re.search(rf"<{tag}\b[^>]*\bname\s*=\s*[\"']{re.escape(name)}[\"']", self._text)
        return self._text.count("\n", 0, found.start()) + 1 if found is not None else 1

    def _free(self, link: str) -> str:
        plain = name = _plain(link)
        number = 1
        while name in self._names:
            number += 1
            name = f"{plain[:58]}_{number}"
        self._names.add(name)
        return name


def _plain(name: str) -> str:
    """Return a name of letters, digits and `_` that begins with a letter."""
    plain = re.sub(r"[^a-z0-9_]+", "_", name.lower()).strip("_")[:60]
    return plain if plain[:1].isalpha() else f"link_{plain}".rstrip("_")


def _origin(element: Element) -> RigidTransform:
    origin = element.find("origin")
    attributes = origin.attrib if origin is not None else {}
    xyz, rpy = (_vector(attributes.get(key, "0 0 0")) for key in ("xyz", "rpy"))
    return RigidTransform.from_pose(Placement(xyz=xyz, rpy=rpy).pose())


def _at(pose: RigidTransform) -> str:
    at = Placement.of(Pose(xyz=_triple(pose.xyz.tolist()), xyzw=pose.to_pose("world").xyzw))
    shown = [f"{key}: [{', '.join(_number(v) for v in values)}]" for key, values in (("xyz", at.xyz), ("rpy", at.rpy))]
    if not np.abs(at.rpy).max() > 1e-9:
        shown.pop()
    return f"at: {{{', '.join(shown)}}}"


def _vector(text: str) -> Vector3:
    return _triple(_values(text))


def _triple(values: list[float]) -> Vector3:
    x, y, z = values
    return x, y, z


def _values(text: str) -> list[float]:
    return [float(value) for value in text.split()]


def _number(value: float) -> str:
    return f"{round(value, 9) + 0.0:.10g}"
