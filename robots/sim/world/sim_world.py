"""The simulated world of a cell as a device: opens its host, provides ports to its robots, publishes on the bus."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import AsyncExitStack
from functools import partial
from pathlib import Path
from types import TracebackType
from typing import Self, cast

from engine.bus import SkillBus
from engine.clock import VirtualLoop
from engine.document import Cell
from engine.errors import RobotError
from engine.messages import Vector3
from engine.robot import DeviceStatus, Robot
from robots.control.commanding.arm_commands import StopAll
from robots.control.commanding.motion_registry import MotionRegistry
from robots.port import ArmPort, Array, GripperPort, HandPort
from robots.scene.sim_scene import SimScene
from robots.sim.commands.world_commands import MirrorArm
from robots.sim.host.lockstep_host import LockstepHost
from robots.sim.host.process_host import NewStopLine, ProcessHost
from robots.sim.host.world_host import StepHook, WorldHost
from robots.sim.loop.snapshot import SimSnapshot
from robots.sim.physics.scene_description import describe_scene
from robots.sim.ports.arm_ports import arm_ports, arm_summaries, input_ports, output_ports
from robots.sim.ports.sim_inputs import SimInputPort
from robots.sim.ports.sim_outputs import SimOutputPort
from robots.sim.ports.tool_ports import ToolPorts
from robots.sim.world.body_services import BodyServices
from robots.sim.world.driven_tools import mirror_driven_tools
from robots.sim.world.module_services import ModuleServices
from robots.sim.world.person_services import PersonServices
from robots.sim.world.sim_robot import SimRobot, StatefulDevice, WorldDependentDevice
from robots.sim.world.snapshot_codec import WorldImage, decode_snapshot, encode_snapshot
from robots.sim.world.world_publisher import FRAME_RATE_HZ, JOINT_RATE_HZ, WorldPublisher

RobotMaker = Callable[["SimWorld"], tuple[SimRobot, ...]]


def no_robots(_world: SimWorld) -> tuple[SimRobot, ...]:
    """Create no skill servers, for direct use of the ports."""
    return ()


class SimWorld:
    """Implements `engine.robot.World`.

    With a lockstep host it also implements `engine.clock.LockstepSimulation` and is attached to a `VirtualLoop` while
    open.

    `make_robots` creates the skill servers on the ports, `arm(name)` and `gripper(name)`, which exist
    before the world is opened and work while it is open. Servers without an arm are devices of
    the world itself, such as cameras: they are entered, registered and exited with the world.
    `modules` says what of the scene is in the world; without a `cell` it is all of it.
    """

    def __init__(
        self,
        scene: SimScene,
        *,
        host: WorldHost,
        make_robots: RobotMaker = no_robots,
        cache: Path | None = None,
        cell: Cell | None = None,
    ) -> None:
        self._scene = scene
        self._host = host
        self._cache = cache
        self._board = MotionRegistry(on_lost=self._lost)
        self._arms = arm_summaries(scene)
        self._arm_ports = arm_ports(scene, host, self._board)
        self._tools = ToolPorts(host, self._board, self._arms)
        self._outputs = output_ports(scene)
        self._inputs = input_ports(scene)
        self._status = DeviceStatus.DISCONNECTED
        self._at_loss = b""
        self._connection_changed: Callable[[], None] = _nothing
        self._publisher: WorldPublisher | None = None
        self._timer: asyncio.Task[None] | None = None
        self._joint_steps = max(1, round(1.0 / (JOINT_RATE_HZ * scene.step_s)))
        self._frame_steps = max(1, round(1.0 / (FRAME_RATE_HZ * scene.step_s)))
        self._hooked_steps = 0
        self._hooks: list[tuple[StepHook, Callable[[], bool]]] = []
        self.people = PersonServices(self.name, scene.people, host)
        self.modules = ModuleServices(self.name, scene, host, cell=cell)
        self._bodies = BodyServices(
            self.name,
            host,
            arms=tuple(self._arms),
            is_moving=lambda: bool(self._board.active()),
            modules=self.modules,
        )
        self._robots = make_robots(self)
        self._devices = tuple(robot for robot in self._robots if robot.name not in self._arms)
        self._opened_devices = AsyncExitStack()

    @property
    def name(self) -> str:
        """Its namespace on the bus."""
        return "cell"

    @property
    def status(self) -> DeviceStatus:
        """FAULT once the world's process is lost."""
        if self._status is DeviceStatus.READY and self._board.active():
            return DeviceStatus.MOVING
        return self._status

    @property
    def host(self) -> WorldHost:
        """Where it runs."""
        return self._host

    def robots(self) -> tuple[Robot, ...]:
        """Return the simulated robots, not yet connected."""
        return tuple(robot for robot in self._robots if robot.name in self._arms)

    def devices(self) -> tuple[Robot, ...]:
        """Return the devices of the world itself, entered, registered and exited with it."""
        return self._devices

    def measures(self) -> dict[str, float]:
        """Return what arms, tools and contacts have summed up since the open world was opened or restored."""
        return self._host.measures()

    def each_step(self, hook: StepHook, *, busy: Callable[[], bool]) -> None:
        """Call `hook` after every lockstep step; time advances while `busy` returns true."""
        self._hooks.append((hook, busy))

    def arm_names(self) -> tuple[str, ...]:
        """Return the arms of this world, in document order."""
        return tuple(self._arm_ports)

    def arm(self, name: str) -> ArmPort:
        """Return the port of one arm."""
        return self._arm_ports[name]

    def mirror(self, name: str, position_rad: Array, velocity_rad_s: Array) -> None:
        """Place the body of a driven arm where its driver measures it; nothing happens while the world is lost."""
        if self._status is DeviceStatus.READY:
            self._host.send(MirrorArm(arm=name, position_rad=position_rad, velocity_rad_s=velocity_rad_s))

    def gripper(self, name: str) -> GripperPort:
        """Return the port of the gripper on one arm."""
        return cast("GripperPort", self._tools.port(name, "gripper"))

    def hand(self, name: str) -> HandPort:
        """Return the port of the hand on one arm."""
        return cast("HandPort", self._tools.port(name, "hand"))

    def tool(self, name: str, kind: str) -> object:
        """Return the port of the tool of a kind on one arm; raises CellError where there is none."""
        return self._tools.port(name, kind)

    def outputs(self, name: str) -> SimOutputPort | None:
        """Return the digital outputs of one arm's controller, None where it has none."""
        return self._outputs.get(name)

    def inputs(self, name: str) -> SimInputPort | None:
        """Return the digital inputs of one arm's controller, None where it has none."""
        return self._inputs.get(name)

    def measured(self) -> SimSnapshot:
        """Return the latest measurements."""
        return self._host.snapshot()

    def snapshot(self) -> bytes:
        """Return a snapshot from which `restore` continues later, in this process or another."""
        grips = {name: grip for robot in self._robots for name, grip in robot.grips().items()}
        settings = {name: port.settings for name, port in self._arm_ports.items()}
        reflexes = {name: reason for name, port in self._arm_ports.items() if (reason := port.reflex_reason)}
        outputs = {name: port.values for name, port in self._outputs.items()}
        memos = {
            robot.name: memo for robot in self._robots if isinstance(robot, StatefulDevice) and (memo := robot.memo())
        }
        inputs = {name: port.values for name, port in self._inputs.items()}
        image = WorldImage.of(self._host.image(), grips, settings, reflexes, outputs, memos, inputs)
        return encode_snapshot(image, model=self._host.summary.model)

    async def restore(self, snapshot: bytes) -> None:
        """Restore a snapshot, at rest: set points are held, grippers keep their grip.

        Settings, digital outputs and simulated inputs of the arms are restored too.

        Raises:
            RobotError: something moves, the world is lost, or the snapshot is of another world.
        """
        if self._board.active():
            raise RobotError("something moves", where=self.name, hint="restore before the first goal, or stop it")
        await self._take_over(self._unsealed(snapshot))

    def _unsealed(self, snapshot: bytes) -> WorldImage:
        summary = self._host.summary
        return decode_snapshot(snapshot, model=summary.model, size=summary.image_size)

    async def _take_over(self, image: WorldImage) -> None:
        self._board.closed_reason = "the world is being restored"
        try:
            for name, settings in image.settings.items():
                self._arm_ports[name].configure(settings)
            async with self.modules.changing:
                await self._host.restore(image.array())
                self.modules.take_image(image.array())
            self._board.reflexes = dict(image.reflexes)
        finally:
            self._board.closed_reason = ""
        for ports, values in ((self._outputs, image.outputs), (self._inputs, image.inputs)):
            for name in values:
                ports[name].recall(values[name])
        for robot in self._robots:
            robot.recall(image.grips)
            if isinstance(robot, StatefulDevice):
                robot.remember(image.memos.get(robot.name, b""))

    @property
    def lost_reason(self) -> str:
        """Why the world is lost; empty while it is connected."""
        return self._board.lost_reason if self._status is DeviceStatus.FAULT else ""

    def when_connection_changes(self, callback: Callable[[], None]) -> None:
        """Call `callback` when the world is lost and when it is restored."""
        self._connection_changed = callback

    async def reconnect(self) -> str:
        """Start a new process for a lost world, and restore the last state of the old one, at rest.

        Raises:
            RobotError: the process does not start, or is lost again at once.
        """
        if not self.lost_reason:
            return ""
        await self._host.close()
        await self._open_host()
        note = await self._go_on_after_loss()
        self._board.found()
        self._status, self._at_loss = DeviceStatus.READY, b""
        self._publish_on()
        for robot in self._robots:
            if isinstance(robot, WorldDependentDevice):
                robot.world_restored()
        self._connection_changed()
        return note

    async def _go_on_after_loss(self) -> str:
        try:
            image = self._unsealed(self._at_loss)
        except RobotError as error:
            self._begin_ports()
            self._board.reflexes = {}
            for robot in self._robots:
                robot.recall({})
            return f"the world was restarted in the initial state of the cell document: {error.message}"
        await self._take_over(image)
        return ""

    async def _open_host(self) -> None:
        await self._host.open(self._board)
        self.modules.begin()
        if isinstance(self._host, LockstepHost):
            self._host.begin(asyncio.get_running_loop().time())

    def _begin_ports(self) -> None:
        for port in (*self._arm_ports.values(), *self._outputs.values(), *self._inputs.values()):
            port.begin()

    def push(self, body: str, *, force_n: Vector3, duration_s: float, at_m: Vector3 = (0.0, 0.0, 0.0)) -> None:
        """Push a body, in world axes, at a point of its frame; replaces its last push.

        `body` is one of `host.summary.bodies`: `left/panda_hand`, the name of a part.

        Raises:
            RobotError: there is no such body, a value is not finite, the push is too long, or the world is lost.
        """
        self._bodies.push(body, force_n=force_n, duration_s=duration_s, at_m=at_m)

    def register(self, bus: SkillBus) -> None:
        """Publish scene, frames, parts, joints and grippers; the world is open."""
        describe = partial(describe_scene, cache=self._cache)
        publisher = self._publisher = WorldPublisher(bus, self._host, describe, scene=self.modules.scene)
        self.modules.watch(publisher.take_scene)
        self.modules.follow_frames(lambda: publisher.take_frames(self.modules.scene.frames))
        mirror_driven_tools(bus, self._host, self._scene)
        self._bodies.register(bus)
        self.people.register(bus)
        self.modules.register(bus)
        for device in self._devices:
            device.register(bus)
        self._publish_on()

    def _publish_on(self) -> None:
        """Start publishing in real time; in lockstep every step publishes."""
        if self._publisher is not None and not isinstance(self._host, LockstepHost):
            self._timer = asyncio.get_running_loop().create_task(self._publish_in_real_time(), name="world publisher")

    async def stop(self) -> None:
        """Cancel every motion and return when all have ended at rest.

        Raises:
            RobotError: an arm did not come to rest, or the world is lost.
        """
        motions = self._board.active()
        self._host.send(StopAll())
        reports = await asyncio.gather(*(motion.report() for motion in motions))
        moving = [report.reason for report in reports if not report.at_rest]
        if moving or self._board.lost_reason:
            raise RobotError("; ".join(moving) or self._board.lost_reason, where=self.name)

    async def __aenter__(self) -> Self:
        await self._open_host()
        self._begin_ports()
        self._status = DeviceStatus.READY
        loop = asyncio.get_running_loop()
        if isinstance(self._host, LockstepHost) and isinstance(loop, VirtualLoop):
            loop.attach(self)
        try:
            for device in self._devices:
                await self._opened_devices.enter_async_context(device)
        except BaseException:
            # If a device fails to open, cancellation included, the world must not stay open.
            await self.__aexit__(None, None, None)
            raise
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        try:
            await self._stop_publishing()
            await self._opened_devices.aclose()
            if self._status is DeviceStatus.READY:
                await self.stop()
        finally:
            # Even if this is cancelled while it waits, the world ends.
            loop = asyncio.get_running_loop()
            if isinstance(self._host, LockstepHost) and isinstance(loop, VirtualLoop):
                loop.detach(self)
            self._status = DeviceStatus.DISCONNECTED
            await self._host.close()

    async def _stop_publishing(self) -> None:
        timer, self._timer = self._timer, None
        if timer is not None:
            timer.cancel()
            await asyncio.wait((timer,))

    @property
    def busy(self) -> bool:
        """True while a motion is active or a topic has subscribers (lockstep)."""
        if self._lockstep().busy or (self._publisher is not None and self._publisher.read):
            return True
        return any(busy() for _, busy in self._hooks)

    def advance(self, until_s: float) -> float:
        """Step towards `until_s`; returns early, with the time reached, after any callback into the event loop."""
        return self._lockstep().advance(until_s, after_step=self._after_step)

    def _lockstep(self) -> LockstepHost:
        if not isinstance(self._host, LockstepHost):
            raise RobotError("a world in real time cannot be stepped", hint="open the cell with the virtual clock")
        return self._host

    def _after_step(self) -> bool:
        self._hooked_steps += 1
        publisher, notified = self._publisher, False
        if publisher is not None:
            if self._hooked_steps % self._joint_steps == 0:
                notified = publisher.publish_joints()
            if self._hooked_steps % self._frame_steps == 0:
                notified = publisher.publish_frames() or notified
        for hook, _ in self._hooks:
            notified = hook() or notified
        return notified

    async def _publish_in_real_time(self) -> None:
        assert self._publisher is not None
        loop = asyncio.get_running_loop()
        every = max(1, round(JOINT_RATE_HZ / FRAME_RATE_HZ))
        start, tick = loop.time(), 0
        while not self._board.lost_reason:
            tick = max(tick + 1, int((loop.time() - start) * JOINT_RATE_HZ))
            await asyncio.sleep(max(0.0, start + tick / JOINT_RATE_HZ - loop.time()))
            self._publisher.publish_joints()
            if tick % every == 0:
                self._publisher.publish_frames()

    def _lost(self, reason: str) -> None:
        if self._status is not DeviceStatus.READY:
            return
        self._at_loss = self.snapshot()
        self._status = DeviceStatus.FAULT
        for robot in self._robots:
            if isinstance(robot, WorldDependentDevice):
                robot.world_lost(reason)
        self._connection_changed()


def _nothing() -> None:
    """Do nothing."""


def new_world(
    scene: SimScene,
    *,
    virtual: bool,
    make_robots: RobotMaker = no_robots,
    cache: Path | None = None,
    new_stop_line: NewStopLine | None = None,
    cell: Cell | None = None,
) -> SimWorld:
    """Return a world for virtual time (in this process, in lockstep) or real time (in its own process)."""
    host = LockstepHost(scene) if virtual else ProcessHost(scene, new_stop_line=new_stop_line)
    return SimWorld(scene, host=host, make_robots=make_robots, cache=cache, cell=cell)
