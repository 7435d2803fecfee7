"""How a motion along a given path avoids collisions: the `collisions` of lines, profiles, primitives, guarded moves."""

from __future__ import annotations

from typing import Annotated

import msgspec

from engine.messages import Message

BlockedPathTimeout = Annotated[
    float,
    msgspec.Meta(ge=0.0, le=3600.0, description="Maximum wait for a free path", extra_json_schema={"unit": "s"}),
]
AvoidCollisions = Annotated[
    bool, msgspec.Meta(description="Whether the path is checked for collisions before the motion and during it")
]
MayTouch = Annotated[
    tuple[Annotated[str, msgspec.Meta(extra_json_schema={"cell_name": "body"})], ...],
    msgspec.Meta(description="Names that the arm, and what it holds, may touch: parts, fixtures, other arms"),
]


class CollisionOptions(Message, frozen=True, kw_only=True, omit_defaults=True):
    """Whether the path of a motion is checked, what may be touched, and how long the arm waits for a free path.

    With `avoid` the motion is rejected if it would touch something of the planning scene, and while it moves the
    rest of its path is checked whenever the scene or the occupancy map changes. The arm stops before a contact and
    waits for `patience_s`, then the goal fails. Contact that the motion is meant for needs no `may_touch`: that of the
    tool over the last 5 mm of a path, the contact that ends a guarded move, and that of a force-controlled primitive.
    """

    avoid: AvoidCollisions = True
    may_touch: MayTouch = ()
    patience_s: BlockedPathTimeout = 0.0


PathCollisions = Annotated[
    CollisionOptions,
    msgspec.Meta(description="`{avoid, may_touch, patience_s}`: the check of the path for collisions"),
]
