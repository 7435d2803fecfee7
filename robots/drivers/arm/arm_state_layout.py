"""The latest measurement of a real arm as one flat array of numbers in shared memory."""

from __future__ import annotations

from dataclasses import dataclass
from math import nan

import numpy as np

from engine.skills.arm_control import ControlSettings
from robots.port import ArmSample, Array

_OUTPUTS = _INPUTS = 32
ToolNumbers = tuple[float, float, float, float, float, float, float]
"""Load, kg, its centre of mass and the tool centre point, m, in the tool link."""
NO_TOOL: ToolNumbers = (nan, nan, nan, nan, nan, nan, nan)
"""That of a controller that was told none yet."""


@dataclass(frozen=True, kw_only=True)
class ArmProcessState:
    """What is written once a period.

    `read_at_s` is when the measurement came, on CLOCK_MONOTONIC. `motion` is the number of the active one, 0 for none.
    `tool` is what the controller has as `tool_numbers`.
    """

    sample: ArmSample
    motion: int
    progress: float
    speed_scaling: float
    outputs: tuple[bool, ...]
    read_at_s: float
    readings: int
    tool: ToolNumbers = NO_TOOL
    inputs: tuple[bool, ...] = ()

    def has_settings(self, settings: ControlSettings) -> bool:
        """Return whether the controller has their tool and load, or adopts them at the end of a motion."""
        return self.motion != 0 or self.tool == tool_numbers(settings)


def tool_numbers(settings: ControlSettings) -> ToolNumbers:
    """Return what a controller is told of tool and load."""
    return (settings.load_kg, *settings.load_com_m, *settings.tool_xyz_m)


class ArmStateLayout:
    """Where each quantity lies; both sides derive it from the number of joints."""

    def __init__(self, dof: int) -> None:
        self._dof = dof
        self._wrench = slice(8, 14)
        self._outputs = slice(14, 14 + _OUTPUTS)
        self._tool = slice(self._outputs.stop, self._outputs.stop + len(NO_TOOL))
        # Their number, then their values.
        self._inputs = slice(self._tool.stop, self._tool.stop + 1 + _INPUTS)
        self._joints = slice(self._inputs.stop, self._inputs.stop + 5 * dof)
        self.size = self._joints.stop

    def write(self, values: Array, state: ArmProcessState) -> None:
        """Write a state into an array of `size`."""
        sample = state.sample
        values[:8] = (
            sample.time_s,
            state.motion,
            state.progress,
            sample.reflex,
            state.speed_scaling,
            state.read_at_s,
            state.readings,
            len(state.outputs),
        )
        values[self._wrench] = sample.wrench
        values[self._tool] = state.tool
        values[self._outputs] = 0.0
        values[self._outputs][: len(state.outputs)] = state.outputs
        values[self._inputs] = 0.0
        values[self._inputs][: 1 + len(state.inputs)] = (len(state.inputs), *state.inputs)
        block = values[self._joints].reshape(5, self._dof)
        block[0], block[1], block[2] = sample.position_rad, sample.velocity_rad_s, sample.effort_nm
        block[3], block[4] = sample.desired_rad, sample.external_nm

    def read(self, values: Array) -> ArmProcessState:
        """Return the state that was written."""
        time_s, motion, progress, reflex, scaling, read_at_s, readings, outputs = values[:8].tolist()
        block = values[self._joints].reshape(5, self._dof)
        kg, com_x, com_y, com_z, tool_x, tool_y, tool_z = values[self._tool].tolist()
        sample = ArmSample(
            time_s=time_s,
            position_rad=block[0],
            velocity_rad_s=block[1],
            effort_nm=block[2],
            desired_rad=block[3],
            external_nm=block[4],
            wrench=values[self._wrench],
            reflex=bool(reflex),
        )
        inputs = values[self._inputs]
        return ArmProcessState(
            sample=sample,
            motion=int(motion),
            progress=progress,
            speed_scaling=scaling,
            outputs=tuple(np.asarray(values[self._outputs][: int(outputs)], dtype=bool).tolist()),
            read_at_s=read_at_s,
            readings=int(readings),
            tool=(kg, com_x, com_y, com_z, tool_x, tool_y, tool_z),
            inputs=tuple(np.asarray(inputs[1 : 1 + int(inputs[0])], dtype=bool).tolist()),
        )
