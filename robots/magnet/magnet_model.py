"""The mechanism of a switchable magnet."""

from __future__ import annotations

from msgspec.structs import replace

from robots.model.mechanism import Mechanism, PadBox, Positive


class MagnetModel(Mechanism, frozen=True, kw_only=True, tag="magnet"):
    """A switchable magnet: it holds objects at its face with up to `max_force_n`.

    `face` is the flat pole face, its box's z axis pointing out of it; ferrous parts within `reach_m` of it are
    attracted. The field takes `switch_s` to rise or fall.
    """

    face: PadBox
    max_force_n: Positive
    reach_m: Positive
    max_payload_kg: Positive
    switch_s: Positive = 0.2

    def link_names(self) -> tuple[str, ...]:
        """Return the link of the face."""
        return (self.face.link,)

    def with_prefix(self, prefix: str) -> MagnetModel:
        """Return it with `prefix` before its link names."""
        return replace(self, face=self.face.with_prefix(prefix))
