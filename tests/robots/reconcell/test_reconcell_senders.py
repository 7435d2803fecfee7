"""Who commands: one sender at a time, watched; and set points of direct control, in physics and virtual time."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from robots.reconcell import ControlMode, ReconcellClient
from robots.reconcell.packets import TrapezoidGoal
from tests.robots.reconcell.primitives_184 import HOME, THERE
from tests.robots.reconcell.reconcell_cell import HandMade, ReconcellCell, reconcell_cell


async def sine(cell: ReconcellCell, sender: HandMade | ReconcellClient, seconds: float) -> float:
    """Send set points of a slow sine of the last joint and return the greatest speed."""
    clock, fastest = cell.bus.clock, 0.0
    start_s = clock.now_s()
    while clock.now_s() < start_s + seconds:
        joints = (*HOME[:5], 0.3 * math.sin(2.0 * (clock.now_s() - start_s)))
        if isinstance(sender, HandMade):
            sender.doubles(20000, *joints)
        else:
            sender.send_set_point(joints)
        await cell.arrived()
        await clock.sleep(0.01)
        fastest = max(fastest, cell.speed_rad_s())
    return fastest


@pytest.mark.virtual
async def test_set_points_are_followed_and_a_silent_sender_leaves_the_arm_at_rest_and_free(tmp_path: Path) -> None:
    """The watchdog brings it to rest; a second later direct control ends and others may command."""
    async with reconcell_cell(tmp_path) as cell:
        await cell.go_home()
        await cell.bus.clock.sleep(1.5)
        with HandMade(cell.address) as sender:
            sender.doubles(20000, *HOME)
            sender.raw(10000, bytes([4]))
            await cell.until(lambda: cell.mode() == "direct")
            assert await sine(cell, sender, 1.0) > 0.1
        assert await cell.until(lambda: cell.speed_rad_s() < 0.01) < 0.6
        assert cell.mode() == "direct"
        await cell.until(lambda: cell.mode() == "idle", within_s=2.0)
        assert cell.refused == {"silent commander": 1}
        await cell.go_home()


@pytest.mark.virtual
async def test_a_set_point_far_away_that_is_not_repeated_is_not_reached(tmp_path: Path) -> None:
    async with reconcell_cell(tmp_path) as cell:
        await cell.go_home()
        cell.client.send_set_point(HOME)
        cell.client.select(ControlMode.DIRECT)
        await cell.until(lambda: cell.mode() == "direct")
        far = (HOME[0] + 2.0, *HOME[1:])
        cell.client.send_set_point(far)
        await cell.until(lambda: cell.speed_rad_s() > 0.1)
        assert await cell.until(lambda: cell.speed_rad_s() < 0.01) < 0.9
        assert abs(cell.joints()[0] - far[0]) > 0.5


@pytest.mark.virtual
async def test_stop_ends_direct_control_and_set_points_after_it_are_refused(tmp_path: Path) -> None:
    async with reconcell_cell(tmp_path) as cell:
        client = cell.client
        await cell.go_home()
        client.send_set_point(HOME)
        client.select(ControlMode.DIRECT)
        await cell.arrived()
        assert await sine(cell, client, 0.5) > 0.1
        client.move_joints(THERE, speed=0.5)
        await cell.until(lambda: cell.refused == {"busy": 1})
        client.stop()
        await cell.at_rest()
        assert cell.mode() == "idle"
        rest = cell.joints()
        client.send_set_point(THERE)
        await cell.arrived()
        await cell.bus.clock.sleep(0.5)
        assert np.abs(cell.joints() - rest).max() < 0.02
        assert cell.refused == {"busy": 1}


@pytest.mark.virtual
async def test_a_stop_of_the_cell_ends_direct_control_for_good(tmp_path: Path) -> None:
    async with reconcell_cell(tmp_path) as cell:
        client = cell.client
        await cell.go_home()
        client.send_set_point(HOME)
        client.select(ControlMode.DIRECT)
        await sine(cell, client, 0.3)
        await cell.stop()
        rest = cell.joints()
        client.send_set_point(THERE)
        await cell.arrived()
        await cell.bus.clock.sleep(0.5)
        assert np.abs(cell.joints() - rest).max() < 0.02
        assert cell.refused == {"direct control is off": 1}
        await cell.go_home()


@pytest.mark.virtual
async def test_no_set_point_before_the_mode_and_no_mode_without_a_set_point(tmp_path: Path) -> None:
    async with reconcell_cell(tmp_path) as cell:
        start = cell.joints()
        cell.client.select(ControlMode.DIRECT)
        await cell.until(lambda: cell.refused == {"no data": 1})
        await sine(cell, cell.client, 0.3)
        assert np.abs(cell.joints() - start).max() < 1e-3
        assert not cell.server.interface.commands.moving


@pytest.mark.virtual
async def test_a_second_sender_is_refused_by_name_until_the_first_is_silent(tmp_path: Path) -> None:
    async with reconcell_cell(tmp_path) as cell:
        await cell.go_home()
        cell.client.move_joints(THERE, speed=0.2)
        await cell.until(lambda: cell.speed_rad_s() > 0.05)
        with HandMade(cell.address) as other:
            other.raw(10000, bytes([0]))
            other.doubles(26000, *HOME, 0.5)
            other.raw(10000, bytes([5]))
            await cell.until(lambda: cell.refused == {"not the commander": 3})
            await cell.at_rest()
            assert np.abs(cell.joints() - THERE).max() < 0.01
            cell.client.send(TrapezoidGoal(joints=HOME, speed=0.5), 26000)
            other.raw(10000, bytes([0]))
            await cell.until(lambda: cell.refused == {"not the commander": 4})
            await cell.bus.clock.sleep(1.5)
            other.raw(10000, bytes([5]))
            # What the first one had sent is not executed for the second one.
            await cell.until(lambda: cell.refused == {"not the commander": 4, "no data": 1})
            other.doubles(26000, *HOME, 0.5)
            other.raw(10000, bytes([5]))
            await cell.at_rest()
        assert np.abs(cell.joints() - HOME).max() < 0.01


@pytest.mark.virtual
async def test_a_program_with_a_socket_for_each_port_is_one_sender_by_its_address(tmp_path: Path) -> None:
    async with reconcell_cell(tmp_path, commander="host") as cell:
        with HandMade(cell.address) as data, HandMade(cell.address) as mode:
            data.doubles(26000, *THERE, 0.5)
            mode.raw(10000, bytes([5]))
            await cell.at_rest()
        assert np.abs(cell.joints() - THERE).max() < 0.01
        assert cell.refused == {}


@pytest.mark.virtual
async def test_with_a_limit_of_silence_a_motion_ends_when_its_sender_is_gone(tmp_path: Path) -> None:
    async with reconcell_cell(tmp_path, silence_s=0.5) as cell:
        with HandMade(cell.address) as sender:
            sender.doubles(26000, *THERE, 0.02)
            sender.raw(10000, bytes([5]))
            await cell.until(lambda: cell.speed_rad_s() > 0.01)
        assert await cell.until(lambda: not cell.server.interface.commands.moving) < 1.5
        assert cell.speed_rad_s() < 0.02
        assert np.abs(cell.joints() - THERE).max() > 0.05
        assert cell.refused == {"silent commander": 1}


@pytest.mark.virtual
async def test_packets_in_a_wrong_order_or_of_a_wrong_size_move_nothing(tmp_path: Path) -> None:
    async with reconcell_cell(tmp_path) as cell:
        start = cell.joints()
        with HandMade(cell.address) as sender:
            for mode in (5, 13, 11, 12, 16):
                sender.raw(10000, bytes([mode]))
            sender.doubles(25009, 1.0, 0.0)
            sender.raw(25109, bytes([1, 0]))
            sender.raw(25110, bytes([1]))
            sender.doubles(25101, *[0.5] * 184)
            await cell.until(lambda: sum(cell.refused.values()) == 9)
            assert cell.refused == {"no data": 4, "incomplete parameters": 5}
            sender.raw(10000, bytes([6]))
            sender.raw(10000, b"")
            sender.raw(10000, bytes([5, 0]))
            sender.doubles(26000, *THERE)
            sender.doubles(26000, *THERE, math.nan)
            sender.doubles(26000, *THERE, 1.5)
            sender.doubles(26000, *THERE[:5], 100.0, 0.5)
            sender.doubles(27000, 0.5, 0.0, 0.5, 0.0, 0.0, 0.0, 0.9, 2.0)
            sender.doubles(25009, 2.0, 0.0)
            sender.raw(10000, bytes([5]))
            await cell.until(lambda: sum(cell.refused.values()) == 19)
        assert cell.refused == {
            "no data": 5,
            "incomplete parameters": 5,
            "wrong mode byte": 1,
            "wrong size": 3,
            "not finite": 1,
            "out of range": 4,
        }
        await cell.bus.clock.sleep(0.5)
        assert np.abs(cell.joints() - start).max() < 1e-3
