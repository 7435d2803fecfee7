"""One configuration of a sweep as a sweep of its own: a case that is kept with a project."""

from __future__ import annotations

import os
from pathlib import Path

import msgspec

from engine.document.sweep import NO_FILE, Sweep
from engine.document.text.yaml_writer import write_yaml
from engine.sweep.execution.trial_result import TrialResult

_FILES = ("faults", "substitutes")


def case_document(sweep: Sweep, result: TrialResult, file: Path, *, placement_noise: bool | None = None) -> bytes:
    """Return a sweep document with the configuration of a result, which requires that it succeeds.

    Args:
        sweep: The sweep that the result is of.
        result: The result.
        file: Where the document is written: its paths are relative to it.
        placement_noise: Whether the result is with placement noise; by default as in the sweep.
    """
    document, configuration = sweep.document, result.configuration

    def moved(path: str) -> str:
        return path if path == NO_FILE else os.path.relpath(sweep.resolve(path), file.parent.resolve())

    values = {
        address: moved(str(value)) if address in _FILES else value
        for address, value in configuration.values.items()
        if address != "seed"
    }
    data: dict[str, object] = {
        "flexcell": 1,
        "description": f"Ended with {result.label}: {result.cause}",
        "behavior": moved(document.behavior),
    }
    for key in ("cell", "store", *_FILES):
        written: str | None = getattr(document, key)
        if written is not None:
            data[key] = moved(written)
    for key in ("parameters", "inputs"):
        if getattr(document, key):
            data[key] = getattr(document, key)
    data["factors"] = {
        "seed": {"values": [configuration.seed]},
        **{address: {"values": [value]} for address, value in values.items()},
    }
    noise = document.placement_noise if placement_noise is None else placement_noise
    data |= {"design": "grid", "runs": 1, "require": "success >= 1", "placement_noise": noise}
    return write_yaml(msgspec.to_builtins(data)).encode()
