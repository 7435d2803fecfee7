"""Parts that are joined, as they are placed in a seeded run, and the bonds between them with the limits of that run."""

from __future__ import annotations

import zlib
from collections.abc import Mapping

import numpy as np
from msgspec.structs import replace

from engine.document import BondSpec, PartSpec, joined_groups
from engine.messages import Pose
from robots.model.transform import RigidTransform
from robots.scene.jitter import jitter_pose


def part_poses(parts: Mapping[str, PartSpec], bonds: Mapping[str, BondSpec], *, seed: int | None) -> dict[str, Pose]:
    """Return the poses of parts in the world; with a `seed` they are displaced, those that are joined as one."""
    poses = {name: part.at.pose() for name, part in parts.items()}
    if seed is None:
        return poses
    displaced = {
        name: jitter_pose(pose, name=name, seed=seed, xy_m=parts[name].jitter.xy_m, yaw_rad=parts[name].jitter.yaw_rad)
        for name, pose in poses.items()
    }
    for group in joined_groups(bonds):
        leader = next((name for name in parts if name in group and displaced[name] != poses[name]), None)
        if leader is None:
            continue
        moved, home = RigidTransform.from_pose(displaced[leader]), RigidTransform.from_pose(poses[leader]).inverse()
        for name in group - {leader}:
            displaced[name] = moved.then(home.then(RigidTransform.from_pose(poses[name]))).to_pose("world")
    return displaced


def drawn_bonds(bonds: Mapping[str, BondSpec], *, seed: int | None) -> dict[str, BondSpec]:
    """Return the bonds of a world; with a `seed` their limits deviate by their jitter."""
    return dict(bonds) if seed is None else {name: _drawn(name, bond, seed) for name, bond in bonds.items()}


def _drawn(name: str, bond: BondSpec, seed: int) -> BondSpec:
    stream = np.random.default_rng([seed, zlib.crc32(f"bond {name}".encode())])
    share = 1.0 + bond.jitter * float(stream.uniform(-1.0, 1.0))
    return replace(
        bond,
        force_n=_scaled(bond.force_n, share),
        torque_nm=_scaled(bond.torque_nm, share),
        cut_n=_scaled(bond.cut_n, share),
    )


def _scaled(limit: float | None, share: float) -> float | None:
    return limit * share if limit is not None else None
