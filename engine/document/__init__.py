"""Documents: behaviors, cells and entries as strict YAML or JSON, read into frozen models.

An invalid document raises `DocumentError` with file, line and column. Entries are read and written by
`engine.document.entries_document`, which few programs need.
"""

from engine.document.behavior import Behavior, BehaviorDocument
from engine.document.cell import (
    Cell,
    CellDocument,
    MujocoWorld,
    RealismName,
    RobotSpec,
    load_cell,
)
from engine.document.cell_bodies import Fixture, Jitter, PartSpec, UnknownBody
from engine.document.cell_bonds import BondSpec, joined_groups
from engine.document.cell_devices import (
    DeviceAxis,
    DeviceBelt,
    DevicePosition,
    DeviceSensor,
    DeviceSpec,
    HingeAxis,
    LightBarrier,
    SlideAxis,
)
from engine.document.cell_frames import poses_in_world
from engine.document.cell_meshes import Decomposition
from engine.document.cell_perception import (
    DepthCamera,
    DetectionRate,
    ObjectDetector,
    OccupancyMap,
    Person,
    SpeedAndSeparationMonitoring,
    UnknownSpacePolicy,
    arm_reach_m,
)
from engine.document.cell_tools import ToolChangerSpec, ToolShape, ToolSpec, centre_of_mass
from engine.document.docking import cell_as_docked, cell_at_start, docks_at_start, modules_below
from engine.document.duration import seconds
from engine.document.expression.expression import Template, compile_template
from engine.document.hexapods import HexapodSpec, beyond_limits, leg_lengths_m, path_beyond_limits
from engine.document.linear_units import LinearScale, LinearUnitSpec
from engine.document.loader import (
    BehaviorSurvey,
    CircularReference,
    load_behavior,
    parse_behavior,
    read_behavior,
    survey_behavior,
)
from engine.document.module_document import MODULE_FILE, Module, load_module
from engine.document.nodes.concurrency_condition import ConcurrencyCondition
from engine.document.nodes.node_spec import (
    ConcurrencySpec,
    ForEachSpec,
    GuardSpec,
    MachineSpec,
    NodeSpec,
    RetrySpec,
    TimeoutSpec,
)
from engine.document.parameter_spec import ParameterSpec, any_value, bind_parameters
from engine.document.placement import FramedPlacement, Placement
from engine.document.signature import KeySignature, StateSignature, read_signature
from engine.document.simulated_devices import with_simulated_devices
from engine.document.sweep import SweepDocument
from engine.document.text.decoding import StrictModel, decode_document
from engine.document.text.yaml_source import MAX_BYTES, DataPath, DocumentSource, load_source, parse_source
from engine.document.text.yaml_writer import write_yaml

__all__ = [
    "MAX_BYTES",
    "MODULE_FILE",
    "Behavior",
    "BehaviorDocument",
    "BehaviorSurvey",
    "BondSpec",
    "Cell",
    "CellDocument",
    "CircularReference",
    "ConcurrencyCondition",
    "ConcurrencySpec",
    "DataPath",
    "Decomposition",
    "DepthCamera",
    "DetectionRate",
    "DeviceAxis",
    "DeviceBelt",
    "DevicePosition",
    "DeviceSensor",
    "DeviceSpec",
    "DocumentSource",
    "Fixture",
    "ForEachSpec",
    "FramedPlacement",
    "GuardSpec",
    "HexapodSpec",
    "HingeAxis",
    "Jitter",
    "KeySignature",
    "LightBarrier",
    "LinearScale",
    "LinearUnitSpec",
    "MachineSpec",
    "Module",
    "MujocoWorld",
    "NodeSpec",
    "ObjectDetector",
    "OccupancyMap",
    "ParameterSpec",
    "PartSpec",
    "Person",
    "Placement",
    "RealismName",
    "RetrySpec",
    "RobotSpec",
    "SlideAxis",
    "SpeedAndSeparationMonitoring",
    "StateSignature",
    "StrictModel",
    "SweepDocument",
    "Template",
    "TimeoutSpec",
    "ToolChangerSpec",
    "ToolShape",
    "ToolSpec",
    "UnknownBody",
    "UnknownSpacePolicy",
    "any_value",
    "arm_reach_m",
    "beyond_limits",
    "bind_parameters",
    "cell_as_docked",
    "cell_at_start",
    "centre_of_mass",
    "compile_template",
    "decode_document",
    "docks_at_start",
    "joined_groups",
    "leg_lengths_m",
    "load_behavior",
    "load_cell",
    "load_module",
    "load_source",
    "modules_below",
    "parse_behavior",
    "parse_source",
    "path_beyond_limits",
    "poses_in_world",
    "read_behavior",
    "read_signature",
    "seconds",
    "survey_behavior",
    "with_simulated_devices",
    "write_yaml",
]
