"""A project whose behavior ends as its parameters say, for tests of sweeps: no robot, no simulation."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import msgspec

from engine.document.sweep import Sweep, parse_sweep
from tests.engine.project_folder import ProjectFolder

LUCK = """
import os
import signal

from typing import ClassVar

from engine.errors import StateError
from engine.state import Context, Outcome, State


class Try(State, frozen=True, kw_only=True):
    '''Succeed if `luck` is below `rate`, else do what `otherwise` says.'''

    outcomes: ClassVar[tuple[str, ...]] = ("done", "missed")
    luck: float = 0.0
    rate: float = 0.5
    otherwise: str = "miss"

    async def run(self, ctx: Context) -> Outcome:
        await ctx.clock.sleep(1.0 + self.luck)
        if self.luck < self.rate:
            return Outcome("done")
        match self.otherwise:
            case "miss":
                return Outcome("missed")
            case "raise":
                raise StateError(f"the luck was {self.luck:.3f}", where="cup", hint="try again")
            case "die":
                os.kill(os.getpid(), signal.SIGKILL)
            case "exit":
                os._exit(7)
            case "orphan":
                os.kill(os.getppid(), signal.SIGKILL)
                signal.pause()
            case "hang":
                signal.pause()
            case "eat":
                bytearray(64 * 2**30)
            case "forever":
                await ctx.clock.sleep(1e6)
            case "print":
                print("a state prints")
        return Outcome("missed")
"""
BEHAVIOR = """\
flexcell: 1
name: luck
parameters:
  luck: {{type: number, default: 0.0, minimum: 0.0, maximum: 1.0, description: Drawn}}
  rate: {{type: number, default: 0.5, minimum: 0.0, maximum: 1.0, description: Of success}}
  otherwise: {{type: string, default: miss, description: What it does without luck}}
outcomes: [done, missed]
success: [done]
root:
  machine:
    initial: only
    states:
      only:
        state: "{module}:Try"
        with: {{luck: "${{luck}}", rate: "${{rate}}", otherwise: "${{otherwise}}"}}
        transitions: {{done: done, missed: missed}}
"""


class LuckProject:
    """A folder with the behavior; each of its runs succeeds with the probability `rate`."""

    def __init__(self, path: Path) -> None:
        self.path = path
        folder = ProjectFolder(path)
        self.module = folder.module(LUCK)
        folder.allow(self.module)
        self.behavior = path / "luck.yaml"
        self.behavior.write_text(BEHAVIOR.format(module=self.module), encoding="utf-8")

    def sweep(self, **keys: object) -> Sweep:
        """Return a sweep over `luck`, with further keys of its document."""
        return parse_sweep(self.text(**keys), file=self.path / "sweep.yaml")

    def write(self, **keys: object) -> Path:
        """Write the document of `sweep` and return its file."""
        file = self.path / "sweep.yaml"
        file.write_bytes(self.text(**keys))
        return file

    def text(self, **keys: object) -> bytes:
        """Return the document of `sweep`."""
        factors: Mapping[str, object] = {"parameters.luck": {"uniform": [0.0, 1.0]}}
        document = {"flexcell": 1, "behavior": "luck.yaml", "factors": factors, **keys}
        return msgspec.json.encode(document)
