"""The state of a scene in a snapshot: its bytes are the same whatever the order of a set, and stay readable."""

from __future__ import annotations

import msgspec

from engine.clock import LoopClock
from engine.messages import Pose
from engine.messages.shapes import Solid, Sphere
from robots.planning.scene.planning_scene import AttachedPart
from robots.workspace.live_scene import LiveScene, SceneMemo
from robots.workspace.planning_services import PlanningServices
from robots.workspace.workspace import Workspace

CUP = AttachedPart(
    name="cup", arm="left", solids=(Solid(shape=Sphere(radius_m=0.03)),), pose=Pose(xyz=(0.0, 0.0, 0.1), frame="hand")
)
WRITTEN = {
    "put": [],
    "removed": [],
    "rules": [],
    "held": [
        {
            "part": msgspec.to_builtins(CUP),
            "link": "hand",
            "taken": {"xyz": [0.0, 0.0, 0.1], "xyzw": [0.0, 0.0, 0.0, 1.0], "frame": "hand"},
            "touches": ["box", "crate", "table"],
        }
    ],
    "let_go": [{"part": "lid", "arm": "left", "links": ["finger", "hand", "thumb"]}],
}


async def test_a_scene_is_written_as_it_was_read() -> None:
    def make_scene() -> LiveScene:
        raise AssertionError("nothing needs the scene")

    clock = LoopClock()
    workspace = Workspace(make_scene, planners=PlanningServices(clock), clock=clock)
    data = msgspec.msgpack.encode(WRITTEN)
    workspace.remember(data)
    assert workspace.memo() == data
    assert msgspec.msgpack.decode(data, type=SceneMemo).held[0].touches == {"box", "crate", "table"}
