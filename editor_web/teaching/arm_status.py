"""Description and live status of the arms for the teaching page."""

from __future__ import annotations

import json

from msgspec.structs import asdict

from editor_web.teaching.teaching_messages import ArmInfo, ArmInfoFrame, ArmLive, ToolLive
from engine.cell import tool_kinds
from engine.errors import FlexcellError
from engine.messages import DRAWN_ONLY, FramePoses, JointState, Message, RobotDescription
from engine.project import Session
from engine.skill import activity_words
from engine.skills.arm_control import ArmStatus

_STILL_RAD = 1e-4
_DIGITS = 6


class ArmStatusReader:
    """Reads the status of the arms of one cell for one page."""

    def __init__(self, backend: Session) -> None:
        self._backend = backend
        self._tools: dict[str, str] = {}
        self._sent: dict[str, ArmLive] = {}
        self._names: tuple[str, ...] = ()

    async def arms(self) -> ArmInfoFrame:
        """Return the arms on the bus, by name."""
        rows = await self._backend.bus.listing()
        arms = {row.name.rpartition("/")[0]: row.name for row in rows if row.type == RobotDescription.__name__}
        skills = [row.name for row in rows if row.kind in ("action", "service")]
        kinds = {kind.measured.__name__ for kind in tool_kinds().values()}
        cards: list[ArmInfo] = []
        for name, topic in sorted(arms.items()):
            description = self._backend.latest(topic)
            if not isinstance(description, RobotDescription):
                continue
            start = f"{name}/"
            tool = next((row.name for row in rows if row.name.startswith(start) and row.type in kinds), "")
            if tool:
                self._tools[name] = tool
            cards.append(
                ArmInfo(
                    **asdict(description),
                    skills=tuple(sorted(each.removeprefix(start) for each in skills if each.startswith(start))),
                )
            )
        self._names = tuple(card.name for card in cards)
        frames = self._backend.latest("cell/frames")
        return ArmInfoFrame(
            arms=tuple(cards),
            can_push="cell/push_body" in skills,
            frames=_aimed_at(frames) if isinstance(frames, FramePoses) else (),
        )

    async def changed(self) -> dict[str, ArmLive]:
        """Return the arms whose status has changed since the last call."""
        changed: dict[str, ArmLive] = {}
        for name in self._names:
            now = await self._read(name)
            if now is not None and now != self._sent.get(name):
                changed[name] = self._sent[name] = now
        return changed

    async def _read(self, name: str) -> ArmLive | None:
        status = self._backend.latest(f"{name}/status")
        if not isinstance(status, ArmStatus):
            return None
        before = self._sent.get(name)
        state = self._backend.latest(f"{name}/joint_state")
        joints = tuple(round(q, _DIGITS) for q in state.position_rad) if isinstance(state, JointState) else ()
        if before is not None and _still(before.joints, joints):
            # Sensor noise is not a change.
            joints, pose = before.joints, before.tool_pose
        else:
            pose = await self._pose(name)
        return ArmLive(
            mode=status.mode,
            activity=activity_words(status.activity),
            error=status.error,
            joints=joints,
            tool_pose=pose,
            tool=self._tool(name),
        )

    async def _pose(self, name: str) -> tuple[float, ...]:
        try:
            pose = json.loads(await self._backend.bus.call(f"{name}/forward_kinematics", {}))
        except FlexcellError:
            # A disconnected arm has no pose; its mode reports that.
            return ()
        return tuple(round(value, _DIGITS) for value in (*pose["xyz"], *pose["xyzw"]))

    def _tool(self, name: str) -> ToolLive | None:
        state = self._backend.latest(self._tools[name]) if name in self._tools else None
        if not isinstance(state, Message):
            return None
        # What a kind of tool does not measure is missing.
        measured = asdict(state)
        width_m, closed_percent = measured.get("width_m"), measured.get("closed_percent")
        return ToolLive(
            width_m=round(width_m, 4) if width_m is not None else None,
            closed_percent=round(closed_percent, 1) if closed_percent is not None else None,
            held=measured["held"],
        )


def _still(before: tuple[float, ...], now: tuple[float, ...]) -> bool:
    return len(before) == len(now) and all(abs(a - b) < _STILL_RAD for a, b in zip(before, now, strict=True))


def _aimed_at(frames: FramePoses) -> tuple[str, ...]:
    return tuple(sorted(name for name in frames.names if DRAWN_ONLY not in name))
