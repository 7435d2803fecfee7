"""What a driver reports of its device without commanding it: the rows of `flexcell devices`."""

from __future__ import annotations

from collections.abc import Sequence
from statistics import median

import msgspec


class RoundTrip(msgspec.Struct, frozen=True, kw_only=True):
    """How long the device took to answer readings, in seconds."""

    readings: int
    min_s: float
    median_s: float
    max_s: float

    @staticmethod
    def of(times_s: Sequence[float]) -> RoundTrip:
        """Sum up measured times, of which there is at least one."""
        return RoundTrip(readings=len(times_s), min_s=min(times_s), median_s=median(times_s), max_s=max(times_s))


class DeviceReport(msgspec.Struct, frozen=True, kw_only=True):
    """One device as it answered; with an `error` it did not, and nothing of it is known.

    `inputs` and `outputs` are the digital ones of a controller, by number.
    `state` is what the device says of itself, in words. `fault` is its fault by name, empty for none.
    `clock_offset_s` is the device's clock minus ours; None for a device without a clock.
    """

    device: str
    driver: str
    address: str
    state: str = ""
    fault: str = ""
    firmware: str = ""
    readings: dict[str, float] = {}
    inputs: tuple[bool, ...] = ()
    outputs: tuple[bool, ...] = ()
    round_trip: RoundTrip | None = None
    clock_offset_s: float | None = None
    capabilities: tuple[str, ...] = ()
    proven: str = ""
    error: str = ""
    hint: str = ""
