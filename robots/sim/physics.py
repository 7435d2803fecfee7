"""The edge to MuJoCo: a compiled model and its state behind typed arrays and calls.

MuJoCo's Python bindings carry no types, so its objects are `Any` in here and in the two modules
that build specifications, and nowhere else.
"""

from __future__ import annotations

import hashlib
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robots.port import Array

mujoco: Any = import_module("mujoco")


class Physics:
    """One MuJoCo world. The arrays are views of its state and stay valid.

    Shapes: `positions` (nq,), `velocities`, `bias` (nv,), `motors` (nu,). `bias` is gravity and
    Coriolis force at the state that `start_step` has read.
    """

    def __init__(self, model: Any) -> None:
        self._model = model
        self._data: Any = mujoco.MjData(model)
        self._state_kind: Any = mujoco.mjtState.mjSTATE_INTEGRATION
        self._step1, self._step2 = mujoco.mj_step1, mujoco.mj_step2
        self._wrench = np.zeros(6)
        self.step_s = float(model.opt.timestep)
        self.dof_count = int(model.nv)
        self.state_size = int(mujoco.mj_stateSize(model, self._state_kind))
        self.geom_body: list[int] = model.geom_bodyid.tolist()
        self.positions: Array = self._data.qpos
        self.velocities: Array = self._data.qvel
        self.motors: Array = self._data.ctrl
        self.bias: Array = self._data.qfrc_bias
        self._xpos: Array = self._data.xpos
        self._xquat: Array = self._data.xquat

    def refresh(self) -> None:
        """Recompute everything that follows from positions and velocities."""
        mujoco.mj_forward(self._model, self._data)

    def start_step(self) -> None:
        """Compute poses, contacts and bias of the present state."""
        self._step1(self._model, self._data)

    def finish_step(self) -> None:
        """Apply the motors and integrate over one step."""
        self._step2(self._model, self._data)

    def inertia_times(self, acceleration: Array, *, out: Array) -> None:
        """Write the forces that would accelerate by `acceleration`, both (nv,)."""
        mujoco.mj_mulM(self._model, self._data, out, acceleration)

    def inertia_diagonal(self) -> Array:
        """Return the diagonal of the mass matrix, (nv,)."""
        full = np.zeros((self.dof_count, self.dof_count))
        mujoco.mj_fullM(self._model, self._data, full)
        return np.diag(full).copy()

    def contact_pairs(self) -> list[tuple[int, int]]:
        """Return the two geometries of each contact of the last step."""
        return [(a, b) for a, b in self._data.contact.geom.tolist()] if self._data.ncon else []

    def normal_force_n(self, contact: int) -> float:
        """Return the normal force of a contact of the last step."""
        mujoco.mj_contactForce(self._model, self._data, contact, self._wrench)
        return float(self._wrench[0])

    def pressing_force_n(self, contact: int, axis: Array) -> float:
        """Return how hard a contact of the last step presses along a unit `axis` (world), friction included."""
        mujoco.mj_contactForce(self._model, self._data, contact, self._wrench)
        frame: Array = self._data.contact.frame[contact].reshape(3, 3)
        return abs(float(axis @ (self._wrench[:3] @ frame)))

    def geom_y_axis(self, geom: int) -> Array:
        """Return the y axis of a geometry in the world, (3,)."""
        return self._data.geom_xmat[geom].reshape(3, 3)[:, 1]

    def body_poses(self, bodies: NDArray[np.intp]) -> tuple[Array, Array]:
        """Return positions (m, 3) and quaternions w x y z (m, 4) of bodies at the start of the last step."""
        return self._xpos[bodies], self._xquat[bodies]

    def read_state(self, out: Array) -> None:
        """Write everything that the future depends on, shape (`state_size`,)."""
        mujoco.mj_getState(self._model, self._data, out, self._state_kind)

    def rest_at(self, state: Array) -> None:
        """Go to where a state was read, and stand still there."""
        # What is no part of the state but left over from before must not reach the future either.
        mujoco.mj_resetData(self._model, self._data)
        mujoco.mj_setState(self._model, self._data, state, self._state_kind)
        self.velocities[:] = 0.0
        self.refresh()

    def state_hash(self) -> str:
        """Return the SHA-256 of everything that the future depends on."""
        state = np.zeros(self.state_size)
        self.read_state(state)
        return hashlib.sha256(state.tobytes()).hexdigest()
