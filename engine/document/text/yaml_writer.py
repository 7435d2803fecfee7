"""Writes plain data as YAML 1.2 text that reads back to the same data; the output is deterministic."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, cast

import yaml

from engine.document.text.core_schema import plain_scalar

_LINE = 80
"""Maximum line length of plain values."""


class _Dumper(yaml.CSafeDumper):
    """PyYAML's dumper that quotes text that YAML 1.1 or 1.2 would read as another type."""

    def ignore_aliases(self, data: Any) -> bool:
        """Write shared values in full; the strict reader refuses aliases."""
        return True

    def represent_mapping(
        self,
        tag: str,
        mapping: Any,
        flow_style: bool | None = None,  # noqa: FBT001 - PyYAML's signature
    ) -> yaml.MappingNode:
        """Write a mapping of plain values on one line if it fits."""
        represent = cast("Callable[..., yaml.MappingNode]", super().represent_mapping)  # pyright: ignore[reportUnknownMemberType]
        node = represent(tag, mapping, flow_style=flow_style)
        pairs = cast("list[tuple[yaml.Node, yaml.Node]]", node.value)
        node.flow_style = _fits([part for pair in pairs for part in pair])
        return node

    def represent_sequence(
        self,
        tag: str,
        sequence: Any,
        flow_style: bool | None = None,  # noqa: FBT001 - PyYAML's signature
    ) -> yaml.SequenceNode:
        """Write a list of plain values on one line if it fits, a list of numbers always."""
        represent = cast("Callable[..., yaml.SequenceNode]", super().represent_sequence)  # pyright: ignore[reportUnknownMemberType]
        node = represent(tag, sequence, flow_style=flow_style)
        items = cast("list[yaml.Node]", node.value)
        numbers = all(item.tag in ("tag:yaml.org,2002:float", "tag:yaml.org,2002:int") for item in items)
        node.flow_style = numbers or _fits(items)
        return node


def _fits(parts: list[yaml.Node]) -> bool:
    """Return whether scalars fit on one line without a line break inside."""
    scalars = [part.value for part in parts if isinstance(part, yaml.ScalarNode)]
    return len(scalars) == len(parts) and sum(len(text) + 2 for text in scalars) <= _LINE


def _represent_text(dumper: _Dumper, text: str) -> yaml.ScalarNode:
    quoted = plain_scalar(text) != text or not text.isprintable() or "${" in text
    style = '"' if quoted else None
    represent = cast("Callable[..., yaml.ScalarNode]", dumper.represent_scalar)  # pyright: ignore[reportUnknownMemberType]
    return represent("tag:yaml.org,2002:str", text, style=style)


_Dumper.add_representer(str, cast("Any", _represent_text))


def write_yaml(data: object) -> str:
    """Return the YAML of mappings, lists, text, numbers, booleans and null; mappings keep their order."""
    return yaml.dump(data, Dumper=_Dumper, sort_keys=False, allow_unicode=True, width=100, default_flow_style=None)
