"""The captures of all connections of one device."""

from __future__ import annotations

from pathlib import Path

from robots.io.wire.capture_file import CaptureFile, CaptureLimits
from robots.io.wire.wire_tap import NO_TAP, WireTap


class WireCapture:
    """Makes the taps of a device: to files in a folder, or to nowhere.

    Args:
        folder: Where the files are; None captures nothing.
        device: The device, as on the bus.
        limits: Sizes of each connection's files.
    """

    def __init__(self, folder: Path | None = None, *, device: str = "", limits: CaptureLimits | None = None) -> None:
        self._folder = folder
        self._device = device
        self._limits = limits
        self._files: list[CaptureFile] = []

    @property
    def folder(self) -> Path | None:
        """Where the files are; None where nothing is captured."""
        return self._folder

    def tap(self, protocol: str) -> WireTap:
        """Return the tap of one connection, whose protocol no other connection of the device has."""
        if self._folder is None:
            return NO_TAP
        file = CaptureFile(self._folder, device=self._device, protocol=protocol, limits=self._limits)
        self._files.append(file)
        return WireTap(file.note)

    def close(self) -> None:
        """Write what waits; waits for the disk, a few seconds at most."""
        for file in self._files:
            file.close()


NO_CAPTURE = WireCapture()
