"""How a tool works, as its `tool.yaml` says it and as control and simulation use it: one class for each mechanism.

Lengths are metres, angles radians, masses kilograms, forces newtons.
"""

from __future__ import annotations

from typing import Annotated, Self, TypeVar

import msgspec
from msgspec import Meta
from msgspec.structs import replace

from engine.document import StrictModel

Triple = tuple[float, float, float]
Text = Annotated[str, Meta(min_length=1)]
Positive = Annotated[float, Meta(gt=0.0, description="A number above 0")]
M = TypeVar("M", bound="Mechanism")


class PadBox(StrictModel, frozen=True, kw_only=True):
    """A flat part that touches objects, as a box: centre in the frame of its link, full edge lengths."""

    link: Text
    xyz: Triple = (0.0, 0.0, 0.0)
    size_m: tuple[Positive, Positive, Positive]

    def with_prefix(self, prefix: str) -> PadBox:
        """Return it on a link whose name begins with `prefix`."""
        return replace(self, link=prefix + self.link)


class Mechanism(StrictModel, frozen=True, kw_only=True, tag_field="kind"):
    """Base of all mechanisms; `kind` in the document selects the class.

    Names of links and joints are those of the tool's own URDF in the document, and have the tool's prefix on the arm.
    """

    # Models are keys of caches; the hash of a struct refuses mappings, which are frozen by convention here.
    def __hash__(self) -> int:
        """Return a hash of the type and all values."""
        return hash(msgspec.json.encode(self))

    def joint_names(self) -> tuple[str, ...]:
        """Return the joints that it names."""
        return ()

    def link_names(self) -> tuple[str, ...]:
        """Return the links that it names."""
        return ()

    def joints_at(self, opening_m: float) -> dict[str, float]:
        """Return its joints (metres or radians) at an opening of its fingers; empty for a mechanism without fingers."""
        return {}

    def with_prefix(self, prefix: str) -> Self:
        """Return it with `prefix` before its link and joint names."""
        raise NotImplementedError


def with_prefix_each(prefix: str, names: tuple[str, str]) -> tuple[str, str]:
    """Return two names with `prefix` before each."""
    return prefix + names[0], prefix + names[1]
