"""What is killed and resumed: two behaviors with devices that write every effect down, and two in physics."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

import msgspec

from engine.bus import ActiveGoal, SkillBus
from engine.document import Behavior, load_behavior, load_cell, parse_behavior
from engine.document.cell import Cell
from engine.errors import ControlError
from engine.event import Event, NodeEntered, PauseConfirmed, RunSteppedBack
from engine.registry import load_states
from engine.runtime.history.resume import RERUN, ResumeQuestion
from engine.runtime.plan import Catalogue
from engine.runtime.run import Run
from engine.skill import Action, Service
from engine.state import ActivationRecord, Context, Outcome, State

BEHAVIORS = Path(__file__).resolve().parents[1] / "behaviors"


class Stamped(msgspec.Struct, frozen=True, kw_only=True):
    """What a device answers."""

    what: str


class Stamp(Action[Stamped, Stamped], frozen=True, kw_only=True):
    """Do something that stays done."""

    what: str


class Note(Service[Stamped], frozen=True, kw_only=True):
    """Write something down."""

    what: str


class Press:
    """Carries out both; each effect is a line in a file, written at once and whole."""

    def __init__(self, bus: SkillBus, effects: Path) -> None:
        self._bus = bus
        self._effects = effects
        for name in ("left", "right"):
            bus.advertise_action(Stamp, self.stamp, namespace=name)
        bus.advertise_service(Note, self.note, namespace="desk")

    async def stamp(self, goal: Stamp, handle: ActiveGoal[Stamped]) -> Stamped:
        """The effect happens in the middle of the goal."""
        handle.accept()
        await self._bus.clock.sleep(0.4)
        self._write(goal.what)
        await self._bus.clock.sleep(0.4)
        return Stamped(what=goal.what)

    async def note(self, request: Note) -> Stamped:
        """The effect happens before the answer."""
        self._write(request.what)
        return Stamped(what=request.what)

    def _write(self, what: str) -> None:
        descriptor = os.open(self._effects, os.O_WRONLY | os.O_CREAT | os.O_APPEND)
        try:
            os.write(descriptor, f"{what}\n".encode())
        finally:
            os.close(descriptor)


class StampPart(State, frozen=True, kw_only=True):
    """Send the goal."""

    state_name: ClassVar[str] = "crash.Stamp"
    outcomes: ClassVar[tuple[str, ...]] = ("stamped", "failed")
    success: ClassVar[tuple[str, ...]] = ("stamped",)
    outputs: ClassVar[Mapping[str, Any]] = {"stamped": str}
    device: str
    what: str

    def resources(self) -> tuple[str, ...]:
        return (self.device,)

    async def run(self, ctx: Context) -> Outcome:
        end = await ctx.perform(Stamp(what=self.what), to=self.device)
        return Outcome("stamped", {"stamped": self.what}) if end.status == "succeeded" else Outcome("failed")


class NoteDown(State, frozen=True, kw_only=True):
    """Ask the service."""

    state_name: ClassVar[str] = "crash.Note"
    outcomes: ClassVar[tuple[str, ...]] = ("noted",)
    what: str

    async def run(self, ctx: Context) -> Outcome:
        await ctx.call(Note(what=self.what), to="desk")
        return Outcome("noted")


class StampBack(StampPart, frozen=True, kw_only=True):
    """Send the goal, and know how to take it back."""

    state_name: ClassVar[str] = "crash.StampBack"

    async def undo(self, ctx: Context, done: ActivationRecord) -> None:
        await ctx.perform(Stamp(what=f"no {self.what}"), to=self.device)


PRESS = """
flexcell: 1
name: press
parameters: {rounds: {type: integer, default: 3}}
userdata: {count: 0, last: "", all: []}
outcomes: [finished, failed]
success: [finished]
root:
  machine:
    initial: both
    states:
      both:
        concurrency:
          states:
            left:
              machine:
                initial: one
                states:
                  one:
                    state: crash.Stamp
                    with: {device: left, what: left one}
                    transitions: {stamped: two, failed: out}
                  two: {state: flow.Wait, with: {duration_s: 0.3}, transitions: {done: three}}
                  three:
                    state: crash.Stamp
                    with: {device: left, what: left two}
                    transitions: {stamped: out, failed: out}
            right:
              foreach:
                items: "${['a', 'b', 'c']}"
                collect: {stamped: all}
                child:
                  state: crash.Stamp
                  with: {device: right, what: "${'right ' + item}"}
                  timeout: {after: 10 s, to: failed}
                next: [stamped]
          conditions: [{done: {left: out, right: exhausted}}]
          otherwise: failed
        transitions: {done: count, failed: failed}
      count: {state: flow.SetValue, with: {value: "${count + 1}"}, out: {value: count}, transitions: {done: note}}
      note: {state: crash.Note, with: {what: "${'note ' + string(count)}"}, transitions: {noted: enough}}
      enough: {state: flow.Decide, with: {when: "${count >= rounds}"}, transitions: {"true": last, "false": count}}
      last:
        tree:
          sequence:
            - {state: crash.Note, name: close, with: {what: close}}
            - {state: crash.Stamp, name: seal, with: {device: left, what: seal}, out: {stamped: last}}
        transitions: {success: finished, failure: failed}
"""
GLUE = """
flexcell: 1
name: glue
userdata: {done: []}
outcomes: [finished, failed]
success: [finished]
root:
  machine:
    initial: approach
    states:
      approach: {state: flow.Wait, with: {duration_s: 0.2}, transitions: {done: both}}
      both:
        concurrency:
          states:
            left: {state: crash.Stamp, resume: ask, with: {device: left, what: left bead}}
            right:
              machine:
                initial: bead
                states:
                  bead:
                    state: crash.Stamp
                    with: {device: right, what: right bead}
                    resume: ask
                    transitions: {stamped: cure, failed: cure}
                  cure: {state: crash.Note, with: {what: cure}, resume: noted, transitions: {noted: again}}
                  again:
                    state: crash.Stamp
                    with: {device: right, what: second bead}
                    resume: stamped
                    transitions: {stamped: out, failed: out}
          conditions: [{done: {left: stamped, right: out}}]
          otherwise: failed
        transitions: {done: finish, failed: failed}
      finish: {state: flow.SetValue, with: {value: "${done + ['all']}"}, out: {value: done}, transitions: {done: seal}}
      seal:
        state: crash.Stamp
        with: {device: left, what: seal}
        resume: ask
        transitions: {stamped: finished, failed: failed}
"""
REVISED = """
flexcell: 1
name: revised
userdata: {stamped: none}
outcomes: [finished, failed]
success: [finished]
root:
  machine:
    initial: one
    states:
      one: {state: crash.StampBack, with: {device: left, what: one}, transitions: {stamped: pair, failed: failed}}
      pair:
        machine:
          initial: two
          states:
            two: {state: crash.StampBack, with: {device: left, what: two}, transitions: {stamped: three, failed: no}}
            three: {state: crash.StampBack, with: {device: right, what: three}, transitions: {stamped: out, failed: no}}
        transitions: {out: last, no: failed}
      last: {state: crash.StampBack, with: {device: left, what: last}, transitions: {stamped: finished, failed: failed}}
"""
ASKED = {
    "root/both/left": "left bead",
    "root/both/right/bead": "right bead",
    "root/seal": "seal",
}
"""The states of `GLUE` that ask, and their effects."""
REVISIONS = 3
"""How often `REVISED` is stepped back."""


@dataclass(frozen=True, kw_only=True)
class Subject:
    """One behavior with what it needs around it.

    `answer` is what a person who looks at the effects says of a state in mid-work.
    """

    name: str
    behavior: Callable[[], Behavior]
    catalogue: Callable[[], Catalogue]
    cell: Callable[[], Cell | None] = lambda: None
    install: Callable[[SkillBus, Path], object] = lambda bus, effects: None
    answer: Callable[[ResumeQuestion, Sequence[str]], str] = lambda question, effects: RERUN
    once: frozenset[str] = frozenset()
    """Effects that no crash may repeat."""
    operate: Callable[[Run, Sequence[Event]], object] = lambda run, events: None
    """Operates a run that has these events already."""
    exactly: frozenset[str] = frozenset()
    """Effects that happen exactly once."""


def _catalogue() -> Catalogue:
    return {**load_states(), "crash.Stamp": StampPart, "crash.Note": NoteDown, "crash.StampBack": StampBack}


class Reviser:
    """Pauses a run in its last state, takes the last three things back, and lets it go on."""

    def __init__(self, run: Run, events: Sequence[Event]) -> None:
        self._run = run
        self._back = 0
        self._orders: set[asyncio.Task[None]] = set()
        for event in events:
            self._count(event)
        run.watch(self._take)

    def _count(self, event: Event) -> None:
        self._back += isinstance(event, RunSteppedBack)

    def _take(self, event: Event) -> None:
        self._count(event)
        if isinstance(event, NodeEntered) and event.path == "root/last" and self._back < REVISIONS:
            asyncio.get_running_loop().call_later(0.2, self._run.control.pause)
        if isinstance(event, PauseConfirmed):
            order = asyncio.get_running_loop().create_task(self._go())
            self._orders.add(order)
            order.add_done_callback(self._orders.discard)

    async def _go(self) -> None:
        await self._run.control.settled()
        try:
            if self._back < REVISIONS:
                await self._run.step_back()
                return
        except ControlError:
            # The goal of a state in mid-work died with its engine, or the run is elsewhere: it goes on from there.
            self._back = REVISIONS
        self._run.control.resume()


def _as_seen(question: ResumeQuestion, effects: Sequence[str]) -> str:
    return "stamped" if ASKED[question.path] in effects else RERUN


SUBJECTS = {
    subject.name: subject
    for subject in (
        Subject(
            name="press",
            behavior=lambda: parse_behavior(PRESS, file="press.yaml"),
            catalogue=_catalogue,
            install=Press,
        ),
        Subject(
            name="glue",
            behavior=lambda: parse_behavior(GLUE, file="glue.yaml"),
            catalogue=_catalogue,
            install=Press,
            answer=_as_seen,
            once=frozenset((*ASKED.values(), "cure", "second bead")),
            exactly=frozenset(ASKED.values()),
        ),
        Subject(
            name="revised",
            behavior=lambda: parse_behavior(REVISED, file="revised.yaml"),
            catalogue=_catalogue,
            install=Press,
            operate=Reviser,
        ),
        Subject(
            name="transfer",
            behavior=lambda: load_behavior(BEHAVIORS / "reconcycle" / "two_arm_transfer.yaml"),
            catalogue=load_states,
            cell=lambda: load_cell(BEHAVIORS / "cells" / "dual_panda.yaml"),
        ),
        Subject(
            name="cylinder",
            behavior=lambda: load_behavior(BEHAVIORS / "test_cylinder" / "test_cylinder.yaml"),
            catalogue=load_states,
            cell=lambda: load_cell(BEHAVIORS / "cells" / "servo_arm.yaml"),
        ),
    )
}
