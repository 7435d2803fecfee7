"""Chains of causes are told from what was measured outwards."""

from __future__ import annotations

from engine.cause_chain import describe_cause, links_from_root
from engine.errors import Cause

MEASURED = Cause(message="fingers 0.0 mm apart, 30.0 mm expected", where="right/gripper/grasp")
STATE = Cause(message="right did not grasp the part", where="root/pick/grasp", because=MEASURED)
ENDED = Cause(message="grasp ended with missed", where="root/pick/grasp", because=STATE)
LEFT = Cause(message="pick was left for rescue", where="root/pick", because=ENDED)


def test_a_chain_begins_with_what_was_measured() -> None:
    assert describe_cause(LEFT) == (
        "right gripper: grasp: fingers 0.0 mm apart, 30.0 mm expected, "
        "so root/pick/grasp: right did not grasp the part, so root/pick/grasp ended with missed, "
        "so root/pick was left for rescue"
    )


def test_its_links_go_from_the_inside_out() -> None:
    assert links_from_root(LEFT) == (MEASURED, STATE, ENDED, LEFT)
    assert links_from_root(None) == ()


def test_only_the_name_of_the_node_itself_gives_way_to_its_path() -> None:
    assert describe_cause(Cause(message="grasper ended with missed", where="root/grasp")) == (
        "root/grasp: grasper ended with missed"
    )
    assert describe_cause(Cause(message="the door is open")) == "the door is open"
