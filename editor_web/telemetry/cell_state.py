"""Where the parts, frames and cameras of a cell are now, and what its tools hold, from the latest messages."""

from __future__ import annotations

from editor_web.telemetry.data_frames import CellStateFrame, ToolHolds
from engine.cell import tool_kinds
from engine.messages import FramePoses, PartPoses, Pose
from engine.messages.sensing import CameraInfo
from engine.project import BusInspector

_DIGITS = 4


def cell_state(inspector: BusInspector) -> CellStateFrame:
    """Return the state of the cell on a bus; what has no message is left out."""
    poses: dict[str, Pose] = {}
    cameras: dict[str, Pose] = {}
    tools: dict[str, ToolHolds] = {}
    measured = {kind.measured.__name__ for kind in tool_kinds().values()}
    for topic in inspector.topics():
        owner = topic.name.partition("/")[0]
        if topic.type in measured:
            state = inspector.latest(topic.name)
            if state is not None:
                # Each kind of tool has a message of its own; `held` is what they share.
                held = bool(getattr(state, "held", False))
                tools[owner] = ToolHolds(held=held, part=str(getattr(state, "part", "")))
        elif topic.type in _READ:
            message = inspector.latest(topic.name)
            match message:
                case FramePoses():
                    rows = zip(message.names, message.xyz, message.xyzw, strict=True)
                    poses |= {name: _rounded(Pose(xyz=xyz, xyzw=xyzw)) for name, xyz, xyzw in rows}
                case PartPoses():
                    poses |= {name: _rounded(pose) for name, pose in message.poses.items()}
                case CameraInfo():
                    cameras[owner] = _rounded(message.pose)
                case _:
                    pass
    return CellStateFrame(poses=poses, cameras=cameras, tools=tools)


_READ = frozenset((FramePoses.__name__, PartPoses.__name__, CameraInfo.__name__))


def _rounded(pose: Pose) -> Pose:
    x, y, z = (round(each, _DIGITS) for each in pose.xyz)
    qx, qy, qz, qw = (round(each, _DIGITS) for each in pose.xyzw)
    return Pose(xyz=(x, y, z), xyzw=(qx, qy, qz, qw), frame=pose.frame)
