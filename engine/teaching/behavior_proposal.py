"""Generates a behavior from taught steps: approach, grasp, transfer, release, with taught motions in between."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import cast

from engine.cell.robot_models import tool_kinds
from engine.cell.tool_kind import ToolKind
from engine.document.text.yaml_writer import write_yaml
from engine.errors import SkillFailed
from engine.messages import Vector3
from engine.skills.proposing import Proposal, ProposalOptions, TaughtStep, ToolName
from engine.teaching.proposal_nodes import Node, ProposalNodeBuilder
from engine.teaching.step_roles import MOTIONS, PLACES, ObservedStep, assign_step_roles, guess_part
from engine.wording.suggestions import did_you_mean

_HEADER = "# Proposed from taught entries: {names}.\n# If an entry is overwritten, the next run uses the new values.\n"
_UNKNOWN_WIDTH = "The width of the part is unknown: any object between the fingers counts as held."
_UNKNOWN_PART = "The part grasped {where} is unknown: in a cell with known parts, paths with it cannot be planned."
_END_HELD = "The tool still holds a part at the end."
_PARAMETERS: Mapping[str, tuple[str, float, float, str]] = {
    "speed": ("", 0.05, 1.0, "Fraction of the joint speed limits"),
    "line_speed_m_s": ("m/s", 0.01, 0.5, "Speed of straight approach and depart motions"),
    "approach_m": ("m", 0.01, 0.5, "Length of the straight approach, along the axis of the tool"),
}


def build_proposal(
    steps: Sequence[ObservedStep],
    options: ProposalOptions,
    *,
    arm: str,
    tool: ToolName = "gripper",
    parts: Mapping[str, Vector3 | None] | None = None,
) -> Proposal:
    """Return the behavior that executes taught steps.

    Args:
        steps: The steps in order; a step without a role gets one.
        options: Its name, and the defaults of its parameters.
        arm: The arm that moves.
        tool: The kind of the arm's tool.
        parts: The parts that can be grasped, with their centres in the world where known.

    Raises:
        SkillFailed: a role does not fit its entry, no step moves the arm, or there is no such kind of tool.
    """
    known = parts or {}
    roles = [_with_part(taught, known) for taught in assign_step_roles(steps)]
    if all(taught.step.kind not in (*PLACES, *MOTIONS) for taught in roles):
        raise SkillFailed("no step moves the arm", where="teach", hint="select at least one pose or motion")
    plan = _Plan(ProposalNodeBuilder(arm, _kind(tool)), options)
    index = 0
    while index < len(roles):
        index += plan.take(roles, index)
    text = plan.text(_HEADER.format(names=", ".join(dict.fromkeys(each.step.name for each in roles))))
    return Proposal(
        text=text, steps=tuple(each.step for each in roles), words=tuple(plan.words), remarks=plan.all_remarks(),
        arm=arm, tool=tool, parts=tuple(known),
    )  # fmt: skip


def _kind(tool: ToolName) -> ToolKind:
    kinds = tool_kinds()
    if tool not in kinds:
        raise SkillFailed(f"there is no kind of tool {tool}", where="teach", hint=did_you_mean(tool, kinds))
    return kinds[tool]


def _with_part(taught: ObservedStep, parts: Mapping[str, Vector3 | None]) -> ObservedStep:
    """Name the part of a grasp that has none."""
    step = taught.step
    if step.role not in ("grasp", "close") or step.part is not None:
        return taught
    part = guess_part(taught, parts)
    return replace(taught, step=TaughtStep(kind=step.kind, name=step.name, role=step.role, part=part))


@dataclass
class _Plan:
    """The states of the behavior so far; their next states are set later."""

    nodes: ProposalNodeBuilder
    options: ProposalOptions
    states: dict[str, Node] = field(default_factory=dict[str, Node])
    words: list[str] = field(default_factory=list[str])
    remarks: dict[str, None] = field(default_factory=dict[str, None])
    widths: dict[str, float] = field(default_factory=dict[str, float])
    holds: str | None = None
    """The held part; empty for a part without a name, None for no part."""

    def take(self, steps: Sequence[ObservedStep], index: int) -> int:
        """Create the states of the step at `index` and of the steps that belong to it; return the number of steps."""
        taught = steps[index]
        if taught.role == "approach":
            following = steps[index + 1] if index + 1 < len(steps) else None
            if following is not None and following.role in ("grasp", "release"):
                return 1 + self._at(steps, index + 1, approach=taught)
            self._via(taught)
        elif taught.role in ("grasp", "release"):
            return self._at(steps, index, approach=None)
        elif taught.role == "follow":
            self._follow(taught)
        elif taught.role == "open":
            self._open()
        elif taught.role == "close":
            self._close(taught)
        else:
            self._via(taught)
        return 1

    def text(self, header: str) -> str:
        """Return the document."""
        names = [*self.states]
        for name, following in zip(names, [*names[1:], "finished"], strict=True):
            _lead_on(self.states[name], following)
        outcomes = ["finished", *(each for each in ("missed", "blocked") if each in self.nodes.outcomes), "failed"]
        document: Node = {"flexcell": 1, "name": self.options.name, "description": _summary(self.words)}
        if self.options.cell:
            document["cell"] = self.options.cell
        needed = self._parameters()
        if needed:
            document["parameters"] = needed
        document |= {"outcomes": outcomes, "success": ["finished"]}
        document["root"] = {"machine": {"initial": names[0], "states": self.states}}
        return header + write_yaml(document)

    def all_remarks(self) -> tuple[str, ...]:
        """Remarks for the reader."""
        return (*self.remarks, *((_END_HELD,) if self.holds is not None else ()))

    def _via(self, place: ObservedStep) -> None:
        words = f"Free of collisions to {place.step.name}."
        self._add(f"to_{place.step.name}", self.nodes.free(place, _NEXT, words), f"Move to {place.step.name}")

    def _follow(self, motion: ObservedStep) -> None:
        name = motion.step.name
        start = self.nodes.free_to_start(motion, _NEXT, f"Free of collisions to the start of {name}.")
        self._add(f"to_start_of_{name}", start, f"Move to the start of {name}")
        words = f"As taught in {name}."
        self._add(f"along_{name}", self.nodes.follow(motion, _NEXT, words), f"Follow {name}")

    def _open(self) -> None:
        part = self.holds or ""
        self._add("let_go", self.nodes.let_go(_NEXT, "The tool releases.", part=part), "Release")
        if part:
            self._add(f"detach_{part}", self.nodes.detach(part, _NEXT), "")
        self.holds = None

    def _close(self, taught: ObservedStep) -> None:
        part = taught.step.part or ""
        self._missing(part, "where the tool closes")
        self.nodes.outcomes["missed"] = None
        words = "The tool closes at the current pose."
        node = self.nodes.hold(_NEXT, "missed", words, part=part, width=self._width(taught), like=taught)
        self._add("hold", node, f"Grasp {part or 'the object'}")
        if part:
            self._add(f"attach_{part}", self.nodes.attach(part, _NEXT), "")
        self.holds = part

    def _at(self, steps: Sequence[ObservedStep], index: int, *, approach: ObservedStep | None) -> int:
        """Grasp or release at a pose; includes the action of the tool there, and the depart."""
        place, count, like = steps[index], 1, None
        closing = place.role == "grasp"
        if index + count < len(steps) and steps[index + count].role == ("close" if closing else "open"):
            like = steps[index + count]
            count += 1
        depart = approach
        if index + count < len(steps) and steps[index + count].role == "depart":
            depart = steps[index + count]
            count += 1
        if closing:
            self._grasp(place, approach, depart, like)
        else:
            self._release(place, approach, depart)
        return count

    def _grasp(
        self, place: ObservedStep, approach: ObservedStep | None, depart: ObservedStep | None, like: ObservedStep | None
    ) -> None:
        name, nodes = place.step.name, self.nodes
        part = place.step.part or (like.step.part if like is not None else None) or ""
        self._missing(part, f"at {name}")
        nodes.outcomes["missed"] = None
        inside: dict[str, Node] = {
            "open": nodes.let_go("approach", "The tool is empty."),
            "approach": self._in_front(place, approach, "down", "Free of collisions"),
            "down": nodes.straight(place, "grasp", f"Straight to {name}."),
            "grasp": nodes.hold(
                "attach" if part else "up", "let_go", f"The tool grasps {part or 'the part'}.",
                part=part, width=self._width(like), like=like,
            ),
        }  # fmt: skip
        if part:
            inside["attach"] = nodes.attach(part, "up")
        inside |= {
            "up": self._straight_out(place, depart, "check"),
            "check": nodes.still_held("picked", "let_go", "The part was lifted.", part=part),
            "let_go": nodes.let_go("detach" if part else "back_off", "The tool opens again without the part."),
        }
        if part:
            inside["detach"] = nodes.detach(part, "back_off")
        inside["back_off"] = self._straight_out(place, depart, "missed")
        words = f"Pick {part or 'a part'} at {name}"
        self._add_machine(f"pick_{part or name}", inside, "open", "picked", words)
        self.holds = part

    def _release(self, place: ObservedStep, approach: ObservedStep | None, depart: ObservedStep | None) -> None:
        name, nodes, part = place.step.name, self.nodes, self.holds or ""
        nodes.outcomes["missed"] = None
        inside: dict[str, Node] = {
            "approach": self._in_front(place, approach, "check", "Free of collisions, with the part,"),
            "check": nodes.still_held("down", "missed", "A part is placed only if it is still held.", part=part),
            "down": nodes.straight(place, "let_go", f"Straight to {name}."),
            "let_go": nodes.let_go("detach" if part else "up", "The part is released.", part=part),
        }
        if part:
            inside["detach"] = nodes.detach(part, "up")
        inside["up"] = self._straight_out(place, depart, "placed")
        words = f"Place {part or 'it'} at {name}"
        self._add_machine(
            f"place_{part}_at_{name}" if part else f"place_at_{name}", inside, "approach", "placed", words
        )
        self.holds = None

    def _in_front(self, place: ObservedStep, approach: ObservedStep | None, then: str, words: str) -> Node:
        if approach is not None:
            return self.nodes.free(approach, then, f"{words} to {approach.step.name}.")
        return self.nodes.free(place, then, f"{words} to in front of {place.step.name}.", before=True)

    def _straight_out(self, place: ObservedStep, depart: ObservedStep | None, then: str) -> Node:
        if depart is not None:
            return self.nodes.straight(depart, then, f"Straight to {depart.step.name}.")
        return self.nodes.straight(place, then, f"Straight back from {place.step.name}.", before=True)

    def _width(self, like: ObservedStep | None) -> str:
        """Return the parameter with the width of the grasped part; one parameter for each taught width."""
        taught = like is not None and like.step.kind == "gripper" and like.width_m > 0.0
        width_m = like.width_m if like is not None and taught else self.options.width_m
        if not self.nodes.takes_width:
            return ""
        if width_m is None:
            self.remarks[_UNKNOWN_WIDTH] = None
            return ""
        rounded = round(width_m, 4)
        for name, known in self.widths.items():
            if known == rounded:
                return name
        name = f"width_{len(self.widths) + 1}_m" if self.widths else "width_m"
        self.widths[name] = rounded
        return name

    def _missing(self, part: str, where: str) -> None:
        if not part:
            self.remarks[_UNKNOWN_PART.format(where=where)] = None

    def _parameters(self) -> Node:
        defaults = {
            "speed": self.options.speed,
            "line_speed_m_s": self.options.line_speed_m_s,
            "approach_m": self.options.approach_m,
        }
        made: Node = {}
        for name, (unit, least, most, words) in _PARAMETERS.items():
            if name in self.nodes.needed:
                default = defaults[name]
                limits = {"minimum": min(least, default), "maximum": max(most, default)}
                measured = {"unit": unit} if unit else {}
                made[name] = {"type": "number", "default": default, **limits, **measured, "description": words}
        for name, width_m in self.widths.items():
            words = "Width of the grasped part, between the fingers"
            limits = {"minimum": 0.0, "maximum": max(1.0, width_m)}
            made[name] = {"type": "number", "default": width_m, **limits, "unit": "m", "description": words}
        return made

    def _add_machine(self, name: str, inside: dict[str, Node], initial: str, good: str, words: str) -> None:
        leads = {
            str(target) for node in inside.values() for target in _transitions(node).values() if target not in inside
        }
        ends = {good: _NEXT, **{each: each for each in ("missed", "blocked", "failed") if each in leads}}
        machine = {"initial": initial, "states": inside}
        self._add(name, {"description": f"{words}.", "machine": machine, "transitions": ends}, words)

    def _add(self, name: str, node: Node, words: str) -> None:
        self.states[_free_name(name, self.states)] = node
        if words:
            self.words.append(words)


_NEXT = "\0next"
"""Placeholder in a transition for the next state."""


def _transitions(node: Node) -> dict[str, object]:
    return cast("dict[str, object]", node["transitions"])


def _lead_on(node: Node, following: str) -> None:
    node["transitions"] = {
        outcome: following if target == _NEXT else target for outcome, target in _transitions(node).items()
    }


def _free_name(preferred: str, taken: Mapping[str, Node]) -> str:
    base = re.sub(r"[^a-z0-9_]+", "_", preferred)[:58].strip("_")
    number, name = 1, base
    while name in taken or name in ("finished", "missed", "blocked", "failed"):
        number += 1
        name = f"{base}_{number}"
    return name


def _summary(words: Sequence[str]) -> str:
    text = ", ".join(word[0].lower() + word[1:] for word in words)
    text = text[0].upper() + text[1:]
    return f"{text}." if len(text) <= 300 else f"{text[:297]}..."
