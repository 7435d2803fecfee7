"""One fact, one class: no two public classes of engine, states and robots say the same under two names.

Classes are compared as in `test_mirrors`, by the names of the fields that they do not inherit. A state and a skill are
not compared: what a document says about a state is a contract of its own. Nor are two events: each is its own fact.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from itertools import combinations
from typing import Any

import msgspec

from engine.event import Event
from engine.skill import Skill
from engine.state import State
from tests.house.class_fields import own_fields, public_classes

PACKAGES = ("engine", "states", "robots")
LEAST_FIELDS = 3
"""Classes with fewer fields share names by chance."""
MOST_SHARED = 0.75
"""The share of the larger class."""
CARTESIAN = "the same about joints and about the tool; their values have other types"
DIFFERENT_FACTS: Mapping[str, str] = {
    "DigitalOutputPin ~ PwmPin": "on or off, and a duty with a frequency; the kind tells them apart in the document",
    "DigitalInputs ~ DigitalOutputs": "two topics of one controller; what is measured, and what is set",
    "EquipmentOptions ~ GpiozeroPins": "where a server of equipment is; where the pigpiod behind it is",
    "EquipmentOptions ~ ModbusPins": "where a server of equipment is; where the PLC behind it is",
    "GpiozeroPins ~ ModbusPins": "a pigpiod and a PLC; both are at an address",
    "FrankaLoad ~ Payload": "by columns and about the centre, as libfranka takes it",
    "AttachedPart ~ HeldPart": "of the scene to plan in, where no link is the tool link; the topic names the link",
    "BusParameter ~ EntryDraft": "a setting and an entry, both typed and named",
    "CartDMP ~ JointDMP": CARTESIAN,
    "CartFit ~ JointFit": CARTESIAN,
    "CartMotionResult ~ JointMotionResult": "where the tool is measured; where the joints are",
    "Close ~ Open": "of a hand: closing has a share",
    "Concurrency ~ ConcurrencySpec": "the container that executes what the document says",
    "EntryChange ~ EntryChanged": "a change with its value; the topic has none",
    "EntryChange ~ RevisionRow": "a change with its typed value; the row of a database has text",
    "EntryChanged ~ EntryKey": "a change with its reason; a row of a list",
    "EntryDraft ~ EntryRecord": "text for a database; a stored value with its revision",
    "FingerIndices ~ LinkageIndices": "two fingers with a motor each; a linkage with one",
    "FollowCartDmp ~ FollowJointDmp": CARTESIAN,
    "ForEach ~ ForEachSpec": "the container that executes what the document says",
    "FormerValue ~ UserdataAppended": "what a key had before an undo; what a key got",
    "FoxgloveQuaternion ~ FoxgloveVector3": "two messages of Foxglove",
    "GateReached ~ GateWait": "the event of a wait; the wait itself, which also knows the required autonomy",
    "GraphTransition ~ TransitionTaken": "an arrow of a picture; that a run took it",
    "GripperState ~ HandState": "two kinds of tools, of which each measures something of its own",
    "HandResult ~ HandState": "how an action ended; a measurement",
    "IfThenElseSpec ~ WhileDoElseSpec": "two kinds of nodes with the same parts",
    "IdentifyFriction ~ IdentifyPayload": "joints of a choice; the wrist, and a tolerance of the mass",
    "Joints ~ NamedAngles": "an entry of a store, checked against its names; an entry as a person writes it",
    "KeySignature ~ KeyView": "a declaration in Python with its type; its plain data",
    "KeyView ~ ParameterView": "a key of a state; a parameter, whose schema has the default",
    "LearnCartDmp ~ LearnJointDmp": CARTESIAN,
    "LoopBlocked ~ LoopStall": "the event of a state that blocks; a block by anything, also outside a run",
    "MagnetResult ~ MagnetState": "how an action ended; a measurement",
    "MoveHexapod ~ PullBase": "a pose with two tolerances; a place along a rail, of which the arm itself is moved",
    "Pose ~ PoseTarget": "a pose; a pose or the name of an entry",
    "PutObstacle ~ ToolShape": "a state; a body of a tool, with its mass",
    "PutTool ~ TakeTool": "one has a tool centre point; the other ends in a place",
    "SearchSummary ~ SearchView": "made from its fields, so that a page gets each of them; no field is written twice",
    "SetTransition ~ TransitionTaken": "an edit of a document; that a run took a transition",
    "SweepSummary ~ SweepView": "made from its fields, so that a page gets each of them; no field is written twice",
    "ToolShape ~ UnknownBody": "fixed to a tool, with a mass; on its own, fixed or free",
    "Waypoint ~ WaypointTarget": "values for an arm; values or names of entries, and a blend or that of the state",
}
"""Pairs of classes with nearly the same names of fields, and why they are not one class."""


def test_no_two_classes_say_the_same() -> None:
    """But those that are named above."""
    classes = {name: cls for package in PACKAGES for name, cls in public_classes(package).items()}
    assert len(classes) > 700, "the classes are not found any more"
    found = dict(_pairs(classes.values()))
    assert found == {name: found.get(name, "no pair: take its exception away") for name in DIFFERENT_FACTS}


def test_a_pair_is_recognised_but_no_child_no_state_and_no_event() -> None:
    class Fact(msgspec.Struct):
        path: str
        line: int
        message: str
        hint: str

    class FactLike(msgspec.Struct):
        path: str
        line: int
        message: str

    class SeenFact(Fact):
        seen: bool

    class TellFact(Skill[Any], frozen=True, kw_only=True):
        line: int
        message: str
        hint: str

    class TellingState(State, frozen=True, kw_only=True):
        line: int
        message: str
        hint: str

    class FactTold(Event, frozen=True, kw_only=True, tag="fact_told"):
        path: str
        line: int
        seen: bool

    class FactForgotten(Event, frozen=True, kw_only=True, tag="fact_forgotten"):
        path: str
        line: int
        seen: bool

    classes = (Fact, FactLike, SeenFact, TellFact, TellingState, FactTold, FactForgotten)
    assert set(dict(_pairs(classes, apart_from=(Fact, Event)))) == {
        "Fact ~ FactLike",
        "Fact ~ TellFact",
        "Fact ~ TellingState",
    }


def _pairs(classes: Iterable[type[Any]], *, apart_from: tuple[type[Any], ...] = ()) -> Iterator[tuple[str, str]]:
    """Yield the names of every pair of classes that share most of their fields, and which share that is."""
    own = {cls: own_fields(cls, packages=PACKAGES, apart_from=apart_from) for cls in classes}
    large = {cls: names for cls, names in own.items() if len(names) >= LEAST_FIELDS}
    for (one, ours), (other, theirs) in combinations(large.items(), 2):
        share = len(ours & theirs) / max(len(ours), len(theirs))
        if share >= MOST_SHARED and not _are_apart(one, other):
            first, second = sorted((one.__name__, other.__name__))
            yield f"{first} ~ {second}", f"share {share:.0%} of their fields"


def _are_apart(one: type[Any], other: type[Any]) -> bool:
    if issubclass(one, Event) and issubclass(other, Event):
        return True
    return any(issubclass(a, State) and issubclass(b, Skill) for a, b in ((one, other), (other, one)))
