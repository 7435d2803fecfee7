"""vision.Detect: asks the detector of a camera what it finds."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar

import msgspec
from msgspec import Meta

from engine.cause_chain import cause_of, wrap_cause
from engine.errors import SkillFailed
from engine.event import Cause
from engine.messages import Pose
from engine.skills.vision import Detection, Detections, DetectObjects, Score
from engine.state import Context, Outcome, State, nothing_to_undo


class Detect(State, frozen=True, kw_only=True):
    """Look for things in the next image of a camera; the best is the one with the highest score.

    Writes `detections`, all that were found, the best first, with their poses in the world, and `pose` and `label`
    of the best.
    """

    state_name: ClassVar[str] = "vision.Detect"
    outcomes: ClassVar[tuple[str, ...]] = ("found", "not_found", "failed")
    success: ClassVar[tuple[str, ...]] = ("found",)
    outputs: ClassVar[Mapping[str, Any]] = {"detections": list[Detection], "pose": Pose, "label": str}
    unwritten: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "not_found": ("pose", "label"),
        "failed": ("detections", "pose", "label"),
    }
    undo = nothing_to_undo

    camera: Annotated[
        str,
        Meta(
            min_length=1,
            description="Name of the camera; it needs `detect` in the cell",
            extra_json_schema={"cell_name": "detector"},
        ),
    ]
    label: Annotated[
        str,
        Meta(
            description="What to look for; anything where it is empty",
            extra_json_schema={"cell_name": "label", "of": "camera"},
        ),
    ] = ""
    minimal_score: Score = 0.5

    async def run(self, ctx: Context) -> Outcome:
        """Ask the camera; one that gives no images is an outcome, one that detects nothing at all an error."""
        request = DetectObjects(labels=(self.label,) if self.label else (), minimal_score=self.minimal_score)
        what = self.label or "anything"
        try:
            found = await ctx.call(request, to=self.camera)
        except SkillFailed as error:
            message = f"{self.camera} did not look for {what}"
            return Outcome("failed", cause=wrap_cause(message, cause_of(error), where=ctx.path, kind=self.state_name))
        seen = _in_world(found)
        if not seen:
            because = Cause(
                message=f"nothing of that kind is seen with a score of {self.minimal_score:.2f} or more",
                where=f"{self.camera}/{request.skill_name()}",
            )
            message = f"{self.camera} does not find {what}"
            cause = wrap_cause(message, because, where=ctx.path, kind=self.state_name)
            return Outcome("not_found", {"detections": []}, cause)
        best = seen[0]
        return Outcome("found", {"detections": seen, "pose": best.pose, "label": best.label})


def _in_world(found: Detections) -> list[Detection]:
    """Return the detections, the best first, where they are in the world."""
    turned = [msgspec.structs.replace(each, pose=found.in_world(each)) for each in found.detections]
    return sorted(turned, key=lambda each: -each.score)
