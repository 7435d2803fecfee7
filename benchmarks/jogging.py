"""Whether each press of a jog moves the arm: `python -P -m benchmarks.jogging [--presses N] [--drags N] [--cell NAME]`.

A real Chromium opens the page that teaches, of a simulated cell in real time, and jogs its first arm: first presses
(after the start, a change of button, frame, mode, a stop), then seeded changes of direction by mouse, keyboard,
touch, gamepad, its stick alone, and the handle in the 3D view. The log of the joints says what each has moved. A
press is *moved* if the tool, or the joint, went its way after it, *told* if the page said that it was dropped, else
*lost*; that does not depend on the speed of the machine, the times do. Needs the extras `all` and `test`.
"""

from __future__ import annotations

import argparse
import math
import random
import sys
import tempfile
import time
from collections.abc import Callable, Generator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from statistics import median
from typing import Any, cast

import numpy as np
from msgspec import structs
from playwright.sync_api import Page, expect, sync_playwright

from benchmarks.handle_on_screen import Arrow, find_arrows
from engine.document.cell import load_cell
from engine.messages import JointState, RobotDescription
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.transform import RigidTransform
from robots.port import Array
from robots.scene.scene_builder import build_scene
from tests.editor_web.browsing import browser_program, opened_page
from tests.editor_web.teach_page import DEADMAN, SHIFT, Gamepads
from tests.editor_web.teach_site import RESTS_RAD_S, TeachSite

ROOT = Path(__file__).parents[1]
ARM, SEED = "left", 7
AXES = ("X", "Y", "Z", "RX", "RY", "RZ")
KEYS = ("Arrow", "ArrowUp", "ArrowDown", "ArrowLeft", "ArrowRight", "PageUp", "PageDown")
HOLDS_S = (0.0, 0.03, 0.08, 0.15)
STRAIGHT, LEAST_M, LEAST_RAD, STILL_S = 0.9, 3e-4, 1e-3, 0.15
LOST_S, UP_MS, SILENCE_S = 20.0, 600_000, 20.0
DROPPED = "was dropped"
_STOP = """() => fetch('/api/v1/cell/stop', {method: 'POST', headers: {'content-type': 'application/json'},
    body: JSON.stringify({reason: 'benchmark'})}).then((answer) => answer.status)"""


@dataclass(frozen=True, kw_only=True)
class Direction:
    """Where a press is to move the arm: along or about an axis of a frame, or a joint."""

    axis: int
    sign: int
    frame: str = "World"
    space: str = "Tool"


@dataclass(frozen=True, kw_only=True)
class Result:
    """What became of one press; times in seconds."""

    end: str
    to_motion_s: float = math.nan
    to_rest_s: float = math.nan


@dataclass
class Log:
    """The joints of the arm as they were published, each with when that was."""

    kinematics: ArmKinematics
    rows: list[tuple[float, JointState]] = field(default_factory=list[tuple[float, JointState]])

    def take(self, state: JointState) -> None:
        """Keep a sample."""
        self.rows.append((time.perf_counter(), state))

    def moves(self, since: int) -> list[int]:
        """Return the samples after a place in which a joint moves."""
        return [k for k in range(since, len(self.rows)) if _fastest(self.rows[k][1]) > RESTS_RAD_S]

    def goes(self, since: int, direction: Direction) -> bool:
        """Return whether the arm has gone that direction since a place."""
        first, last = (np.array(self.rows[k][1].position_rad) for k in (since, -1))
        if direction.space == "Joints":
            expected, done, least = np.eye(len(first))[direction.axis] * direction.sign, last - first, LEAST_RAD
        else:
            before, after = self.kinematics.tool_pose(first), self.kinematics.tool_pose(last)
            axes = before.rotation if direction.frame == "Tool axes" else np.eye(3)
            expected = axes[:, direction.axis % 3] * direction.sign
            turned = after.rotation @ before.rotation.T
            done = after.xyz - before.xyz if direction.axis < 3 else _rotation_vector(turned)
            least = LEAST_M if direction.axis < 3 else LEAST_RAD
        length = float(np.linalg.norm(done))
        return length > least and float(done @ expected) > STRAIGHT * length


def _fastest(state: JointState) -> float:
    return max(map(abs, state.velocity_rad_s))


def _rotation_vector(turned: Array) -> Array:
    return 0.5 * np.array((turned[2, 1] - turned[1, 2], turned[0, 2] - turned[2, 0], turned[1, 0] - turned[0, 1]))


@dataclass
class JogTrial:
    """A page that jogs, and the log of its arm."""

    site: TeachSite
    page: Page
    log: Log
    random: random.Random

    def press(
        self, direction: Direction, down: Callable[[], object], up: Callable[[], object], hold_s: float = 0.0
    ) -> Result:
        """Press once and wait until the arm has moved and rests, the page tells of it, or it is lost."""
        since = max(0, len(self.log.rows) - 1)
        down_s = time.perf_counter()
        down()
        while time.perf_counter() - down_s < hold_s:
            time.sleep(0.005)
        up()
        up_s = time.perf_counter()
        while time.perf_counter() - up_s < LOST_S:
            moves = self.log.moves(since)
            if moves and self.log.rows[-1][1].time_s - self.log.rows[moves[-1]][1].time_s > STILL_S:
                motion_s, ended_s = self.log.rows[moves[0]][0], self.log.rows[moves[-1]][0]
                end = "moved" if self.log.goes(since, direction) else "wrong way"
                return Result(end=end, to_motion_s=motion_s - down_s, to_rest_s=ended_s - up_s)
            if not moves and DROPPED in self.words():
                return Result(end="told")
            self.page.wait_for_timeout(20)
        print(f"lost: {direction}; the page says: {self.words()!r}", file=sys.stderr)
        return Result(end="lost")

    def words(self) -> str:
        """What the page says of jogging."""
        return self.page.get_by_role("status", name="State of jogging").inner_text()

    def ready(self) -> None:
        """Wait until the keys may be pressed."""
        expect(self.page.get_by_role("button", name="Z plus", exact=True)).not_to_have_attribute(
            "aria-disabled", "true", timeout=UP_MS
        )

    def choose(self, group: str, name: str) -> None:
        """Choose what, how or along which axes is jogged."""
        radio = self.page.get_by_role("radiogroup", name=group).get_by_role("radio", name=name, exact=True)
        if not radio.is_checked():
            self.page.get_by_role("radiogroup", name=group).get_by_text(name, exact=True).click()

    def middle(self, direction: Direction) -> tuple[float, float]:
        """Where the button of a direction is."""
        name = AXES[direction.axis] if direction.space == "Tool" else f"J{direction.axis + 1}"
        button = self.page.get_by_role("button", name=f"{name} {'plus' if direction.sign > 0 else 'minus'}", exact=True)
        button.scroll_into_view_if_needed()
        box = button.bounding_box()
        assert box is not None
        return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2

    def by_mouse(self, direction: Direction) -> Result:
        """Press a button."""
        self.page.mouse.move(*self.middle(direction))
        return self.press(direction, self.page.mouse.down, self.page.mouse.up, self.random.choice(HOLDS_S))

    def by_keyboard(self, direction: Direction) -> Result:
        """Press a key of the keyboard."""
        self.page.get_by_role("button", name="Jog with the keyboard").focus()
        key = KEYS[1 + (direction.axis % 3) * 2 + (direction.sign < 0)]
        keys = ["Shift", key] if direction.axis > 2 else [key]

        def each(act: Callable[[str], None], names: Sequence[str]) -> None:
            for name in names:
                act(name)

        return self.press(
            direction,
            lambda: each(self.page.keyboard.down, keys),
            lambda: each(self.page.keyboard.up, keys[::-1]),
            self.random.choice(HOLDS_S),
        )

    def by_touch(self, direction: Direction) -> Result:
        """Touch a button."""
        x, y = self.middle(direction)
        # The methods of the protocol are untyped: Any contains them here.
        send = cast("Any", self.page.context.new_cdp_session(self.page)).send

        def touch(kind: str, points: list[dict[str, float]]) -> None:
            send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

        return self.press(
            direction,
            lambda: touch("touchStart", [{"x": x, "y": y}]),
            lambda: touch("touchEnd", []),
            self.random.choice(HOLDS_S),
        )

    def by_pad(self, pads: Gamepads, *rest: int) -> Callable[[Direction], Result]:
        """Push a stick; `rest` are the buttons that stay down between."""

        def pressed(direction: Direction) -> Result:
            sticks = [0.0] * 4
            sticks[(1, 0, 3)[direction.axis % 3]] = float(-direction.sign)
            buttons = (DEADMAN, SHIFT) if direction.axis > 2 else (DEADMAN,)

            def down() -> None:
                pads.hold(*buttons, axes=sticks)
                pads.looked_at(3)

            result = self.press(direction, down, lambda: pads.hold(*rest))
            pads.looked_at(3)
            return result

        return pressed

    def by_handle(self, arrow: Arrow, sign: int) -> Result:
        """Pull the handle along one of its axes."""
        (x, y), (along_x, along_y) = arrow.grip, arrow.along
        self.page.mouse.move(x, y)
        self.page.wait_for_timeout(200)

        def pull() -> None:
            self.page.mouse.down()
            for share in (0.25, 0.5, 0.75, 1.0):
                self.page.mouse.move(x + sign * share * along_x, y + sign * share * along_y)

        return self.press(
            Direction(axis=arrow.axis, sign=sign, frame="Tool axes"),
            pull,
            self.page.mouse.up,
            self.random.choice(HOLDS_S),
        )

    def changes(self, count: int, *, axes: int = 6) -> list[Direction]:
        """Seeded directions, there and back, each another than the one before."""
        directions: list[Direction] = []
        while len(directions) < count:
            direction = Direction(axis=self.random.randrange(axes), sign=self.random.choice((1, -1)))
            if not directions or direction.axis != directions[-1].axis:
                directions += [direction, Direction(axis=direction.axis, sign=-direction.sign)]
        return directions[:count]


def firsts(trial: JogTrial, opened_s: float) -> Generator[tuple[str, Result]]:
    """The first press after each change."""
    trial.ready()
    print(f"the keys were enabled {time.perf_counter() - opened_s:.1f} s after the page was opened\n", flush=True)
    up, down = (Direction(axis=2, sign=sign) for sign in (1, -1))
    yield "start", trial.by_mouse(up)
    yield "button", trial.by_mouse(down)
    for frame in ("Base", "Tool axes", "World"):
        trial.choose("Along the axes of", frame)
        sign = 1 if frame != "Tool axes" else -1
        yield f"frame {frame}", trial.by_mouse(Direction(axis=2, sign=sign, frame=frame))
    for space in ("Joints", "Tool"):
        trial.choose("Jog target", space)
        yield f"mode {space}", trial.by_mouse(Direction(axis=1, sign=-1, space=space))
    assert trial.page.evaluate(_STOP) < 300
    trial.page.wait_for_timeout(500)
    trial.ready()
    yield "stop", trial.by_mouse(up)


def row(name: str, results: Sequence[Result]) -> str:
    """One line of the table."""
    moved = [each for each in results if each.end == "moved"]
    counts = [sum(each.end == end for each in results) for end in ("moved", "told", "lost", "wrong way", "hidden")]
    cells = [name, str(len(results)), *map(str, counts)]
    cells.append(_times([each.to_motion_s for each in moved]))
    cells.append(_times([each.to_rest_s for each in moved]))
    return "| " + " | ".join(cells) + " |"


def _times(times_s: Sequence[float]) -> str:
    return f"{median(times_s) * 1e3:.0f} / {max(times_s) * 1e3:.0f} ms" if times_s else "–"


def measure(trial: JogTrial, presses: int, drags: int, opened_s: float, inputs: Sequence[str]) -> None:
    """Print a row for each kind of input as soon as it is known."""
    print("| input | presses | moved | told | lost | wrong way | hidden | to motion, median / most | to rest |")
    print("|---|---|---|---|---|---|---|---|---|", flush=True)
    for name, result in firsts(trial, opened_s):
        print(row(f"first after {name}", [result]), flush=True)
    by: dict[str, Callable[[Direction], Result]] = {
        "mouse": trial.by_mouse,
        "keyboard": trial.by_keyboard,
        "touch": trial.by_touch,
    }
    for name in inputs:
        if name in by:
            print(row(name, [by[name](direction) for direction in trial.changes(presses)]), flush=True)
    if "gamepad" in inputs:
        pads = Gamepads(trial.page)
        trial.page.get_by_role("switch", name="Jog with a gamepad").click(force=True)
        pads.hold()
        pads.looked_at()
        print(row("gamepad", [trial.by_pad(pads)(direction) for direction in trial.changes(presses)]), flush=True)
        print(
            row(
                "stick alone", [trial.by_pad(pads, DEADMAN)(direction) for direction in trial.changes(presses, axes=3)]
            ),
            flush=True,
        )
        pads.hold()
    if "handle" in inputs:
        trial.page.get_by_role("button", name="Handle").click()
        trial.page.get_by_role("radiogroup", name="Arm with the handle").get_by_text(ARM, exact=True).click()
        trial.page.keyboard.press("Escape")
        results: list[Result] = []
        while len(results) < drags:
            axis, sign = len(results) // 2 % 3, 1 - 2 * (len(results) % 2)
            # The handle goes with the arm.
            arrow = next((each for each in find_arrows(trial.page) if each.axis == axis), None)
            results.append(trial.by_handle(arrow, sign) if arrow is not None else Result(end="hidden"))
        print(row("handle", results), flush=True)


@contextmanager
def opened(name: str, host: str, *, view: bool) -> Generator[tuple[TeachSite, Log]]:
    """Serve a cell, with the log of its first arm; its world waits longer for an engine that a busy machine starves."""
    cell = load_cell(ROOT / "behaviors" / "cells" / f"{name}.yaml")
    assert cell.document.world is not None
    world = structs.replace(cell.document.world, engine_silence_s=SILENCE_S, world_silence_s=SILENCE_S)
    cell = replace(cell, document=structs.replace(cell.document, world=world))
    placed = next(arm for arm in build_scene(cell.document, resolve=cell.resolve).arms if arm.name == ARM)
    with (
        tempfile.TemporaryDirectory() as folder,
        TeachSite(host=host, project=Path(folder), view=view, cell=cell, warm=False) as site,
    ):
        log = Log(ArmKinematics(placed.robot(), base=RigidTransform.from_pose(placed.base)))
        site.on_loop(lambda: site.bus.find_topic(f"{ARM}/joint_state").subscribe(cast("Any", log.take)))
        description = site.on_loop(lambda: site.bus.find_topic(f"{ARM}/description").latest)
        assert isinstance(description, RobotDescription)
        yield site, log


def main() -> None:
    """Measure, and print a table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--presses", type=int, default=100)
    parser.add_argument("--drags", type=int, default=100)
    parser.add_argument("--cell", default="dual_panda")
    parser.add_argument("--host", default="127.0.0.1")
    parser.add_argument("--inputs", default="mouse,keyboard,touch,gamepad,handle")
    options = parser.parse_args()
    inputs = options.inputs.split(",")
    # Without a graphics card the 3D view takes more of a processor than all else.
    served = opened(options.cell, options.host, view="handle" in inputs)
    with served as (site, log), sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=browser_program(), args=["--no-sandbox"])
        opened_s = time.perf_counter()
        with opened_page(browser, site.running, "/teach", quiet=False, size=(1280, 800)) as page:
            trial = JogTrial(site, page, log, random.Random(SEED))
            measure(trial, options.presses, options.drags, opened_s, inputs)


if __name__ == "__main__":
    main()
