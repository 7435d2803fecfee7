"""Fault documents: what is accepted, and where the first breach is reported."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from engine.document.faults import CrashFault, ErrorFault, Fault, load_faults, parse_faults
from engine.errors import DocumentError

HEAD = "flexcell: 1\nfaults:\n"


def test_a_document_says_what_goes_wrong_where_and_when(tmp_path: Path) -> None:
    """In order of precedence; a bare message is an error too."""
    file = tmp_path / "faults.yaml"
    file.write_text(
        HEAD + "- {at: root/*/grasp, address: left/*, request: 2, times: 3, probability: 0.5, late: 500 ms}\n"
        "- {name: blocked, error: the fingers are blocked}\n- {crash: {at_event: 7}}\n",
        encoding="utf-8",
    )
    faults = load_faults(file)
    late, blocked, crash = faults.document.faults
    assert late == Fault(at="root/*/grasp", address="left/*", request=2, times=3, probability=0.5, late="500 ms")
    assert (late.kind, late.late_s, blocked.failure) == ("late", 0.5, ErrorFault(message="the fingers are blocked"))
    assert (crash.crash, crash.crashes_at, faults.position(1).line) == (CrashFault(at_event=7), 7, 4)


@pytest.mark.parametrize(
    ("fault", "message"),
    [
        ("{at: root}", "3:3: this fault has no kind (add one of `late`, `hang`"),
        ("{late: 1, hang: {}}", "3:13: this fault has both `late` and `hang` (split it into two faults)"),
        ("{late: 1 day}", "3:10: `late`: not in the allowed form"),
        ("{probability: 1.5, late: 1}", "`probability`: expected number <= 1.0 (Above 0, at most 1)"),
        ("{request: 0, late: 1}", "`request`: expected integer >= 1 (The n-th matching request of a state, from 1)"),
        ("{lost: both}", "`lost`: there is no choice 'both' (known: answer, request)"),
        ("{error: {by: abort}}", "the key `message` is missing"),
        ("{hang: {ignore: true}}", "unknown key `ignore` (did you mean ignore_cancel?)"),
        ("{crash: {}}", "3:4: a crash has either `at_event` or `on_request` (set one of them)"),
        ("{times: 2, crash: {at_event: 4}}", "3:4: `times` has no effect with `at_event` (remove `times`)"),
    ],
)
def test_a_violation_is_reported_at_its_place(fault: str, message: str) -> None:
    """One line that says what to do."""
    with pytest.raises(DocumentError) as raised:
        parse_faults(HEAD + f"- {fault}\n", file="f.yaml")
    assert message in str(raised.value)


def test_a_document_without_faults_is_refused() -> None:
    """It would do nothing, which nobody means."""
    with pytest.raises(DocumentError, match="expected list of length >= 1"):
        parse_faults("flexcell: 1\nfaults: []\n", file="f.yaml")


def test_the_documents_of_the_how_to_page_are_accepted() -> None:
    """What is shown can be used."""
    page = (Path(__file__).parents[3] / "docs/how-to/inject-faults.md").read_text(encoding="utf-8")
    shown = re.findall(r"^```yaml\n(.*?)^```", page, re.DOTALL | re.MULTILINE)
    assert [len(parse_faults(text, file="page.yaml").document.faults) for text in shown] == [3]
