"""Up to when all cameras have shown what is there: the one that is behind counts, and each only with two images."""

from __future__ import annotations

import math

import pytest

from robots.vision.occupancy.image_times import ImageTimes


def _times(**seen: tuple[float, ...]) -> ImageTimes:
    times = ImageTimes({"front": 0.1, "side": 0.5})
    for camera, images in seen.items():
        for at_s in images:
            times.take(camera, at_s)
    return times


@pytest.mark.parametrize(
    ("front", "side"), [((), ()), ((1.0, 1.1), ()), ((1.0, 1.1), (1.0,)), ((1.1,), (0.5, 1.0))], ids=str
)
def test_before_the_second_image_of_each_nothing_is_confirmed(
    front: tuple[float, ...], side: tuple[float, ...]
) -> None:
    assert _times(front=front, side=side).confirmed_s == -math.inf


def test_then_the_latest_image_of_the_one_that_is_behind_counts() -> None:
    assert _times(front=(1.0, 1.1, 1.2), side=(0.5, 1.0)).confirmed_s == 1.0
    assert _times(front=(0.8, 0.9), side=(0.5, 1.0)).confirmed_s == 0.9


def test_an_image_that_is_half_a_period_late_is_regular() -> None:
    assert _times(front=(1.0, 1.15), side=(1.0, 1.5)).confirmed_s == 1.15


def test_an_image_after_a_pause_counts_with_the_next_one_only() -> None:
    times = _times(front=(1.0, 1.1, 3.0), side=(2.6, 3.1))
    assert times.confirmed_s == pytest.approx(1.1 + 0.15)
    times.take("front", 3.1)
    assert times.confirmed_s == 3.1


def test_a_map_that_begins_anew_has_none_of_the_images() -> None:
    times = _times(front=(1.0, 1.1), side=(0.6, 1.1))
    times.forget()
    assert times.confirmed_s == -math.inf
    times.take("front", 1.2)
    times.take("side", 1.2)
    assert times.confirmed_s == -math.inf


def test_without_cameras_nothing_is_confirmed() -> None:
    assert ImageTimes({}).confirmed_s == -math.inf
