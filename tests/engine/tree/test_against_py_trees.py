"""Random trees give the same statuses and activations as plain py_trees ticked in step with them."""

from __future__ import annotations

import json

from hypothesis import given, settings

from engine.event import Entered
from tests.engine.tree.lockstep import Course, run_lockstep
from tests.engine.tree.run_tree import run_tree
from tests.engine.tree.specimen import Specimen, specimens

UNTIL_S = 6.0
LIMIT = 120


def _run(specimen: Specimen) -> Course:
    told = run_tree(json.dumps(specimen.document()), stop_at_s=UNTIL_S + 0.1, instant_limit=LIMIT)
    begun = tuple(
        (event.time_s, event.path.removeprefix("root/"))
        for event in told.events
        if isinstance(event, Entered) and event.kind == "state" and event.time_s < UNTIL_S
    )
    result = told.result
    if result.status == "finished" and result.duration_s < UNTIL_S:
        return Course(result.outcome, result.duration_s, begun)
    endless = result.status == "errored" and "without waiting" in told.why[0]
    assert endless or result.status in ("finished", "stopped"), told.why
    return Course(None, result.duration_s if endless else UNTIL_S, begun, endless=endless)


@given(specimen=specimens)
@settings(max_examples=100, deadline=None)
def test_a_random_tree_goes_the_way_plain_py_trees_goes(specimen: Specimen) -> None:
    """With and without memory, through every composite and decorator that both have."""
    expected = run_lockstep(specimen, until_s=UNTIL_S, instant_limit=LIMIT)
    assert _run(specimen) == expected
