"""The parameters, inputs and outputs of what a node may run instead, to judge what of a node fits it."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass

import msgspec

from engine.check.analyzed_behavior import template
from engine.document.expression.expression import Template
from engine.document.loader import load_behavior
from engine.editing.project_context import ProjectContext
from engine.editing.text.draft import EditRefused
from engine.errors import DocumentError
from engine.wording.misfit import explain_misfit
from engine.wording.suggestions import did_you_mean

_WORDS = {"with": "parameter", "in": "input key", "out": "output key"}
ValueProblem = Callable[[object], "str | None"]
"""Returns what is wrong with the value of a parameter; None if it is valid."""


@dataclass(frozen=True)
class TypeSignature:
    """What a state or behavior takes: its parameters with their check, its input and output keys."""

    runs: str
    parameters: Mapping[str, ValueProblem]
    keys: Mapping[str, Collection[str]]
    """The keys of `in` and `out`."""

    def problem(self, section: str, name: str, value: object) -> str | None:
        """Return why an entry of `with`, `in` or `out` does not fit; None if it does."""
        declared = self.parameters if section == "with" else self.keys[section]
        if name not in declared:
            return f"`{self.runs}` has no {_WORDS[section]} `{name}`"
        if section != "with":
            return None
        found = template(value)
        # The value of an expression is known to a run only; the check says what it can.
        return self.parameters[name](value) if isinstance(found, Template) and found.constant else None


def type_signature(context: ProjectContext, kind: str, runs: str) -> TypeSignature:
    """Return the signature of a state or of a referenced behavior.

    Raises:
        EditRefused: there is none, or it is broken.
    """
    return _of_state(context, runs) if kind == "state" else _of_behavior(context, runs)


def _of_state(context: ProjectContext, runs: str) -> TypeSignature:
    found = context.signature(runs)
    if found is None:
        hint = did_you_mean(runs, context.catalogue)
        raise EditRefused(f"there is no state `{runs}`, or it is broken", hint=hint)
    parameters = {name: _by_type(key.type) for name, key in found.parameters.items()}
    return TypeSignature(runs, parameters, {"in": found.inputs, "out": found.outputs})


def _by_type(declared: object) -> ValueProblem:
    def problem(value: object) -> str | None:
        try:
            msgspec.convert(value, declared)  # pyright: ignore[reportArgumentType, reportCallIssue]
        except msgspec.ValidationError as error:
            return explain_misfit(error, declared)
        except Exception:
            # The constructor of a custom state may raise anything; a run reports it.
            return None
        return None

    return problem


def _of_behavior(context: ProjectContext, runs: str) -> TypeSignature:
    file = context.file_of(runs) if runs else None
    if file is None:
        raise EditRefused(f"there is no behavior `{runs}` in this project", hint="name a file relative to the document")
    try:
        document = load_behavior(file)
    except DocumentError as error:
        raise EditRefused(f"`{runs}` is not valid: {error.message}", hint="correct it first") from error
    parameters = {name: each.problem for name, each in document.parameters.items()}
    userdata = document.document.userdata
    return TypeSignature(runs, parameters, {"in": userdata, "out": userdata})
