"""A behavior of so many states in nested containers: chains, branches and ways back, two at once, trees."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import cycle, pairwise

_INNER = (20, 12, 26, 16, 30, 10, 22, 18, 24, 14)
"""States of the innermost containers, in turn."""
_MIDDLE = 6
"""Innermost containers of each container around them."""


def large_document(states: int = 1000) -> str:
    """Return YAML with exactly so many states in containers of 10 to 30, three levels deep."""
    lines = ["flexcell: 1", "name: large", "description: Made to be large.", "outcomes: [finished]"]
    lines += ["success: [finished]", "root:"]
    areas = list(_areas(states))
    names = [f"area_{number}" for number in range(len(areas))]
    inside = dict(zip(names, areas, strict=True))

    def area(indent: str, name: str) -> list[str]:
        sizes = inside[name]
        steps = [f"step_{number}" for number in range(len(sizes))]
        kinds = dict(zip(steps, zip(sizes, cycle((_chain, _branches, _chain, _tree, _branches, _pair))), strict=False))

        def step(deep: str, own: str) -> list[str]:
            size, kind = kinds[own]
            return kind(deep, size)

        return _machine(indent, steps, "done", step)

    lines += _machine("  ", names, "finished", area)
    return "\n".join(lines) + "\n"


def _areas(states: int) -> Iterator[list[int]]:
    sizes = cycle(_INNER)
    left = states
    while left > 0:
        area: list[int] = []
        while left > 0 and len(area) < _MIDDLE:
            area.append(min(left, next(sizes)))
            left -= area[-1]
        yield area


def _machine(indent: str, names: list[str], leave: str, inside: Callable[[str, str], list[str]]) -> list[str]:
    lines = [f"{indent}machine:", f"{indent}  initial: {names[0]}", f"{indent}  states:"]
    for name, follower in pairwise([*names, leave]):
        lines += [f"{indent}    {name}:", *inside(f"{indent}      ", name)]
        outcomes = ("success", "failure") if lines[-1].strip().startswith("- {") else ("done",)
        transitions = ", ".join(f"{outcome}: {follower}" for outcome in outcomes)
        lines.append(f"{indent}      transitions: {{{transitions}}}")
    return lines


def _wait(deep: str, _: str) -> list[str]:
    return [f"{deep}state: flow.Wait  # lets things settle", f"{deep}with: {{duration_s: 0.5}}"]


def _chain(indent: str, size: int) -> list[str]:
    return _machine(indent, [f"wait_{number}" for number in range(size)], "done", _wait)


def _branches(indent: str, size: int) -> list[str]:
    """Every third state decides: on, or back to the one before, so that the layout engine is needed."""
    lines = [f"{indent}machine:", f"{indent}  initial: part_0", f"{indent}  states:"]
    for number in range(size):
        follower = f"part_{number + 1}" if number + 1 < size else "done"
        lines.append(f"{indent}    part_{number}:")
        if number % 3 == 1:
            back = f"part_{number - 1}"
            skip = f"part_{number + 2}" if number + 2 < size and number % 2 else back
            lines += [f"{indent}      state: flow.Decide", f"{indent}      with: {{when: true}}"]
            lines.append(f"{indent}      transitions: {{'true': {follower}, 'false': {skip}}}")
        else:
            lines += _wait(f"{indent}      ", "")
            lines.append(f"{indent}      transitions: {{done: {follower}}}")
    return lines


def _pair(indent: str, size: int) -> list[str]:
    """Two chains at once."""
    left = size // 2
    lines = [f"{indent}concurrency:", f"{indent}  states:"]
    for name, many in (("left", left), ("right", size - left)):
        lines += [f"{indent}    {name}:", *_chain(f"{indent}      ", many)]
    return [*lines, f"{indent}  conditions:", f"{indent}    - done: {{left: done, right: done}}"]


def _tree(indent: str, size: int) -> list[str]:
    lines = [f"{indent}tree:", f"{indent}  sequence:"]
    for number in range(0, size, 4):
        lines.append(f"{indent}    - sequence:")
        lines += [
            f"{indent}        - {{state: flow.Wait, name: leaf_{each}, with: {{duration_s: 0.1}}}}"
            for each in range(number, min(size, number + 4))
        ]
    return lines
