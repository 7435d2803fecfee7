"""Endless loops in which no time passes are reported, others are not."""

from __future__ import annotations

from pathlib import Path

from tests.engine.check.checking import code_paths, findings_in, findings_in_files, message_of

LOOK = "{state: flow.Decide, with: {when: '${ready}'}, transitions: {'true': good, 'false': %s}}"
TELL = "{state: flow.Log, with: {message: again}, transitions: {done: %s}}"
HEAD = "parameters: {ready: {type: boolean, default: true}}\n"


def machine(initial: str, **states: str) -> str:
    """Write a machine whose states are given on one line each."""
    lines = "".join(f"      {name}: {text}\n" for name, text in states.items())
    return f"root:\n  machine:\n    initial: {initial}\n    states:\n{lines}"


def test_a_loop_that_decides_on_what_it_does_not_write_never_ends() -> None:
    """The message names the loop from its first state on."""
    text = HEAD + machine("look", look=LOOK % "tell", tell=TELL % "look")
    assert code_paths(text) == ["instant-loop root/look"]
    assert message_of(text).startswith("no time passes in the loop look → tell → look,")
    assert code_paths(HEAD + machine("look", look=LOOK % "look")) == ["instant-loop root/look"]


def test_a_state_that_waits_makes_the_loop_one_that_waits() -> None:
    """Time passes at each round."""
    wait = "{state: flow.Wait, with: {duration_s: 1}, transitions: {done: look}}"
    assert code_paths(HEAD + machine("look", look=LOOK % "wait", wait=wait)) == []


def test_a_loop_that_counts_is_not_reported() -> None:
    """It writes what it decides on."""
    count = "{state: flow.SetValue, with: {value: '${tries + 1}'}, out: {value: tries}, transitions: {done: look}}"
    look = "{state: flow.Decide, with: {when: '${tries < 3}'}, transitions: {'true': count, 'false': good}}"
    assert code_paths("userdata: {tries: 0}\n" + machine("count", count=count, look=look)) == []


def test_a_closed_guard_leads_on_at_once() -> None:
    """Whatever the state behind it would do."""
    wait = "{state: flow.Wait, with: {duration_s: 1}, guard: {when: '${ready}', to: tell}, transitions: {done: good}}"
    assert code_paths(HEAD + machine("wait", wait=wait, tell=TELL % "wait")) == ["instant-loop root/wait"]


def test_a_retry_that_waits_in_a_tree_makes_the_loop_one_that_waits() -> None:
    """It fails after its wait only; what succeeds at the first run takes no time."""
    decide = "{state: flow.Decide, with: {when: '${ready}'}}"
    retry = "{tree: {retry: {times: 1, backoff: %s, child: " + decide + "}}, transitions: {success: %s, failure: %s}}"
    assert code_paths(HEAD + machine("ask", ask=retry % ("2 s", "good", "ask"))) == []
    assert code_paths(HEAD + machine("ask", ask=retry % ("0 s", "good", "ask"))) == ["instant-loop root/ask"]


def test_a_container_ends_at_once_where_a_way_through_instant_states_leads() -> None:
    """Machines, trees, rounds and branches are looked into."""
    inner = f"{{machine: {{initial: a, states: {{a: {TELL % 'over'}}}}}, transitions: {{over: look}}}}"
    tree = "{tree: {sequence: [{state: flow.Log, with: {message: a}}]}, transitions: {success: look}}"
    log = "{state: flow.Log, with: {message: a}}"
    each = f"{{foreach: {{times: 2, child: {log}}}, transitions: {{exhausted: look, broken: bad}}}}"
    both = (
        "{concurrency: {states: {a: {state: flow.Log, with: {message: a}}}, conditions: [{over: {a: done}}]},"
        " transitions: {over: look}}"
    )
    for text in (inner, tree, each, both):
        assert code_paths(HEAD + machine("look", look=LOOK % "inner", inner=text)) == ["instant-loop root/look"]
    slow = both.replace("flow.Log, with: {message: a}", "flow.Wait, with: {duration_s: 1}")
    assert code_paths(HEAD + machine("look", look=LOOK % "inner", inner=slow)) == []


def test_a_behavior_that_ends_at_once_is_part_of_a_loop(tmp_path: Path) -> None:
    """It is looked into as well."""
    main = HEAD + machine("look", look=LOOK % "sub", sub="{behavior: part.yaml, transitions: {good: look, bad: bad}}")
    part = machine("tell", tell=TELL % "good")
    assert [f"{f.code} {f.path}" for f in findings_in_files(tmp_path, main=main, part=part)] == [
        "instant-loop root/look"
    ]
    waiting = machine("wait", wait="{state: flow.Wait, with: {duration_s: 1}, transitions: {done: good}}")
    assert findings_in_files(tmp_path, main=main, part=waiting) == ()


def test_a_loop_of_thousands_of_states_is_found_without_recursion() -> None:
    """And named by its beginning."""
    states = {f"s{i}": TELL % f"s{(i + 1) % 3000}" for i in range(3000)}
    (found,) = [finding for finding in findings_in(machine("s0", **states)) if finding.code == "instant-loop"]
    assert "s0 → s1 → s2 → s3 → s4 → … → s0" in found.message
