"""From a stopped cell back to runs: what each arm holds, the steps that move, and the release of the stop."""

from __future__ import annotations

import math
from collections.abc import AsyncGenerator, Callable, Iterator
from contextlib import asynccontextmanager
from typing import Literal

import msgspec

from engine.bus.json_bus import LocalJsonBus
from engine.cause_chain import describe_cause
from engine.cell.open_cell import OpenCell
from engine.cell.robot_models import tool_kinds
from engine.cell.tool_kind import ToolKind
from engine.errors import ControlError, FlexcellError, NoSuchSkill, StoreError
from engine.messages import JointState, RobotDescription
from engine.messages.device_state import DeviceState
from engine.messages.tool_hold import ToolHold
from engine.project.cell_stop import UNKNOWN_PART, ArmRecovery, CellStop, DeviceRecovery
from engine.project.session_stops import SessionStops, StopRecord
from engine.robot import Reconnectable
from engine.skills.goal_end import GoalStatus
from engine.store import Joints, decode_entry

_MOVED_RAD = 0.01
_AT_HOME_RAD = 0.01
_HOME_SPEED = 0.2
_HELD_SPEED = 0.1
_RESET_PARTS = "cell/reset_parts"


class StopRecovery:
    """The steps of recovery after a stop; state is kept here, so that every page shows the same.

    Belongs to the event loop of its session. Steps that move an arm are refused unless the cell is stopped.

    Args:
        cell: The cell.
        stops: The stops of the session.
    """

    def __init__(self, cell: OpenCell, stops: SessionStops) -> None:
        self._cell = cell
        self._stops = stops
        self._bus = LocalJsonBus(cell.bus)
        self._kept: dict[str, str] = {}
        self._stopped_at: dict[str, tuple[float, ...]] = {}
        self._problems: dict[str, str] = {}
        self._are_parts_reset = False
        self._of_stop = 0
        stops.when_changed(self._take_up)

    def when_changed(self, callback: Callable[[], None]) -> Callable[[], None]:
        """Call `callback` when a stop begins, changes or is released; not when an arm moves or grips."""
        return self._stops.when_changed(callback)

    @property
    def is_stopped(self) -> bool:
        """Whether there is a stop that is not forgotten."""
        return self._stops.latest is not None

    @property
    def is_latched(self) -> bool:
        """Whether the latest stop still has to be released."""
        return self._stops.latched

    async def state(self) -> CellStop | None:
        """Return the latest stop and what is open; None if there is none, or it is forgotten."""
        record = self._stops.latest
        if record is None:
            return None
        arms = [await self._arm(name) for name in self._cell.robots if self._described(name) is not None]
        return CellStop(
            number=record.number,
            phase=self._phase(record),
            reason=record.reason,
            since_unix_s=record.since_unix_s,
            devices=tuple(record.devices.values()),
            runs=tuple(record.runs.values()),
            arms=tuple(arms),
            parts=self._parts(),
            real=tuple(self._real()),
        )

    async def keep(self, arm: str) -> None:
        """Let an arm keep the part that it holds: in the planning scene the part belongs to the arm from now on.

        Raises:
            ControlError: the cell is not stopped, or the arm holds nothing.
            FlexcellError: the planning scene does not take the part.
        """
        self._require_stopped(arm)
        part = self._part(arm)
        if not part:
            raise ControlError("the arm holds nothing", where=arm, hint="nothing has to be kept or released")
        async with self._step(arm):
            await self._attach(arm, part)
            self._kept[arm] = part

    async def release_part(self, arm: str) -> None:
        """Open the tool of an arm, which drops what it holds; in the planning scene the part is free again.

        Raises:
            ControlError: the cell is not stopped, or this tool cannot be opened from here.
            FlexcellError: the tool did not open.
        """
        self._require_stopped(arm)
        kind, part = self._kind(arm), self._part(arm)
        if kind is None or kind.release_goal is None:
            raise ControlError("its tool cannot be opened from here", where=arm, hint="open it at the robot")
        async with self._step(arm):
            await self._perform(f"{arm}/{kind.name}/{kind.release_goal.skill_name()}", kind.release_goal)
            self._kept.pop(arm, None)
            if part and part != UNKNOWN_PART and self._has("cell/detach_part"):
                await self._bus.call("cell/detach_part", {"part": part})

    async def go_home(self, arm: str) -> None:
        """Move an arm to its home configuration around obstacles, slowly; a part that it holds moves with it.

        Raises:
            ControlError: the cell is not stopped, has no home for the arm, or plans no paths.
            FlexcellError: there is no free path, or the motion failed.
        """
        self._require_stopped(arm)
        name, joints = await self._home(arm)
        if not name:
            raise ControlError(
                f"the store has no joints entry {' or '.join(self._home_names(arm))}",
                where=arm,
                hint="jog the arm home and save its joints under that name on the page Teach",
            )
        if not self._has(f"{arm}/move_free"):
            raise ControlError("this cell plans no paths around obstacles", where=arm, hint="jog the arm home")
        part = self._part(arm)
        speed = _HELD_SPEED if part else _HOME_SPEED
        goal = {"target": {"joints": joints}, "options": {"speed": speed}, "adaptation": {"patience_s": 0.0}}
        async with self._step(arm):
            if part:
                await self._attach(arm, part)
            await self._perform(f"{arm}/move_free", goal)

    async def reset_parts(self) -> None:
        """Put the parts of a simulation back to their initial poses, also those that an arm holds.

        Raises:
            ControlError: the cell is not stopped.
            FlexcellError: the cell has no simulated parts, or something moves.
        """
        self._require_stopped(self._cell.name)
        await self._bus.call(_RESET_PARTS, {})
        self._are_parts_reset = True
        self._stops.notify()

    async def release(self, number: int | None = None) -> None:
        """Release the stop of this number, by default the latest: runs may start again. Nothing moves by this.

        Raises:
            ControlError: the cell was stopped again, the stop is still in progress, or a device is not at rest.
        """
        await self._stops.release(number)

    def close(self) -> None:
        """Forget a released stop: its runs stay ended. Does nothing while the cell is stopped."""
        self._stops.forget()

    def _take_up(self) -> None:
        """Note where the arms were stopped; stops during a recovery change nothing of that."""
        record = self._stops.latest
        if record is None:
            return
        if record.first != self._of_stop:
            self._kept, self._stopped_at, self._problems, self._are_parts_reset = {}, {}, {}, False
            self._of_stop = record.first
        for name, device in record.devices.items():
            joints = self._joints(name)
            if name not in self._stopped_at and device.status != "stopping" and joints:
                self._stopped_at[name] = joints

    def _phase(self, record: StopRecord) -> Literal["stopping", "stopped", "released"]:
        if record.released:
            return "released"
        return "stopping" if self._stops.in_progress else "stopped"

    async def _arm(self, name: str) -> ArmRecovery:
        part, joints = self._part(name), self._joints(name)
        stopped_at = self._stopped_at.get(name, joints)
        home, at = await self._home(name)
        kind = self._kind(name)
        return ArmRecovery(
            name=name,
            part=part,
            kept=bool(part) and self._kept.get(name) == part,
            can_release=kind is not None and kind.release_goal is not None,
            has_moved=_farthest_rad(joints, stopped_at) > _MOVED_RAD,
            home=home,
            home_names=self._home_names(name),
            at_home=bool(home) and _farthest_rad(joints, at) < _AT_HOME_RAD,
            problem=self._problems.get(name, ""),
        )

    def _real(self) -> Iterator[DeviceRecovery]:
        for name, device in (*self._cell.robots.items(), *self._cell.tools.items(), *self._cell.equipment.items()):
            state = self._latest(f"{name}/device")
            if isinstance(state, DeviceState):
                is_lost = isinstance(device, Reconnectable) and bool(device.lost_reason)
                yield DeviceRecovery(
                    name=name,
                    connected=state.connected and not is_lost,
                    enabled=state.enabled,
                    problem=state.problem,
                )

    def _parts(self) -> Literal["open", "reset", "absent"]:
        if not self._has(_RESET_PARTS):
            return "absent"
        return "reset" if self._are_parts_reset else "open"

    async def _home(self, arm: str) -> tuple[str, tuple[float, ...]]:
        """Return name and joints of the home configuration; empty if there is none for this arm."""
        store, described = self._cell.store, self._described(arm)
        if store is None or described is None:
            return "", ()
        for name in self._home_names(arm):
            try:
                joints = decode_entry(await store.get("joints", name), Joints).joints
            except StoreError:
                # No such entry, or a store that cannot be read: either way there is no home to go to.
                continue
            if len(joints) == len(described.joint_names):
                return name, joints
        return "", ()

    def _home_names(self, arm: str) -> tuple[str, ...]:
        """Return the names of entries that may be its home; `home` alone would be ambiguous for several arms."""
        return (f"{arm}_home", *(("home",) if len(self._cell.robots) == 1 else ()))

    def _part(self, arm: str) -> str:
        """Return the name of the part that the tool of an arm holds, `?` when unknown, empty for none."""
        kind = self._kind(arm)
        state = self._latest(f"{arm}/{kind.name}/state") if kind is not None else None
        return (state.part or UNKNOWN_PART) if isinstance(state, ToolHold) and state.held else ""

    def _kind(self, arm: str) -> ToolKind | None:
        described = self._described(arm)
        mechanism = described.tool_kind if described is not None else ""
        return next((kind for kind in tool_kinds().values() if mechanism in kind.mechanisms), None)

    def _described(self, arm: str) -> RobotDescription | None:
        latest = self._latest(f"{arm}/description")
        return latest if isinstance(latest, RobotDescription) else None

    def _joints(self, arm: str) -> tuple[float, ...]:
        latest = self._latest(f"{arm}/joint_state")
        return latest.position_rad if isinstance(latest, JointState) else ()

    def _latest(self, topic: str) -> object | None:
        try:
            return self._cell.bus.find_topic(topic).latest
        except FlexcellError:
            # A device without this topic, or one that is lost, tells nothing.
            return None

    def _has(self, address: str) -> bool:
        try:
            self._cell.bus.request_type(address)
        except NoSuchSkill:
            return False
        return True

    async def _attach(self, arm: str, part: str) -> None:
        """Let a part belong to an arm in the planning scene, where its name is known and there is a scene."""
        if part != UNKNOWN_PART and self._has("cell/attach_part"):
            await self._bus.call("cell/attach_part", {"part": part, "robot": arm})

    async def _perform(self, address: str, goal: object) -> None:
        end = await self._bus.perform(address, msgspec.to_builtins(goal))
        if end.status is not GoalStatus.SUCCEEDED:
            cause = describe_cause(end.cause) if end.cause is not None else f"it ended as {end.status.value}"
            raise ControlError(cause, where=address, hint="jog the arm clear, then try again")

    @asynccontextmanager
    async def _step(self, arm: str) -> AsyncGenerator[None]:
        """Keep why a step failed, so that every page says it, and tell the pages of its end."""
        self._problems.pop(arm, None)
        try:
            yield
        except FlexcellError as error:
            self._problems[arm] = str(error)
            raise
        finally:
            self._stops.notify()

    def _require_stopped(self, where: str) -> None:
        if not self._stops.latched:
            raise ControlError("the cell is not stopped", where=where, hint="these steps are those after a stop")
        if self._stops.in_progress:
            raise ControlError("the stop is still in progress", where=where, hint="wait until everything is at rest")


def _farthest_rad(joints: tuple[float, ...], other: tuple[float, ...]) -> float:
    """Return the largest difference of two configurations; infinite if one of them is not known."""
    if not joints or len(joints) != len(other):
        return math.inf if joints or other else 0.0
    return max(abs(a - b) for a, b in zip(joints, other, strict=True))
