"""Measures how often a device is read and how long it was silent, in intervals of half a second."""

from __future__ import annotations

import math

from engine.messages.device_state import DeviceLink

INTERVAL_S = 0.5
_LONGEST_S = 3600.0


class LinkMeter:
    """Counts the readings of one device; belongs to the event loop."""

    def __init__(self) -> None:
        self._since_s = math.nan
        self._readings = 0
        self._gap_s = 0.0
        self._hz = self._longest_gap_s = 0.0

    def note(self, now_s: float, *, readings: int, age_s: float) -> bool:
        """Note the number of readings so far and the age of the last one; return whether an interval has ended."""
        if math.isnan(self._since_s) or readings < self._readings:
            # The first call, or a device that was opened anew and counts from 0.
            self._since_s, self._readings, self._gap_s = now_s, readings, 0.0
        self._gap_s = max(self._gap_s, age_s)
        passed_s = now_s - self._since_s
        if passed_s < INTERVAL_S:
            return False
        self._hz, self._longest_gap_s = (readings - self._readings) / passed_s, self._gap_s
        self._since_s, self._readings, self._gap_s = now_s, readings, 0.0
        return True

    def link(self, *, age_s: float, speed_scaling: float | None = None) -> DeviceLink:
        """Return the figures of the last interval, with the present age of the last reading."""
        return DeviceLink(
            readings_hz=round(self._hz, 1),
            longest_gap_s=round(min(self._longest_gap_s, _LONGEST_S), 3),
            age_s=round(min(age_s, _LONGEST_S), 2),
            speed_scaling=speed_scaling,
        )
