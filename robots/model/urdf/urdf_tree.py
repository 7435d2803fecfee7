"""URDF as a tree: reads, prunes, renames and joins it; makes mesh paths independent of the file's location."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from pathlib import Path

from engine.errors import CellError
from robots.model.urdf.description import PACKAGE_SCHEME, resolve_uri
from robots.model.urdf.mesh_file import verify_mesh_file
from robots.model.urdf.untrusted_xml import parse_xml, read_text
from robots.model.urdf.urdf_validation import verify_urdf

Element = ET.Element

_MAX_PREFIXES = 32
_PREFIX_USED = re.compile(r"<(\w+):")


def read_urdf(path: Path, *, package_dir: Path, within: Path | None = None) -> Element:
    """Return the `robot` element of a file, meshes as `package://` URIs below `package_dir`, links and joints only.

    Args:
        path: The file.
        package_dir: Folder of the packages.
        within: Folder that must contain the meshes, symbolic links resolved; `package_dir` by default.

    Raises:
        CellError: it cannot be read, is not XML or not a URDF, or a mesh is missing, outside, or too large.
    """
    text = _with_prefixes_declared(read_text(path, what="URDF"), where=path)
    robot = parse_xml(text, what="URDF", where=path)
    _write_colours_out(robot)
    for element in list(robot):
        if element.tag not in ("link", "joint"):
            robot.remove(element)
    verify_urdf(robot, where=path)
    known: dict[str, str] = {}
    for mesh in robot.iter("mesh"):
        name = mesh.attrib["filename"]
        if name not in known:
            known[name] = _mesh_uri(name, urdf=path, package_dir=package_dir, within=within or package_dir)
        mesh.attrib["filename"] = known[name]
    return robot


def _mesh_uri(name: str, *, urdf: Path, package_dir: Path, within: Path) -> str:
    file = resolve_uri(name, package_dirs=(package_dir,), relative_to=urdf.parent).resolve()
    if not file.is_relative_to(within.resolve()):
        raise CellError(f"the mesh {file} is outside {within}", where=str(urdf), hint="move it into the folder")
    verify_mesh_file(file)
    return PACKAGE_SCHEME + file.relative_to(package_dir.resolve()).as_posix()


def _write_colours_out(robot: Element) -> None:
    """Write into every visual the colour that its material has elsewhere in the file."""
    colours = {
        m.get("name", ""): c for m in robot.iter("material") if m.get("name") and (c := m.find("color")) is not None
    }
    for material in robot.iterfind("link/visual/material"):
        if material.find("color") is None and (colour := colours.get(material.get("name", ""))) is not None:
            material.append(colour)


def _with_prefixes_declared(text: str, *, where: Path) -> str:
    """Declare undeclared namespace prefixes; xacro produces such files."""
    used = set(_PREFIX_USED.findall(text))
    if len(used) > _MAX_PREFIXES:
        raise CellError(
            f"the URDF uses {len(used)} prefixes, more than {_MAX_PREFIXES}", where=str(where), hint="correct it"
        )
    missing = sorted(p for p in used if f"xmlns:{p}=" not in text)
    return re.sub(r"<robot\b", " ".join(["<robot", *(f'xmlns:{p}="{p}"' for p in missing)]), text, count=1)


def links_of(robot: Element) -> dict[str, Element]:
    """Return the links by name, in file order."""
    return {link.attrib["name"]: link for link in robot.findall("link")}


def joints_of(robot: Element) -> dict[str, Element]:
    """Return the joints by name, in file order."""
    return {joint.attrib["name"]: joint for joint in robot.findall("joint")}


def ends_of(joint: Element) -> tuple[str, str]:
    """Return the names of a joint's parent and child link."""
    parent, child = joint.find("parent"), joint.find("child")
    assert parent is not None
    assert child is not None
    return parent.attrib["link"], child.attrib["link"]


def root_of(robot: Element) -> str:
    """Return the link without a parent joint."""
    children = {ends_of(joint)[1] for joint in robot.findall("joint")}
    return next(name for name in links_of(robot) if name not in children)


def descendants_of(robot: Element, link: str) -> set[str]:
    """Return `link` and all its descendants."""
    found, edges = {link}, [ends_of(joint) for joint in robot.findall("joint")]
    while True:
        more = {child for parent, child in edges if parent in found} - found
        if not more:
            return found
        found |= more


def keep_links(robot: Element, names: set[str]) -> None:
    """Remove all other links, and the joints attached to them."""
    for link in robot.findall("link"):
        if link.attrib["name"] not in names:
            robot.remove(link)
    for joint in robot.findall("joint"):
        if not set(ends_of(joint)) <= names:
            robot.remove(joint)


def add_prefix(robot: Element, prefix: str) -> None:
    """Add `prefix` to the names of all links, joints and named materials, and to references to them."""
    for element in (*robot.findall("link"), *robot.findall("joint"), *robot.iter("material")):
        if element.get("name"):
            element.attrib["name"] = prefix + element.attrib["name"]
    for joint in robot.findall("joint"):
        for end in (*joint.findall("parent"), *joint.findall("child")):
            end.attrib["link"] = prefix + end.attrib["link"]
        for mimic in joint.findall("mimic"):
            mimic.attrib["joint"] = prefix + mimic.attrib["joint"]


def take_collisions(robot: Element, other: Element) -> None:
    """Replace the collision shapes of every link that is also in `other` by those of `other`."""
    theirs = links_of(other)
    for name, link in links_of(robot).items():
        if name in theirs:
            for shape in link.findall("collision"):
                link.remove(shape)
            link.extend(theirs[name].findall("collision"))


def add_fixed_joint(
    robot: Element, name: str, *, parent: str, child: str, xyz: tuple[float, ...], rpy: tuple[float, ...]
) -> None:
    """Join link `child` to link `parent` by a fixed joint."""
    joint = ET.SubElement(robot, "joint", name=name, type="fixed")
    ET.SubElement(joint, "parent", link=parent)
    ET.SubElement(joint, "child", link=child)
    set_origin(joint, xyz=xyz, rpy=rpy)


def set_origin(element: Element, *, xyz: tuple[float, ...], rpy: tuple[float, ...]) -> None:
    """Write the origin of a joint; numbers keep all their digits."""
    origin = element.find("origin")
    if origin is None:
        origin = ET.SubElement(element, "origin")
    origin.attrib.update(xyz=" ".join(map(repr, map(float, xyz))), rpy=" ".join(map(repr, map(float, rpy))))


def set_limits(joint: Element, *, lower: float, upper: float, velocity: float, effort: float) -> None:
    """Write a joint's limits; a continuous joint becomes one with these limits."""
    joint.attrib["type"] = "revolute" if joint.attrib["type"] == "continuous" else joint.attrib["type"]
    limit = joint.find("limit")
    if limit is None:
        limit = ET.SubElement(joint, "limit")
    limit.attrib.update(lower=repr(lower), upper=repr(upper), velocity=repr(velocity), effort=repr(effort))


def scale_mass(robot: Element, mass_kg: float) -> None:
    """Scale the root link's mass and inertia so that all links together weigh `mass_kg`.

    Raises:
        CellError: the other links alone reach this mass, or the root has no mass.
    """
    root = links_of(robot)[root_of(robot)]
    mass, inertia = root.find("inertial/mass"), root.find("inertial/inertia")
    missing = mass_kg - mass_of(robot)
    if mass is None or inertia is None or float(mass.attrib["value"]) + missing <= 0.0:
        raise CellError(
            f"the mass of {root.attrib['name']} cannot be scaled to a total of {mass_kg:g} kg",
            hint="correct `mass_kg` or the inertial of the root link",
        )
    share = 1.0 + missing / float(mass.attrib["value"])
    mass.attrib["value"] = repr(float(mass.attrib["value"]) * share)
    for key, value in inertia.attrib.items():
        inertia.attrib[key] = repr(float(value) * share)


def mass_of(robot: Element) -> float:
    """Return the sum of the masses of all links, in kg."""
    return sum(float(mass.attrib["value"]) for mass in robot.iterfind("link/inertial/mass"))
