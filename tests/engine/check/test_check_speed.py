"""The check takes time in proportion to the document, also where data goes round and round."""

from __future__ import annotations

import time
from collections.abc import Callable

import pytest

from engine.check import check_behavior
from engine.document import parse_behavior
from engine.registry import load_states
from tests.tiers import nightly

CATALOGUE = load_states()
HEAD = "flexcell: 1\nname: large\noutcomes: [done, failed]\nsuccess: [done]\nuserdata: {n: 0}\n"
MACHINE = HEAD + "root:\n  machine:\n    initial: s0\n    states:\n"


def chain_with_data(size: int) -> str:
    """A chain that counts, decides, and goes back a little, with a key of its own at every fourth state."""
    lines: list[str] = []
    for i in range(size):
        to = f"s{i + 1}" if i < size - 1 else "done"
        back = f"s{max(0, i - 50)}"
        states = (
            f"{{state: flow.SetValue, with: {{value: '${{n + {i}}}'}}, out: {{value: n}}, "
            f"transitions: {{done: {to}}}}}",
            "{state: gripper.Grasp, with: {gripper: left, width_m: 0.03}, "
            f"out: {{held: h{i}}}, transitions: {{held: {to}, missed: {back}, failed: failed}}}}",
            f"{{state: flow.Decide, with: {{when: '${{h{i - 1}}}'}}, transitions: {{'true': {to}, 'false': failed}}}}",
            f"{{state: flow.Wait, with: {{duration_s: '${{n}}'}}, transitions: {{done: {to}}}}}",
        )
        lines.append(f"      s{i}: {states[i % 4]}\n")
    return MACHINE + "".join(lines)


def ring_of_copies(size: int) -> str:
    """A loop in which each state copies the key that the next one writes."""
    return MACHINE + "".join(
        f"      s{i}: {{state: flow.SetValue, with: {{value: '${{n{i + 1}}}'}}, out: {{value: n{i}}}, "
        f"transitions: {{done: s{(i + 1) % size}}}}}\n"
        for i in range(size)
    )


def jumps(size: int) -> str:
    """A graph in which everything leads everywhere and all states write one key."""
    return MACHINE + "".join(
        f"      s{i}: {{state: gripper.Grasp, with: {{gripper: left, width_m: '${{n}}'}}, out: {{width_m: n}}, "
        f"transitions: {{held: s{(i * 7 + 1) % size}, missed: s{(i * 13 + 5) % size}, failed: s{(i + 1) % size}}}}}\n"
        for i in range(size)
    )


def wide(size: int) -> str:
    """Branches that all read and write one key, and a condition for each."""
    branch = "{machine: {initial: a, states: {a: {state: flow.SetValue, with: {value: '${n}'}, out: {value: n}, transitions: {done: b}}, b: {state: flow.Log, with: {message: '${string(n)}'}, transitions: {done: done}}}}}"  # noqa: E501
    children = "".join(f"      b{i}: {branch}\n" for i in range(size))
    rules = "".join(f"      - {{done: {{b{i}: done}}}}\n" for i in range(size))
    return f"{HEAD}root:\n  concurrency:\n    states:\n{children}    conditions:\n{rules}"


@pytest.mark.parametrize(
    ("make", "size"),
    [(chain_with_data, 3000), nightly(chain_with_data, 10_000), (ring_of_copies, 3000), (jumps, 3000), (wide, 1500)],
)
def test_a_large_behavior_is_checked_within_seconds(make: Callable[[int], str], size: int) -> None:
    """Generous: what takes seconds here took minutes when it grew with the square of the size."""
    behavior = parse_behavior(make(size), file="large.yaml")
    start = time.process_time()
    check_behavior(behavior, CATALOGUE)
    assert time.process_time() - start < 8.0
