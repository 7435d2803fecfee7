"""JUnit XML: what the usual readers allow, whatever the texts are."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.cli.output.junit import JunitCase, JunitProblem, JunitSuite, class_name, junit_xml, write_junit
from engine.errors import FlexcellError

ALLOWED = {
    "testsuites": {"name"},
    "testsuite": {"name", "tests", "failures", "errors", "skipped", "time", "file"},
    "properties": set[str](),
    "property": {"name", "value"},
    "testcase": {"name", "classname", "time"},
    "failure": {"type", "message"},
    "error": {"type", "message"},
}
"""Elements and attributes that the schemas of Jenkins (junit-10) and of xunit2 both have."""
CHILDREN = {
    "testsuites": {"testsuite"},
    "testsuite": {"properties", "testcase"},
    "properties": {"property"},
    "testcase": {"failure", "error"},
}
PASSED = JunitCase(name="p", classname="a.b", time_s=1.25)
FAILED = JunitCase(
    name="f", classname="a.b", time_s=0.5, problem=JunitProblem(kind="failure", type="t", message="m", text="x")
)
ERROR = JunitCase(name="e", classname="a.b", time_s=0.0, problem=JunitProblem(kind="error", type="t", message="m"))


def _checked(suites: list[JunitSuite]) -> ET.Element:
    root = ET.fromstring(junit_xml(suites))
    for element in root.iter():
        assert set(element.attrib) <= ALLOWED[element.tag]
        assert {child.tag for child in element} <= CHILDREN.get(element.tag, set())
    return root


def test_cases_are_counted_and_properties_kept() -> None:
    suite = JunitSuite(name="s", file="f.yaml", cases=(PASSED, FAILED, ERROR), properties={"run": "r"})
    root = _checked([suite])
    (found,) = root
    assert found.attrib == {
        "name": "s", "tests": "3", "failures": "1", "errors": "1", "skipped": "0", "time": "1.750", "file": "f.yaml",
    }  # fmt: skip
    assert [child.tag for child in found] == ["properties", "testcase", "testcase", "testcase"]
    failure = found.find("./testcase/failure")
    assert failure is not None
    assert (failure.get("message"), failure.text) == ("m", "x")


@given(text=st.text())
def test_any_text_gives_xml_that_can_be_read(text: str) -> None:
    """Terminal colors and NUL come from states; XML 1.0 cannot hold them, not even escaped."""
    problem = JunitProblem(kind="failure", type="t", message=text, text=f"\x1b[31m{text}\0")
    case = JunitCase(name=text, classname=text, time_s=0.0, problem=problem)
    _checked([JunitSuite(name=text, file=text, cases=(case,), properties={text: text})])


def test_a_path_becomes_a_class_name() -> None:
    assert class_name("behaviors/a/pick.yaml") == "behaviors.a.pick"
    assert class_name("/abs/../pick.yaml") == "abs.pick"


def test_a_file_that_cannot_be_written_is_an_error_in_one_line(tmp_path: Path) -> None:
    with pytest.raises(FlexcellError, match="the JUnit file cannot be written: No such file or directory"):
        write_junit(tmp_path / "nowhere" / "r.xml", [])
