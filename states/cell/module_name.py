"""Parameter types for modules and connectors of a cell."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

ModuleName = Annotated[
    str, Meta(min_length=1, description="Name of the module in the cell", extra_json_schema={"cell_name": "module"})
]
ConnectorName = Annotated[
    str,
    Meta(
        description="Name of the connector; empty for the one that the cell document names",
        extra_json_schema={"cell_name": "connector"},
    ),
]
