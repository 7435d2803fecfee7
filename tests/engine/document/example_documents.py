"""Random valid behavior documents as plain data, for the round trips of loader and writer."""

from __future__ import annotations

from typing import Any

from hypothesis import strategies as st

Plain = dict[str, object]
Drawn = dict[str, st.SearchStrategy[Any]]

WORDS = st.sampled_from(["go", "look", "s1", "on", "no", "null", "true", "0x10", "1e3", "12", "_a", "A-b"])
OUTCOMES = st.sampled_from(["done", "failed", "lost"])
KEYS = st.sampled_from(["part", "count", "speed_m_s", "_k"])
TEXTS = st.text(st.characters(min_codepoint=32, max_codepoint=0x2FF, exclude_characters="\x7f"), max_size=12).map(
    lambda text: "".join(c for c in text if not 0x7F <= ord(c) < 0xA0)
)
NUMBERS = st.floats(allow_nan=False, allow_infinity=False) | st.integers(-(2**63), 2**63 - 1)
SCALARS = st.none() | st.booleans() | NUMBERS | TEXTS
VALUES = st.recursive(
    SCALARS, lambda inner: st.lists(inner, max_size=3) | st.dictionaries(TEXTS, inner, max_size=3), max_leaves=6
)
UNITS = st.sampled_from([" ms", "s", " min", " h"])
DURATIONS = st.floats(0, 1e6) | st.tuples(st.integers(0, 999).map(str), UNITS).map("".join)


def merged(own: Plain, common: Plain) -> Plain:
    """Return both mappings as one."""
    return {**own, **common}


def as_condition(outcome: str, when: dict[str, str]) -> dict[str, dict[str, str]]:
    """Return one entry of `conditions`."""
    return {outcome: when}


def as_preempting(whom: list[str], when: dict[str, str]) -> Plain:
    """Return one entry of `conditions` that decides nothing."""
    return {"preempt": whom, "when": when}


def keyed(required: Drawn, optional: Drawn | None = None) -> st.SearchStrategy[Plain]:
    """Draw a mapping with some keys, and others that may be absent."""
    return st.fixed_dictionaries(required, optional=optional or {})


COMMON = keyed(
    {},
    {
        "timeout": keyed({"after": DURATIONS, "to": OUTCOMES}),
        "retry": keyed({"times": st.integers(1, 9)}, {"backoff": DURATIONS, "errors": st.booleans()}),
        "on_error": OUTCOMES,
        "description": TEXTS,
    },
)
WIRING = keyed({}, {"transitions": st.dictionaries(OUTCOMES, OUTCOMES, max_size=3)})
LEAVES = st.builds(
    merged,
    keyed(
        {"state": st.sampled_from(["flow.Wait", "arm.Move"])},
        {"with": st.dictionaries(KEYS, VALUES, max_size=3), "in": st.dictionaries(KEYS, KEYS, max_size=2)},
    ),
    COMMON,
)


def containers(inner: st.SearchStrategy[Plain]) -> st.SearchStrategy[Plain]:
    """Draw a machine or a concurrency container around nodes."""
    wired = st.builds(merged, inner, WIRING)
    machine = keyed(
        {"initial": WORDS, "states": st.dictionaries(WORDS, wired, min_size=1, max_size=3)},
        {"userdata": st.dictionaries(KEYS, VALUES, max_size=2)},
    )
    asked = st.dictionaries(WORDS, OUTCOMES, min_size=1)
    whom = st.lists(WORDS, min_size=1, max_size=2, unique=True)
    condition = st.builds(as_condition, OUTCOMES, asked) | st.builds(as_preempting, whom, asked)
    concurrency = keyed(
        {
            "states": st.dictionaries(WORDS, inner, min_size=1, max_size=3),
            "conditions": st.lists(condition, max_size=3),
        },
        {"otherwise": OUTCOMES},
    )
    return st.builds(
        merged,
        keyed({"machine": machine}) | keyed({"concurrency": concurrency}),
        COMMON,
    )


CANVAS_NOTES: st.SearchStrategy[Plain] = keyed(
    {
        "text": TEXTS,
        "position": st.tuples(st.integers(-99, 99), st.floats(0, 99)).map(list),
        "size": st.just([200, 80.5]),
        "colour": st.sampled_from(["yellow", "grey"]),
    },
    {},
)
BEHAVIORS: st.SearchStrategy[Plain] = keyed(
    {
        "flexcell": st.just(1),
        "name": st.sampled_from(["transfer", "on", "Zwei Arme", "1e3"]),
        "outcomes": st.lists(OUTCOMES, min_size=1, unique=True),
        "root": st.recursive(LEAVES, containers, max_leaves=6),
    },
    {
        "description": TEXTS,
        "parameters": st.dictionaries(
            st.sampled_from(["speed", "tries"]),
            keyed({"type": st.just("number")}, {"default": st.floats(0, 1), "unit": TEXTS}),
            max_size=2,
        ),
        "success": st.lists(OUTCOMES, unique=True),
        "view": st.dictionaries(
            st.sampled_from(["root", "root/go"]), st.tuples(st.integers(0, 99), st.floats(0, 99)).map(list)
        ),
        "canvas_notes": st.dictionaries(
            st.sampled_from(["root", "root/go"]),
            st.dictionaries(KEYS, CANVAS_NOTES, min_size=1, max_size=2),
        ),
    },
)
