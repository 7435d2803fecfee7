"""A project folder with Python modules in it, for tests of what may be imported."""

from __future__ import annotations

import sys
from pathlib import Path
from uuid import uuid4

STATE = """
from typing import ClassVar
from engine.state import Context, Outcome, State

class Nod(State, frozen=True, kw_only=True):
    '''Nod.'''
    outcomes: ClassVar[tuple[str, ...]] = ("done",)
    async def run(self, ctx: Context) -> Outcome:
        return Outcome("done")
"""
BEHAVIOR = """\
flexcell: 1
name: {name}
outcomes: [done]
success: [done]
root:
  machine:
    initial: only
    states:
      only: {{state: "{state}", {more}transitions: {{done: done}}}}
"""


class ProjectFolder:
    """Writes modules with names that no other test has, behaviors and the project file."""

    def __init__(self, path: Path) -> None:
        self.path = path
        (path / "behaviors").mkdir()

    def module(self, text: str = STATE) -> str:
        """Write a module and return its name."""
        name = f"module_{uuid4().hex}"
        (self.path / f"{name}.py").write_text(text, encoding="utf-8")
        return name

    def allow(self, *modules: str) -> Path:
        """Write the project file."""
        file = self.path / "flexcell.yaml"
        file.write_text(f"flexcell: 1\nstates: [{', '.join(modules)}]\n", encoding="utf-8")
        return file

    def behavior(self, name: str, state: str = "flow.Wait") -> Path:
        """Write a behavior of one state."""
        file = self.path / "behaviors" / f"{name}.yaml"
        file.write_text(behavior_text(name, state), encoding="utf-8")
        return file


def behavior_text(name: str, state: str) -> str:
    """A behavior of one state."""
    more = "with: {duration_s: 0.01}, " if state == "flow.Wait" else ""
    return BEHAVIOR.format(name=name, state=state, more=more)


def is_imported(module: str) -> bool:
    """Whether this process has imported a module."""
    return module in sys.modules
