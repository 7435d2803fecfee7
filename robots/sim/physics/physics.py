"""The interface to MuJoCo: a compiled model and its state behind typed arrays and calls.

MuJoCo's Python bindings have no types, so its objects are `Any`, only here and in the two modules
that build specifications.
"""

from __future__ import annotations

import hashlib
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robots.model.transform import cross
from robots.port import Array
from robots.sim.physics.mujoco_library import load_mujoco

mujoco: Any = load_mujoco()

# Distances are measured up to this one.
_FAR_M = 100.0
_CYLINDER = int(mujoco.mjtGeom.mjGEOM_CYLINDER)


class Physics:
    """One MuJoCo world. The arrays are views of its state and stay valid.

    Shapes: `positions` (nq,), `velocities` (nv,), `motors` (nu,), `gravity_m_s2` (3,), `tendon_lengths` (nt,). Forces
    of the simulator are not offered: controllers of arms and drives of tools know nominal models only.

    `geom_centres` (n, 3) and `geom_rotations` (n, 9), row by row, are the poses of the geometries at the start of the
    last step, and `geom_radii` (n,) the radii of the spheres around their centres that contain them.
    """

    def __init__(self, model: Any) -> None:
        self._model = model
        self._data: Any = mujoco.MjData(model)
        self._state_kind: Any = mujoco.mjtState.mjSTATE_INTEGRATION
        self._step1, self._step2 = mujoco.mj_step1, mujoco.mj_step2
        self._wrench = np.zeros(6)
        self._attractions: dict[int, Array] = {}
        self.step_s = float(model.opt.timestep)
        self.dof_count = int(model.nv)
        self.state_size = int(mujoco.mj_stateSize(model, self._state_kind))
        self.geom_body: list[int] = model.geom_bodyid.tolist()
        self.positions: Array = self._data.qpos
        self.velocities: Array = self._data.qvel
        self.motors: Array = self._data.ctrl
        self.gravity_m_s2: Array = model.opt.gravity.copy()
        self.tendon_lengths: Array = self._data.ten_length
        self._xpos: Array = self._data.xpos
        self._xquat: Array = self._data.xquat
        self._rotations: Array = self._data.xmat.reshape(-1, 3, 3)
        self._body_wrenches: Array = self._data.cfrc_ext
        self._tree_centres: Array = self._data.subtree_com
        self._pushes: Array = self._data.xfrc_applied
        self._roots: list[int] = model.body_rootid.tolist()
        self.geom_centres: Array = self._data.geom_xpos
        self.geom_rotations: Array = self._data.geom_xmat
        self.geom_radii: Array = model.geom_rbound.copy()
        self._probe: Any = None
        # The rows of the constraints of bonds; they change where a bond begins or ends to act.
        self._coupling_rows: dict[tuple[int, ...], list[tuple[int, int]]] = {}
        self._couplings_changed = False

    def refresh(self) -> None:
        """Recompute everything that follows from positions and velocities."""
        mujoco.mj_forward(self._model, self._data)

    def start_step(self) -> None:
        """Compute poses and contacts of the present state."""
        if self._couplings_changed:
            self._coupling_rows.clear()
            self._couplings_changed = False
        self._step1(self._model, self._data)
        self._attractions.clear()

    def finish_step(self) -> None:
        """Apply motors and external pushes, integrate over one step, and compute the wrenches."""
        pushes = self._pushes
        before = {body: pushes[body].copy() for body in self._attractions}
        for body, attraction in self._attractions.items():
            pushes[body] += attraction
        self._step2(self._model, self._data)
        mujoco.mj_rnePostConstraint(self._model, self._data)
        for body, push in before.items():
            pushes[body] = push

    def body_number(self, name: str) -> int:
        """Return the number of a body."""
        return int(self._model.body(name).id)

    def motor_number(self, name: str) -> int:
        """Return the number of a motor in `motors`."""
        return int(self._model.actuator(name).id)

    def tendon_number(self, name: str) -> int:
        """Return the number of a tendon in `tendon_lengths`."""
        return int(self._model.tendon(name).id)

    def run_joint(self, joint: str, velocity: float) -> None:
        """Let a joint with one axis have a velocity, in m/s or rad/s, in the next step, and be at 0 before it."""
        found = self._model.joint(joint)
        self.positions[found.qposadr[0]] = 0.0
        self.velocities[found.dofadr[0]] = velocity

    def set_dry_friction(self, joint: str, force: float) -> None:
        """Set the dry friction of a joint with one axis, N or N m, from the next step on."""
        self._model.dof_frictionloss[self._model.joint(joint).dofadr[0]] = force

    def set_damping(self, joint: str, damping: float) -> None:
        """Set the damping of a joint with one axis, N s/m or N m s/rad, from the next step on."""
        self._model.dof_damping[self._model.joint(joint).dofadr[0]] = damping

    def joint_address(self, joint: str) -> int:
        """Return the address of the position of a joint with one axis."""
        return int(self._model.joint(joint).qposadr[0])

    def coupling_number(self, name: str) -> int:
        """Return the number of a coupling: a constraint that holds two bodies together."""
        return int(self._model.equality(name).id)

    def couple(self, coupling: int, *, on: bool) -> None:
        """Hold two bodies together from the next step on, or let them go; it is part of the state."""
        self._data.eq_active[coupling] = on
        self._couplings_changed = True

    def is_coupled(self, coupling: int) -> bool:
        """Return whether a coupling holds."""
        return bool(self._data.eq_active[coupling])

    def coupling_loads(self, couplings: tuple[int, ...]) -> list[tuple[float, float]]:
        """Return the force in N and the torque in N m, about its place, that each coupling carried in the last step.

        Args:
            couplings: Their numbers, ascending.
        """
        data = self._data
        count = int(data.ne)
        rows = self._coupling_rows.get(couplings)
        if rows is None:
            numbers = data.efc_id[:count]
            first = np.searchsorted(numbers, couplings).tolist()
            rows = list(zip(first, np.searchsorted(numbers, couplings, side="right").tolist(), strict=True))
            self._coupling_rows[couplings] = rows
        loads: list[float] = data.efc_force[:count].tolist()
        # The rows of a weld's rotation are those of a quaternion, of half the angle.
        return [(math.hypot(*loads[a : min(a + 3, b)]), 0.5 * math.hypot(*loads[a + 3 : b])) for a, b in rows]

    def gap_m(self, geom: int, point: Array) -> float:
        """Return the distance of a point in the world from a box or an upright cylinder, 0 inside."""
        inside = np.abs((point - self.geom_position(geom)) @ self.geom_axes(geom))
        size: Array = self._model.geom_size[geom]
        if int(self._model.geom_type[geom]) == _CYLINDER:
            beyond = np.array([np.hypot(inside[0], inside[1]) - size[0], inside[2] - size[1]])
        else:
            beyond = inside - size
        return float(np.linalg.norm(np.maximum(beyond, 0.0)))

    def members(self, body: int) -> NDArray[np.intp]:
        """Return the numbers of a body and of all its descendants."""
        found = {body}
        # A body's parent has a lower number.
        for child, parent in enumerate(self._model.body_parentid.tolist()):
            if parent in found:
                found.add(child)
        return np.array(sorted(found), dtype=np.intp)

    def point_of(self, body: int, offset: Array) -> Array:
        """Return a point given in a body's frame in the world at the start of the last step, both (3,)."""
        return self._xpos[body] + self._rotations[body] @ offset

    def axes_of(self, body: int) -> Array:
        """Return the axes of a body in the world as columns, (3, 3)."""
        return self._rotations[body]

    def wrench_on(self, bodies: NDArray[np.intp], point: Array) -> Array:
        """Return force and torque about `point` (6,), world axes, exerted by contacts and pushes on bodies.

        It refers to the last step; the bodies belong to one tree. A force sensor before the first body
        would measure the same, after subtraction of their own weight and inertia.
        """
        sums = np.add.reduce(self._body_wrenches[bodies])
        centre = self._tree_centres[self._roots[bodies[0]]]
        force = sums[3:]
        return np.concatenate((force, sums[:3] + cross(centre - point, force)))

    def contact_pairs(self) -> list[tuple[int, int]]:
        """Return the two geometries of each contact of the last step."""
        return [(a, b) for a, b in self._data.contact.geom.tolist()] if self._data.ncon else []

    @property
    def contact_count(self) -> int:
        """The number of contact points of the last step."""
        return self._data.ncon

    def contact_geoms(self) -> NDArray[np.int32]:
        """Return the contact pairs as an array, (m, 2), valid until the next step."""
        return self._data.contact.geom

    def contact_depth_m(self, contact: int) -> float:
        """Return the penetration depth of a contact of the last step, negative for a gap."""
        return -float(self._data.contact.dist[contact])

    def normal_force_n(self, contact: int) -> float:
        """Return the normal force of a contact of the last step."""
        mujoco.mj_contactForce(self._model, self._data, contact, self._wrench)
        return float(self._wrench[0])

    def pressing_force_n(self, contact: int, axis: Array) -> float:
        """Return the force of a contact of the last step along a unit `axis` (world), friction included."""
        mujoco.mj_contactForce(self._model, self._data, contact, self._wrench)
        frame: Array = self._data.contact.frame[contact].reshape(3, 3)
        return abs(float(axis @ (self._wrench[:3] @ frame)))

    def geom_axes(self, geom: int) -> Array:
        """Return the axes of a geometry in the world as columns, (3, 3)."""
        return self._data.geom_xmat[geom].reshape(3, 3)

    def geom_position(self, geom: int) -> Array:
        """Return the centre of a geometry in the world, (3,)."""
        return self._data.geom_xpos[geom]

    def distance_m(self, first: int, second: int) -> float:
        """Return the distance of two geometries at the start of the last step, negative where they overlap."""
        return mujoco.mj_geomDistance(self._model, self._data, first, second, _FAR_M, None)

    def collidable_pairs(self) -> NDArray[np.intp]:
        """Return all pairs of geometries between which there can be contacts and whose distance can change, (n, 2)."""
        model = self._model
        first, second = np.triu_indices(model.ngeom, k=1)
        kinds, partners, body = model.geom_contype, model.geom_conaffinity, model.geom_bodyid.astype(np.intp)
        touching = ((kinds[first] & partners[second]) | (kinds[second] & partners[first])).astype(np.bool_)
        # Bodies without a joint between them are one.
        welded = model.body_weldid[body]
        touching &= welded[first] != welded[second]
        low, high = np.minimum(body[first], body[second]), np.maximum(body[first], body[second])
        excluded = np.sort(np.stack((model.exclude_signature >> 16, model.exclude_signature & 0xFFFF), axis=1), axis=1)
        touching &= ~np.isin(low * model.nbody + high, excluded @ (model.nbody, 1))
        return np.stack((first[touching], second[touching]), axis=1)

    def geom_distance(self, geom: int, point: Array) -> float:
        """Return a lower bound of the distance from a point (world) to a geometry: to its bounding sphere."""
        return float(np.linalg.norm(self._data.geom_xpos[geom] - point)) - float(self._model.geom_rbound[geom])

    def ray(self, geom: int, start: Array, direction: Array) -> float:
        """Return the distance along a ray (world, unit direction) to a primitive geometry, -1 for no hit."""
        data, model = self._data, self._model
        matrix, size, kind = data.geom_xmat[geom], model.geom_size[geom], model.geom_type[geom]
        return float(mujoco.mju_rayGeom(data.geom_xpos[geom], matrix, size, start, direction, int(kind)))

    def tendon(self, tendon: int) -> tuple[float, float]:
        """Return the length of a tendon and its rate."""
        return float(self._data.ten_length[tendon]), float(self._data.ten_velocity[tendon])

    def speed(self, body: int) -> float:
        """Return the speed of the origin of a free body, m/s."""
        dof = int(self._model.body_dofadr[body])
        return float(np.linalg.norm(self.velocities[dof : dof + 3]))

    def attract(self, body: int, *, force: Array, point: Array) -> None:
        """Add an external force (3,) at a point, both in the world, to the step begun by `start_step` only."""
        attraction = self._attractions.setdefault(body, np.zeros(6))
        attraction[:3] += force
        attraction[3:] += cross(point - self._data.xipos[body], force)

    def apart_m(self, body: int, other: int) -> float:
        """Return the distance of the origins of two bodies at the start of the last step."""
        return math.dist(self._xpos[body].tolist(), self._xpos[other].tolist())

    def seen_from(self, body: int, other: int) -> Array:
        """Return the origin of another body in the frame of a body, (3,), at the start of the last step."""
        return (self._xpos[other] - self._xpos[body]) @ self._rotations[body]

    def body_poses(self, bodies: NDArray[np.intp]) -> tuple[Array, Array]:
        """Return positions (m, 3) and quaternions w x y z (m, 4) of bodies at the start of the last step."""
        return self._xpos[bodies], self._xquat[bodies]

    def place_fixed(self, body: int, xyz: Array, xyzw: Array) -> None:
        """Place a body that no joint moves from the next step on; its published pose is the new one at once."""
        place_fixed(self._model, body, xyz, xyzw)
        self._show(body, xyz, xyzw)

    def place_free(self, qpos: NDArray[np.intp], dof: NDArray[np.intp], xyz: Array, xyzw: Array, *, body: int) -> None:
        """Place a free body, at rest, with the addresses of its pose (7,) and velocity (6,)."""
        self.positions[qpos] = (*xyz.tolist(), *np.roll(xyzw, 1).tolist())
        self.velocities[dof] = 0.0
        self._data.qacc_warmstart[dof] = 0.0
        self._pushes[body] = 0.0
        self._show(body, xyz, xyzw)

    def prepare_probe(self) -> None:
        """Allocate what `near` needs, so that it allocates nothing later."""
        self._probe = mujoco.MjData(self._model)

    def near(self, bodies: set[int], *, within_m: float) -> dict[int, float]:
        """Return the distances, negative in one another, of what could touch the present positions of `bodies`.

        It looks at a copy: nothing of the state changes. Bodies that are fixed to the world are near bodies that
        can move only.
        """
        model, probe = self._model, self._probe
        probe.qpos[:] = self.positions
        mujoco.mj_kinematics(model, probe)
        body_of = model.geom_bodyid
        mine = np.isin(body_of, list(bodies))
        first, second = np.meshgrid(mine.nonzero()[0], (~mine).nonzero()[0], indexing="ij")
        first, second = first.reshape(-1), second.reshape(-1)
        kinds, partners = model.geom_contype, model.geom_conaffinity
        chosen = ((kinds[first] & partners[second]) | (kinds[second] & partners[first])) != 0
        welded = model.body_weldid[body_of]
        chosen &= welded[first] != welded[second]
        centres, radii = probe.geom_xpos, model.geom_rbound
        apart = np.linalg.norm(centres[first] - centres[second], axis=1) - radii[first] - radii[second]
        chosen &= apart <= within_m
        found: dict[int, float] = {}
        for a, b in zip(first[chosen].tolist(), second[chosen].tolist(), strict=True):
            distance_m = float(mujoco.mj_geomDistance(model, probe, a, b, within_m + 0.01, None))
            other = int(body_of[b])
            if distance_m <= within_m:
                found[other] = min(distance_m, found.get(other, distance_m))
        return found

    def pose_now(self, qpos: NDArray[np.intp]) -> tuple[Array, Array]:
        """Return position (3,) and quaternion x y z w (4,) of a free body with the addresses of its pose."""
        place = self.positions[qpos]
        return place[:3].copy(), np.roll(place[3:], -1)

    def _show(self, body: int, xyz: Array, xyzw: Array) -> None:
        self._xpos[body], self._xquat[body] = xyz, np.roll(xyzw, 1)
        mujoco.mju_quat2Mat(self._data.xmat[body], self._xquat[body])

    def read_state(self, out: Array) -> None:
        """Write the complete state, shape (`state_size`,)."""
        mujoco.mj_getState(self._model, self._data, out, self._state_kind)

    def rest_at(self, state: Array) -> None:
        """Restore a state, at rest."""
        # Leftovers outside the state must not affect later steps either.
        mujoco.mj_resetData(self._model, self._data)
        mujoco.mj_setState(self._model, self._data, state, self._state_kind)
        self._couplings_changed = True
        self.velocities[:] = 0.0
        self._pushes[:] = 0.0
        self.refresh()

    def state_hash(self) -> str:
        """Return the SHA-256 of the complete state."""
        state = np.zeros(self.state_size)
        self.read_state(state)
        return hashlib.sha256(state.tobytes()).hexdigest()


def place_fixed(model: Any, body: int, xyz: Array, xyzw: Array) -> None:
    """Place a body of a compiled model that stands in the world without a joint, or on a joint of its own."""
    model.body_pos[body], model.body_quat[body] = xyz, np.roll(xyzw, 1)
