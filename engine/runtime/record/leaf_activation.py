"""What one activation of a state was given, sent and wrote: what its state class needs to undo it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from engine.state import ActivationRecord, RequestRecord


@dataclass(kw_only=True)
class LeafActivation:
    """One activation of a state: its entry event, inputs, requests and outputs."""

    path: str
    visit: int
    seq: int
    shown: dict[str, object]
    """Parameters and inputs, as plain data."""
    outcome: str = ""
    requests: dict[str, RequestRecord] = field(default_factory=dict[str, RequestRecord])
    """By the name of the goal or call."""
    replaced: bool = False
    """Whether a hot change has replaced its class since."""
    written: dict[str, object] = field(default_factory=dict[str, object])
    """The values it wrote last, by the key of its container."""

    def record(self, *, inputs: Iterable[str], outputs: Mapping[str, str]) -> ActivationRecord:
        """Return the activation as its state class expects it.

        Args:
            inputs: The input keys of the class.
            outputs: The container keys that its output keys are written to.
        """
        own = {target: key for key, target in outputs.items()}
        return ActivationRecord(
            inputs={key: self.shown[key] for key in inputs if key in self.shown},
            outcome=self.outcome,
            outputs={own.get(key, key): value for key, value in self.written.items()},
            requests=tuple(self.requests.values()),
        )
