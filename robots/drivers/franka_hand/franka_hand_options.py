"""The options of the driver `franka_hand`, as a cell document writes them."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from engine.cell.drivers import DriverOptions


class FrankaHandOptions(DriverOptions, frozen=True, kw_only=True, tag="franka_hand"):
    """A Franka Hand at an FR3. Without fingers of others there is nothing to set but its address."""

    host: Annotated[str, Meta(min_length=1, description="Address of the control cabinet; its ports are fixed")]
    period_s: Annotated[float, Meta(ge=0.005, le=0.5, description="Seconds between two readings")] = 0.02
    timeout_s: Annotated[float, Meta(ge=0.02, le=5.0, description="Seconds until a request counts as lost")] = 0.5
    stale_s: Annotated[
        float, Meta(ge=0.1, le=10.0, description="Seconds without a reading until the connection counts as lost")
    ] = 1.0
    patience_s: Annotated[
        float, Meta(ge=1.0, le=600.0, description="Seconds by which a motion of the fingers may be late until it fails")
    ] = 3.0
