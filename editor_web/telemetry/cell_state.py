"""Where the parts, frames, cameras and modules of a cell are now, and what its tools hold, from the latest messages."""

from __future__ import annotations

from editor_web.telemetry.data_frames import CellStateFrame, DeviceNow, ToolHolds
from engine.cell import tool_kinds
from engine.messages import FramePoses, PartPoses, Pose
from engine.messages.device_state import DeviceLink, DeviceState
from engine.messages.sensing import CameraInfo
from engine.messages.tool_hold import ToolHold
from engine.project import BusInspector
from engine.skills.modules import CellModules
from engine.skills.tool_changer import ToolChangerState

_DIGITS = 4


def cell_state(inspector: BusInspector) -> CellStateFrame:
    """Return the state of the cell on a bus; what has no message is left out."""
    poses: dict[str, Pose] = {}
    cameras: dict[str, Pose] = {}
    tools: dict[str, ToolHolds] = {}
    modules: dict[str, str] = {}
    states: dict[str, DeviceState] = {}
    links: dict[str, DeviceLink] = {}
    measured = {kind.measured.__name__ for kind in tool_kinds().values()}
    for topic in inspector.topics():
        owner, device = topic.name.partition("/")[0], topic.name.rpartition("/")[0]
        if topic.type in measured:
            state = inspector.latest(topic.name)
            if isinstance(state, ToolHold):
                tools[owner] = ToolHolds(held=state.held, part=state.part)
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
                case DeviceState():
                    states[device] = message
                case DeviceLink():
                    links[device] = message
                case ToolChangerState():
                    tools[owner] = ToolHolds(held=bool(message.tool), part=message.tool)
                case CellModules():
                    modules = {each.module: each.connector for each in message.modules}
                case _:
                    pass
    devices = {name: DeviceNow(state=state, link=links.get(name)) for name, state in states.items()}
    return CellStateFrame(poses=poses, cameras=cameras, tools=tools, devices=devices, modules=modules)


_KINDS = (FramePoses, PartPoses, CameraInfo, DeviceState, DeviceLink, CellModules, ToolChangerState)
_READ = frozenset(kind.__name__ for kind in _KINDS)


def _rounded(pose: Pose) -> Pose:
    x, y, z = (round(each, _DIGITS) for each in pose.xyz)
    qx, qy, qz, qw = (round(each, _DIGITS) for each in pose.xyzw)
    return Pose(xyz=(x, y, z), xyzw=(qx, qy, qz, qw), frame=pose.frame)
