"""The sketch, compiled for this machine, and the emulated board answer the same lines with the same words."""

from __future__ import annotations

import random
import shutil
import subprocess
from pathlib import Path

import pytest

from robots.drivers.servo_arm.emulation.emulated_board import EmulatedBoard

FOLDER = Path(__file__).parents[5] / "robots" / "drivers" / "servo_arm" / "flexcell_servo_arm"
STUB = Path(__file__).parents[1] / "sketch_stub.cpp"
SERVO_H = "struct Servo { void attach(int) {} void writeMicroseconds(int) {} };\n"
LINES = [
    "?", "GO", "STOP", "pick", "place", "90.0 90.0", "10.0 170.0", "0.0 160.0", "180 0", "45.5 120.25", "181.0 90.0",
    "-0.1 90.0", "nan 3", "45.0", "1 2 3", "", "go", "4x 5", "1.0 " + "2" * 80,
]  # fmt: skip


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The sketch as a program; skips without a compiler."""
    compiler = shutil.which("g++")
    if compiler is None:
        pytest.skip("no g++")
    folder = tmp_path_factory.mktemp("sketch")
    (folder / "Servo.h").write_text(SERVO_H, encoding="utf-8")
    built = folder / "sketch"
    sketch = f'-DSKETCH="{FOLDER / "flexcell_servo_arm.ino"}"'
    command = [compiler, "-std=c++11", "-Wall", "-Werror", f"-I{folder}", sketch, str(STUB), "-o", str(built)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)
    assert done.returncode == 0, done.stderr
    return built


def sketch_answers(program: Path, requests: list[str]) -> list[str]:
    """Return what the sketch says before the first request, and to each."""
    given = "".join(f"{request}\n" for request in requests)
    done = subprocess.run([program], input=given, capture_output=True, text=True, check=True, timeout=60)
    return done.stdout.split(".\n")[:-1]


def board_answers(requests: list[str]) -> list[str]:
    """Return what the emulated board says to each request."""
    now_ms = 0
    # The sketch counts whole milliseconds.
    board = EmulatedBoard(lambda: now_ms / 1000.0, home_deg=(0.0, 160.0), max_deg_s=60.0, watchdog_s=0.5005)
    answers: list[str] = []
    for request in requests:
        if request.startswith("t "):
            now_ms += int(request[2:])
            answers.append("")
        else:
            answers.append(board.execute(request[2:].encode()).decode())
    return answers


def is_same(one: str, other: str) -> bool:
    """Whether two answers have the same words, and angles that differ by no more than one step."""
    mine, theirs = one.split(), other.split()
    if len(mine) != len(theirs) or not mine:
        return mine == theirs
    if mine[0] == "ERR":
        return mine == theirs
    *words, first, second, claw = mine
    *their_words, their_first, their_second, their_claw = theirs
    angles = ((first, their_first), (second, their_second))
    return (words, claw) == (their_words, their_claw) and all(abs(float(a) - float(b)) <= 0.7 for a, b in angles)


@pytest.mark.parametrize("seed", range(8))
def test_sketch_and_emulator_say_the_same(program: Path, seed: int) -> None:
    """Steps of the sketch are 5 ms, 0.3° at its speed; those of the emulator have no length."""
    chosen = random.Random(seed)
    requests: list[str] = ["l ?", "l GO"]
    for _ in range(300):
        requests.append(f"t {chosen.choice([3, 17, 101, 337, 701])}")
        line = chosen.choice(LINES)
        requests.append(f"l {line}")
        if chosen.random() < 0.3:
            requests.append("l GO")
    ready, *rest = sketch_answers(program, requests)[0].split("\n", 1)
    assert ready.startswith("READY ")
    sketch = [rest[0], *sketch_answers(program, requests)[1:]]
    board = board_answers(requests)
    assert len(sketch) == len(board)
    different = [
        (request, mine, theirs)
        for request, mine, theirs in zip(requests, sketch, board, strict=True)
        if not is_same(mine, theirs)
    ]
    assert different[:3] == []


def test_questions_alone_do_not_keep_a_joint_turning(program: Path) -> None:
    requests = ["l GO", "l 90.0 160.0", *["t 100", "l ?"] * 8]
    halted = sketch_answers(program, requests)[-1].split()
    assert halted[:2] == ["HALT", "watchdog"]
    assert float(halted[2]) == pytest.approx(30.0, abs=0.7)
    assert board_answers(requests)[-1].split()[:2] == halted[:2]


def test_questions_alone_let_an_arm_at_rest_wait(program: Path) -> None:
    requests = ["l GO", "l 6.0 160.0", *["t 100", "l ?"] * 20, "l 12.0 160.0"]
    assert sketch_answers(program, requests)[-1].startswith("OK 6.0 160.0")
    assert board_answers(requests)[-1].startswith("OK 6.0 160.0")


def test_the_sketch_moves_nothing_before_go_and_stops_without_lines(program: Path) -> None:
    requests = ["l 90.0 90.0", "t 300", "l ?", "l GO", "l 90.0 90.0", "t 2000", "l ?", "l 90.0 90.0", "t 100", "l ?"]
    answers = sketch_answers(program, requests)
    assert answers[2] == "HALT boot 0.0 160.0 place\n"
    halted = answers[6].split()
    assert halted[:2] == ["HALT", "watchdog"]
    assert float(halted[2]) == pytest.approx(30.0, abs=0.7)
    assert answers[9] == answers[6]
