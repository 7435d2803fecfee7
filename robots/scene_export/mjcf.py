"""The scene as MJCF in one file: bodies, joints, motors and contacts of the simulation, and the links as they look.

Shapes that touch are in geometry group 3, what only looks like something in group 2. The key frame `home` has all arms
at home. The motors take joint torques in newton metres; the controllers that the engine has are not in the file.
"""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from engine.errors import CellError
from engine.messages import Pose
from engine.messages.shapes import AT_ORIGIN
from robots.model.urdf.visual_mesh import VisualMesh, link_visuals
from robots.scene.sim_scene import SimScene
from robots.sim.physics.cell_model import build_cell, cell_spec
from robots.sim.physics.physics import mujoco

_LOOKS, _TOUCHES = 2, 3
_MESH = mujoco.mjtGeom.mjGEOM_MESH


def mjcf_of(scene: SimScene, name: str) -> Mapping[str, bytes]:
    """Return the file `NAME.xml`.

    Raises:
        CellError: a mesh cannot be read, or MuJoCo rejects the scene.
    """
    spec = cell_spec(scene)
    spec.modelname = name
    for mesh in spec.meshes:
        if mesh.file:
            _embed(mesh)
    for geom in spec.geoms:
        geom.group = _TOUCHES
    spec.worldbody.add_light(
        name="sun", type=mujoco.mjtLightType.mjLIGHT_DIRECTIONAL, pos=[0.0, 0.0, 4.0], dir=[0.3, 0.4, -1.0]
    )
    _paint(spec, scene)
    for arm in scene.arms:
        for index, visual in enumerate(link_visuals(arm.robot())):
            name_of_mesh, body = f"{arm.name}/visual_{index}", f"{arm.name}/{visual.link}"
            _add_visual(spec, body, visual.mesh, name_of_mesh, at=Pose(xyz=visual.xyz, xyzw=visual.xyzw))
    for fixture in scene.fixtures:
        for index, look in enumerate(fixture.mesh.looks if fixture.mesh is not None else ()):
            _add_visual(spec, fixture.name, look, f"{fixture.name}/look_{index}", at=AT_ORIGIN)
    try:
        spec.compile()
        spec.add_key(name="home", qpos=_home(scene).tolist())
        spec.compile()
        text: str = spec.to_xml()
    except ValueError as error:
        raise CellError(f"the scene cannot be written as MJCF: {error}", where=name) from error
    return {f"{name}.xml": text.encode()}


def _paint(spec: Any, scene: SimScene) -> None:
    """Give fixtures without a mesh and parts, which look like what they are, their colours."""
    solids = (fixture for fixture in scene.fixtures if fixture.mesh is None)
    for body in (*solids, *scene.parts):
        for geom in spec.body(body.name).geoms:
            geom.rgba, geom.group = list(body.rgba), 0


def _add_visual(spec: Any, body: str, mesh: VisualMesh, name: str, *, at: Pose) -> None:
    x, y, z, w = at.xyzw
    spec.add_mesh(
        name=name,
        uservert=np.frombuffer(mesh.vertices, np.float32).tolist(),
        userface=np.frombuffer(mesh.faces, np.uint32).astype(np.int32).tolist(),
        # A surface has no volume that its mass could follow from, and has no mass.
        inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL,
    )
    spec.body(body).add_geom(
        name=name,
        type=_MESH,
        meshname=name,
        pos=list(at.xyz),
        quat=[w, x, y, z],
        rgba=list(mesh.rgba),
        contype=0,
        conaffinity=0,
        group=_LOOKS,
        mass=0.0,
    )


def _embed(mesh: Any) -> None:
    """Put the triangles of a mesh file into the document."""
    # Slow to import; its types are incomplete.
    trimesh: Any = import_module("trimesh")
    read = trimesh.load_mesh(Path(mesh.file))
    mesh.uservert = np.asarray(read.vertices, np.float32).reshape(-1).tolist()
    mesh.userface = np.asarray(read.faces, np.int32).reshape(-1).tolist()
    mesh.file = ""


def _home(scene: SimScene) -> Any:
    """Return the positions of all joints with the arms at home, in the order of the compiled model."""
    built = build_cell(scene)
    qpos = np.array(built.model.qpos0)
    for arm in built.arms:
        qpos[arm.qpos] = arm.model.home_rad
        if arm.tool is not None:
            qpos[arm.tool.qpos] = arm.tool.home
    return qpos
