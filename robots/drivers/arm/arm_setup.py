"""An arm with a driver as its cell document describes it: model, base, outputs, and the world around it."""

from __future__ import annotations

from dataclasses import dataclass

from engine.cell.drivers import DeviceContext
from engine.clock import Clock
from engine.errors import CellError
from robots.arm.services.input_services import InputServices
from robots.arm.services.numbered_signals import require_signals
from robots.arm.services.output_services import OutputServices
from robots.model.robot_model import RobotModel
from robots.port import InputPort, OutputPort
from robots.port.heartbeat import ENGINE_SILENCE_S
from robots.scene.scene_builder import driven_arm
from robots.scene.sim_scene import ArmPlacement
from robots.sim.world.sim_world import SimWorld
from robots.workspace.workspace import Workspace


@dataclass(frozen=True, kw_only=True)
class ArmSetup:
    """One arm of a cell.

    Attributes:
        context: The surroundings.
        placement: Its models and its base.
        model: Arm and tool.
    """

    context: DeviceContext
    placement: ArmPlacement
    model: RobotModel

    @property
    def engine_silence_s(self) -> float:
        """Silence of the engine after which the arm comes to rest."""
        world = self.context.cell.document.world
        return world.engine_silence_s if world is not None else ENGINE_SILENCE_S

    @property
    def world(self) -> SimWorld | None:
        """The world in which its body is mirrored; None without one."""
        world = self.context.world
        return world if isinstance(world, SimWorld) else None

    def workspace(self) -> Workspace | None:
        """Return the workspace that it shares with the arms of the world; None without one."""
        devices = self.world.devices() if self.world is not None else ()
        return next((device for device in devices if isinstance(device, Workspace)), None)

    def output_services(self, port: OutputPort) -> OutputServices:
        """Return the skills of its outputs; raises CellError where the cell names a missing output."""
        name = self.context.robot
        uses = require_signals(
            self.context.cell, name, "output", count=len(port.values), owner=f"the controller of {name}"
        )
        return OutputServices(name, port, uses=uses)

    def input_services(self, port: InputPort | None) -> InputServices | None:
        """Return its inputs on the bus, None without any; raises CellError where the cell names a missing input."""
        name, count = self.context.robot, port.count if port is not None else 0
        names = require_signals(self.context.cell, name, "input", count=count, owner=f"the controller of {name}")
        return InputServices(name, port, names=names) if port is not None else None


def arm_setup(context: DeviceContext, *, clock: Clock) -> ArmSetup:
    """Return the setup of an arm.

    Raises:
        CellError: time is virtual, or a model is unknown.
        DocumentError: a model folder or a calibration file is invalid.
    """
    name = context.robot
    if clock.virtual:
        hint = "run it in real time: without `--clock virtual`; or simulate it with `driver: sim`"
        raise CellError("a real arm has no virtual time", where=name, hint=hint)
    placement = driven_arm(name, context.cell.document.robots[name], context.cell.resolve)
    return ArmSetup(context=context, placement=placement, model=placement.robot())
