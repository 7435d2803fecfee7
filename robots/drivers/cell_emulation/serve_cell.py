"""Serves the emulators of a cell's devices and its side channel until it is cancelled."""

from __future__ import annotations

import asyncio
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from functools import partial

from msgspec import structs

from engine.cell.drivers import AssignedDriver, Emulator, EmulatorOptions, Ready, assigned_drivers, emulator
from engine.document import cell_at_start, load_cell, with_simulated_devices
from engine.errors import FlexcellError
from robots.drivers.cell_emulation.cell_emulator import CellEmulatorOptions
from robots.drivers.cell_emulation.serve_franka_cell import franka_hosts, is_franka, serve_franka_cell
from robots.drivers.cell_emulation.switched_world_tool import SwitchedWorldTool
from robots.drivers.cell_emulation.two_worlds import TwoWorlds
from robots.drivers.cell_emulation.world_arm import WorldArm
from robots.drivers.cell_emulation.world_judge import WorldJudge
from robots.drivers.cell_emulation.world_time import WorldTime
from robots.drivers.cell_emulation.world_tool import tool_holds, world_tool
from robots.drivers.emulation.plant import Plant
from robots.drivers.emulation.side_channel import SideChannel
from robots.drivers.franka.emulation.franka_cell_process import FrankaCellProcess
from robots.model.joint_map import JointMap
from robots.scene.scene_builder import build_scene
from robots.scene.sim_scene import ArmPlacement
from robots.sim.world.sim_world import SimWorld, new_world
from robots.switched.switched_options import SwitchedToolOptions


@dataclass(frozen=True, kw_only=True)
class _Device:
    """One device with a driver, and its emulator."""

    name: str
    robot: str
    is_tool: bool
    emulator: Emulator
    options: EmulatorOptions

    @staticmethod
    def of(assigned: AssignedDriver) -> _Device:
        """Return the device; raises FlexcellError if it cannot be emulated where its driver connects."""
        driver = assigned.driver()
        chosen = emulator(assigned.kind)
        model = assigned.model.rstrip("/").rpartition("/")[2]
        options = chosen.options_for(assigned.options(driver), model=model)
        name = assigned.device_name(driver)
        return _Device(
            name=name, robot=assigned.robot, is_tool=assigned.device == "tool", emulator=chosen, options=options
        )


class EmulatedCell:
    """The emulators of devices on an open world; each of them runs on this event loop.

    Args:
        devices: Those with emulators.
        switched: The options of the tools that have none: the outputs of a controller switch them. By arm.
        world: What they move.
        time: The time of the world.
        joint_maps: By arm, from the joints of the world to the angles of its controller.
    """

    def __init__(
        self,
        devices: tuple[_Device, ...],
        switched: Mapping[str, SwitchedToolOptions],
        world: SimWorld,
        time: WorldTime,
        *,
        joint_maps: Mapping[str, JointMap],
    ) -> None:
        self._devices = devices
        self._world = world
        self._time = time
        self._joint_maps = joint_maps
        self._tools = {arm.name: arm.tool for arm in world.host.summary.arms}
        self._switched = tuple(
            SwitchedWorldTool(
                options,
                owner=options.device or arm,
                tool=world_tool(world, arm, tool),
                holds=partial(tool_holds, world, arm, tool),
            )
            for arm, options in switched.items()
            if (tool := self._tools[arm]) is not None
        )

    async def serve(self, group: asyncio.TaskGroup) -> dict[str, Mapping[str, object]]:
        """Start all emulators in a group, and return where they listen, by the name of the device."""
        places: dict[str, Mapping[str, object]] = {}
        for device in self._devices:
            place: asyncio.Future[Mapping[str, object]] = asyncio.get_running_loop().create_future()
            task = group.create_task(self._run(device, place), name=device.name)
            await asyncio.wait((task, place), return_when=asyncio.FIRST_COMPLETED)
            if not place.done():
                await task
            places[device.name] = place.result()
        return places

    async def _run(self, device: _Device, place: asyncio.Future[Mapping[str, object]]) -> None:
        try:
            await device.emulator.run(device.options, place.set_result, plant=self._plant(device))
        except FlexcellError as error:
            error.where = error.where or device.name
            raise

    def _plant(self, device: _Device) -> Plant:
        """Return what a device moves: the fingers of the tool, or the joints of the arm."""
        tool = self._tools[device.robot]
        if device.is_tool and tool is not None:
            return Plant(tool=world_tool(self._world, device.robot, tool), clock=self._time)
        arm = WorldArm(self._world.arm(device.robot), self._joint_maps[device.robot])
        wired = [tool for tool in self._switched if tool.owner == device.robot]

        def on_output(output: int, *, on: bool) -> None:
            for each in wired:
                each.take(output, on=on)

        def inputs() -> dict[int, bool]:
            return {number: on for each in wired for number, on in each.sensed().items()}

        return Plant(arm=arm, on_output=on_output, inputs=inputs, clock=self._time)


async def serve_cell(options: CellEmulatorOptions, ready: Ready) -> None:
    """Open the world of a cell with everything in it simulated, and serve until this is cancelled.

    Raises:
        FlexcellError: the cell has no device with a driver, one of them cannot be emulated, or cannot listen.
    """
    cell = load_cell(options.file)
    # Equipment has its own server, which serves pins in memory too.
    assigned = tuple(each for each in assigned_drivers(cell) if each.device != "equipment")
    if not assigned:
        raise FlexcellError("no device of this cell has a driver", where=options.file)
    simulated = with_simulated_devices(cell, [each.written_name for each in assigned])
    seed = options.seed if options.seed >= 0 else None
    scene = build_scene(cell_at_start(simulated), seed=seed, resolve=simulated.resolve)
    others = tuple(each for each in assigned if not is_franka(each))
    if not others:
        await serve_franka_cell(assigned, scene, options, ready)
        return
    franka = None
    if len(others) < len(assigned):
        # Where franky-sim has its arms, they are bodies here.
        franka = FrankaCellProcess(franka_hosts(assigned), scene)
        scene = structs.replace(scene, arms=tuple(_driven(arm, franka.arms) for arm in scene.arms))
    switched = dict(_switched_tools(others))
    devices = tuple(_Device.of(each) for each in others if not (each.device == "tool" and each.robot in switched))
    joint_maps = {placement.name: placement.robot().joint_map for placement in scene.arms}
    async with new_world(scene, virtual=True) as world:
        time = WorldTime(world)
        worlds = None if franka is None else TwoWorlds(world, franka.arms, franka)
        side = SideChannel(WorldJudge(world, time, worlds).execute, host=options.host, port=options.side_port)
        async with time.passing() as stepping:
            try:
                async with asyncio.TaskGroup() as group:
                    group.create_task(_end_with(stepping))
                    emulated = EmulatedCell(devices, switched, world, time, joint_maps=joint_maps)
                    places = await emulated.serve(group)
                    if franka is not None and worlds is not None:
                        places |= await franka.open()
                        group.create_task(franka.read(worlds.take), name="Franka arms")
                    ready({"host": options.host, "side_port": await side.open(), "devices": places})
            finally:
                side.close()
                if franka is not None:
                    await franka.close()
                # What moves comes to rest in the time of the world, where that still passes.
                if not stepping.done():
                    await world.stop()


def _driven(arm: ArmPlacement, franka: Collection[str]) -> ArmPlacement:
    is_franka = arm.name in franka
    return structs.replace(arm, driven=is_franka, driven_tool=is_franka and arm.gripper is not None)


def _switched_tools(assigned: tuple[AssignedDriver, ...]) -> Iterator[tuple[str, SwitchedToolOptions]]:
    """Yield the options of the tools that outputs switch, by arm."""
    for each in assigned:
        options = each.options(each.driver())
        if isinstance(options, SwitchedToolOptions):
            yield each.robot, options


async def _end_with(stepping: asyncio.Task[None]) -> None:
    """Fail as soon as the world cannot be stepped any more."""
    await asyncio.shield(stepping)
