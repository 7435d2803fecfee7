"""Parameter types of the states that read and write named entries."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from engine.store import STANDARD_KINDS

EntryKindName = Annotated[
    str,
    Meta(
        description="Kind of entry: joints, pose, dmp, record",
        examples=list(STANDARD_KINDS),
        extra_json_schema={"entry_kind": True},
    ),
]
"""A store may have more kinds than the standard ones."""
StoredEntryName = Annotated[str, Meta(description="Name of the entry", extra_json_schema={"entry_of": "kind"})]
"""An entry of the kind that the parameter `kind` names; a missing one is an outcome, and no mistake."""
NewEntryName = Annotated[str, Meta(description="Name of the entry", extra_json_schema={"new_entry_of": "kind"})]
