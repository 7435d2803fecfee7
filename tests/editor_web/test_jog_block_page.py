"""Jogging with a part in the hand, in a real browser: the part blocks no way out, and what blocks is said and seen."""

from __future__ import annotations

from collections.abc import Generator

import pytest
from playwright.sync_api import Browser, Page, expect

from engine.bus.json_bus import CLI_HOLDER
from engine.document.cell import load_cell
from engine.messages import FramePoses
from engine.skills.gripper import GripperGrasp, GripperOpen
from engine.skills.jogging import JogBlock
from tests.editor_web.browsing import require_accessible
from tests.editor_web.teach_page import name_of, seeing, teaching
from tests.editor_web.teach_site import CELL, TeachSite
from tests.editor_web.viser_page import ViserPage
from tests.robots.panda_arm import home, panda_kinematics

RED = (220, 38, 38)
SIZE_M = (0.06, 0.03, 0.04)


def cell_text() -> str:
    """A cell whose arm has a cube on a stand between its fingers."""
    x, y, z = panda_kinematics().tool_pose_and_jacobian(home())[0].xyz.tolist()
    top = z - SIZE_M[2] / 2
    return f"""{CELL}\
  stand: {{shape: box, size_m: [0.05, 0.02, 0.1], at: {{xyz: [{x}, {y}, {top - 0.05}]}}}}
parts:
  cube: {{shape: box, size_m: {list(SIZE_M)}, mass_kg: 0.1, at: {{xyz: [{x}, {y}, {z}]}}}}
"""


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory, loopback: str) -> Generator[TeachSite]:
    """The arm holds the cube, which still stands on its stand."""
    project = tmp_path_factory.mktemp("holding")
    file = project / "cell.yaml"
    file.write_text(cell_text(), encoding="utf-8")
    with TeachSite(host=loopback, project=project, cell=load_cell(file), view=True) as opened:
        opened.call(grasp(opened))
        yield opened


async def grasp(site: TeachSite) -> None:
    """Close the fingers on the cube."""
    for goal in (GripperOpen(), GripperGrasp(width_m=SIZE_M[1], force_n=30.0)):
        end = await site.bus.send_goal(goal, to="left/gripper", holder=CLI_HOLDER).result()
        assert end.result is not None
    site.bus.leases.release_run(CLI_HOLDER.run)
    assert end.result.held


def height_m(site: TeachSite) -> float:
    """How high the cube is; called on the loop."""
    poses = site.bus.find_topic("cell/frames").latest
    assert isinstance(poses, FramePoses)
    return float(poses.xyz[poses.names.index("cube")][2])


def block_of(site: TeachSite) -> JogBlock:
    """What the arm stands before; called on the loop."""
    block = site.bus.find_topic("left/jog_block").latest
    assert isinstance(block, JogBlock)
    return block


def hold(page: Page, name: str) -> None:
    """Press a jog key, until `page.keyboard.up("Enter")`."""
    page.get_by_role("button", name=name, exact=True).focus()
    page.keyboard.down("Enter")


def draw_nothing(page: Page) -> None:
    """Without a graphics card a picture of the cell takes seconds; what it would show is asked for by `seeing`."""
    page.route("**/cell/*/**", lambda route: route.fulfill(body="<title>cell</title>", content_type="text/html"))
    page.reload()
    expect(page.get_by_role("button", name="Z plus", exact=True)).not_to_have_attribute("aria-disabled", "true")


def reds(view: ViserPage) -> set[str]:
    """The bodies that are red in a 3D view, by the frames that they belong to."""
    nodes = {name: view.node(name) for name in view.nodes}
    return {
        name.split("/")[2]
        for name, node in nodes.items()
        if name.startswith("/cell/") and node is not None and tuple(node.props.get("color") or ()) == RED
    }


def words_of(block: JogBlock) -> str:
    """How the page says it, in the axes of the tool."""
    assert block.distance_m is not None
    axes = ("X", "Y", "Z", "RX", "RY", "RZ")
    out = ", ".join(f"{axes[each.axis]} {'plus' if each.sign > 0 else 'minus'}" for each in block.directions_out)
    return f"{block.first} stands {block.distance_m * 1000:.1f} mm before {block.second}. Directions out: {out}."


def test_a_held_part_blocks_no_way_out_and_what_it_stands_before_is_said_and_red(
    browser: Browser, site: TeachSite
) -> None:
    """Up from its stand, down until it is blocked, and up again, as the page says."""
    with teaching(browser, site, quiet=False) as page, seeing(site, name_of(page)) as view:
        draw_nothing(page)
        said = page.get_by_role("status", name="State of jogging")
        low_m = site.on_loop(lambda: height_m(site))
        hold(page, "Z plus")
        site.call(site.seen(lambda _: height_m(site) > low_m + 0.015))
        expect(said).to_have_text("It moves while this is held")
        page.keyboard.up("Enter")
        site.call(site.rested())
        speed = page.get_by_role("slider", name="Speed", exact=True)
        for key in ("Home", *["ArrowRight"] * 3):
            speed.press(key)
        hold(page, "Z minus")
        expect(said).to_contain_text("Directions out: ")
        site.call(site.rested())
        block = site.on_loop(lambda: block_of(site))
        assert {block.first, block.second} == {"cube", "stand"}
        assert (2, 1) in {(each.axis, each.sign) for each in block.directions_out}
        expect(said).to_have_text(words_of(block))
        site.call(view.until(lambda: reds(view) == {"cube", "world"}))
        require_accessible(page, "a blocked jog")
        page.keyboard.up("Enter")
        assert site.on_loop(lambda: height_m(site)) > low_m
        speed.press("End")
        hold(page, "Z plus")
        site.call(site.seen(lambda _: height_m(site) > low_m + 0.03))
        expect(said).not_to_contain_text("stands")
        site.call(view.until(lambda: not reds(view)))
        page.keyboard.up("Enter")
        site.call(site.rested())
