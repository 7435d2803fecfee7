"""Where the controller sends its measurements, and how long it may be silent."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from engine.document import StrictModel

PERIOD_S = 0.004
"""Time between two measurements: `\\SampleRate:=4` of the RAPID program."""


class EgmOptions(StrictModel, frozen=True, kw_only=True):
    """Externally Guided Motion: all motions of the arm are set points; the program FlexcellEgm runs in its motion task.

    `address` is that of this computer in the network of the controller; empty for any.
    """

    port: Annotated[int, Meta(ge=1, le=65535, description="UDP port here, to which the controller sends")] = 6510
    address: Annotated[str, Meta(description="Address of this computer to listen on; empty for any")] = ""
    stale_s: Annotated[
        float, Meta(ge=0.02, le=10.0, description="Seconds without a measurement until the arm counts as lost")
    ] = 0.2
    start_s: Annotated[
        float, Meta(ge=0.5, le=30.0, description="Seconds that guided motion may take to start when it is enabled")
    ] = 5.0
    process_silence_s: Annotated[
        float, Meta(ge=0.1, le=30.0, description="Seconds that its process may be silent until it is ended")
    ] = 0.3
