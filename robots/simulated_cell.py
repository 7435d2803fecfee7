"""The simulated world of a cell document with skill servers for its arms and grippers: the entry point `mujoco`."""

from __future__ import annotations

import itertools
from functools import partial

from msgspec.structs import replace

from engine.bus import SkillBus
from engine.cell.drivers import digital_inputs, digital_outputs
from engine.clock import Clock
from engine.document import Cell
from engine.errors import CellError
from engine.messages import Pose
from robots.arm.arm_server import ArmServer
from robots.arm.services.input_services import InputServices
from robots.arm.services.numbered_signals import require_signals
from robots.arm.services.output_services import OutputServices
from robots.devices.simulated_devices import SimulatedDevices
from robots.model.arm_base import ArmBase
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.transform import RigidTransform
from robots.scene.docked_scene import with_modules
from robots.scene.scene_builder import build_scene
from robots.scene.sim_scene import ArmPlacement, SimScene
from robots.sim.host.process_host import NewStopLine
from robots.sim.ports.sim_tool_lock import SimToolLock
from robots.sim.world.sim_robot import SimRobot
from robots.sim.world.sim_world import SimWorld
from robots.sim.world.sim_world import new_world as new_sim_world
from robots.standard_tools.tool_simulation import tool_server
from robots.tool_changer import ToolChangerServer, changeable_tools
from robots.tool_changer.tool_changer_server import FOLLOW_S
from robots.vision.cell_cameras import cell_cameras
from robots.workspace.live_scene import LiveScene
from robots.workspace.monitored_separation import MonitoredSeparation
from robots.workspace.planning_services import PlanningServices
from robots.workspace.separation_rule import rest_distance_m, separation_rule
from robots.workspace.separation_supervisor import SeparationSupervisor
from robots.workspace.unknown_space import UnknownSpaceRule
from robots.workspace.workspace import Workspace
from robots.workspace.world_snapshot import WorldPoseReader


def new_world(
    cell: Cell, *, bus: SkillBus, virtual: bool, seed: int | None, new_stop_line: NewStopLine | None = None
) -> SimWorld:
    """Return the simulated world of a cell, not yet open; its robots serve the motion and gripper skills.

    In real time it receives STOP on a line of `new_stop_line`, if given.

    Raises:
        CellError: a model is unknown, or a size or gripper does not fit.
    """
    rule = separation_rule(cell.document)
    driven = [name for name, robot in cell.document.robots.items() if not robot.simulated]
    if rule is not None and driven:
        raise CellError(
            f"speed and separation monitoring does not slow arms with a driver down yet: {', '.join(driven)}",
            where=cell.source.position(("robots", driven[0], "driver")),
            hint="remove `separation`, and use the safety functions of the controller",
        )
    scene = with_modules(build_scene(cell.document, seed=seed, resolve=cell.resolve), cell)
    scene = replace(scene, separation=rule, arms=tuple(_with_signals(cell, arm) for arm in scene.arms))

    def make_robots(world: SimWorld) -> tuple[SimRobot, ...]:
        cameras = cell_cameras(cell.document, scene=scene, world=world, seed=seed)
        separation = MonitoredSeparation(rest_distance_m(rule)) if rule is not None else None
        workspace = Workspace(
            partial(_live_scene, world),
            planners=PlanningServices(bus.clock),
            clock=bus.clock,
            occupancy=cameras if cell.document.occupancy is not None else None,
            unknown_space=UnknownSpaceRule.of(cell.document.occupancy, cameras=cell.document.cameras),
            separation=separation,
        )
        arms = tuple(
            _arm(cell, world, placement, bus.clock, workspace) for placement in scene.arms if not placement.driven
        )
        if cameras is not None:
            world.modules.follow(cameras.take_scene)
        world.modules.follow(workspace.take_scene)
        world.modules.follow(partial(_take_bases, arms))
        devices: tuple[SimRobot, ...] = (*((cameras,) if cameras is not None else ()), workspace)
        if cell.document.devices:
            devices += (SimulatedDevices(cell, world, clock=bus.clock),)
        if separation is not None and cameras is not None:
            supervisor = SeparationSupervisor(
                world,
                scene,
                sensor=cameras,
                workspace=workspace,
                separation=separation,
                look=WorldPoseReader(world, scene),
                clock=bus.clock,
            )
            devices += (supervisor,)
        return (*devices, *arms)

    return new_sim_world(scene, virtual=virtual, make_robots=make_robots, new_stop_line=new_stop_line, cell=cell)


def _take_bases(arms: tuple[ArmServer, ...], scene: SimScene) -> None:
    """Have each arm stand where it is on its carriage."""
    placements = {placement.name: placement for placement in scene.arms}
    for arm in arms:
        if placements[arm.name].on:
            arm.take_placement(placements[arm.name])


def _live_scene(world: SimWorld) -> LiveScene:
    # Imported here, so that Coal is loaded only when a scene is needed, not by every cell that is opened.
    from robots.planning.scene.cell_planning_scene import planning_scene

    scene = world.modules.scene
    parts = tuple(part.name for part in scene.parts)
    return LiveScene(planning_scene(scene), parts=parts, look=WorldPoseReader(world, scene))


def _arm(cell: Cell, world: SimWorld, placement: ArmPlacement, clock: Clock, workspace: Workspace) -> ArmServer:
    model, base = placement.robot(), ArmBase(RigidTransform.from_pose(placement.base))
    return ArmServer(
        name=placement.name,
        model=model,
        base=base,
        port=world.arm(placement.name),
        clock=clock,
        gripper=tool_server(world, placement.name, model.tool) if not placement.driven_tool else None,
        outputs=_outputs(cell, world, placement),
        inputs=_inputs(cell, world, placement),
        frames=world.modules.frames,
        workspace=workspace,
        tool_changer=_tool_changer(cell, world, placement, base, clock),
    )


def _tool_changer(
    cell: Cell, world: SimWorld, placement: ArmPlacement, base: ArmBase, clock: Clock
) -> ToolChangerServer | None:
    """Return the tool changer of an arm, None without one."""
    name, changer = placement.name, placement.tool_changer
    if changer is None:
        return None
    port, kinematics = world.arm(name), ArmKinematics(placement.robot(), base=base)
    lock = SimToolLock(arm=name, changer=changer, host=world.host)

    def place_of(tool: str) -> Pose | None:
        document = world.modules.document or cell.document
        return document.parts[tool].at.pose() if tool in document.parts else None

    server = ToolChangerServer(
        name,
        changer=changer,
        lock=lock,
        arm=port,
        tools=changeable_tools(cell.document.parts),
        place_of=place_of,
        face=lambda: kinematics.tool_pose(port.sample().position_rad),
        clock=clock,
        simulate=lock.break_it,
    )
    if clock.virtual:
        every = max(1, round(FOLLOW_S / world.modules.scene.step_s))
        steps = itertools.count(1)
        world.each_step(lambda: next(steps) % every == 0 and server.follow(), busy=lambda: False)
    return server


def _with_signals(cell: Cell, arm: ArmPlacement) -> ArmPlacement:
    """Return the arm with outputs and inputs of its controller, which its driver knows even while it is simulated."""
    model = arm.robot()
    return replace(
        arm,
        digital_outputs=digital_outputs(cell, arm.name, of_model=model.digital_outputs),
        digital_inputs=digital_inputs(cell, arm.name, of_model=model.digital_inputs),
    )


def _outputs(cell: Cell, world: SimWorld, placement: ArmPlacement) -> OutputServices | None:
    """Return the outputs of an arm, None without any; raises CellError where the cell names a missing output."""
    name, port = placement.name, world.outputs(placement.name)
    count = len(port.values) if port is not None else 0
    uses = require_signals(cell, name, "output", count=count, owner=f"a {placement.robot().name}")
    return OutputServices(name, port, uses=uses) if port is not None else None


def _inputs(cell: Cell, world: SimWorld, placement: ArmPlacement) -> InputServices | None:
    """Return the inputs of an arm, None without any; raises CellError where the cell names a missing input."""
    name, port = placement.name, world.inputs(placement.name)
    count = port.count if port is not None else 0
    names = require_signals(cell, name, "input", count=count, owner=f"a {placement.robot().name}")
    return InputServices(name, port, names=names, simulate=port.simulate) if port is not None else None
