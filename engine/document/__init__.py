"""Documents: behaviors, cells and entries as strict YAML or JSON, read into frozen models.

A document that cannot be used is a `DocumentError` with file, line and column. Entries are read and written by
`engine.document.entries`, which few programs need.
"""

from engine.document.behavior import Behavior, BehaviorDocument
from engine.document.cell import Cell, CellDocument, Fixture, Jitter, Part, RobotEntry, load_cell
from engine.document.cell_senses import DepthCamera, OccupancyMap, Person
from engine.document.condition import Condition
from engine.document.expression import Template, compile_template
from engine.document.loader import (
    CircularReference,
    Survey,
    load_behavior,
    parse_behavior,
    read_behavior,
    survey_behavior,
)
from engine.document.node import Concurrency, ForEach, Guard, Machine, Node, Retry, Timeout
from engine.document.parameter import Parameter, bind_parameters
from engine.document.placement import Placement
from engine.document.signature import KeySignature, StateSignature, read_signature
from engine.document.yaml_source import Source, load_source, parse_source
from engine.document.yaml_writer import write_yaml

__all__ = [
    "Behavior",
    "BehaviorDocument",
    "Cell",
    "CellDocument",
    "CircularReference",
    "Concurrency",
    "Condition",
    "DepthCamera",
    "Fixture",
    "ForEach",
    "Guard",
    "Jitter",
    "KeySignature",
    "Machine",
    "Node",
    "OccupancyMap",
    "Parameter",
    "Part",
    "Person",
    "Placement",
    "Retry",
    "RobotEntry",
    "Source",
    "StateSignature",
    "Survey",
    "Template",
    "Timeout",
    "bind_parameters",
    "compile_template",
    "load_behavior",
    "load_cell",
    "load_source",
    "parse_behavior",
    "parse_source",
    "read_behavior",
    "read_signature",
    "survey_behavior",
    "write_yaml",
]
