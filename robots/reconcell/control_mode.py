"""The mode bytes of table 1 of the ReconCell interfaces, and one of ours that stops."""

from __future__ import annotations

from enum import IntEnum


class ControlMode(IntEnum):
    """What the arm is commanded to do, as port 10000 receives it.

    The document has no byte that ends a motion; `STOP` is ours.
    """

    STOP = 0
    DIRECT = 4
    JOINT_TRAPEZOID = 5
    JOINT_DMP = 11
    CART_DMP = 12
    CART_LINE = 13
    ADMITTANCE = 16
    GUIDING = 101
