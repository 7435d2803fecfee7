"""The drawing of a cell: the drawable bodies of its arms, fixtures, parts, people and unknown bodies."""

from __future__ import annotations

from pathlib import Path

from engine.messages import Pose, SceneDescription, VisualGeometry
from engine.messages.pose_algebra import compose_poses
from robots.model.urdf.visual_mesh import LinkVisual, link_visuals
from robots.scene.sim_scene import FixtureBody, PartBody, SimScene
from robots.sim.physics.cell_model import tray_boxes
from robots.sim.physics.hexapod_drawing import leg_geometries
from robots.sim.physics.person_drawing import person_geometries


def describe_scene(scene: SimScene, *, cache: Path | None = None) -> SceneDescription:
    """Return everything drawable; meshes come from `cache` (the user's folder by default) if present.

    Frames are those of `FramePoses`: `<arm>/<link>`, `<person>/<body>` and part names; fixtures are fixed to `world`,
    those that a device moves have a frame of their own.
    """
    geometries = [
        _mesh(arm.name, index, visual)
        for arm in scene.arms
        for index, visual in enumerate(link_visuals(arm.robot(), cache=cache))
    ]
    for fixture in (*scene.fixtures, *scene.unknown_fixtures):
        geometries += _fixture(fixture)
    geometries += leg_geometries(scene)
    geometries += [one for part in (*scene.parts, *scene.unknown_parts) for one in _part(part)]
    geometries += [geometry for person in scene.people for geometry in person_geometries(person)]
    return SceneDescription(geometries=tuple(geometries))


def _mesh(arm: str, index: int, visual: LinkVisual) -> VisualGeometry:
    return VisualGeometry(
        name=f"{arm}/{visual.link}/{index}",
        frame=f"{arm}/{visual.link}",
        kind="mesh",
        vertices=visual.mesh.vertices,
        faces=visual.mesh.faces,
        rgba=visual.mesh.rgba,
        xyz=visual.xyz,
        xyzw=visual.xyzw,
    )


def _fixture(fixture: FixtureBody) -> list[VisualGeometry]:
    pose = fixture.pose if not fixture.moves else Pose(xyz=(0.0, 0.0, 0.0))
    frame = fixture.name if fixture.moves else "world"
    if fixture.mesh is not None:
        return [
            VisualGeometry(
                name=f"{fixture.name}/{index}",
                frame=frame,
                kind="mesh",
                vertices=look.vertices,
                faces=look.faces,
                rgba=look.rgba,
                xyz=pose.xyz,
                xyzw=pose.xyzw,
            )
            for index, look in enumerate(fixture.mesh.looks)
        ]
    if fixture.shape != "tray":
        kind, size = _shape(fixture.shape, fixture.size_m)
        return [
            VisualGeometry(
                name=fixture.name,
                frame=frame,
                kind=kind,
                size_m=size,
                rgba=fixture.rgba,
                xyz=pose.xyz,
                xyzw=pose.xyzw,
            )
        ]
    return [
        VisualGeometry(
            name=f"{fixture.name}/{index}",
            frame=frame,
            kind="box",
            size_m=size,
            rgba=fixture.rgba,
            xyz=compose_poses(pose, Pose(xyz=centre)).xyz,
            xyzw=pose.xyzw,
        )
        for index, (centre, size) in enumerate(tray_boxes(fixture))
    ]


def _part(part: PartBody) -> list[VisualGeometry]:
    kind, size = _shape(part.shape, part.size_m)
    drawn = [VisualGeometry(name=part.name, frame=part.name, kind=kind, size_m=size, rgba=part.rgba)]
    for index, one in enumerate(part.tool.shapes if part.tool is not None else ()):
        kind, size = _shape(one.shape, one.size_m)
        at = one.at.pose()
        drawn.append(
            VisualGeometry(
                name=f"{part.name}/{index}",
                frame=part.name,
                kind=kind,
                size_m=size,
                rgba=part.rgba,
                xyz=at.xyz,
                xyzw=at.xyzw,
            )
        )
    return drawn


def _shape(shape: str, size_m: tuple[float, ...]) -> tuple[str, tuple[float, ...]]:
    if shape == "cylinder":
        diameter, length = size_m
        return "cylinder", (diameter / 2, length)
    if shape == "sphere":
        return "sphere", (size_m[0] / 2,)
    return shape, size_m
