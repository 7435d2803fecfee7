"""The blocking wire to one device, used by one thread: open, read, write, close."""

from __future__ import annotations

from typing import Protocol, TypeVar

Reading_co = TypeVar("Reading_co", covariant=True)
Command_contra = TypeVar("Command_contra", contravariant=True)


class DeviceTransport(Protocol[Reading_co, Command_contra]):
    """Each call ends within the transport's time limit, or raises LinkError."""

    @property
    def address(self) -> str:
        """Where the device is, for messages: `192.168.1.11:502`, `/dev/ttyUSB0`."""
        ...

    @property
    def remedy(self) -> str:
        """What to check when it does not answer."""
        ...

    def open(self) -> None:
        """Connect; commands nothing."""
        ...

    def close(self) -> None:
        """Disconnect; does nothing when it is not connected."""
        ...

    def read(self) -> Reading_co:
        """Return what the device measures."""
        ...

    def write(self, command: Command_contra) -> None:
        """Send a command and return when the device has acknowledged it."""
        ...
