"""Every route, with requests that keep its schema, nearly keep it, or break it: refused in words or done, never broken.

`FLEXCELL_FUZZ_EXAMPLES=500 pytest tests/editor_web/routes/test_routes_fuzz.py` fuzzes for longer.
"""

from __future__ import annotations

import re
from collections.abc import Generator
from typing import Any, cast
from urllib.parse import unquote

import pytest
from hypothesis import assume, given

from editor_web.security.authentication import OPERATOR, VIEWER
from editor_web.security.request_rules import SAFE_METHODS
from tests.editor_web.fuzzing import (
    CHECKS,
    ENDLESS,
    Operation,
    Target,
    aimed,
    broken,
    can_break,
    fuzzed,
    opened_target,
    operations,
)

ENDING = [each for each in operations() if each != ENDLESS]
each_operation = pytest.mark.parametrize("operation", ENDING, ids=lambda each: f"{each[0]} {each[1]}")

_NO_ADDRESS = re.compile("[\\x00-\\x1f\\x7f-\\x9f\\ufffd]")


@pytest.fixture(scope="module")
def target(tmp_path_factory: pytest.TempPathFactory, loopback: str) -> Generator[Target]:
    """One server for all."""
    with opened_target(tmp_path_factory.mktemp("fuzz"), host=loopback) as opened:
        yield opened


@each_operation
def test_an_operator_breaks_nothing(target: Target, operation: Operation) -> None:
    """What is declared is answered, nothing is stored outside of the project."""

    target.restore()
    for kind in (aimed(operation, target.known), *([broken(operation)] if can_break(operation) else [])):

        @fuzzed
        @given(case=kind)
        def sent(case: Any) -> None:
            answer = target.send(case, role=OPERATOR)
            case.validate_response(answer, checks=CHECKS)

        sent()
    target.require_untouched_surroundings()


@each_operation
def test_who_may_not_act_changes_nothing(target: Target, operation: Operation) -> None:
    """A viewer looks, without a token there is nothing to see; both with names that exist."""
    target.restore()
    runs = [run.id for run in target.shop.session.runs()]
    inside = target.inside()

    @fuzzed
    @given(case=aimed(operation, target.known))
    def sent(case: Any) -> None:
        # What is no address is refused before anybody asks who asks.
        names = cast("dict[str, object]", case.path_parameters or {})
        assume(not any(_NO_ADDRESS.search(unquote(str(name))) for name in names.values()))
        assert target.send(case, role="").status_code in (401, 403)
        assert operation[0] in SAFE_METHODS or target.send(case, role=VIEWER).status_code == 403

    sent()
    assert target.inside() == inside
    assert [run.id for run in target.shop.session.runs()] == runs
    target.require_untouched_surroundings()
