"""The parameters of the states of devices."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

DeviceName = Annotated[
    str,
    Meta(
        min_length=1,
        description="Name of the device in the cell, such as `vice/jaws`",
        extra_json_schema={"cell_name": "device"},
    ),
]
DevicePositionName = Annotated[
    str,
    Meta(
        min_length=1,
        description="Name of one of its positions",
        extra_json_schema={"cell_name": "position", "of": "device"},
    ),
]
