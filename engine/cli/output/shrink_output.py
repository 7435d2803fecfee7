"""What `flexcell sweep shrink` writes: progress on stderr, and the smallest change that still fails."""

from __future__ import annotations

import sys

from engine.sweep.report.words import value_text
from engine.sweep.shrinking import ShrinkProgress, Shrunk

_EVERY = 5


def show_shrinking(progress: ShrinkProgress) -> None:
    """Print how far it is, every few runs."""
    if progress.runs % _EVERY == 1:
        changed = ", ".join(progress.changed) or "nothing"
        sys.stderr.write(f"{progress.runs} of at most {progress.most_runs}: {progress.step}; still varied: {changed}\n")
        sys.stderr.flush()


def shrunk_text(found: Shrunk) -> str:
    """Return what is left of a failing configuration, a line for each factor."""
    lines = [f"{found.result.label}: {found.result.cause}"]
    for address, (nominal, value) in found.changed.items():
        near = f"; with {value_text(found.passes[address])} it does not fail so" if address in found.passes else ""
        lines.append(f"  {address}: {value} instead of {nominal}{near}")
    seed = found.result.configuration.seed
    if not found.changed:
        alone = f"seed {seed} alone fails" if found.seed_matters else "it fails with all nominal values"
        lines.append(f"  nothing is varied: {alone}")
    chance = f"seed {seed}: with the nominal one it does not fail so" if found.seed_matters else f"seed {seed}"
    noise = "with" if found.placement_noise else "without"
    lines.append(f"  {chance}; {noise} placement noise")
    lines.append(f"{'interrupted after' if found.interrupted else 'found in'} {found.runs} runs")
    return "\n".join(lines) + "\n"
