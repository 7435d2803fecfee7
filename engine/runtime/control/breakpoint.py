"""Breakpoints pause a run automatically; stored in a file beside the behavior, keyed by state path."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from fnmatch import fnmatchcase
from functools import cached_property
from pathlib import Path
from typing import Annotated, Literal

import msgspec
from msgspec import Meta

from engine.document.expression.expression import Template, compile_template
from engine.document.text.decoding import StrictModel, decode_document
from engine.document.text.yaml_source import load_source
from engine.document.text.yaml_writer import write_yaml
from engine.errors import DocumentError, ExpressionError

GatePoint = Literal["before", "after"]


class Breakpoint(StrictModel, frozen=True, kw_only=True, dict=True, rename={"condition": "if"}):
    """Pause the run `before` the entry or `after` the outcome of the nodes that `path` matches.

    `path` may contain the wildcards `*` and `?`. `condition` (`if:`) is an expression over userdata and
    parameters. The run pauses from hit number `hits` on. `outcomes` limits an `after` breakpoint to
    these outcomes. One with `once` is removed when it has paused the run.
    """

    path: Annotated[str, Meta(min_length=1, description="Node path; may contain the wildcards `*` and `?`")]
    when: GatePoint = "before"
    condition: str | None = None
    hits: Annotated[int, Meta(ge=1, description="Pause from the n-th hit on")] = 1
    outcomes: tuple[str, ...] = ()
    enabled: bool = True
    once: bool = False

    def matches(self, path: str, when: GatePoint, outcome: str) -> bool:
        """Return whether the breakpoint applies to this gate point."""
        if not self.enabled or self.when != when or (self.outcomes and outcome not in self.outcomes):
            return False
        return self.path == path or fnmatchcase(path, self.path)

    def holds(self, read: Callable[[str], object]) -> bool:
        """Return whether its condition is true; `read` returns the value of a userdata key or parameter.

        Raises:
            FlexcellError: a key is not defined there, or the condition is not a boolean.
        """
        if self.template is None:
            return True
        value = self.template.evaluate({name: read(name) for name in self.template.names})
        if not isinstance(value, bool):
            message = f"the condition of the breakpoint evaluates to {value!r}, which is not a boolean"
            raise ExpressionError(message, where=self.path, hint="use a comparison")
        return value

    @cached_property
    def template(self) -> Template | None:
        """The compiled condition; None without a condition."""
        if self.condition is None:
            return None
        return compile_template(self.condition if "${" in self.condition else f"${{{self.condition}}}")


class BreakpointsDocument(StrictModel, frozen=True, kw_only=True):
    """The breakpoints file beside a behavior."""

    flexcell: Literal[1]
    breakpoints: tuple[Breakpoint, ...] = ()


def breakpoints_file(behavior: Path) -> Path:
    """Return the path of the breakpoints file of a behavior file: `pick.yaml` → `pick.breakpoints.yaml`."""
    return behavior.with_name(f"{behavior.stem}.breakpoints.yaml")


def load_breakpoints(behavior: Path) -> tuple[Breakpoint, ...]:
    """Read the breakpoints of a behavior file; empty where the file does not exist.

    Raises:
        DocumentError: the file is not valid; `where` is the position.
    """
    file = breakpoints_file(behavior)
    if not file.is_file():
        return ()
    source = load_source(file)
    document = decode_document(source, BreakpointsDocument)
    for index, each in enumerate(document.breakpoints):
        try:
            _ = each.template
        except ExpressionError as error:
            where = source.position(("breakpoints", index, "if"))
            raise DocumentError(error.message, where=where, hint=error.hint) from None
    return document.breakpoints


def save_breakpoints(behavior: Path, breakpoints: Iterable[Breakpoint]) -> None:
    """Write the breakpoints file atomically; without breakpoints the file is removed."""
    file = breakpoints_file(behavior)
    kept = tuple(breakpoints)
    if not kept:
        file.unlink(missing_ok=True)
        return
    document = BreakpointsDocument(flexcell=1, breakpoints=kept)
    fresh = file.with_name(f".{file.name}.new")
    fresh.write_text(write_yaml(msgspec.to_builtins(document)), encoding="utf-8")
    fresh.replace(file)
