"""Userdata as the reference interpreter has it: values of containers, each inside another."""

from __future__ import annotations

from dataclasses import dataclass

from engine.document import compile_template
from engine.errors import ExpressionError


class Failed(Exception):
    """A key is missing, or a value does not fit."""


@dataclass
class Scope:
    """Values of a container; `walled` keeps the writes of a branch inside, but for keys that are shared."""

    values: dict[str, object]
    outer: Scope | None = None
    walled: bool = False
    shared: frozenset[str] = frozenset()

    def read(self, key: str) -> object:
        if key in self.values:
            return self.values[key]
        if self.outer is None:
            raise Failed(key)
        return self.outer.read(key)

    def has(self, key: str) -> bool:
        return key in self.values or (self.outer is not None and self.outer.has(key))

    def write(self, key: str, value: object) -> None:
        made_in = self
        scope: Scope | None = self
        while scope is not None and key not in scope.values:
            if scope.walled and key not in scope.shared:
                break
            # A shared key that is new is made outside of the branches.
            made_in = scope.outer if scope.walled and made_in is self and scope.outer is not None else made_in
            scope = scope.outer
        (scope or made_in).values[key] = value

    def evaluate(self, template: object) -> object:
        compiled = compile_template(template)
        try:
            return compiled.evaluate({name: self.read(name) for name in compiled.names})
        except ExpressionError as error:
            raise Failed from error
