"""The sequence of a device over a port of pins: order, times, sensors, interlocks, and the name of each failure."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import msgspec
import pytest

from engine.bus import Holder
from engine.clock import new_clock, run_virtual
from engine.document.cell_devices import DeviceSpec
from engine.skills.device_moves import DeviceResult
from robots.devices.device_sequence import DeviceSequence

MAIN = {"body": "jaw", "joint": "slide", "along": [1, 0, 0], "stroke_m": 0.05, "force_n": 60, "speed_m_s": 0.1}
VICE = {
    "axes": {"main": {**MAIN, "output": "main"}},
    "sensors": {
        "is_open": {"axis": "main", "at_most": 0.01},
        "shut": {"axis": "main", "at_least": 0.02},
        "air": {"air": True},
    },
    "positions": {
        "timed": {"steps": [{"set": {"side": True}}, {"pause": "1.8 s"}, {"set": {"main": True}}], "time": "1 s"},
        "closed": {"steps": [{"set": {"main": True}}], "sensors": {"shut": True, "is_open": False}, "time": "1 s"},
        "stable": {"steps": [{"set": {"main": True}}], "sensors": {"shut": True}, "stable": 0.3, "time": 1},
        "after": {"steps": [{"wait_for": {"shut": True}, "within": "0.5 s"}], "time": 0},
    },
    "interlocks": [{"position": "after", "device": "door", "at": "closed"}],
}

HOLDER = Holder(run="a run")


def no_change(_time_s: float) -> dict[str, bool]:
    """Leave all sensors as they are."""
    return {}


def leaves_its_place(time_s: float) -> dict[str, bool]:
    """Leave the first end, and arrive nowhere."""
    return {"is_open": time_s < 0.1}


@dataclass(kw_only=True)
class Pins:
    """Pins with a time of each change; sensors change when `follow` is called with the time since."""

    sensors: dict[str, bool]
    follow: Callable[[float], dict[str, bool]]
    outputs: dict[str, bool] = field(default_factory=dict[str, bool])
    axes: dict[str, float] = field(default_factory=dict[str, float])
    log: list[tuple[float, str, bool]] = field(default_factory=list[tuple[float, str, bool]])
    now: Callable[[], float] = lambda: 0.0

    async def set_output(self, name: str, *, on: bool, holder: Holder) -> None:
        """Keep it with its time."""
        self.log.append((round(self.now(), 3), name, on))

    def __getattribute__(self, name: str) -> object:
        if name != "sensors":
            return super().__getattribute__(name)
        written: dict[str, bool] = super().__getattribute__("sensors")
        return written | self.follow(self.now())


def moved(
    position: str,
    follow: Callable[[float], dict[str, bool]] = no_change,
    *,
    air: bool = True,
    door: bool = True,
) -> tuple[DeviceResult, list[tuple[float, str, bool]], float]:
    """Return how a motion ends, which outputs were set when, and how long it took."""

    async def move() -> tuple[DeviceResult, list[tuple[float, str, bool]], float]:
        clock = new_clock()
        start_s = clock.now_s()
        pins = Pins(sensors={"is_open": True, "shut": False, "air": air}, follow=follow)
        pins.now = lambda: clock.now_s() - start_s
        device = msgspec.convert(VICE, DeviceSpec)
        sequence = DeviceSequence(device, pins, clock=clock, is_at=lambda _device, _position: door)
        result = await sequence.execute(position, holder=HOLDER, at_step=lambda _step, _steps: None)
        return result, pins.log, round(pins.now(), 2)

    return run_virtual(move())


def test_side_jaws_then_a_pause_then_the_main_jaw_and_only_time_tells() -> None:
    """Sensors that are not named for the position say nothing of it."""
    result, log, took_s = moved("timed")
    assert (result.ended, result.sensed, took_s) == ("timed", "between", 2.8)
    assert log == [(0.0, "side", True), (1.8, "main", True)]


def test_sensors_end_it_at_once() -> None:
    result, _, took_s = moved("closed", lambda t: {"is_open": t < 0.1, "shut": t > 0.3})
    assert (result.ended, result.sensed) == ("reached", "closed")
    assert took_s == pytest.approx(0.32, abs=0.021)


@pytest.mark.parametrize(
    ("follow", "reason"),
    [
        (no_change, "shut is off, is_open is on after 1 s; nothing has changed since its start"),
        (leaves_its_place, "shut is off after 1 s; it left its place"),
    ],
)
def test_what_does_not_arrive_is_stuck(follow: Callable[[float], dict[str, bool]], reason: str) -> None:
    result, _, took_s = moved("closed", follow)
    assert (result.ended, result.reason, took_s) == ("stuck", reason, 1.0)


def test_two_ends_at_once_contradict() -> None:
    result, _, _ = moved("closed", lambda t: {"shut": t > 0.2})
    assert (result.ended, result.reason) == (
        "sensor_contradicts",
        "the sensors is_open and shut of the axis main are both on",
    )


def test_without_air_nothing_is_set() -> None:
    result, log, _ = moved("closed", air=False)
    assert (result.ended, result.reason, log) == ("no_air", "the pressure switch air is off", [])


def test_air_that_goes_meanwhile_is_the_cause() -> None:
    result, _, _ = moved("closed", lambda t: {"air": t < 0.2})
    assert result.ended == "no_air"


def test_air_that_goes_while_only_time_tells_is_not_taken_for_done() -> None:
    result, _, _ = moved("timed", lambda t: {"air": t < 2.0})
    assert result.ended == "no_air"


def test_an_interlock_leaves_the_outputs_alone() -> None:
    result, log, took_s = moved("after", door=False)
    assert (result.ended, result.reason, log, took_s) == ("interlocked", "door is not at closed", [], 0.0)


def test_a_step_waits_for_its_sensor_only_so_long() -> None:
    result, _, took_s = moved("after")
    assert (result.ended, took_s) == ("stuck", 0.5)


def test_sensors_that_are_passed_are_not_a_position_that_must_be_stable() -> None:
    """They say so from 0.2 s to 0.4 s, and that is not long enough; then to the end."""
    passing, _, _ = moved("stable", lambda t: {"is_open": t < 0.1, "shut": 0.2 < t < 0.4})
    resting, _, took_s = moved("stable", lambda t: {"is_open": t < 0.1, "shut": t > 0.2})
    assert (passing.ended, passing.reason) == ("stuck", "shut is off after 1 s; it left its place")
    assert (resting.ended, took_s) == ("reached", pytest.approx(0.52, abs=0.03))
