"""Behavior documents that are damaged, blown up, or filled with hostile expressions; seeded."""

from __future__ import annotations

import json
import random
from collections.abc import Callable, Sequence
from pathlib import Path

from benchmarks.hostile_expressions import hostile_data, hostile_text
from benchmarks.large_document import large_document

_HEAD = "flexcell: 1\nname: hostile\noutcomes: [done]\nsuccess: [done]\n"
_WORDS = ("root", "machine", "states", "initial", "transitions", "with", "done", "foreach", "tree", "guard", "timeout")
_VALUES = (
    "[]",
    "{}",
    "null",
    "-1",
    "1e308",
    "9" * 40,
    '"\\0"',
    "&a [*a]",
    "!!python/object:os.system",
    "${",
    "1 s",
    "~",
)


def base_documents(project: Path) -> tuple[str, ...]:
    """Return what is damaged: the behaviors of the project that need no other file, and a larger one."""
    found = [_alone(file.read_text(encoding="utf-8")) for file in sorted((project / "behaviors").rglob("*.yaml"))]
    return (*(text for text in found if "\nroot:" in text and "behavior:" not in text), large_document(60))


def expression_document(chance: random.Random) -> str:
    """Return a behavior whose only state is given a hostile text and hostile data."""
    state = {"state": "hostile.Take", "with": {"value": hostile_text(chance)}, "out": {"value": "a"}}
    if chance.random() < 0.3:
        state["guard"] = {"when": hostile_text(chance), "to": "done"}
    node = {**state, "transitions": {"done": "take" if chance.random() < 0.02 else "done"}}
    root = {"machine": {"initial": "take", "states": {"take": node}}}
    userdata = {key: value for key, value in hostile_data(chance).items() if value != 10**30}
    return f"{_HEAD}userdata: {json.dumps(userdata)}\nroot: {json.dumps(root)}\n"


def mutated_document(chance: random.Random, bases: Sequence[str]) -> str:
    """Return a document that is damaged in one to five places, rarely one that is far too large."""
    if chance.random() < 0.01:
        return chance.choice(_HUGE)(chance)
    lines = chance.choice(bases).splitlines(keepends=True)
    for _ in range(chance.randint(1, 5)):
        chance.choice(_DAMAGES)(chance, lines)
    return "".join(lines)


def _alone(text: str) -> str:
    return "".join(line for line in text.splitlines(keepends=True) if not line.startswith("cell:"))


def _drop(chance: random.Random, lines: list[str]) -> None:
    if lines:
        del lines[chance.randrange(len(lines))]


def _double(chance: random.Random, lines: list[str]) -> None:
    at = chance.randrange(len(lines) + 1)
    lines[at:at] = lines[max(0, at - chance.randint(1, 8)) : at]


def _swap(chance: random.Random, lines: list[str]) -> None:
    if len(lines) > 1:
        one, other = chance.sample(range(len(lines)), 2)
        lines[one], lines[other] = lines[other], lines[one]


def _set(chance: random.Random, lines: list[str]) -> None:
    if lines:
        at = chance.randrange(len(lines))
        value = chance.choice((*_VALUES, json.dumps(hostile_text(chance))))
        lines[at] = f"{lines[at].partition(':')[0]}: {value}\n"


def _rename(chance: random.Random, lines: list[str]) -> None:
    if lines:
        at = chance.randrange(len(lines))
        lines[at] = lines[at].replace(chance.choice(_WORDS), chance.choice((*_WORDS, "__proto__", "x" * 300)))


def _scribble(chance: random.Random, lines: list[str]) -> None:
    if lines:
        at = chance.randrange(len(lines))
        cut = chance.randrange(len(lines[at]) + 1)
        lines[at] = lines[at][:cut] + chance.choice("{}[]:,&*!|>'\"%@`#\t\x00\ud7ff-") + lines[at][cut:]


_DAMAGES: tuple[Callable[[random.Random, list[str]], None], ...] = (_drop, _double, _swap, _set, _rename, _scribble)


def _states(chance: random.Random) -> str:
    count = chance.choice((1_000, 4_000))
    states = "".join(
        f"      s{number}: {{state: hostile.Take, with: {{value: '${{k{number % 500} + {number}}}'}},"
        f" transitions: {{done: s{number + 1}}}}}\n"
        for number in range(count)
    )
    return f"{_HEAD}root:\n  machine:\n    initial: s0\n    states:\n{states}"


_SUM = '"${a + 1}",'
_HUGE: tuple[Callable[[random.Random], str], ...] = (
    _states,
    lambda _: f'{_HEAD}description: "{"x" * 1_900_000}"\nroot: {{state: flow.Wait}}\n',
    lambda _: f"{_HEAD}userdata: {{xs: [{'1,' * 150_000}1]}}\nroot: {{state: flow.Wait, with: {{duration_s: 0}}}}\n",
    lambda _: f"{_HEAD}root: {{state: hostile.Take, with: {{value: [{_SUM * 4_000}1]}}}}\n",
    lambda _: f"{_HEAD}root: {'{tree: {sequence: [' * 30}{{state: flow.Wait}}{']}}' * 30}\n",
    lambda _: "[" * 1_000_000,
    lambda _: f"{_HEAD}root: {{foreach: {{times: 999999999999, child: {{state: hostile.Take}}}}}}\n",
)
