"""The visual meshes of a robot's links: mesh files split by colour and simplified, primitives converted to meshes."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from importlib import import_module
from io import BytesIO
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from engine.errors import CellError
from engine.host.user_cache import cache_dir
from engine.messages import Quaternion, Vector3
from robots.model.robot_model import RobotModel
from robots.model.urdf.description import resolve_uri
from robots.model.urdf.mesh_cache import content_key, read_cached, write_cached
from robots.model.urdf.mesh_file import require_triangles, verify_mesh_file

Rgba = tuple[float, float, float, float]

# With a tenth of the faces a Panda has 14 thousand triangles and looks the same.
_KEEP = 0.1
_LEAST_FACES = 150
_RECIPE = f"visual mesh 1, keep {_KEEP}, least {_LEAST_FACES}"
_ROUND = 32
_SHARP_DEG = 30.0
_PRIMITIVE_RECIPE = f"primitive 1, round {_ROUND}"
_PLAIN: Rgba = (0.7, 0.7, 0.7, 1.0)


class VisualMesh(msgspec.Struct, frozen=True, kw_only=True):
    """One colour of a mesh file: float32 vertices (n x 3, metres), uint32 faces (m x 3), as bytes."""

    vertices: bytes
    faces: bytes
    rgba: Rgba


class LinkVisual(msgspec.Struct, frozen=True, kw_only=True):
    """A mesh fixed to a link, with its pose in the link's frame."""

    link: str
    mesh: VisualMesh
    xyz: Vector3
    xyzw: Quaternion


def link_visuals(model: RobotModel, *, cache: Path | None = None) -> tuple[LinkVisual, ...]:
    """Return the visual meshes of all links, in URDF order; `cache` is the user's folder by default.

    Raises:
        CellError: a mesh file is missing or cannot be read.
    """
    folder = cache if cache is not None else cache_dir()
    known: dict[Path, tuple[VisualMesh, ...]] = {}
    visuals: list[LinkVisual] = []
    for link in ET.fromstring(model.urdf_text).iter("link"):  # noqa: S314 - our composed URDF
        for visual in link.findall("visual"):
            xyz, xyzw = _origin(visual.find("origin"))
            meshes = _described(visual, model, known, folder)
            visuals += [LinkVisual(link=link.attrib["name"], mesh=m, xyz=xyz, xyzw=xyzw) for m in meshes]
    return tuple(visuals)


def file_visuals(path: Path, *, scale: float, colour: Rgba, cache: Path | None = None) -> tuple[VisualMesh, ...]:
    """Return the meshes of one file; `scale` is metres for one unit of it, `colour` that of files without colours.

    Raises:
        CellError: it is missing or cannot be read.
    """
    fixed = colour if path.suffix.lower() != ".dae" else None
    meshes = _meshes(path, cache if cache is not None else cache_dir())
    return tuple(_with_edges(_adjusted(each, (scale, scale, scale), fixed)) for each in meshes)


def _with_edges(mesh: VisualMesh) -> VisualMesh:
    """Return a mesh whose sharp edges are drawn as edges: what shades surfaces smoothly has vertices of each side."""
    trimesh: Any = import_module("trimesh")
    points = np.frombuffer(mesh.vertices, np.float32).reshape(-1, 3)
    faces = np.frombuffer(mesh.faces, np.uint32).reshape(-1, 3)
    whole = trimesh.Trimesh(vertices=points, faces=faces, process=False)
    split = trimesh.graph.smooth_shade(whole, angle=np.radians(_SHARP_DEG), facet_minarea=None)
    vertices, triangles = np.asarray(split.vertices, np.float32), np.asarray(split.faces, np.uint32)
    return VisualMesh(vertices=vertices.tobytes(), faces=triangles.tobytes(), rgba=mesh.rgba)


def _described(
    visual: ET.Element, model: RobotModel, known: dict[Path, tuple[VisualMesh, ...]], folder: Path
) -> tuple[VisualMesh, ...]:
    colour, mesh = _described_colour(visual), visual.find("geometry/mesh")
    if mesh is None:
        return _primitive(visual, colour or _PLAIN, folder)
    path = resolve_uri(mesh.attrib["filename"], package_dirs=model.package_dirs, relative_to=Path())
    if path not in known:
        known[path] = _meshes(path, folder)
    scale = tuple(float(v) for v in mesh.attrib.get("scale", "1 1 1").split())
    # Collada files have their own colours; the colours of the URDF are for formats without them.
    fixed = colour if path.suffix.lower() != ".dae" else None
    return tuple(_adjusted(each, scale, fixed) for each in known[path])


def _adjusted(mesh: VisualMesh, scale: tuple[float, ...], colour: Rgba | None) -> VisualMesh:
    if scale == (1.0, 1.0, 1.0) and colour is None:
        return mesh
    vertices = np.frombuffer(mesh.vertices, np.float32).reshape(-1, 3) * np.array(scale, np.float32)
    return VisualMesh(vertices=vertices.tobytes(), faces=mesh.faces, rgba=colour or mesh.rgba)


def _primitive(visual: ET.Element, colour: Rgba, folder: Path) -> tuple[VisualMesh, ...]:
    for shape in visual.findall("geometry/*"):
        if shape.tag in ("box", "cylinder", "sphere"):
            key = content_key(ET.tostring(shape), recipe=_PRIMITIVE_RECIPE)
            kept = read_cached(folder, key)
            if kept is not None:
                return (msgspec.structs.replace(msgspec.msgpack.decode(kept, type=VisualMesh), rgba=colour),)
            made = _made_of(shape, colour)
            write_cached(folder, key, msgspec.msgpack.encode(made))
            return (made,)
    return ()


def _made_of(shape: ET.Element, colour: Rgba) -> VisualMesh:
    # As in _converted.
    trimesh: Any = import_module("trimesh")
    numbers = {key: [float(v) for v in text.split()] for key, text in shape.attrib.items()}
    if shape.tag == "box":
        made = trimesh.creation.box(extents=numbers["size"])
    elif shape.tag == "cylinder":
        made = trimesh.creation.cylinder(numbers["radius"][0], numbers["length"][0], sections=_ROUND)
    else:
        made = trimesh.creation.icosphere(subdivisions=2, radius=numbers["radius"][0])
    vertices, faces = np.asarray(made.vertices, np.float32), np.asarray(made.faces, np.uint32)
    return VisualMesh(vertices=vertices.tobytes(), faces=faces.tobytes(), rgba=colour)


def _described_colour(visual: ET.Element) -> Rgba | None:
    colour = visual.find("material/color")
    if colour is None:
        return None
    red, green, blue, alpha = (float(v) for v in colour.attrib["rgba"].split())
    return (red, green, blue, alpha)


def _meshes(path: Path, folder: Path) -> tuple[VisualMesh, ...]:
    verify_mesh_file(path)
    data = path.read_bytes()
    key = content_key(data, recipe=_RECIPE)
    kept = read_cached(folder, key)
    if kept is not None:
        return msgspec.msgpack.decode(kept, type=tuple[VisualMesh, ...])
    made = _converted(path, data)
    write_cached(folder, key, msgspec.msgpack.encode(made))
    return made


def _converted(path: Path, data: bytes) -> tuple[VisualMesh, ...]:
    # Slow to import and needed only on a cache miss; its types are incomplete.
    trimesh: Any = import_module("trimesh")
    try:
        # Read from memory, so that a file cannot refer to other files.
        scene: Any = trimesh.load_scene(BytesIO(data), file_type=path.suffix[1:].lower())
    except Exception as error:
        # The readers behind trimesh have their own error classes for each format.
        raise CellError(f"the mesh cannot be read: {error}", where=str(path)) from error
    require_triangles(sum(len(getattr(each, "faces", ())) for each in scene.geometry.values()), path)
    parts: dict[Rgba, list[Any]] = {}
    for node in sorted(scene.graph.nodes_geometry):
        transform, name = scene.graph[node]
        geometry = scene.geometry[name].copy()
        geometry.apply_transform(transform)
        parts.setdefault(_color(geometry), []).append(geometry)
    return tuple(_thinned(trimesh.util.concatenate(pieces), rgba) for rgba, pieces in sorted(parts.items()))


def _color(geometry: Any) -> Rgba:
    material = getattr(geometry.visual, "material", geometry.visual)
    channels = [float(c) / 255.0 for c in np.asarray(material.main_color)]
    return (channels[0], channels[1], channels[2], channels[3])


def _thinned(mesh: Any, rgba: Rgba) -> VisualMesh:
    fast_simplification: Any = import_module("fast_simplification")
    mesh.merge_vertices(merge_norm=True, merge_tex=True)
    vertices: NDArray[np.float32] = np.asarray(mesh.vertices, dtype=np.float32)
    faces: NDArray[np.uint32] = np.asarray(mesh.faces, dtype=np.uint32)
    keep = max(int(len(faces) * _KEEP), _LEAST_FACES)
    if keep < len(faces):
        points, triangles = fast_simplification.simplify(vertices, faces, target_count=keep)
        vertices, faces = np.asarray(points, dtype=np.float32), np.asarray(triangles, dtype=np.uint32)
    return VisualMesh(
        vertices=np.ascontiguousarray(vertices).tobytes(), faces=np.ascontiguousarray(faces).tobytes(), rgba=rgba
    )


def _origin(origin: ET.Element | None) -> tuple[Vector3, Quaternion]:
    attributes = origin.attrib if origin is not None else {}
    x, y, z = (float(v) for v in attributes.get("xyz", "0 0 0").split())
    roll, pitch, yaw = (float(v) for v in attributes.get("rpy", "0 0 0").split())
    (cr, cp, cy), (sr, sp, sy) = (tuple(f(a / 2) for a in (roll, pitch, yaw)) for f in (np.cos, np.sin))
    quaternion = (
        float(sr * cp * cy - cr * sp * sy),
        float(cr * sp * cy + sr * cp * sy),
        float(cr * cp * sy - sr * sp * cy),
        float(cr * cp * cy + sr * sp * sy),
    )
    return (x, y, z), quaternion
