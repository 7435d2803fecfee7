"""Skill server of a tool changer: locks and releases tools, and gives the arm what it has with them."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping

import msgspec

from engine.bus import ActiveGoal, SkillBus, Topic
from engine.clock import Clock
from engine.document import ToolChangerSpec, seconds
from engine.errors import GoalRejected, RobotError, SkillFailed
from engine.messages import Pose, Quaternion, Vector3
from engine.messages.pose_algebra import compose_poses, invert_pose
from engine.skills.device_moves import DeviceFault, SimulateDeviceFault
from engine.skills.switch_result import SwitchResult
from engine.skills.tool_changer import (
    ChangeableTool,
    DescribeTool,
    LockFeedback,
    LockTool,
    LockToolResult,
    ReadToolChanger,
    ReleaseTool,
    ReleaseToolResult,
    ToolChangerState,
    ToolDescription,
)
from engine.wording import did_you_mean
from robots.model.transform import RigidTransform
from robots.port import ArmPort
from robots.tool_changer.tool_lock_port import LockReading, ToolLockPort

FOLLOW_S = 0.05
"""Period at which the sensors are read while nothing is asked."""
_POLL_S = 0.02
# Longer than the piston travels; then a sensor that has not changed is believed.
_PATIENCE_S = 0.3
_AT_PLACE_M, _AT_PLACE_RAD = 0.005, 0.052
_BARE: tuple[Vector3, Quaternion] = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))


class ToolChangerServer:
    """Serves the tool changer of an arm under the arm's name; owned by its `ArmServer`.

    Args:
        name: The arm.
        changer: The tool changer as written.
        lock: Its output and sensors.
        arm: Takes tool centre point and load.
        tools: The tools of the cell.
        place_of: Returns where a part that is a tool hangs, in the world; None while its hanger is not in the cell.
        face: Returns where the arm measures the face of the master plate, in the world.
        clock: The time.
        simulate: Breaks a simulated tool changer; None for a real one.
    """

    def __init__(
        self,
        name: str,
        *,
        changer: ToolChangerSpec,
        lock: ToolLockPort,
        arm: ArmPort,
        tools: Mapping[str, ChangeableTool],
        place_of: Callable[[str], Pose | None],
        face: Callable[[], RigidTransform],
        clock: Clock,
        simulate: Callable[[DeviceFault], SwitchResult] | None = None,
    ) -> None:
        self._name = name
        self._changer = changer
        self._lock = lock
        self._arm = arm
        self._tools = tools
        self._place_of = place_of
        self._face = face
        self._clock = clock
        self._simulate = simulate
        self._following: asyncio.Task[None] | None = None
        self._tool = ""
        self._lost = ""
        self._topic: Topic[ToolChangerState] | None = None
        self._published = ToolChangerState()
        self.changed: Callable[[], None] = _no_operation
        """Called when the arm has another tool, tool centre point or load."""

    @property
    def tool(self) -> str:
        """The tool that is locked to the arm; empty for none."""
        return self._tool

    def register(self, bus: SkillBus) -> None:
        """Advertise the skills under the arm's name and publish `<arm>/tool_changer`."""
        name = self._name
        bus.advertise_action(LockTool, self._lock_tool, namespace=name, exclusive=name)
        bus.advertise_action(ReleaseTool, self._release_tool, namespace=name, exclusive=name)
        bus.advertise_service(ReadToolChanger, self._read, namespace=name)
        bus.advertise_service(DescribeTool, self._describe, namespace=name)
        if self._simulate is not None:
            bus.advertise_service(SimulateDeviceFault, self._break, namespace=name)
        self._topic = bus.topic(f"{name}/tool_changer", ToolChangerState)
        self._topic.provide(self.state)
        self._published = self.state()
        self._topic.publish(self._published)

    def begin(self) -> None:
        """Follow the sensors in real time, until `end`; in virtual time the world calls `follow`."""
        if not self._clock.virtual:
            self._following = asyncio.create_task(self._follow_on(), name=f"tool changer of {self._name}")

    async def end(self) -> None:
        """End what `begin` began."""
        if self._following is not None:
            self._following.cancel()
            await asyncio.wait((self._following,))
            self._following = None

    def follow(self) -> bool:
        """Take what the sensors tell: a tool that came off, or that is on after a restore; true if that is new."""
        try:
            reading = self._lock.reading()
        except RobotError:
            return self._publish()
        if self._tool and not reading.locked:
            self._lost, self._tool = self._tool, ""
            self._configure(_BARE, None)
        elif reading.locked and not self._tool:
            self._tool, self._lost = reading.tool, ""
        elif self._lost and not reading.on:
            self._lost = ""
        return self._publish()

    def state(self) -> ToolChangerState:
        """Return what is known of the tool changer."""
        try:
            reading = self._lock.reading()
        except RobotError as error:
            return ToolChangerState(problem=error.message)
        return ToolChangerState(
            tool=self._tool,
            tcp=self._tcp_name(),
            lock="locked" if reading.locked else "empty" if reading.on else "open",
            outputs={self._changer.output: reading.on},
            sensors=self._sensors(reading),
            problem=f"{self._lost} came off" if self._lost else "",
        )

    async def _lock_tool(self, goal: LockTool, handle: ActiveGoal[LockFeedback]) -> LockToolResult:
        tool = self._tools.get(goal.tool)
        if tool is None:
            hint = did_you_mean(goal.tool, self._tools)
            raise GoalRejected(f"the cell has no tool {goal.tool}", where=handle.address, hint=hint)
        if goal.tcp and goal.tcp not in tool.tcps:
            hint = did_you_mean(goal.tcp, tool.tcps)
            raise GoalRejected(f"{goal.tool} has no tool centre point {goal.tcp}", where=handle.address, hint=hint)
        self.follow()
        if self._tool not in ("", goal.tool):
            raise GoalRejected(f"{self._name} has {self._tool}", where=handle.address, hint="put it back first")
        handle.accept()
        if not self._tool:
            try:
                ended = await self._shut(tool, handle)
            except RobotError as error:
                raise SkillFailed(f"{goal.tool} is not locked", where=handle.address) from error
            if ended.ended != "locked":
                return ended
            self._tool, self._lost = tool.name, ""
        at = tool.tcps[goal.tcp or next(iter(tool.tcps))]
        self._configure((at.xyz, at.xyzw), tool)
        return LockToolResult(ended="locked")

    async def _shut(self, tool: ChangeableTool, handle: ActiveGoal[LockFeedback]) -> LockToolResult:
        lock, changer = self._lock, self._changer
        if lock.reading().on:
            lock.switch(on=False)
            await self._until(lambda one: not one.on and not one.locked, handle)
        if not lock.reading().present:
            return LockToolResult(ended="missing", reason=f"{changer.present} is off: no plate is at the face")
        lock.switch(on=True)
        reading = await self._until(lambda one: one.locked, handle)
        if not reading.locked:
            lock.switch(on=False)
            await self._until(lambda one: not one.on, handle)
            after_s = seconds(changer.time) + _PATIENCE_S
            return LockToolResult(ended="not_locked", reason=f"{changer.locked} is off after {after_s:g} s")
        if reading.tool not in ("", tool.name):
            lock.switch(on=False)
            await self._until(lambda one: not one.locked, handle)
            return LockToolResult(ended="wrong_tool", reason=f"the pins of its plate tell {reading.tool}")
        return LockToolResult(ended="locked")

    async def _release_tool(self, goal: ReleaseTool, handle: ActiveGoal[LockFeedback]) -> ReleaseToolResult:
        self.follow()
        if self._tool and not goal.anywhere:
            self._require_place(handle)
        handle.accept()
        try:
            self._lock.switch(on=False)
            reading = await self._until(lambda one: not one.locked and not one.on, handle)
        except RobotError as error:
            raise SkillFailed("the lock is not opened", where=handle.address) from error
        if reading.locked:
            after_s = seconds(self._changer.time) + _PATIENCE_S
            return ReleaseToolResult(
                ended="not_released", reason=f"{self._changer.locked} is still on after {after_s:g} s"
            )
        self._tool = self._lost = ""
        self._configure(_BARE, None)
        return ReleaseToolResult(ended="released")

    def _require_place(self, handle: ActiveGoal[LockFeedback]) -> None:
        docked = self._docked(self._tools[self._tool])
        hint = "put it back (equipment.PutTool), or release it `anywhere` while somebody holds it"
        if docked is None:
            raise GoalRejected(f"the place of {self._tool} is not in the cell", where=handle.address, hint=hint)
        face, place = self._face(), RigidTransform.from_pose(docked)
        away_m, away_rad = place.distance_m(face), place.angle_rad(face)
        if away_m > _AT_PLACE_M or away_rad > _AT_PLACE_RAD:
            raise GoalRejected(
                f"{self._tool} would fall: it is {away_m * 1e3:.0f} mm from its place", where=handle.address, hint=hint
            )

    async def _until(self, done: Callable[[LockReading], bool], handle: ActiveGoal[LockFeedback]) -> LockReading:
        """Wait until the sensors tell something, at most the time of the piston and some patience."""
        end_s = self._clock.now_s() + seconds(self._changer.time) + _PATIENCE_S
        while True:
            await self._clock.sleep(_POLL_S)
            reading = self._lock.reading()
            handle.feedback(LockFeedback(sensors=self._sensors(reading)))
            if done(reading) or self._clock.now_s() >= end_s:
                return reading

    async def _follow_on(self) -> None:
        while True:
            await self._clock.sleep(FOLLOW_S)
            self.follow()

    async def _break(self, request: SimulateDeviceFault) -> SwitchResult:
        assert self._simulate is not None
        return self._simulate(request.fault)

    async def _read(self, _request: ReadToolChanger) -> ToolChangerState:
        self.follow()
        return self.state()

    async def _describe(self, request: DescribeTool) -> ToolDescription:
        tool = self._tools.get(request.tool)
        if tool is None:
            hint = did_you_mean(request.tool, self._tools)
            raise SkillFailed(f"the cell has no tool {request.tool}", where=self._name, hint=hint)
        docked = self._docked(tool)
        if docked is None:
            raise SkillFailed(f"the hanger of {tool.name} is not plugged", where=self._name, hint="plug its module")
        return ToolDescription(tool=tool, docked=docked)

    def _docked(self, tool: ChangeableTool) -> Pose | None:
        place = self._place_of(tool.name)
        return compose_poses(place, invert_pose(tool.plate)) if place is not None else None

    def _configure(self, tcp: tuple[Vector3, Quaternion], tool: ChangeableTool | None) -> None:
        self._arm.configure(
            msgspec.structs.replace(
                self._arm.settings,
                tool_xyz_m=tcp[0],
                tool_xyzw=tcp[1],
                load_kg=tool.mass_kg if tool is not None else 0.0,
                load_com_m=tool.com_m if tool is not None else (0.0, 0.0, 0.0),
            )
        )
        self.changed()
        self._publish()

    def _tcp_name(self) -> str:
        settings, tool = self._arm.settings, self._tools.get(self._tool)
        found = tool.tcps.items() if tool is not None else ()
        at = (settings.tool_xyz_m, settings.tool_xyzw)
        return next((name for name, pose in found if (pose.xyz, pose.xyzw) == at), "")

    def _sensors(self, reading: LockReading) -> dict[str, bool]:
        return {self._changer.locked: reading.locked, self._changer.present: reading.present}

    def _publish(self) -> bool:
        state = self.state()
        if self._topic is None or state == self._published:
            return False
        self._published = state
        self._topic.publish(state)
        return True


def _no_operation() -> None:
    """Do nothing."""
