"""The scene as glTF 2.0 in one binary file: all links, fixtures and parts as they look, with the arms at home.

Nodes have the names of the cell. Each link is a node below the link that carries it, so that a viewer turns a joint by
turning its node; frames are nodes without a mesh. glTF has its y axis up: the node `world` turns the world of the cell,
whose z axis is up.
"""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from typing import Any

import numpy as np

from engine.messages import Pose
from robots.model.transform import RigidTransform
from robots.model.urdf.visual_mesh import Rgba, VisualMesh, link_visuals
from robots.port import Array
from robots.scene.sim_scene import ArmPlacement, FixtureBody, PartBody, SimScene
from robots.scene_export.body_shapes import BodySolid, solids_of
from robots.sim.physics.cell_model import CellModel, build_cell
from robots.sim.physics.physics import mujoco

_ROOT, _WORLD = "scene", "world"
_Z_TO_Y_UP = Pose(xyz=(0.0, 0.0, 0.0), xyzw=(-(0.5**0.5), 0.0, 0.0, 0.5**0.5))
_ROUND = 48


def gltf_of(scene: SimScene, name: str) -> Mapping[str, bytes]:
    """Return the file `NAME.glb`.

    Raises:
        CellError: a mesh cannot be read, or the scene is invalid.
    """
    # Slow to import; its types are incomplete.
    trimesh: Any = import_module("trimesh")
    drawn = trimesh.Scene(base_frame=_ROOT)
    drawn.graph.update(frame_to=_WORLD, frame_from=_ROOT, matrix=_matrix(_Z_TO_Y_UP))
    built = build_cell(scene)
    for arm in scene.arms:
        _add_arm(trimesh, drawn, arm, built)
    for body in (*scene.fixtures, *scene.parts):
        _add_body(trimesh, drawn, body)
    for frame, pose in scene.frames.items():
        drawn.graph.update(frame_to=frame, frame_from=_WORLD, matrix=_matrix(pose))
    content: bytes = drawn.export(file_type="glb")
    return {f"{name}.glb": content}


def _add_arm(trimesh: Any, drawn: Any, arm: ArmPlacement, built: CellModel) -> None:
    model, data = built.model, mujoco.MjData(built.model)
    for each in built.arms:
        data.qpos[each.qpos] = each.model.home_rad
        if each.tool is not None:
            data.qpos[each.tool.qpos] = each.tool.home
    mujoco.mj_kinematics(model, data)
    prefix = f"{arm.name}/"
    # Bodies are numbered after those that carry them.
    for index in range(1, model.nbody):
        body, carrier = model.body(index).name, model.body(model.body_parentid[index]).name
        if body.startswith(prefix):
            on = _body_pose(data, model.body_parentid[index]).inverse().then(_body_pose(data, index))
            below = carrier if carrier.startswith(prefix) else _WORLD
            drawn.graph.update(frame_to=body, frame_from=below, matrix=_matrix(on.to_pose(below)))
    for number, visual in enumerate(link_visuals(arm.robot())):
        mesh = _mesh(trimesh, visual.mesh)
        drawn.add_geometry(
            mesh,
            node_name=f"{prefix}visual_{number}",
            geom_name=f"{prefix}visual_{number}",
            parent_node_name=f"{prefix}{visual.link}",
            transform=_matrix(Pose(xyz=visual.xyz, xyzw=visual.xyzw)),
        )


def _add_body(trimesh: Any, drawn: Any, body: FixtureBody | PartBody) -> None:
    drawn.graph.update(frame_to=body.name, frame_from=_WORLD, matrix=_matrix(body.pose))
    if isinstance(body, FixtureBody) and body.mesh is not None:
        for number, look in enumerate(body.mesh.looks):
            name = f"{body.name}/look_{number}"
            drawn.add_geometry(_mesh(trimesh, look), node_name=name, geom_name=name, parent_node_name=body.name)
        return
    for number, solid in enumerate(solids_of(body)):
        shape = _solid(trimesh, solid)
        shape.visual = _colour(trimesh, body.rgba)
        drawn.add_geometry(
            shape,
            node_name=f"{body.name}/solid_{number}",
            geom_name=f"{body.name}/solid_{number}",
            parent_node_name=body.name,
            transform=_matrix(solid.pose),
        )


def _solid(trimesh: Any, solid: BodySolid) -> Any:
    size = solid.size_m
    match solid.shape:
        case "box":
            return trimesh.creation.box(extents=size)
        case "cylinder":
            return trimesh.creation.cylinder(size[0] / 2.0, size[1], sections=_ROUND)
        case _:
            return trimesh.creation.icosphere(subdivisions=3, radius=size[0] / 2.0)


def _mesh(trimesh: Any, mesh: VisualMesh) -> Any:
    made = trimesh.Trimesh(
        vertices=np.frombuffer(mesh.vertices, np.float32).reshape(-1, 3),
        faces=np.frombuffer(mesh.faces, np.uint32).reshape(-1, 3),
        process=False,
    )
    made.visual = _colour(trimesh, mesh.rgba)
    return made


def _colour(trimesh: Any, rgba: Rgba) -> Any:
    material = trimesh.visual.material.PBRMaterial(
        baseColorFactor=[round(255 * value) for value in rgba], metallicFactor=0.1, roughnessFactor=0.7
    )
    return trimesh.visual.TextureVisuals(material=material)


def _body_pose(data: Any, index: int) -> RigidTransform:
    w, x, y, z = data.xquat[index].tolist()
    return RigidTransform.of(data.xpos[index].tolist(), (x, y, z, w))


def _matrix(pose: Pose) -> Array:
    placed, matrix = RigidTransform.from_pose(pose), np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = placed.rotation, placed.xyz
    return matrix
