"""Executes the motions of one arm: follows a generator, holds, resumes, cancels, finishes and reports the end."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from robots.control.arm_state import ArmState
from robots.control.generators.motion_generator import MotionGenerator, StreamGenerator
from robots.control.generators.yielding import YieldGenerator
from robots.control.motion_event import AnyMotionEvent, MotionFinished, MotionHeld, MotionResumed
from robots.model.robot_model import JointLimits
from robots.port import Array, MotionEnd, MotionReport, Tolerance

_REST_RAD_S = 0.01
_REST_S = 0.02
_STILL_MOVING_AFTER_S = 3.0


@dataclass(kw_only=True)
class _ActiveMotion:
    """The active motion."""

    number: int
    generator: MotionGenerator
    tolerance: Tolerance
    ending: MotionEnd | None = None
    reason: str = ""
    stop_cause: str = ""
    hold: bool = False
    finishing: bool = False
    request: int = 0
    held_reported: bool = False
    resume_pending: bool = False
    waited_s: float = 0.0


class MotionExecutor:
    """The set point of one arm; without a motion it is constant.

    `position`, `velocity` and `acceleration` are the set point, shape (n,); call `step` once per
    control period with the measured arm. `pace` is the speed override of every motion, `permitted_pace` the share of
    its full speed that separation monitoring permits, `controller_pace` that which a real controller permits of any
    speed. `touching` says what the arm touches, `settling` whether its controller still brings it nearer to a set point
    that stands.
    """

    def __init__(
        self, *, joints: tuple[str, ...], limits: JointLimits, touching: Callable[[], str], settling: Callable[[], bool]
    ) -> None:
        self._joints = joints
        self._limits = limits
        self._touching = touching
        self._settling = settling
        self._following: _ActiveMotion | None = None
        self._rest_s = 0.0
        self.pace = 1.0
        self.permitted_pace = 1.0
        self.controller_pace = 1.0
        self._yielding: YieldGenerator | None = None
        self.position = np.zeros(len(joints))
        self.velocity = np.zeros(len(joints))
        self.acceleration = np.zeros(len(joints))

    def initialize(self, position: Array) -> None:
        """Hold `position`; drops the active motion."""
        self._following, self._yielding, self._rest_s = None, None, 0.0
        self.position[:] = position
        self._stand_still()

    @property
    def number(self) -> int:
        """Number of the active motion, 0 for none."""
        return self._following.number if self._following else 0

    @property
    def generator(self) -> MotionGenerator | None:
        """The generator of the active motion, None without one."""
        return self._following.generator if self._following else None

    @property
    def generator_name(self) -> str:
        """What generates the set point, and whether it comes to rest; for messages."""
        following = self._following
        if following is None:
            return "rest"
        if self._yielding is not None:
            return self._yielding.name
        stops = following.hold or following.ending is not None
        return following.generator.name + (" to rest" if stops else "")

    @property
    def progress(self) -> float:
        """Elapsed share of the trajectory's time; 1 without a motion."""
        return self._following.generator.progress if self._following else 1.0

    @property
    def leads(self) -> bool:
        """False while the set point follows the arm, as in guiding."""
        following = self._following
        return following is None or self._yielding is not None or following.generator.leads

    def start(self, number: int, generator: MotionGenerator, tolerance: Tolerance) -> None:
        """Start a motion; the generator starts at the set point and no other motion is active."""
        self._following = _ActiveMotion(number=number, generator=generator, tolerance=tolerance)

    def fail(self, reason: str) -> None:
        """End the active motion as FAILED: it brakes on its path, then yields to the measured joints."""
        following = self._following
        if following and following.ending is not MotionEnd.FAILED:
            following.ending, following.reason, following.waited_s = MotionEnd.FAILED, reason, 0.0

    def reject(self, reason: str, past: Array, *, step_s: float) -> None:
        """Replace the present set point by a stop from the last one, `past` (3, n), and end the motion as FAILED.

        `past` has position, velocity and acceleration. Without a motion, or where the arm leads, the last one is held.
        """
        following = self._following
        if following is None or not following.generator.leads:
            self.position[:] = past[0]
            self._stand_still()
            return
        self.fail(reason)
        self._yield_from(past[0], past[1], past[2])
        assert self._yielding is not None
        self._yielding.step(step_s, past[0])
        self._take(self._yielding)

    def receive(self, number: int, values: Array, *, age_s: float = 0.0) -> None:
        """Pass on values sent to a stream `age_s` ago; ignored without such a stream."""
        following = self._following
        if following and following.number == number and isinstance(following.generator, StreamGenerator):
            following.generator.receive(values, age_s=age_s)

    def finish(self, number: int) -> None:
        """Bring a stream to rest and end it as REACHED, also while it is held."""
        following = self._following
        if following and following.number == number and isinstance(following.generator, StreamGenerator):
            following.generator.finish()
            following.finishing, following.hold = True, False

    def hold(self, number: int, *, request: int = 0) -> None:
        """Decelerate on the path; a finishing stream comes to rest and ends anyway."""
        following = self._following
        if following and following.number == number and not following.finishing:
            following.hold, following.held_reported, following.resume_pending = True, False, False
            following.request = request

    def resume(self, number: int, *, request: int = 0) -> None:
        """Resume along the path."""
        following = self._following
        if following and following.number == number:
            following.hold, following.resume_pending, following.request = False, True, request

    def cancel(self, number: int) -> None:
        """Decelerate on the path, then end as CANCELED."""
        if self._following and self._following.number == number and self._following.ending is None:
            self._following.ending = MotionEnd.CANCELED

    def stop(self, cause: str = "") -> None:
        """Cancel the active motion; with a `cause` it fails with that. The set point is held."""
        following = self._following
        if following and following.ending is None:
            following.ending, following.stop_cause = MotionEnd.CANCELED, cause

    def step(self, step_s: float, state: ArmState) -> tuple[AnyMotionEvent, ...]:
        """Advance the set point by one period and return the events."""
        position = state.position
        at_rest = self._measure_rest(step_s, state.velocity)
        following = self._following
        if following is None:
            return ()
        if self._yielding is not None:
            self._yielding.step(step_s, position)
            self._take(self._yielding)
        else:
            pace = min(self.pace, self.permitted_pace) * self.controller_pace
            target = 0.0 if following.hold or following.ending is not None else pace
            following.generator.step(step_s, target_pace=target, state=state)
            self._take(following.generator)
            if following.generator.failure:
                self.fail(following.generator.failure)
            self._check_path(following, position)
        return self._judge(following, step_s, position, at_rest=at_rest)

    def _measure_rest(self, step_s: float, velocity: Array) -> bool:
        self._rest_s = self._rest_s + step_s if np.maximum.reduce(np.abs(velocity)) < _REST_RAD_S else 0.0
        return self._rest_s >= _REST_S

    def _take(self, generator: MotionGenerator | YieldGenerator) -> None:
        self.position[:] = generator.position
        self.velocity[:] = generator.velocity
        self.acceleration[:] = generator.acceleration

    def _stand_still(self) -> None:
        self.velocity[:] = 0.0
        self.acceleration[:] = 0.0

    def _check_path(self, following: _ActiveMotion, position: Array) -> None:
        if following.ending is MotionEnd.FAILED or not following.generator.leads:
            return
        error = np.abs(self.position - position)
        worst = int(error.argmax())
        if error[worst] > following.tolerance.path_rad:
            following.ending = MotionEnd.FAILED
            following.reason = self._reason(worst, float(error[worst]), "behind its set point")

    def _reason(self, joint: int, error_rad: float, what: str) -> str:
        contact = self._touching()
        return f"{self._joints[joint]} is {error_rad:.3f} rad {what}" + (f"; {contact}" if contact else "")

    def _judge(
        self, following: _ActiveMotion, step_s: float, position: Array, *, at_rest: bool
    ) -> tuple[AnyMotionEvent, ...]:
        generator = following.generator
        if self._yielding is not None:
            return self._end_when_at_rest(following, step_s, at_rest=at_rest)
        if following.resume_pending and generator.moving:
            following.resume_pending = False
            return (MotionResumed(motion=following.number, request=following.request),)
        if not generator.stopped:
            return ()
        if following.ending is not None:
            return self._end_when_at_rest(following, step_s, at_rest=at_rest)
        if following.hold:
            if not at_rest or following.held_reported:
                return ()
            following.held_reported = True
            return (MotionHeld(motion=following.number, request=following.request),)
        return self._settle(following, step_s, position, at_rest=at_rest) if generator.complete else ()

    def _settle(
        self, following: _ActiveMotion, step_s: float, position: Array, *, at_rest: bool
    ) -> tuple[AnyMotionEvent, ...]:
        goal = following.generator.goal
        error = np.abs((position if goal is None else goal) - position)
        worst = int(np.argmax(error))
        tolerance = following.tolerance
        is_away = error[worst] > tolerance.in_position_rad
        waits = is_away and following.waited_s < tolerance.in_position_s and self._settling()
        if at_rest and not waits and error[worst] <= tolerance.goal_rad:
            return self._finish(following, MotionEnd.REACHED, "")
        following.waited_s += step_s
        if following.waited_s >= tolerance.settle_s:
            following.ending, following.waited_s = MotionEnd.FAILED, 0.0
            moving = "" if at_rest else " and still moving"
            settle = f"away from the goal{moving} after {tolerance.settle_s:g} s"
            following.reason = self._reason(worst, float(error[worst]), settle)
        return ()

    def _end_when_at_rest(
        self, following: _ActiveMotion, step_s: float, *, at_rest: bool
    ) -> tuple[AnyMotionEvent, ...]:
        ending = following.ending or MotionEnd.CANCELED
        if ending is MotionEnd.FAILED and self._yielding is None:
            self._yield_from(self.position, self.velocity, self.acceleration)
            return ()
        following.waited_s += step_s
        if self._yielding is not None and not self._yielding.complete:
            return ()
        if at_rest:
            if following.stop_cause and not following.reason:
                return self._finish(following, MotionEnd.FAILED, following.stop_cause)
            return self._finish(following, ending, following.reason)
        if following.waited_s >= _STILL_MOVING_AFTER_S:
            why = following.reason or following.stop_cause
            reason = (why + "; " if why else "") + "the arm does not come to rest"
            return self._finish(following, MotionEnd.FAILED, reason, at_rest=False)
        return ()

    def _yield_from(self, position: Array, velocity: Array, acceleration: Array) -> None:
        self._yielding = YieldGenerator(
            limits=self._limits, position=position, velocity=velocity, acceleration=acceleration
        )

    def _finish(
        self, following: _ActiveMotion, end: MotionEnd, reason: str, *, at_rest: bool = True
    ) -> tuple[AnyMotionEvent, ...]:
        self._following, self._yielding = None, None
        self._stand_still()
        generator = following.generator
        return (
            MotionFinished(
                motion=following.number,
                progress=generator.progress,
                report=MotionReport(
                    end=end, reason=reason, contact=generator.contact, data=generator.data(), at_rest=at_rest
                ),
            ),
        )
