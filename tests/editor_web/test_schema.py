"""What crosses the border to the browser is described, committed and current."""

from __future__ import annotations

import re

from editor_web.schema import OPENAPI, TYPES, openapi, typescript


def test_the_committed_description_of_the_http_interface_is_current() -> None:
    """Else run `python -m editor_web.schema`."""
    assert OPENAPI.read_text(encoding="utf-8") == openapi()


def test_the_committed_typescript_types_are_current() -> None:
    """Else run `python -m editor_web.schema`."""
    assert TYPES.read_text(encoding="utf-8") == typescript()


def test_every_field_has_a_type() -> None:
    """`unknown` only where the value is anything by its nature."""
    unknown = {line.strip() for line in typescript().splitlines() if re.search(r"^  readonly .*\bunknown\b", line)}
    assert sorted(unknown) == [
        "readonly after: unknown",
        "readonly arguments: Dict<unknown>",
        "readonly base: unknown",
        "readonly before: unknown",
        "readonly changed: Dict<readonly [unknown, unknown]>",
        "readonly changes: Dict<unknown>",
        "readonly default: unknown",
        "readonly every: unknown",
        "readonly executed: readonly unknown[]",
        "readonly failing: readonly unknown[]",
        "readonly feedback: unknown",
        "readonly guard: Dict<unknown> | null",
        "readonly inputs: Dict<unknown>",
        "readonly inputs?: Dict<unknown>",
        "readonly message: Dict<unknown>",
        "readonly message: unknown",
        "readonly mine: unknown",
        "readonly nominal: unknown",
        "readonly options: Dict<unknown>",
        "readonly options: readonly unknown[]",
        "readonly parameters: Dict<Dict<unknown>>",
        "readonly parameters: Dict<unknown>",
        "readonly parameters?: Dict<unknown>",
        "readonly passes: Dict<unknown>",
        "readonly post: Dict<unknown> | null",
        "readonly request: Dict<unknown>",
        "readonly request?: Dict<unknown>",
        "readonly result: unknown",
        "readonly result?: Dict<unknown> | null",
        "readonly result?: unknown",
        "readonly retry: Dict<unknown> | null",
        "readonly schema: Dict<unknown>",
        "readonly settings: Dict<unknown>",
        "readonly theirs: unknown",
        "readonly timeout: Dict<unknown> | null",
        "readonly userdata: Dict<unknown>",
        "readonly value: Dict<unknown>",
        "readonly value: unknown",
        "readonly value?: Dict<unknown> | null",
        "readonly value?: unknown",
        "readonly values: Dict<unknown>",
        "readonly values?: readonly unknown[] | null",
    ]
