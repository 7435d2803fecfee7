"""Collects the packets of movement primitives, offsets and force references until they are complete."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeVar

import msgspec

from engine.messages import Pose
from engine.messages.pose_algebra import rotate_vector
from engine.messages.primitives import CartDmp, CartOffsets, ForceReference, JointDmp
from robots.reconcell.packet_errors import PacketRefused
from robots.reconcell.packets import JOINTS, DmpHeader, Doubles, KernelRow
from robots.reconcell.quaternion_order import QuaternionOrder, from_wire

T = TypeVar("T")

_WEIGHTS = tuple(f"w{number}" for number in range(1, JOINTS + 1))
_ROWS = ("c", "sigma", *_WEIGHTS)


class KernelRows:
    """The rows of one family as they arrive.

    No packet says how many kernels offsets and force references have: those before the first variance of 0.
    """

    def __init__(self, title: str) -> None:
        self._title = title
        self._rows: dict[str, Doubles] = {}

    @property
    def empty(self) -> bool:
        """Whether nothing has arrived."""
        return not self._rows

    def take(self, row: str, packet: KernelRow) -> None:
        """Keep a row."""
        self._rows[row] = packet.values

    def clear(self) -> None:
        """Forget all rows."""
        self._rows.clear()

    def missing(self) -> list[str]:
        """Return the rows that have not arrived."""
        return [row for row in _ROWS if row not in self._rows]

    def require(self) -> None:
        """Raise PacketRefused while a row is missing."""
        missing = self.missing()
        if missing:
            raise PacketRefused("incomplete parameters", f"{self._title}: no {', '.join(missing)}")

    def first(self, kernels: int) -> Mapping[str, Doubles]:
        """Return the first numbers of each row."""
        return {row: values[:kernels] for row, values in self._rows.items()}

    def used(self) -> Mapping[str, Doubles]:
        """Return each row up to the first variance of 0; raises PacketRefused for none or for one below it."""
        self.require()
        sigma = self._rows["sigma"]
        kernels = next((index for index, value in enumerate(sigma) if value == 0.0), len(sigma))
        if kernels == 0:
            raise PacketRefused("out of range", f"{self._title}: all variances are 0")
        if kernels > len(self._rows["c"]):
            raise PacketRefused(
                "incomplete parameters", f"{self._title}: {kernels} variances, {len(self._rows['c'])} centres"
            )
        return self.first(kernels)

    def offsets(self) -> CartOffsets | None:
        """Return adaptation offsets; None where no row has arrived."""
        if self.empty:
            return None
        if any(self._rows.get("w7", ())):
            raise PacketRefused("not supported", f"{self._title}: weights 7 are not 0; an offset has six components")
        used = self.used()
        values = {f"{row}o": used[row] for row in _WEIGHTS}
        return _converted({"c_o": used["c"], "sigma_o": used["sigma"], **values}, CartOffsets, self._title)

    def force(self) -> ForceReference:
        """Return the force reference."""
        used = self.used()
        values = {f"{row}f": used[row] for row in _WEIGHTS}
        fields = {"N_f": len(used["c"]), "c_f": used["c"], "sigma_f": used["sigma"], **values}
        return _converted(fields, ForceReference, self._title)


class PrimitiveParameters:
    """The packets of one primitive; its header begins a new one and forgets the rows before it."""

    def __init__(self, title: str) -> None:
        self._title = title
        self._header: DmpHeader | None = None
        self._rows = KernelRows(title)
        self._loaded = 0

    @property
    def loaded_id(self) -> int:
        """The number of the complete primitive, counted from 1 since the start; 0 while it is not complete."""
        return self._loaded if self.complete else 0

    @property
    def complete(self) -> bool:
        """Whether header and all rows are there."""
        return self._header is not None and not self._rows.missing()

    def begin(self, header: DmpHeader) -> None:
        """Take the header of a new primitive."""
        self._header = header
        self._rows.clear()
        self._loaded += 1

    def take(self, row: str, packet: KernelRow) -> None:
        """Take a row; raises PacketRefused where no header came before it."""
        if self._header is None:
            raise PacketRefused("no data", f"{self._title}: the first packet is that with N", hint="send it first")
        self._rows.take(row, packet)

    def require(self) -> None:
        """Raise PacketRefused while header or a row is missing."""
        if self._header is None:
            raise PacketRefused("incomplete parameters", f"{self._title}: no parameters have arrived")
        self._rows.require()

    def joint_dmp(self) -> JointDmp:
        """Return the joint primitive; raises PacketRefused while it is incomplete or where it is senseless."""
        header, rows = self._complete()
        fields = {"w": [rows[row] for row in _WEIGHTS], "goal": header.goal, "y0": header.y0}
        return _converted({**self._fields(header, rows), **fields}, JointDmp, self._title)

    def cart_dmp(self, *, base: Pose, order: QuaternionOrder) -> CartDmp:
        """Return the Cartesian primitive, whose numbers refer to the arm's `base`; raises as `joint_dmp` does."""
        header, rows = self._complete()
        poses = {
            name: (*row[:3], *from_wire(row[3:], order)) for name, row in (("goal", header.goal), ("y0", header.y0))
        }
        weights = {row: rows[row] for row in _WEIGHTS}
        moved = {"tasktrans": _matrix(base), "frame": base.frame}
        return _converted({**self._fields(header, rows), **poses, **weights, **moved}, CartDmp, self._title)

    def _complete(self) -> tuple[DmpHeader, Mapping[str, Doubles]]:
        self.require()
        header = self._header
        assert header is not None
        return header, self._rows.first(int(header.kernels))

    def _fields(self, header: DmpHeader, rows: Mapping[str, Doubles]) -> dict[str, object]:
        return {
            "N": int(header.kernels),
            "a_z": header.a_z,
            "a_x": header.a_x,
            "tau": header.tau,
            "id": self._loaded,
            "dy0": header.dy0,
            "c": rows["c"],
            "sigma": rows["sigma"],
        }


def _matrix(pose: Pose) -> Doubles:
    """Return the transform of a pose, 4 x 4 row by row."""
    axes = [rotate_vector(pose.xyzw, axis) for axis in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))]
    rows = [(*(axis[row] for axis in axes), pose.xyz[row]) for row in range(3)]
    return tuple(value for row in (*rows, (0.0, 0.0, 0.0, 1.0)) for value in row)


def _converted(fields: dict[str, Any], kind: type[T], title: str) -> T:
    try:
        return msgspec.convert(fields, kind)
    except msgspec.ValidationError as error:
        raise PacketRefused("out of range", f"{title}: {error}") from error
