"""Names of runs."""

from __future__ import annotations

import re

from engine.runtime.run_id import new_run_id


def test_runs_that_start_in_the_same_second_have_names_of_their_own() -> None:
    """With four digits some dozens of runs a second met by chance now and then."""
    names = [new_run_id("pick & place") for _ in range(300)]
    assert all(re.fullmatch(r"pick_place-\d{8}-\d{6}-[0-9a-f]{8}", name) for name in names)
    assert len(set(names)) == len(names)
