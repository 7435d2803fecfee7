"""How often a device is read, and how long it was silent."""

from __future__ import annotations

from robots.drivers.link_meter import LinkMeter


def test_rate_and_longest_gap_are_those_of_the_last_interval() -> None:
    meter = LinkMeter()
    ended = [meter.note(now_s, readings=int(now_s * 100), age_s=0.01) for now_s in (1.0, 1.2, 1.4, 1.6)]
    assert ended == [False, False, False, True]
    link = meter.link(age_s=0.004, speed_scaling=0.8)
    assert (link.readings_hz, link.longest_gap_s, link.age_s, link.speed_scaling) == (100.0, 0.01, 0.0, 0.8)

    meter.note(1.9, readings=160, age_s=0.3)
    assert meter.note(2.1, readings=200, age_s=0.01)
    link = meter.link(age_s=0.01)
    assert (link.readings_hz, link.longest_gap_s) == (80.0, 0.3)


def test_a_device_that_counts_from_zero_again_has_no_negative_rate() -> None:
    meter = LinkMeter()
    meter.note(1.0, readings=500, age_s=0.01)
    meter.note(1.2, readings=2, age_s=0.01)
    assert meter.note(1.8, readings=62, age_s=0.01)
    assert meter.link(age_s=0.01).readings_hz == 100.0


def test_a_device_that_was_never_read_has_an_age_all_the_same() -> None:
    assert LinkMeter().link(age_s=float("inf")).age_s == 3600.0
