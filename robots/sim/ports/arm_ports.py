"""The ports of the arms of a world and of the inputs and outputs of their controllers; arms with drivers have none."""

from __future__ import annotations

from robots.control.commanding.commanded_arm_port import CommandedArmPort
from robots.control.commanding.motion_registry import MotionRegistry
from robots.scene.sim_scene import ArmPlacement, SimScene
from robots.sim.grip.tool_summary import tool_summary
from robots.sim.host.world_host import WorldHost
from robots.sim.loop.snapshot import ArmSummary
from robots.sim.ports.sim_inputs import SimInputPort
from robots.sim.ports.sim_outputs import SimOutputPort
from robots.sim.ports.world_arm_link import WorldArmLink


def arm_ports(scene: SimScene, host: WorldHost, board: MotionRegistry) -> dict[str, CommandedArmPort]:
    """Return the port of each simulated arm, by its name."""
    ports: dict[str, CommandedArmPort] = {}
    for placement in scene.arms:
        if not placement.driven:
            name, model = placement.name, placement.robot()
            link = WorldArmLink(host, name)
            ports[name] = CommandedArmPort(link, board, arm=name, joints=model.arm_joints, limits=model.limits)
    return ports


def arm_summaries(scene: SimScene) -> dict[str, ArmSummary]:
    """Return what each arm is, by its name."""
    return {placement.name: _summary(placement) for placement in scene.arms}


def _summary(placement: ArmPlacement) -> ArmSummary:
    robot, changer = placement.robot(), placement.tool_changer is not None
    return ArmSummary(name=placement.name, joints=robot.arm_joints, tool=tool_summary(robot.tool), tool_changer=changer)


def output_ports(scene: SimScene) -> dict[str, SimOutputPort]:
    """Return the outputs of each simulated arm that has some, by its name."""
    counts = {placement.name: _outputs(placement) for placement in scene.arms if not placement.driven}
    return {name: SimOutputPort(name, count=count) for name, count in counts.items() if count}


def input_ports(scene: SimScene) -> dict[str, SimInputPort]:
    """Return the inputs of each simulated arm that has some, by its name."""
    counts = {each.name: _inputs(each) for each in scene.arms if not each.driven}
    return {name: SimInputPort(name, count=count) for name, count in counts.items() if count}


def _inputs(placement: ArmPlacement) -> int:
    given = placement.digital_inputs
    return placement.robot().digital_inputs if given is None else given


def _outputs(placement: ArmPlacement) -> int:
    given = placement.digital_outputs
    return placement.robot().digital_outputs if given is None else given
