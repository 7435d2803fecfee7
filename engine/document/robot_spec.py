"""A robot of a cell document: its model, its driver and its tool."""

from __future__ import annotations

from typing import Annotated, Literal, cast

from msgspec import Meta

from engine.document.cell_tools import ToolChangerSpec
from engine.document.placement import FramedPlacement, Name
from engine.document.text.decoding import StrictModel
from engine.document.text.yaml_source import DataPath, DocumentSource
from engine.errors import DocumentError

OutputUse = Literal["tool_exchange", "gripper", "linear_axis"]
OutputNumber = Annotated[int, Meta(ge=0, description="Number of a digital output of the robot's controller, from 0")]
InputNumber = Annotated[int, Meta(ge=0, description="Number of a digital input of the robot's controller, from 0")]


class GripperSpec(StrictModel, frozen=True, kw_only=True):
    """The gripper at the flange of a robot.

    `driver` is that of a real tool, as a mapping with its name as `kind` and its options as further keys, also on a
    simulated arm; `sim`, the default, leaves the tool to its arm.
    """

    model: Annotated[str, Meta(min_length=1, description="Name or folder of the gripper model")]
    driver: Literal["sim"] | dict[str, object] = "sim"

    @property
    def driver_kind(self) -> str:
        """The name of its own driver; empty if it comes with its arm."""
        return str(self.driver["kind"]) if isinstance(self.driver, dict) else ""


class RobotSpec(StrictModel, frozen=True, kw_only=True):
    """One robot: its model, driver, base placement and gripper.

    `model` (also that of the gripper) is the name of a built-in model, or the path of a model folder
    with a `/` in it, relative to this document. `calibration` is the arm's factory calibration file.
    `coupled_joints`: the controller counts coupled axes relative to each other. `outputs` maps uses to
    digital outputs of the controller, `inputs` names of your own to its digital inputs. `driver` is `sim`,
    or a mapping with the driver's name as `kind` and its options as further keys. A robot with a `tool_changer`
    has no gripper: it takes parts that are tools.
    """

    model: Annotated[str, Meta(min_length=1, description="Name or folder of the robot model")]
    driver: Literal["sim"] | dict[str, object] = "sim"
    base: FramedPlacement = FramedPlacement()
    gripper: GripperSpec | None = None
    tool_changer: ToolChangerSpec | None = None
    calibration: Annotated[str, Meta(min_length=1, description="Calibration file, relative to this one")] | None = None
    coupled_joints: bool = False
    outputs: dict[OutputUse, OutputNumber] = {}
    inputs: dict[Name, InputNumber] = {}

    @property
    def simulated(self) -> bool:
        """True if the world of the cell simulates this robot."""
        return self.driver == "sim"

    @property
    def driver_kind(self) -> str:
        """The name of the driver; its options are the other keys of `driver`."""
        return self.driver if isinstance(self.driver, str) else str(self.driver["kind"])


def require_driver_kind(whose: str, driver: object, source: DocumentSource, path: DataPath) -> None:
    """Refuse a driver without a name; raises DocumentError with its position."""
    if isinstance(driver, dict) and not isinstance(cast("dict[str, object]", driver).get("kind"), str):
        raise DocumentError(
            f"the driver of {whose} has no `kind`",
            where=source.position(path),
            hint="write `driver: sim` or `driver: {kind: NAME, …}`",
        )
