"""The drawing of a person's arm: rods and balls, fixed to the frames of its bodies."""

from __future__ import annotations

from engine.messages import Vector3, VisualGeometry
from robots.scene.sim_scene import PersonBody
from robots.sim.physics.person_spec import FOREARM_SHARE, body_names


def person_geometries(person: PersonBody) -> list[VisualGeometry]:
    """Return the drawable bodies; a capsule is a rod with a ball at each end."""
    upper, fore, hand = body_names(person.name)
    thin_m = FOREARM_SHARE * person.radius_m

    def ball(name: str, frame: str, radius_m: float, xyz: Vector3 = (0.0, 0.0, 0.0)) -> VisualGeometry:
        return VisualGeometry(name=name, frame=frame, kind="sphere", size_m=(radius_m,), rgba=person.rgba, xyz=xyz)

    def rod(frame: str, radius_m: float, length_m: float) -> VisualGeometry:
        return VisualGeometry(
            name=f"{frame}/rod", frame=frame, kind="cylinder", size_m=(radius_m, length_m), rgba=person.rgba
        )

    half_m = person.upper_arm_m / 2.0
    return [
        ball(f"{person.name}/shoulder", upper, person.radius_m, (0.0, 0.0, -half_m)),
        rod(upper, person.radius_m, person.upper_arm_m),
        ball(f"{person.name}/elbow", upper, person.radius_m, (0.0, 0.0, half_m)),
        rod(fore, thin_m, person.forearm_m),
        ball(f"{person.name}/hand/ball", hand, person.radius_m),
    ]
