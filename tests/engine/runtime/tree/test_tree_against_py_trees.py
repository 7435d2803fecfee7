"""Random trees give the same statuses and activations as plain py_trees ticked in step with them."""

from __future__ import annotations

from hypothesis import given, settings

from tests.engine.runtime.tree.course import engine_course
from tests.engine.runtime.tree.lockstep import run_lockstep
from tests.engine.runtime.tree.specimen import Specimen, specimens
from tests.tiers import examples

UNTIL_S = 6.0
LIMIT = 120


@given(specimen=specimens)
@settings(max_examples=examples(30, nightly=200), deadline=None)
def test_a_random_tree_goes_the_way_plain_py_trees_goes(specimen: Specimen) -> None:
    """With and without memory, through every composite and decorator that both have."""
    expected = run_lockstep(specimen, until_s=UNTIL_S, instant_limit=LIMIT)
    assert engine_course(specimen.document(), until_s=UNTIL_S, instant_limit=LIMIT) == expected
