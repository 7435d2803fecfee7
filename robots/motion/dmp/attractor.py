"""The transformation systems: critically damped attractors driven by a forcing term, solved over time.

Time is normalised, s = t / tau; velocities are per tau. For positions

    y'' = a_z (b_z (g - y) - y') + f(x),   b_z = a_z / 4            (Ijspeert et al. 2013)

and for orientations, with ω' and ω in world axes,

    ω' = a_z (b_z 2 log(g * conj(q)) - ω) + f(x),   q' = ½ ω * q     (Ude et al. 2014)
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from robots.motion.dmp.quaternions import conjugate, log, product
from robots.port import Array

_SMALL = 1e-12


@dataclass(frozen=True, kw_only=True)
class AttractorResponse:
    """A solution at even time steps: `value` (T, n) or quaternions (T, 4), `rate` per tau and `push` per tau²."""

    value: Array
    rate: Array
    push: Array


def attract(*, force: Array, goal: Array, value: Array, rate: Array, a_z: float, step: float) -> AttractorResponse:
    """Return the positions over time, exact for forces and goals that are linear between samples.

    Args:
        force: The forcing term at each sample, (T, n).
        goal: The goal at each sample, (T, n).
        value: Start position, (n,).
        rate: Start velocity per tau, (n,).
        a_z: The gain.
        step: Sample period as a share of tau.
    """
    # With b_z = a_z / 4 both poles are at -a_z / 2: two equal first-order systems in series.
    pole = a_z / 2.0
    drive = force + pole * pole * goal
    slope = np.diff(drive, axis=0) / step
    decay = math.exp(-pole * step)
    # Within a step the inner system tends to `steady` + `ramp` t.
    ramp = slope / pole
    steady = drive[:-1] / pole - ramp / pole
    inner = _recur(rate + pole * value, steady * (1.0 - decay) + ramp * step, decay)
    settle = steady / pole - ramp / pole**2
    fed = step * decay * (inner[:-1] - steady) + settle * (1.0 - decay) + ramp / pole * step
    values = _recur(value, fed, decay)
    rates = inner - pole * values
    return AttractorResponse(value=values, rate=rates, push=drive - pole**2 * values - 2.0 * pole * rates)


def _recur(first: Array, fed: Array, decay: float) -> Array:
    """Return v with v[0] = first and v[k + 1] = decay v[k] + fed[k], by doubling: log2(T) passes over the rows."""
    values = np.concatenate((first[None, :], fed))
    reach, factor = 1, decay
    while reach < len(values) and factor > 1e-18:
        values[reach:] = values[reach:] + factor * values[:-reach]
        reach, factor = 2 * reach, factor * factor
    return values


def attract_orientation(
    *, force: Array, goal: Array, value: Array, rate: Array, a_z: float, step: float
) -> AttractorResponse:
    """Return the orientations over time by the midpoint rule on the rotation group.

    Args:
        force: The forcing term, (2 T - 1, 3): at each sample and halfway between.
        goal: The goals, unit quaternions, (2 T - 1, 4).
        value: Start orientation, (4,).
        rate: Start angular velocity per tau, (3,).
        a_z: The gain.
        step: Sample period as a share of tau.
    """
    samples = (len(force) + 1) // 2
    values, rates = np.empty((samples, 4)), np.empty((samples, 3))
    forces, goals = force.tolist(), goal.tolist()
    turn, spin = tuple(value.tolist()), tuple(rate.tolist())
    values[0], rates[0] = turn, spin
    half = step / 2.0
    for k in range(samples - 1):
        push = orientation_acceleration(turn, spin, goals[2 * k], forces[2 * k], a_z)
        middle = (spin[0] + half * push[0], spin[1] + half * push[1], spin[2] + half * push[2])
        push = orientation_acceleration(
            integrate_rotation(turn, spin, half), middle, goals[2 * k + 1], forces[2 * k + 1], a_z
        )
        spin = (spin[0] + step * push[0], spin[1] + step * push[1], spin[2] + step * push[2])
        turn = integrate_rotation(turn, middle, step)
        values[k + 1], rates[k + 1] = turn, spin
    missing = log(product(goal[::2], conjugate(values)))
    push = a_z * (a_z / 4.0 * missing - rates) + force[::2]
    return AttractorResponse(value=values, rate=rates, push=push)


Three = tuple[float, float, float]
Four = tuple[float, float, float, float]


def orientation_acceleration(turn: Four, spin: Three, goal: list[float], force: list[float], a_z: float) -> Three:
    """Return the angular acceleration per tau² towards `goal` under `force`; plain floats, as arrays of 3 are slow."""
    x, y, z, w = _error(goal, turn)
    sine = math.sqrt(x * x + y * y + z * z)
    pull = a_z * a_z / 4.0 * (2.0 * math.atan2(sine, w) / sine if sine > _SMALL else 2.0)
    return (
        pull * x - a_z * spin[0] + force[0],
        pull * y - a_z * spin[1] + force[1],
        pull * z - a_z * spin[2] + force[2],
    )


def integrate_rotation(turn: Four, spin: Three, span: float) -> Four:
    """Return the orientation after a rotation at `spin` (world axes) for `span`."""
    speed = math.sqrt(spin[0] * spin[0] + spin[1] * spin[1] + spin[2] * spin[2])
    share = math.sin(0.5 * speed * span) / speed if speed * span > _SMALL else 0.5 * span
    x, y, z, w = share * spin[0], share * spin[1], share * spin[2], math.cos(0.5 * speed * span)
    a, b, c, d = turn
    px, py, pz, pw = (
        w * a + x * d + y * c - z * b,
        w * b - x * c + y * d + z * a,
        w * c + x * b - y * a + z * d,
        w * d - x * a - y * b - z * c,
    )
    scale = 1.0 / math.sqrt(px * px + py * py + pz * pz + pw * pw)
    return (px * scale, py * scale, pz * scale, pw * scale)


def _error(goal: list[float] | Four, turn: list[float] | Four) -> Four:
    """Return goal * conj(turn), with its sign."""
    gx, gy, gz, gw = goal
    x, y, z, w = turn
    return (
        gx * w - gw * x - gy * z + gz * y,
        gy * w - gw * y - gz * x + gx * z,
        gz * w - gw * z - gx * y + gy * x,
        gw * w + gx * x + gy * y + gz * z,
    )
