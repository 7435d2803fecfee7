"""Addresses of skills in words; the titles are those of the skills that arms have."""

from __future__ import annotations

import pytest

from engine.skill import ARM_SKILL_TITLES, Action, Service, Skill, skill_words
from engine.skills import (
    arm_control,
    contact,
    direct_control,
    dmp,
    guiding,
    jogging,
    motion,
    motion_trace,
    planning,
)

ARM_SUBJECTS = (arm_control, contact, direct_control, dmp, guiding, jogging, motion, motion_trace, planning)


@pytest.mark.parametrize(
    ("address", "words"),
    [
        ("left/cart_lin_task", "left arm: line to a pose"),
        ("left_arm/move_free", "left_arm: collision-free motion"),
        ("arm/joint_trap_vel", "arm: move to joints"),
        ("charm/joint_trap_vel", "charm arm: move to joints"),
        ("right/gripper/gripper_grasp", "right gripper: grasp"),
        ("right/magnet/read_magnet", "right magnet: read magnet"),
        ("cell/attach_part", "cell: attach part"),
        ("camera/own_skill", "camera: own skill"),
        # Nodes, files, devices and entries are no skills.
        ("root/move_free", ""),
        ("root", ""),
        ("left", ""),
        ("behaviors/move.yaml:3:7", ""),
        ("/usr/lib/python3/asyncio.py:12", ""),
        ("pose home", ""),
        ("", ""),
    ],
)
def test_an_address_is_device_and_skill(address: str, words: str) -> None:
    assert skill_words(address) == words


def test_each_skill_of_an_arm_has_a_title_and_no_other() -> None:
    skills = {
        declared.skill_name()
        for subject in ARM_SUBJECTS
        for declared in vars(subject).values()
        if isinstance(declared, type)
        and issubclass(declared, Skill)
        and declared not in (Action, Service)
        and declared.__module__ == subject.__name__
    }
    assert set(ARM_SKILL_TITLES) == skills
