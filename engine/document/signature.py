"""Signature of a state class: outcomes, parameters, input and output keys."""

from __future__ import annotations

import inspect
import typing
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any

import msgspec

from engine.errors import StateError
from engine.state import State
from engine.type_preparation import prepare_type

Schema = Mapping[str, object]


@dataclass(frozen=True, kw_only=True)
class KeySignature:
    """One parameter, input key or output key.

    `schema` is its JSON Schema, with description and unit if the class declares them; `default`
    is valid if it is not `required`.
    """

    name: str
    type: Any
    required: bool
    default: object
    schema: Schema


@dataclass(frozen=True, kw_only=True)
class StateSignature:
    """The signature of a state for documents and the palette."""

    name: str
    doc: str
    outcomes: tuple[str, ...]
    success: tuple[str, ...]
    parameters: Mapping[str, KeySignature]
    inputs: Mapping[str, KeySignature]
    outputs: Mapping[str, KeySignature]
    instant: bool = False
    observes: bool = False
    unwritten: Mapping[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])
    state: type[State] = field(repr=False)

    def passed_on(self, output: str) -> str | None:
        """Return the parameter whose value an output repeats, as declared by the class; else None."""
        return next((key.name for key in self.parameters.values() if key.schema.get("output") == output), None)

    @property
    def commands_hardware(self) -> bool:
        """Whether its class leases devices while it runs."""
        return self.state.resources is not State.resources

    @property
    def has_arm_targets(self) -> bool:
        """Whether its class declares arm targets."""
        return self.state.arm_targets is not State.arm_targets

    @property
    def summary(self) -> str:
        """The first line of its documentation."""
        return self.doc.partition("\n")[0]


@lru_cache(maxsize=4096)
def read_signature(state: type[State]) -> StateSignature:
    """Describe a state class.

    Raises:
        StateError: the class breaks the rules of states; names the class and the rule.
    """
    try:
        return _describe(state)
    except StateError:
        raise
    except (Exception, SystemExit) as error:
        # Annotations and default factories are user code, which may raise anything.
        raise _broken(state, f"describing it raised {type(error).__name__}: {error}", "correct the class") from error


def _describe(state: type[State]) -> StateSignature:
    name = state.state_name or f"{state.__module__}:{state.__qualname__}"
    if not state.outcomes:
        raise _broken(state, "it declares no outcomes", "add `outcomes: ClassVar[tuple[str, ...]] = (…)`")
    unknown = [outcome for outcome in state.success if outcome not in state.outcomes]
    if unknown:
        raise _broken(state, f"its success names `{unknown[0]}`, which is not one of its outcomes", "correct `success`")
    for outcome, keys in state.unwritten.items():
        if outcome not in state.outcomes or not set(keys) <= set(state.outputs):
            raise _broken(state, f"its `unwritten` names an unknown outcome or key: {outcome}", "correct `unwritten`")
    prepare_type(state)
    return StateSignature(
        name=name,
        doc=inspect.getdoc(state) or "",
        outcomes=state.outcomes,
        success=state.success,
        parameters=_parameters(state),
        inputs=_inputs(state),
        outputs={key: _key(key, kind, required=True, default=None) for key, kind in state.outputs.items()},
        instant=state.instant,
        observes=state.observes,
        unwritten=state.unwritten,
        state=state,
    )


def _parameters(state: type[State]) -> dict[str, KeySignature]:
    return {
        found.encode_name: _key(found.encode_name, found.type, required=found.required, default=_default(found))
        for found in msgspec.structs.fields(state)
    }


def _default(found: msgspec.structs.FieldInfo) -> object:
    if found.default_factory is not msgspec.NODEFAULT:
        return found.default_factory()
    return None if found.required else found.default


def _inputs(state: type[State]) -> dict[str, KeySignature]:
    run = getattr(state, "run", None)
    if run is None:
        raise _broken(state, "it has no `run`", "add `async def run(self, ctx: Context) -> Outcome`")
    if not inspect.iscoroutinefunction(run):
        raise _broken(state, "its `run` is not a coroutine", "write `async def run(self, ctx) -> Outcome`")
    try:
        hints = typing.get_type_hints(run, include_extras=True)
    except NameError as error:
        raise _broken(state, f"an annotation of `run` cannot be read: {error}", "import the name it uses") from error
    inputs: dict[str, KeySignature] = {}
    for argument in list(inspect.signature(run).parameters.values())[2:]:
        if argument.kind is not inspect.Parameter.KEYWORD_ONLY:
            raise _broken(state, f"the input `{argument.name}` of `run` is positional", "write `*` before the inputs")
        if argument.name not in hints:
            raise _broken(state, f"the input `{argument.name}` of `run` has no type", "annotate it")
        required = argument.default is inspect.Parameter.empty
        default = None if required else argument.default
        inputs[argument.name] = _key(argument.name, hints[argument.name], required=required, default=default)
    return inputs


def _key(name: str, kind: Any, *, required: bool, default: object) -> KeySignature:
    schema = msgspec.json.schema(kind, schema_hook=_schema_of_custom)
    return KeySignature(name=name, type=kind, required=required, default=default, schema=schema)


def _schema_of_custom(kind: type) -> dict[str, object]:
    return {"description": "any value" if kind is object else f"a {kind.__name__}"}


def _broken(state: type[State], what: str, advice: str) -> StateError:
    return StateError(what, where=f"{state.__module__}:{state.__qualname__}", hint=advice)
