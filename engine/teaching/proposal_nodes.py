"""The nodes of a proposed behavior, as document data."""

from __future__ import annotations

from dataclasses import dataclass, field

from engine.cell.tool_kind import ToolKind
from engine.registry import installed_state
from engine.teaching.step_roles import ObservedStep

Node = dict[str, object]
SPEED, LINE_SPEED, APPROACH = "${speed}", "${line_speed_m_s}", "${approach_m}"
LINE_S = 3.0


@dataclass
class ProposalNodeBuilder:
    """Creates nodes for one arm and its tool, and collects the parameters and outcomes that they require."""

    arm: str
    tool: ToolKind
    needed: dict[str, None] = field(default_factory=dict[str, None])
    outcomes: dict[str, None] = field(default_factory=dict[str, None])

    @property
    def takes_width(self) -> bool:
        """True if the tool is given the width of the part that it grasps."""
        return "width_m" in installed_state(self.tool.hold).__struct_fields__

    def free(self, place: ObservedStep, then: str, words: str, *, before: bool = False) -> Node:
        """Move to a pose, or to the approach pose before it, along a collision-free path."""
        where = "joints" if place.step.kind == "joints" else "pose"
        given: Node = {"robot": self.arm, where: {"entry": place.step.name}, **(self._back() if before else {})}
        return self._free(given, then, words)

    def free_to_start(self, motion: ObservedStep, then: str, words: str) -> Node:
        """Move to the start of a taught motion along a collision-free path."""
        return self._free({"robot": self.arm, "start_of": {motion.step.kind: motion.step.name}}, then, words)

    def straight(self, place: ObservedStep, then: str, words: str, *, before: bool = False) -> Node:
        """Move the tool straight to a pose, or to the approach pose before it."""
        where = "joints" if place.step.kind == "joints" else "target"
        given: Node = {"robot": self.arm, where: {"entry": place.step.name}, **(self._back() if before else {})}
        if place.frame == "world":
            self.needed["line_speed_m_s"] = None
            given["speed_m_s"] = LINE_SPEED
        else:
            # The distance in another frame is unknown, so no speed can be set.
            given["duration_s"] = LINE_S
        return self._state("motion.MoveLinear", given, {"reached": then}, words)

    def follow(self, motion: ObservedStep, then: str, words: str) -> Node:
        """Execute a taught motion."""
        state, key = {
            "trajectory": ("motion.FollowRecording", "recording"),
            "dmp": ("motion.FollowJointDmp", "dmp"),
            "cart_dmp": ("motion.FollowCartDmp", "dmp"),
        }[motion.step.kind]
        return self._state(state, {"robot": self.arm, key: {"entry": motion.step.name}}, {"reached": then}, words)

    def let_go(self, then: str, words: str, *, part: str = "") -> Node:
        """Open the tool, or switch it off."""
        state = installed_state(self.tool.release)
        return self._state(state.state_name, {**self._tool(), **_named(part)}, {state.success[0]: then}, words)

    def hold(self, then: str, missed: str, words: str, *, part: str, width: str, like: ObservedStep | None) -> Node:
        """Close the tool, or switch it on; `width` is the parameter of the width, empty if it is unknown."""
        state = installed_state(self.tool.hold)
        given = {**self._tool(), **_named(part)}
        settings = state.__struct_fields__
        if "percent" in settings:
            given["percent"] = 80
        if "width_m" in settings and width:
            self.needed[width] = None
            given["width_m"] = f"${{{width}}}"
        elif "width_m" in settings:
            # Any object between the fingers counts.
            given |= {"width_m": 0.04, "tolerance_inner_m": 0.038, "tolerance_outer_m": 0.2}
        if "force_n" in settings and like is not None and like.force_n > 0.0:
            given["force_n"] = round(like.force_n, 1)
        return self._state(state.state_name, given, {"held": then, "missed": missed}, words)

    def still_held(self, then: str, lost: str, words: str, *, part: str) -> Node:
        """Check whether the tool holds its part."""
        node = self._state(self.tool.check, {**self._tool(), **_named(part)}, {"held": then, "lost": lost}, words)
        node["transitions"] = {"held": then, "lost": lost}
        return node

    def attach(self, part: str, then: str) -> Node:
        """Attach the part: plan with it as a part of the arm."""
        words = "Paths are now planned with the attached part."
        return self._state("scene.Attach", {"part": part, "robot": self.arm}, {"attached": then}, words)

    def detach(self, part: str, then: str) -> Node:
        """Detach the part: plan without it."""
        words = "The part is now an obstacle at its pose."
        return self._state("scene.Detach", {"part": part}, {"detached": then}, words)

    def _free(self, given: Node, then: str, words: str) -> Node:
        self.needed["speed"] = None
        self.outcomes["blocked"] = None
        ends = {"reached": then, "blocked": "blocked", "no_way": "blocked"}
        return self._state("motion.MoveFree", {**given, "speed": SPEED}, ends, words)

    def _back(self) -> Node:
        self.needed["approach_m"] = None
        return {"back_m": APPROACH}

    def _tool(self) -> Node:
        return {self.tool.name: self.arm}

    @staticmethod
    def _state(state: str, given: Node, ends: dict[str, str], words: str) -> Node:
        return {"description": words, "state": state, "with": given, "transitions": {**ends, "failed": "failed"}}


def _named(part: str) -> Node:
    return {"part": part} if part else {}
