"""Self-collision: home is free, folded arms and hands name the links that touch, allowed pairs are left out."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations, product

import numpy as np
import pytest

from engine.errors import CellError
from robots.model.mechanics.collision_model import CollisionModel, sampled_pairs
from robots.model.registry import robot_model, robot_names, tool_names


@pytest.mark.parametrize(("arm", "tool"), list(product(robot_names(), (None, *tool_names()))))
def test_at_home_nothing_touches(arm: str, tool: str | None) -> None:
    model = robot_model(arm, gripper=tool)
    collision = CollisionModel(model)
    home = np.array(model.home_rad)
    assert collision.colliding_pairs(home) == ()
    assert not collision.in_collision(home)
    assert collision.clearance(home)[0] > 0.003


@pytest.mark.parametrize(
    ("arm", "joints", "pair"),
    [
        ("ur10", (0.0, -1.57, 3.1, 0.0, 0.0, 0.0), {"shoulder_link", "forearm_link"}),
        ("irb4600", (0.2, 1.8, 1.3, -2.1, -1.5, -1.5), {"base_link", "link_5"}),
        ("panda", (0.8, -0.8, -2.7, -3.0, 1.8, 3.4, 0.6), {"panda_link1", "panda_link6"}),
    ],
)
def test_a_folded_arm_names_the_links_that_touch(arm: str, joints: tuple[float, ...], pair: set[str]) -> None:
    collision = CollisionModel(robot_model(arm, gripper=None))
    assert pair in [set(found) for found in collision.colliding_pairs(np.array(joints))]
    assert collision.in_collision(np.array(joints))
    assert collision.clearance(np.array(joints))[0] <= 0.0


def test_a_tool_can_hit_the_arm_it_is_on() -> None:
    """The UR10 turned back on itself touches its forearm with the gripper, and without it does not."""
    random = np.random.default_rng(3)
    bare, held = (CollisionModel(robot_model("ur10", gripper=tool)) for tool in (None, "robotiq_2f85"))
    configurations = random.uniform(-3.0, 3.0, (400, 6))
    only_with_it = [q for q in configurations if held.in_collision(q) and not bare.in_collision(q)]
    assert only_with_it
    tool = robot_model("ur10", gripper="robotiq_2f85").tool
    assert tool is not None
    for q in only_with_it:
        assert all(set(pair) & set(tool.links) for pair in held.colliding_pairs(q))


def test_what_is_allowed_and_neighbours_are_not_looked_at() -> None:
    model = robot_model("panda")
    pairs = {frozenset(pair) for pair in CollisionModel(model).pairs}
    assert not pairs & {frozenset(pair) for pair in model.allowed_collisions}
    assert not pairs & {frozenset((f"panda_link{i}", f"panda_link{i + 1}")) for i in range(7)}
    assert frozenset(("panda_link2", "panda_hand")) in pairs
    free = CollisionModel(replace(model, allowed_collisions=(*model.allowed_collisions, *CollisionModel(model).pairs)))
    assert free.pairs == ()
    assert free.clearance(np.array(model.home_rad))[0] == np.inf


@pytest.mark.parametrize("arm", ["ur10", "irb4600", "servo_arm"])
def test_the_allowed_pairs_of_our_own_folders_meet_in_no_random_configuration(arm: str) -> None:
    """What is listed never meets, and nothing meets always."""
    model = robot_model(arm, gripper=None)
    always, never = sampled_pairs(replace(model, allowed_collisions=()), samples=1500, seed=5)
    assert not always
    assert {frozenset(pair) for pair in model.allowed_collisions} <= {frozenset(pair) for pair in never}


def test_where_the_tool_stands_counts() -> None:
    """Open fingers reach wider than closed ones; a joint of the arm is refused."""
    model = robot_model("panda")
    opened = CollisionModel(model, tool_joints={"panda_finger_joint1": 0.04, "panda_finger_joint2": 0.04})
    closed = CollisionModel(model)
    differ = [
        q
        for q in np.random.default_rng(0).uniform(model.limits.lower_rad, model.limits.upper_rad, (300, 7))
        if abs(opened.clearance(q)[0] - closed.clearance(q)[0]) > 1e-6
    ]
    assert differ
    with pytest.raises(CellError, match="panda_joint1 is not a joint of the tool"):
        CollisionModel(model, tool_joints={"panda_joint1": 0.1})


def test_every_pair_is_of_links_that_move_against_each_other() -> None:
    collision = CollisionModel(robot_model("ur10", gripper="softhand"))
    tool = [link for pair in collision.pairs for link in pair if link.startswith("softhand")]
    assert tool
    assert not [pair for pair in combinations(sorted(set(tool)), 2) if pair in collision.pairs]
