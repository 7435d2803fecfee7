"""Modules in physics: they come and go between two steps, and nothing else of the state changes."""

from __future__ import annotations

import random
from collections.abc import Callable

import numpy as np
import pytest

from engine.document.cell import Cell
from engine.document.docking import cell_as_docked
from engine.messages import Pose
from engine.skills.simulated_world import PushBody
from robots.control.commanding.arm_commands import FollowTrajectory
from robots.control.motion_event import MotionFinished
from robots.model.transform import RigidTransform
from robots.port import Array, MotionEnd, Tolerance
from robots.sim.commands.world_commands import ModulePlaced, PlaceModule, PushSimBody, ResetFreeParts, RestoreWorld
from robots.sim.loop.simulation import Simulation
from robots.sim.loop.snapshot import SimSnapshot
from robots.sim.physics.cell_model import CellModel, build_cell
from tests.robots.module_cell import module_cell, module_scene
from tests.robots.sim.sim_cell import smooth
from tests.tiers import nightly

HOME_SHIFT = np.array([0.3, 0.1, -0.2, 0.1, 0.2, -0.1, 0.3])


@pytest.fixture(scope="module", name="cell")
def _cell(tmp_path_factory: pytest.TempPathFactory) -> Cell:
    return module_cell(tmp_path_factory.mktemp("cell"))


@pytest.fixture(scope="module", name="built")
def _built(cell: Cell) -> CellModel:
    return build_cell(module_scene(cell))


@pytest.fixture(name="plug")
def _plug(cell: Cell) -> Callable[[Simulation, str, str], ModulePlaced]:
    def plug(simulation: Simulation, module: str, connector: str) -> ModulePlaced:
        pose = cell_as_docked(cell, {module: connector}).fixed_frames[module] if connector else None
        return simulation.place_module(PlaceModule(module=module, pose=pose))

    return plug


Plug = Callable[[Simulation, str, str], ModulePlaced]


def image(simulation: Simulation) -> Array:
    """Return the complete state."""
    values = np.zeros(simulation.image_layout.size)
    simulation.write_image(values)
    return values


def seen(simulation: Simulation) -> SimSnapshot:
    """Return what is measured."""
    values = simulation.layout.new_array()
    simulation.write_snapshot(values)
    return SimSnapshot(simulation.layout, values)


def place(simulation: Simulation, part: str) -> list[float]:
    """Return where a part is."""
    return seen(simulation).frame(part)[0].tolist()


def move(simulation: Simulation, arm: str, *, motion: int, sign: float) -> None:
    """Start a motion of 2 s away from the set point, or back."""
    start = seen(simulation).arm(arm).desired_rad.copy()
    way = smooth(start, start + sign * HOME_SHIFT, 2.0)
    simulation.apply(FollowTrajectory(arm=arm, motion=motion, trajectory=way, tolerance=Tolerance()))


def run(simulation: Simulation, steps: int) -> None:
    """Step without looking."""
    for _ in range(steps):
        simulation.step()


def test_plugging_changes_nothing_but_the_module_to_the_bit_while_both_arms_move(built: CellModel, plug: Plug) -> None:
    """The world beside it makes the same steps and is not changed."""
    changed, unchanged = Simulation(built), Simulation(built)
    for simulation in (changed, unchanged):
        move(simulation, "left", motion=1, sign=1.0)
        move(simulation, "right", motion=2, sign=1.0)
        run(simulation, 700)
    assert image(changed).tobytes() == image(unchanged).tobytes()
    for module, connector in (("full", "dock_1"), ("full", "")):
        assert plug(changed, module, connector).refused == ""
        differing = image(changed) != image(unchanged)
        # Its part and its ball: positions, velocities, warm start, each where the state has it.
        touched = int(differing[changed.image_layout.physics].sum())
        assert touched <= 2 * (7 + 6 + 6)
        differing[changed.image_layout.physics] = False
        differing[changed.image_layout.modules] = False
        assert not differing.any()
        for arm in ("left", "right"):
            fields = changed.layout.arms[arm]
            before, after = unchanged.layout.new_array(), changed.layout.new_array()
            unchanged.write_snapshot(before)
            changed.write_snapshot(after)
            assert after[fields.joints].tobytes() == before[fields.joints].tobytes()


@pytest.mark.parametrize("plugs", [12, nightly(200)])
def test_arms_reach_their_goals_whatever_is_plugged_meanwhile(built: CellModel, plug: Plug, plugs: int) -> None:
    """At random steps, in turns and to random connectors; no step of an arm is lost, and the parts go and come."""
    simulation, chance = Simulation(built), random.Random(4)
    docks: dict[str, str] = {}
    ends: list[MotionEnd] = []
    motions, since = 0, 10_000
    while plugs > 0:
        if not simulation.busy:
            for arm in ("left", "right"):
                motions += 1
                move(simulation, arm, motion=motions, sign=1.0 if motions % 4 in (1, 2) else -1.0)
        ends += [event.report.end for event in simulation.step() if isinstance(event, MotionFinished)]
        since += 1
        if since < 150 or chance.random() > 0.01:
            continue
        since, plugs = 0, plugs - 1
        module = chance.choice(("full", "other"))
        free = sorted({"dock_1", "dock_2"} - set(docks.values()))
        where = "" if module in docks else chance.choice(free)
        before = simulation.steps
        assert plug(simulation, module, where).refused == ""
        assert simulation.steps == before
        docks = {**docks, module: where} if where else {name: at for name, at in docks.items() if name != module}
        for name in ("full", "other"):
            away = place(simulation, f"{name}/block")[2] < -100.0
            assert away == (name not in docks)
    while simulation.busy:
        ends += [event.report.end for event in simulation.step() if isinstance(event, MotionFinished)]
    assert ends == [MotionEnd.REACHED] * motions
    for module, where in docks.items():
        run(simulation, 300)
        y = 0.4 if where == "dock_1" else -0.46
        assert place(simulation, f"{module}/block")[1:] == pytest.approx([y, 0.225], abs=2e-3)


def test_parts_lie_on_the_tray_fall_with_gravity_and_come_back_where_they_left(built: CellModel, plug: Plug) -> None:
    simulation = Simulation(built)
    assert plug(simulation, "full", "dock_1") == ModulePlaced(away=("other/block", "other/ball"))
    run(simulation, 300)
    block = place(simulation, "full/block")
    assert block == pytest.approx([0.54, 0.4, 0.225], abs=1e-3)
    # Pushed along the tray, so that it comes back elsewhere than it was at first.
    push = PushBody(body="full/block", force_n=(-1.5, 0.0, 0.0), duration_s=0.1, at_m=(0.0, 0.0, -0.01))
    simulation.apply(PushSimBody(push=push))
    run(simulation, 600)
    pushed = place(simulation, "full/block")
    assert pushed[0] < block[0] - 0.01
    assert plug(simulation, "full", "").away == ("full/block", "full/ball", "other/block", "other/ball")
    run(simulation, 500)
    assert place(simulation, "full/block")[2] < -100.0
    # The other connector is turned by 90°: along x of the first is along y of this one.
    assert plug(simulation, "full", "dock_2").refused == ""
    run(simulation, 300)
    assert place(simulation, "full/block") == pytest.approx([0.6, -0.4 + pushed[0] - 0.6, 0.225], abs=1e-3)


def test_a_part_that_was_carried_elsewhere_stays_and_is_no_longer_of_the_tray(built: CellModel, plug: Plug) -> None:
    simulation = Simulation(built)
    plug(simulation, "full", "dock_1")
    run(simulation, 100)
    moved = image(simulation)
    _put(simulation, built, moved, "full/ball", (0.5, 0.15, 0.22))
    run(simulation, 200)
    assert plug(simulation, "full", "").away == ("full/block", "other/block", "other/ball")
    run(simulation, 200)
    assert place(simulation, "full/ball")[2] == pytest.approx(0.22, abs=2e-3)
    assert plug(simulation, "full", "dock_1").away == ("other/block", "other/ball")
    assert place(simulation, "full/ball")[1] == pytest.approx(0.15, abs=0.01)
    simulation.apply(ResetFreeParts())
    assert place(simulation, "full/ball") == pytest.approx([0.66, 0.4, 0.225], abs=1e-9)


@pytest.mark.parametrize(
    ("part", "at", "refused"),
    [("own", (0.6, 0.4, 0.22), "own is where it would stand"), ("own", (0.6, 0.62, 0.225), "")],
    ids=["in the way", "beside it"],
)
def test_what_is_in_the_way_refuses_a_plug_and_nothing_changes(
    built: CellModel, plug: Plug, part: str, at: tuple[float, float, float], refused: str
) -> None:
    simulation = Simulation(built)
    _put(simulation, built, image(simulation), part, at)
    before = image(simulation)
    assert plug(simulation, "full", "dock_1").refused == refused
    if refused:
        assert image(simulation).tobytes() == before.tobytes()
        run(simulation, 50)
        assert place(simulation, "full/block")[2] < -100.0


def test_an_arm_in_the_way_refuses_a_plug_and_one_that_touches_it_an_unplug(built: CellModel, cell: Cell) -> None:
    simulation = Simulation(built)
    tool = RigidTransform.of(*seen(simulation).frame("left/panda_hand_tcp"))
    at = Pose(xyz=(float(tool.xyz[0]), float(tool.xyz[1]), float(tool.xyz[2]) - 0.005))
    before = image(simulation)
    placed = simulation.place_module(PlaceModule(module="full", pose=at))
    assert placed.refused.startswith("left/panda_")
    assert placed.refused.endswith("finger is where it would stand")
    assert image(simulation).tobytes() == before.tobytes()
    near = Pose(xyz=(at.xyz[0], at.xyz[1], at.xyz[2] - 0.001))
    while refused := simulation.place_module(PlaceModule(module="full", pose=near)).refused:
        assert "finger" in refused
        near = Pose(xyz=(near.xyz[0], near.xyz[1], near.xyz[2] - 0.001))
    before = image(simulation)
    placed = simulation.place_module(PlaceModule(module="full", pose=None))
    assert placed.refused.startswith("left/panda_")
    assert placed.refused.endswith("finger touches it")
    assert image(simulation).tobytes() == before.tobytes()


def test_a_part_of_others_on_the_tray_refuses_an_unplug(built: CellModel, plug: Plug) -> None:
    simulation = Simulation(built)
    plug(simulation, "full", "dock_1")
    _put(simulation, built, image(simulation), "own", (0.6, 0.4, 0.23))
    run(simulation, 100)
    before = image(simulation)
    assert plug(simulation, "full", "").refused == "own touches it"
    assert image(simulation).tobytes() == before.tobytes()


def test_a_restored_world_has_the_modules_of_its_snapshot(built: CellModel, plug: Plug) -> None:
    simulation = Simulation(built)
    plug(simulation, "full", "dock_2")
    run(simulation, 300)
    kept, block = image(simulation), place(simulation, "full/block")
    for change in (lambda: plug(simulation, "full", ""), lambda: plug(simulation, "other", "dock_1")):
        change()
        run(simulation, 50)
    another = Simulation(built)
    for world in (simulation, another):
        world.apply(RestoreWorld(image=kept))
        assert np.array_equal(image(world)[world.image_layout.modules], kept[world.image_layout.modules])
        run(world, 200)
        assert place(world, "full/block") == pytest.approx(block, abs=1e-3)
        assert place(world, "other/block")[2] < -100.0
        assert plug(world, "other", "dock_1").refused == ""


def _put(simulation: Simulation, built: CellModel, state: Array, part: str, at: tuple[float, float, float]) -> None:
    """Place a part, at rest, by the state of the world."""
    physics = state[simulation.image_layout.physics]
    # Time and positions come first.
    row = 1 + built.free_qpos.reshape(-1, 7)[built.parts.index(part)]
    physics[row] = (*at, 1.0, 0.0, 0.0, 0.0)
    simulation.apply(RestoreWorld(image=state))
