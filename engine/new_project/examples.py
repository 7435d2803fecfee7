"""The shipped examples: what each shows, and the files that it needs, for a copy of one's own."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

from engine.document.cell import load_cell
from engine.document.loader import load_behavior
from engine.document.module_document import MODULE_FILE
from engine.errors import FlexcellError
from engine.wording import did_you_mean


@dataclass(frozen=True, kw_only=True)
class Example:
    """An example: its behavior, below the folder of all examples, and what it shows."""

    behavior: str
    shows: str


EXAMPLES: Mapping[str, Example] = {
    "transfer": Example(behavior="reconcycle/two_arm_transfer.yaml", shows="two arms carry parts at the same time"),
    "pick_and_place": Example(
        behavior="pick_and_place/pick_and_place.yaml", shows="a UR10 grips a payload, checks it and puts it down"
    ),
    "plate": Example(behavior="plate_transfer/plate_transfer.yaml", shows="an IRB 4600 carries a steel plate"),
    "cylinder": Example(
        behavior="test_cylinder/test_cylinder.yaml", shows="a small servo arm dips a cylinder into water"
    ),
    "trolley": Example(behavior="trolley/empty_trolley.yaml", shows="a trolley is plugged in, emptied and unplugged"),
    "vice": Example(
        behavior="vice/clamp_block.yaml", shows="a slide brings a block, and a vice without sensors clamps it"
    ),
    "cutter": Example(behavior="cutter/cut_battery.yaml", shows="a cutter cuts a battery off its board"),
}
"""The examples by name."""


def example_files(name: str) -> Mapping[str, bytes]:
    """Return the files of an example by their paths in a project: behavior, cell, entries and modules.

    Raises:
        FlexcellError: there is no such example.
        DocumentError: the installed example cannot be read.
    """
    example = EXAMPLES.get(name)
    if example is None:
        raise FlexcellError(f"there is no example `{name}`", hint=did_you_mean(name, EXAMPLES))
    home = _home()
    behavior = load_behavior(home / example.behavior)
    files = {behavior.file}
    if behavior.cell_file is not None:
        cell = load_cell(behavior.cell_file)
        modules = {cell.resolve(each.module) / MODULE_FILE for each in cell.document.modules.values()}
        files |= {cell.file, *modules, *([cell.seed_file] if cell.seed_file is not None else [])}
        files |= {cell.resolve(mesh) for mesh in cell.meshes}
        files |= {cell.resolve(one.calibration) for one in cell.document.robots.values() if one.calibration is not None}
    found = sorted({file.resolve() for file in files})
    # A cell may refer to a file beside the folder of all examples, such as a calibration.
    return {file.relative_to(home.parent).as_posix(): file.read_bytes() for file in found}


def _home() -> Path:
    spec = find_spec("behaviors")
    if spec is None or spec.origin is None:
        raise FlexcellError("the examples are not installed", hint="install flexcell with pip")
    return Path(spec.origin).resolve().parent
