"""Plain data to YAML 1.2 text that reads back to the same data, byte for byte the same each time."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, cast

import yaml

from engine.document.yaml_source import plain_scalar


class _Dumper(yaml.CSafeDumper):
    """PyYAML's dumper with text quoted wherever YAML 1.1 or 1.2 would read something else."""

    def ignore_aliases(self, data: Any) -> bool:
        """Write shared values out; the strict reader refuses aliases."""
        return True


def _represent_text(dumper: _Dumper, text: str) -> yaml.ScalarNode:
    style = '"' if plain_scalar(text) != text or not text.isprintable() else None
    represent = cast("Callable[..., yaml.ScalarNode]", dumper.represent_scalar)  # pyright: ignore[reportUnknownMemberType]
    return represent("tag:yaml.org,2002:str", text, style=style)


_Dumper.add_representer(str, cast("Any", _represent_text))


def write_yaml(data: object) -> str:
    """Return the YAML of mappings, lists, text, numbers, booleans and null; mappings keep their order."""
    return yaml.dump(data, Dumper=_Dumper, sort_keys=False, allow_unicode=True, width=100, default_flow_style=None)
