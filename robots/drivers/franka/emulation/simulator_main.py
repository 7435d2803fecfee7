"""The process of the simulated robots: franky-sim, unchanged, in a scene with easier fingers and softer wrists.

Its first argument is a `SimulatorSetup`. Reads lines of JSON, each a `SimulatorInput`, and ends with its input.
Writes a `SimulatorReport` when it listens, and then again and again.
"""

from __future__ import annotations

import importlib
import os
import sys
import threading
import time
from itertools import count
from queue import SimpleQueue
from typing import Any

import msgspec

from robots.drivers.franka.emulation.mirrored_parts import MirroredParts
from robots.drivers.franka.emulation.scene_bodies import add_bodies, place_bases, soften_pads
from robots.drivers.franka.emulation.simulated_fingers import add_box, place_box, remove_dry_friction
from robots.drivers.franka.emulation.simulator_messages import (
    PartReport,
    RobotReport,
    SimulatorInput,
    SimulatorReport,
    SimulatorSetup,
)

# With the gains of franky-sim the last joint never rests: it chatters at 0.08 rad/s with every step.
_STIFFNESS_NM_RAD = (4500.0, 4500.0, 3500.0, 3500.0, 600.0, 600.0, 600.0)
_DAMPING_NMS_RAD = (450.0, 450.0, 350.0, 350.0, 60.0, 60.0, 60.0)
# So long after its last client the time of the robot stands still.
_LINGERING_STEPS, _IDLE_S = 3000, 0.02
_STEP_S = 0.001
_FINGERS = ("left_finger", "right_finger")
_AXES = 7


def main() -> None:
    """Serve the addresses of the robots until the input ends."""
    setup = msgspec.json.decode(sys.argv[1], type=SimulatorSetup)
    franky_sim = importlib.import_module("franky_sim")
    simulator = importlib.import_module("franky_sim.mujoco_simulator").MujocoSimulator()
    inputs: SimpleQueue[SimulatorInput] = SimpleQueue()
    with simulator:
        _build(simulator, setup)
        hosts = [robot.host for robot in setup.robots]
        with franky_sim.SimulationServer(simulator, hostname_candidates=hosts) as server:
            threading.Thread(target=_read_input, args=(inputs,), daemon=True).start()
            _serve(server, simulator, setup, inputs)


def _build(simulator: Any, setup: SimulatorSetup) -> None:
    for robot in setup.robots:
        start = {"initial_q": robot.start_rad} if robot.start_rad else {}
        simulator.add_robot(kp=_STIFFNESS_NM_RAD, kv=_DAMPING_NMS_RAD, position=robot.base.xyz, **start)
    place_bases(simulator.scene, setup.robots)
    remove_dry_friction(simulator.scene)
    if setup.scene is None:
        add_box(simulator.scene)
    else:
        soften_pads(simulator.scene)
        add_bodies(simulator.scene, setup.scene)


def _serve(server: Any, simulator: Any, setup: SimulatorSetup, inputs: SimpleQueue[SimulatorInput]) -> None:
    robots, lingering, late_s = server.robot_servers, 0, 0.0
    mirrored = MirroredParts(simulator.model, simulator.data)
    _write(_report(server, simulator, setup, steps=0, late_s=0.0))
    for step in count(1):
        is_used = any(robot.tcp_connected or robot.gripper_server.tcp_connected for robot in robots)
        lingering = 0 if is_used else lingering + 1
        if lingering < _LINGERING_STEPS:
            begun_s = time.monotonic()
            mirrored.place()
            server.run_once()
            late_s += max(0.0, time.monotonic() - begun_s - _STEP_S)
            if step % setup.report_steps == 0:
                _write(_report(server, simulator, setup, steps=step, late_s=late_s))
        else:
            for robot in robots:
                robot.process_commands()
            time.sleep(_IDLE_S)
        while not inputs.empty():
            given = inputs.get()
            mirrored.take(given.parts)
            if given.object_m is not None and setup.scene is None:
                place_box(simulator.model, given.object_m)


def _report(server: Any, simulator: Any, setup: SimulatorSetup, *, steps: int, late_s: float) -> SimulatorReport:
    model, data = simulator.model, simulator.data
    parts = [part.name for part in setup.scene.parts] if setup.scene is not None else []
    touched = _touched(model, data, robots=len(setup.robots), parts=frozenset(parts))
    return SimulatorReport(
        time_s=steps * _STEP_S,
        late_s=late_s,
        robots=tuple(
            _robot_report(data, number, width_m=each.robot.hand_width, touched=tuple(bodies))
            for number, (each, bodies) in enumerate(zip(server.robot_servers, touched, strict=True))
        ),
        parts={name: _pose(data.body(name)) for name in parts},
    )


def _robot_report(data: Any, number: int, *, width_m: float, touched: tuple[str, ...]) -> RobotReport:
    joints = [data.joint(f"robot{number}_fr3_joint{axis}") for axis in range(1, _AXES + 1)]
    return RobotReport(
        position_rad=tuple(float(joint.qpos[0]) for joint in joints),
        fastest_rad_s=max(abs(float(joint.qvel[0])) for joint in joints),
        width_m=width_m,
        touched=touched,
    )


def _pose(body: Any) -> PartReport:
    x, y, z = body.xpos.tolist()
    qw, qx, qy, qz = body.xquat.tolist()
    return PartReport(xyz=(x, y, z), xyzw=(qx, qy, qz, qw))


def _touched(model: Any, data: Any, *, robots: int, parts: frozenset[str]) -> list[list[str]]:
    """Return the parts that the fingers of each robot touch."""
    bodies = [{model.body(int(model.geom_bodyid[geom])).name for geom in pair} for pair in data.contact.geom]
    fingers = [{f"robot{number}_{finger}" for finger in _FINGERS} for number in range(robots)]
    return [sorted({part for pair in bodies if pair & own for part in pair & parts}) for own in fingers]


def _write(message: SimulatorReport) -> None:
    sys.stdout.write(msgspec.json.encode(message).decode() + "\n")
    sys.stdout.flush()


def _read_input(inputs: SimpleQueue[SimulatorInput]) -> None:
    for line in sys.stdin:
        inputs.put(msgspec.json.decode(line, type=SimulatorInput))
    os._exit(0)


if __name__ == "__main__":
    main()
