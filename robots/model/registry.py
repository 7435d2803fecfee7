"""The registry of robot and tool models: built-in folders and the user's own."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from itertools import islice
from pathlib import Path

from engine.document import RobotSpec, ToolChangerSpec
from engine.errors import CellError
from engine.wording import did_you_mean
from robots.model.folder.composition import compose
from robots.model.folder.model_folder import ROBOT_FILE, TOOL_FILE, load_arm, load_tool
from robots.model.robot_model import RobotModel

ARMS_DIR = Path(__file__).parents[1] / "arms"
TOOLS_DIR = Path(__file__).parents[1] / "tools"

_MOST_FILES = 10_000

OWN_TOOL = "own"
"""Selects the tool delivered with the arm, from its `robot.yaml`; none if it names none."""


def robot_names() -> tuple[str, ...]:
    """Return the names of the built-in arms, sorted."""
    return _names(ARMS_DIR, ROBOT_FILE)


def tool_names() -> tuple[str, ...]:
    """Return the names of the built-in tools, sorted."""
    return _names(TOOLS_DIR, TOOL_FILE)


def model_by_name(name: str) -> RobotModel:
    """Return the arm `name` with the tool it is delivered with; see `robot_model`."""
    return robot_model(name)


def robot_model(
    name: str,
    *,
    gripper: str | None = OWN_TOOL,
    calibration: Path | None = None,
    coupled_joints: bool = False,
    changer: ToolChangerSpec | None = None,
) -> RobotModel:
    """Return the model of an arm with a tool at its flange; cached.

    Args:
        name: A built-in arm, or the path of a folder with a `robot.yaml`.
        gripper: A built-in tool, the path of a folder with a `tool.yaml`, None for the bare flange,
            or `OWN_TOOL`.
        calibration: Factory calibration file of this individual arm.
        coupled_joints: The controller uses coupled axes, as an ABB controller does (see `JointMap`).
        changer: The tool changer at a bare flange.

    Raises:
        CellError: unknown model (suggests similar names), its description is not installed, or it has no such option.
        DocumentError: a document of a folder is invalid; `where` is the position.
    """
    arm = _folder(name, ARMS_DIR, ROBOT_FILE, "robot model")
    if gripper == OWN_TOOL:
        gripper = load_arm(arm).document.tool
    tool = _folder(gripper, TOOLS_DIR, TOOL_FILE, "gripper model") if gripper is not None else None
    changed = tuple(_changed_ns(path) for path in (arm, tool, calibration))
    return _composed(arm, tool, calibration, coupled_joints=coupled_joints, changer=changer, changed=changed)


def model_of_entry(entry: RobotSpec, resolve: Callable[[str], Path]) -> RobotModel:
    """Return the model of a robot in a cell document, without a tool if it names none.

    Args:
        entry: The robot's entry in the document.
        resolve: Resolves the document's paths (`Cell.resolve`).

    Raises:
        CellError: unknown model, its description is not installed, or it has no such option.
        DocumentError: a document of a folder, or the calibration file, is invalid.
    """
    return robot_model(
        model_location(entry.model, resolve),
        gripper=model_location(entry.gripper.model, resolve) if entry.gripper is not None else None,
        calibration=resolve(entry.calibration) if entry.calibration is not None else None,
        coupled_joints=entry.coupled_joints,
        changer=entry.tool_changer,
    )


def model_location(written: str, resolve: Callable[[str], Path]) -> str:
    """Return the name of a built-in model unchanged, and the path of a folder resolved."""
    return str(resolve(written)) if _is_folder(written) else written


# `changed` makes an edited folder a new model, so that editing needs no restart.
@lru_cache(maxsize=64)
def _composed(
    arm: Path,
    tool: Path | None,
    calibration: Path | None,
    *,
    coupled_joints: bool,
    changer: ToolChangerSpec | None,
    changed: tuple[int, ...],  # noqa: ARG001 - part of the key of the cache
) -> RobotModel:
    try:
        return compose(
            load_arm(arm),
            load_tool(tool) if tool is not None else None,
            calibration=calibration,
            coupled_joints=coupled_joints,
            changer=changer,
        )
    except CellError as error:
        raise CellError(
            error.message, where=error.where if error.where is not None else arm.name, hint=error.hint
        ) from error


def _changed_ns(path: Path | None) -> int:
    if path is None or not path.exists():
        return 0
    files = list(islice(path.rglob("*"), _MOST_FILES + 1)) if path.is_dir() else [path]
    if len(files) > _MOST_FILES:
        raise CellError(f"this model folder has more than {_MOST_FILES} files", where=str(path), hint="remove some")
    return max((file.stat().st_mtime_ns for file in files if file.is_file()), default=0)


def _folder(name: str, directory: Path, file: str, what: str) -> Path:
    if _is_folder(name):
        return Path(name)
    known = _names(directory, file)
    if name not in known:
        raise CellError(f"there is no {what} {name}", where=name, hint=did_you_mean(name, known))
    return directory / name


def _is_folder(name: str) -> bool:
    return name.startswith(".") or "/" in name


def _names(directory: Path, file: str) -> tuple[str, ...]:
    return tuple(sorted(path.parent.name for path in directory.glob(f"*/{file}")))
