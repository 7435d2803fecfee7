"""vision.Detect: detects objects with the detector of a camera."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar

import msgspec
from msgspec import Meta

from engine.cause_chain import cause_of, wrap_cause
from engine.errors import Cause, SkillFailed
from engine.messages import Pose
from engine.skills.vision import Detection, Detections, DetectObjects, Score
from engine.state import Context, Outcome, State, nothing_to_undo


class Detect(State, frozen=True, kw_only=True):
    """Detect objects in the next image of a camera; the best detection has the highest score.

    Writes all `detections`, best first, with their poses in the world, and `pose` and `label` of the best.
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
            description="Name of the camera; its cell entry needs `detect`",
            extra_json_schema={"cell_name": "detector"},
        ),
    ]
    label: Annotated[
        str,
        Meta(
            description="Label to detect; empty for any",
            extra_json_schema={"cell_name": "label", "of": "camera"},
        ),
    ] = ""
    minimal_score: Score = 0.5

    async def run(self, ctx: Context) -> Outcome:
        """Call the detector; no image gives the outcome `failed`, a camera without a detector raises an error."""
        request = DetectObjects(labels=(self.label,) if self.label else (), minimal_score=self.minimal_score)
        what = self.label or "anything"
        try:
            result = await ctx.call(request, to=self.camera)
        except SkillFailed as error:
            message = f"{self.camera} could not detect {what}"
            return Outcome("failed", cause=wrap_cause(message, cause_of(error), where=ctx.path, kind=self.state_name))
        detections = _in_world(result)
        if not detections:
            because = Cause(
                message=f"no detection has a score of {self.minimal_score:.2f} or more",
                where=f"{self.camera}/{request.skill_name()}",
            )
            message = f"{self.camera} did not detect {what}"
            cause = wrap_cause(message, because, where=ctx.path, kind=self.state_name)
            return Outcome("not_found", {"detections": []}, cause)
        best = detections[0]
        return Outcome("found", {"detections": detections, "pose": best.pose, "label": best.label})


def _in_world(result: Detections) -> list[Detection]:
    """Return the detections, best first, with poses in the world."""
    detections = [msgspec.structs.replace(each, pose=result.in_world(each)) for each in result.detections]
    return sorted(detections, key=lambda each: -each.score)
