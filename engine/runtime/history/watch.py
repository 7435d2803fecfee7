"""Watches: expressions over the userdata of a run, evaluated at any time of it as a node would read it."""

from __future__ import annotations

from typing import Annotated

import msgspec
from msgspec import Meta

from engine.document.expression.expression import compile_template
from engine.errors import ExpressionError
from engine.runtime.history.userdata_history import UserdataHistory
from engine.wording.suggestions import did_you_mean

MAX_WATCHES = 40


class Watch(msgspec.Struct, frozen=True, kw_only=True):
    """An expression, with or without `${…}`, as the node at `path` would read it.

    Without a path the innermost active container that has a name counts.
    """

    expression: Annotated[str, Meta(max_length=1000)]
    path: Annotated[str, Meta(max_length=4000)] = ""


class WatchValue(msgspec.Struct, frozen=True, kw_only=True):
    """Its value; `problem` says why there is none."""

    value: object = None
    problem: str = ""


def evaluate_watch(watch: Watch, userdata: UserdataHistory) -> WatchValue:
    """Return the value of a watch for the userdata as it is."""
    written = watch.expression
    if not written.strip():
        return WatchValue(problem="there is no expression")
    try:
        template = compile_template(written if "${" in written else f"${{{written}}}")
        values = userdata.values_at(watch.path)
        missing = sorted(template.names.difference(values))
        if missing:
            return WatchValue(problem=f"`{missing[0]}` is not defined here; {did_you_mean(missing[0], values)}")
        return WatchValue(value=template.evaluate(values))
    except ExpressionError as error:
        return WatchValue(problem=f"{error.message}; {error.hint}" if error.hint else error.message)
