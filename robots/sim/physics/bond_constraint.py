"""Bonds in MuJoCo's specification: equality constraints, whose forces are those that the bonds carry."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from engine.document import BondSpec
from robots.sim.physics.physics import mujoco

# Stiff, and as soft as a step of a millisecond permits: a gram or a kilogram sags by some hundredths of a millimetre.
_SOLREF, _SOLIMP = (0.004, 1.0), (0.98, 0.999, 0.0005, 0.5, 2.0)


def add_bonds(spec: Any, bonds: Mapping[str, BondSpec]) -> None:
    """Join bodies where they are placed, each bond under its own name."""
    for name, bond in bonds.items():
        kind = mujoco.mjtEq.mjEQ_CONNECT if bond.point else mujoco.mjtEq.mjEQ_WELD
        # The anchor of MuJoCo is in the frame of the first body of `connect`, but of the second of `weld`.
        first, second = (bond.part, bond.to) if bond.point else (bond.to, bond.part)
        joint = spec.add_equality(name=name, type=kind, objtype=mujoco.mjtObj.mjOBJ_BODY, name1=first, name2=second)
        joint.solref, joint.solimp = list(_SOLREF), list(_SOLIMP)
        data = joint.data.copy()
        data[:] = 0.0
        data[:3] = bond.at_m
        if not bond.point:
            data[10] = 1.0
        joint.data = data
