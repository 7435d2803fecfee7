"""The latest measurements of a world as one flat array of numbers, the same in process and in shared memory."""

from __future__ import annotations

from dataclasses import dataclass

import msgspec
import numpy as np

from engine.messages import Quaternion, Vector3
from robots.port import ArmSample, Array, PermittedSpeed
from robots.sim.grip.tool_reading import ToolReading
from robots.sim.grip.tool_summary import ToolSummary
from robots.sim.loop.bond_reading import BOND_FIELDS, BondReading, bond_readings
from robots.sim.measures.measure_layout import MeasureLayout
from robots.sim.people.person_report import PersonSample, person_sample, report_size

# Motion number, progress, three measurements of the device, then the contacts.
_TOOL_FIELDS = 5
LOCK_FIELDS = 3
"""Numbers of a tool changer: its output is on; it has a tool; a plate is at its face."""


class ArmSummary(msgspec.Struct, frozen=True, kw_only=True):
    """The data required to command an arm; `tool` is None for a bare flange, and with a tool changer."""

    name: str
    joints: tuple[str, ...]
    tool: ToolSummary | None = None
    tool_changer: bool = False


class CellSummary(msgspec.Struct, frozen=True, kw_only=True):
    """Summary of a built world for its users.

    `bodies` are all names in contacts; `parts` are the last of `frames`. `model` is the
    fingerprint of the compiled world, `image_size` the length of its image, in which modules begin at `modules_at`.
    """

    step_s: float
    arms: tuple[ArmSummary, ...]
    frames: tuple[str, ...]
    parts: tuple[str, ...]
    bodies: tuple[str, ...]
    model: str
    image_size: int
    modules_at: int = 0
    people: tuple[str, ...] = ()
    bonds: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class ArmFields:
    """Positions of one arm's numbers: `joints` is a block of 5 x n, rows as in `ArmSample`; `wrench` has six.

    `separation` has the three numbers of `PermittedSpeed`, `held` the part that follows a driven tool or is in the tool
    changer, -1 for none. `lock` has output and sensors of a tool changer, as in `robots.sim.loop.tool_locks`.
    """

    number: int
    progress: int
    reflex: int
    separation: slice
    wrench: slice
    joints: slice
    dof: int
    tool: slice
    lock: slice
    held: int


class SnapshotLayout:
    """Where each quantity lies in the array; both sides derive it from the summary.

    A tool has motion number, progress, three measurements, and the numbers of the touched bodies (-1 for
    none), one per contact of its summary. Its kind says what the measurements are. Frames have x y z and
    quaternion w x y z as in MuJoCo.
    """

    def __init__(self, summary: CellSummary) -> None:
        self.summary = summary
        self.time = 0
        at = 1
        arms: dict[str, ArmFields] = {}
        for arm in summary.arms:
            n = len(arm.joints)
            separation = slice(at + 3, at + 6)
            wrench = slice(separation.stop, separation.stop + 6)
            joints = slice(wrench.stop, wrench.stop + 5 * n)
            tool = slice(joints.stop, joints.stop + (_TOOL_FIELDS + arm.tool.contacts if arm.tool else 0))
            lock = slice(tool.stop, tool.stop + (LOCK_FIELDS if arm.tool_changer else 0))
            held = lock.stop
            arms[arm.name] = ArmFields(
                number=at,
                progress=at + 1,
                reflex=at + 2,
                separation=separation,
                wrench=wrench,
                joints=joints,
                dof=n,
                tool=tool,
                lock=lock,
                held=held,
            )
            at = held + 1
        self.arms = arms
        frames = len(summary.frames)
        self.frame_rows = {name: row for row, name in enumerate(summary.frames)}
        self.positions = slice(at, at + 3 * frames)
        self.quaternions = slice(at + 3 * frames, at + 7 * frames)
        at += 7 * frames
        self.people = slice(at, at + report_size(len(summary.people), body_count=len(summary.bodies)))
        self.measure_layout = MeasureLayout(
            {arm.name: arm.tool.kind if arm.tool is not None else None for arm in summary.arms}
        )
        self.measures = slice(self.people.stop, self.people.stop + self.measure_layout.size)
        self.bonds = slice(self.measures.stop, self.measures.stop + BOND_FIELDS * len(summary.bonds))
        self.size = self.bonds.stop

    def new_array(self) -> Array:
        """Return an array of the right size, zero."""
        return np.zeros(self.size)


class SimSnapshot:
    """One consistent state of the world, read-only."""

    def __init__(self, layout: SnapshotLayout, values: Array) -> None:
        self._layout = layout
        self._values = values

    @property
    def time_s(self) -> float:
        """Time of the world."""
        return float(self._values[0])

    def arm(self, name: str) -> ArmSample:
        """Return the measurement of one arm."""
        fields = self._layout.arms[name]
        block = self._values[fields.joints].reshape(5, fields.dof)
        return ArmSample(
            time_s=self.time_s,
            position_rad=block[0],
            velocity_rad_s=block[1],
            effort_nm=block[2],
            desired_rad=block[3],
            external_nm=block[4],
            wrench=self._values[fields.wrench],
            reflex=bool(self._values[fields.reflex]),
        )

    def arm_progress(self, name: str, motion: int) -> float | None:
        """Progress of an arm's motion; None if the arm does not execute this motion."""
        fields = self._layout.arms[name]
        return float(self._values[fields.progress]) if self._values[fields.number] == motion else None

    def moves(self, name: str) -> bool:
        """Return whether an arm has a motion, held or not."""
        return self._values[self._layout.arms[name].number] != 0.0

    def permitted(self, name: str) -> PermittedSpeed:
        """Return what separation monitoring permits an arm."""
        share, speed_m_s, protective_m = self._values[self._layout.arms[name].separation].tolist()
        return PermittedSpeed(share=share, speed_m_s=speed_m_s, protective_m=protective_m)

    def tool(self, name: str) -> ToolReading:
        """Return the measurement of the tool on an arm."""
        _, _, a, b, c, *touched = self._values[self._layout.arms[name].tool].tolist()
        contacts = tuple(self._body(body) for body in touched)
        return ToolReading(time_s=self.time_s, values=(a, b, c), contacts=contacts)

    def held_part(self, name: str) -> str:
        """Return the part that follows the driven tool of an arm, or is in its tool changer; empty for none."""
        number = int(self._values[self._layout.arms[name].held])
        return self._layout.summary.parts[number] if number >= 0 else ""

    def tool_lock(self, name: str) -> tuple[bool, bool, bool]:
        """Return whether the output of a tool changer is on, whether it has a tool, whether a plate is at its face."""
        on, locked, present = self._values[self._layout.arms[name].lock].tolist()
        return bool(on), bool(locked), bool(present)

    def person(self, name: str) -> PersonSample:
        """Motion and contacts of one person."""
        summary = self._layout.summary
        return person_sample(self._values[self._layout.people], summary.people, name, bodies=summary.bodies)

    def measures(self) -> dict[str, float]:
        """Measures by name, as of a fraction of a second before."""
        return self._layout.measure_layout.read(self._values[self._layout.measures])

    def bonds(self) -> dict[str, BondReading]:
        """State and load of each bond."""
        return bond_readings(self._values[self._layout.bonds], self._layout.summary.bonds)

    def tool_progress(self, name: str, motion: int) -> float | None:
        """Progress of a tool's motion; None if the tool does not execute this motion."""
        fields = self._values[self._layout.arms[name].tool]
        return float(fields[1]) if fields[0] == motion else None

    def frame(self, name: str) -> tuple[Array, Array]:
        """Position (3,) and quaternion x y z w (4,) of a frame of the summary."""
        row = self._layout.frame_rows[name]
        xyz = self._values[self._layout.positions][3 * row : 3 * row + 3]
        wxyz = self._values[self._layout.quaternions][4 * row : 4 * row + 4]
        return xyz, wxyz[[1, 2, 3, 0]]

    def frames(self) -> tuple[tuple[Vector3, ...], tuple[Quaternion, ...]]:
        """Positions and quaternions x y z w of all frames of the summary, in its order."""
        xyz = self._values[self._layout.positions].reshape(-1, 3).tolist()
        wxyz = self._values[self._layout.quaternions].reshape(-1, 4)
        xyzw = np.roll(wxyz, -1, axis=1).tolist()
        return tuple((x, y, z) for x, y, z in xyz), tuple((x, y, z, w) for x, y, z, w in xyzw)

    def _body(self, number: float) -> str:
        return self._layout.summary.bodies[int(number)] if number >= 0 else ""
