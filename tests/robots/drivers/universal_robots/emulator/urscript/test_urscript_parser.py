"""URScript is parsed as controllers do, line ends or not; and garbage is an error with its line, and nothing worse."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robots.drivers.universal_robots.emulator.urscript.urscript_parser import parse_program
from robots.drivers.universal_robots.emulator.urscript.urscript_syntax import (
    Assignment,
    IndexExpression,
    ListLiteral,
    Literal,
    UrscriptError,
    VariableName,
)
from robots.drivers.universal_robots.emulator.urscript.urscript_tokens import ProgramSplitter
from tests.robots.drivers.universal_robots.emulator.urscript_execution import execute

WORDS = (
    "def", "end", "thread", "f", "(", ")", ":", "if", "elif", "else", "while", "return", "x", "=", "1", "2.5e3", "\n",
    "global", "kill", "run", "p[", "[", "]", ",", "-", "not", "and", "==", "True", '"text"', "enter_critical", "movej",
    "sync", "#", "$", "halt", "%", "break",
)  # fmt: skip


def test_statements_need_no_line_between_them() -> None:
    """As where the client library writes numbers into its script."""
    program = parse_program("def f():\nglobal a = # an offset\n0    global b = # another\n1   end\n")
    assert program.name == "f"
    assert program.body == (Assignment("a", None, Literal(0), 2), Assignment("b", None, Literal(1), 3))
    assert program.global_names == {"a", "b"}


def test_a_pose_and_an_element_of_a_variable_called_p() -> None:
    """Six numbers are a pose."""
    program = parse_program("x = p[1, 2, 3, 4, 5, 6]\ny = p[0]\np[1] = 2")
    pose, read, written = program.body
    assert isinstance(pose, Assignment)
    assert pose.value == ListLiteral(tuple(Literal(n) for n in range(1, 7)), is_pose=True)
    assert isinstance(read, Assignment)
    assert read.value == IndexExpression(VariableName("p", 2), Literal(0), 2)
    assert written == Assignment("p", Literal(1), Literal(2), 3)


@pytest.mark.parametrize(
    ("source", "message"),
    [
        ("def f():\n  x = 1\n", "line 3: expected `end`"),
        ("x = \n", "line 2: expected a name"),
        ("x = 1\ny = $", "line 2: unexpected character"),
        ("x = " + "(" * 500, "more than 60 levels of nesting"),
        ("x = " + "-" * 5_000 + "1", "more than 60 levels of nesting"),
        ("if True:\n" * 500, "more than 60 levels of nesting"),
        ("while = 3", "expected a name"),
        ("global end = 3", "expected a name, not 'end'"),
    ],
)
def test_what_is_no_urscript_is_refused_with_its_line(source: str, message: str) -> None:
    """By a parser that does not go on guessing."""
    with pytest.raises(UrscriptError, match=message):
        parse_program(source)


@given(st.one_of(st.text(max_size=200), st.lists(st.sampled_from(WORDS), max_size=60).map(" ".join)))
def test_any_text_is_a_program_or_an_error_by_name(source: str) -> None:
    """And what is a program, ends or goes on, but never raises."""
    try:
        parse_program(source)
    except UrscriptError:
        return
    execute(source, cycles=20)


PROGRAM = 'def f():\n  if True: # end\n    textmsg("end")\n  end\nend\n'


@given(
    st.integers(1, 12), st.lists(st.sampled_from([PROGRAM, "stopj(2)\n", "\n", "sec s():\n x = 1\nend\n"]), max_size=6)
)
def test_programs_are_the_same_however_they_arrive(piece: int, programs: list[str]) -> None:
    """Each up to its own `end`; words in comments and texts do not count."""
    splitter = ProgramSplitter()
    stream = "".join(programs)
    split = [program for at in range(0, len(stream), piece) for program in splitter.feed(stream[at : at + piece])]
    assert split == [program.removesuffix("\n") for program in programs if program.strip()]


def test_a_program_without_an_end_is_refused_when_it_is_too_long() -> None:
    """A client cannot fill the memory."""
    splitter = ProgramSplitter(most_characters=1_000)
    splitter.feed("def f():\n")
    with pytest.raises(UrscriptError, match="more than 1000 characters"):
        splitter.feed("x = 1\n" * 200)
