"""The latest stop of a cell as pages and clients see it: what it did, and what is open until runs may start again."""

from __future__ import annotations

from typing import Literal

import msgspec

UNKNOWN_PART = "?"
"""The name of a held part where the tool cannot tell which one it is."""


class StoppedDevice(msgspec.Struct, frozen=True, kw_only=True):
    """What a stop did at one device: at rest `after_s` seconds after the stop, or `failed` with the reason."""

    name: str
    status: Literal["stopping", "at_rest", "failed"]
    after_s: float = 0.0
    reason: str = ""


class StoppedRun(msgspec.Struct, frozen=True, kw_only=True):
    """A run that the stop has ended; a new run can start from its event `seq`, at the node `path`.

    `path` is the state that it had entered last, empty if it had entered none.
    """

    id: str
    behavior: str
    seq: int
    path: str


class ArmRecovery(msgspec.Struct, frozen=True, kw_only=True):
    """What is open at one arm after a stop.

    `part` is the name of the part that its tool holds, `?` when unknown, empty for none; `kept` is true once an
    operator has decided that the arm keeps it. `has_moved` is true once it is elsewhere than where it was stopped.
    `home` is the joints entry of its home configuration, empty if there is none; `home_names` are those looked for.
    `problem` is why the last step with this arm failed, empty if it did not.
    """

    name: str
    part: str
    kept: bool
    can_release: bool
    has_moved: bool
    home: str
    home_names: tuple[str, ...]
    at_home: bool
    problem: str


class DeviceRecovery(msgspec.Struct, frozen=True, kw_only=True):
    """Whether a real device may move after a stop; `problem` is why not, empty if it may.

    `name` is its address on the bus. A device that does not answer has to be connected again before it is enabled.
    """

    name: str
    connected: bool
    enabled: bool
    problem: str


class CellStop(msgspec.Struct, frozen=True, kw_only=True):
    """The latest stop: `stopping`, then `stopped` until an operator releases it, then `released`.

    While it is not released no run starts; an operator may move arms and tools by hand. `parts` is `reset` once the
    parts of a simulation are back at their initial poses, `absent` in a cell that cannot reset them. `devices` are
    arms and world, in the order of the cell. `real` are the devices with a driver.
    """

    number: int
    phase: Literal["stopping", "stopped", "released"]
    reason: str
    since_unix_s: float
    devices: tuple[StoppedDevice, ...]
    runs: tuple[StoppedRun, ...]
    arms: tuple[ArmRecovery, ...]
    parts: Literal["open", "reset", "absent"]
    real: tuple[DeviceRecovery, ...] = ()
