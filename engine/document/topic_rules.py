"""Topics that a cell document opens to everybody: their names and defaults."""

from __future__ import annotations

from collections.abc import Mapping

from engine.document.parameter_spec import ParameterSpec
from engine.document.text.yaml_source import DataPath, DocumentSource
from engine.errors import DocumentError

RESERVED_NAMESPACES = frozenset(("cell", "people", "store", "teach", "world"))
"""What the bus has below these names is that of flexcell itself."""


def require_topics(topics: Mapping[str, ParameterSpec], source: DocumentSource, *, owners: Mapping[str, str]) -> None:
    """Require names that are not below those of a device, and defaults of their type.

    `owners` are the names of devices, with what they are.

    Raises:
        DocumentError: `where` is the position in the document.
    """
    for name, spec in topics.items():
        first = name.partition("/")[0]
        path: DataPath = ("topics", name)
        if first in owners or first in RESERVED_NAMESPACES:
            owner = f"{owners[first]} `{first}`" if first in owners else "flexcell"
            raise DocumentError(
                f"the topics below `{first}` are those of {owner}",
                where=source.position(path, of_key=True),
                hint="name it after who publishes it: operator/key, line/part_ready",
            )
        problem = spec.problem(spec.default) if not spec.required else None
        if problem is not None:
            raise DocumentError(f"the default of topic `{name}`: {problem}", where=source.position((*path, "default")))
