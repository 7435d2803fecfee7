"""A magnet that outputs switch: its port and what serves it."""

from __future__ import annotations

from robots.magnet.magnet_port import MagnetSample
from robots.magnet.magnet_server import MagnetServer
from robots.switched.switch_motion import SwitchMotion
from robots.switched.switched_drive import SwitchedDrive
from robots.switched.switched_kind import SwitchedKind


class SwitchedMagnetPort:
    """Implements `MagnetPort`; the pull is that of the model while it is on, and not measured."""

    def __init__(self, drive: SwitchedDrive) -> None:
        self._drive = drive

    @property
    def max_force_n(self) -> float:
        """Pull on a plate that covers its face, of the model."""
        return self._drive.tool.max_force_n

    def sample(self) -> MagnetSample:
        """Return what is known; raises RobotError where the outputs are not."""
        reading = self._drive.reading()
        return MagnetSample(
            time_s=reading.time_s,
            on=reading.holds,
            pull_n=self.max_force_n if reading.contact else 0.0,
            contact=reading.contact,
            evidence=reading.evidence,
        )

    def switch(self, *, on: bool) -> SwitchMotion:
        """Switch; raises RobotError where it may not be switched, or is being switched."""
        return self._drive.start(holds=on)


class _SwitchedMagnetKind:
    """Implements `SwitchedKind` for magnets."""

    def server(self, name: str, drive: SwitchedDrive) -> MagnetServer:
        """Return the server of a magnet."""
        return MagnetServer(name=name, port=SwitchedMagnetPort(drive))


SWITCHED_MAGNET_KIND: SwitchedKind = _SwitchedMagnetKind()
