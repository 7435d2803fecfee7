"""The fingers of the simulated hand: without dry friction, and with a box between them that can be taken away."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from typing import Any

_NAME = "held_box"
_LINK = "robot0_fr3_link7"
_FINGERS = ("robot0_left_finger", "robot0_right_finger")
# In the frame of the last link: at the finger tips of the hand, which is mounted an eighth of a turn about z.
_AT_TIPS_M, _AWAY_M = 0.2099, -1.0
_TURNED = "0.9238795 0 0 -0.3826834"
_DEPTH_M, _HEIGHT_M = 0.012, 0.012


def remove_dry_friction(scene: ET.Element) -> None:
    """Let the fingers reach their goals: with the friction of franky-sim they stop up to 3 mm short."""
    for joint in scene.iter("joint"):
        if joint.get("class") == "finger":
            joint.set("frictionloss", "0")


def add_box(scene: ET.Element) -> None:
    """Add the box, rigid at the last link and away from the fingers, before the simulator starts."""
    bodies = {body.get("name"): body for body in scene.iter("body")}
    ET.SubElement(
        bodies[_LINK],
        "geom",
        {
            "name": _NAME,
            "type": "box",
            "pos": f"0 0 {_AWAY_M}",
            "quat": _TURNED,
            "size": f"{_DEPTH_M} 0.02 {_HEIGHT_M}",
            "contype": "0",
            "conaffinity": "0",
            "mass": "0.001",
        },
    )
    contact = scene.find("contact")
    assert contact is not None
    # Named pairs: what hangs at one link does not touch another that hangs there else.
    for finger in _FINGERS:
        pads = [geom for geom in bodies[finger].iter("geom") if geom.get("class", "").startswith("fingertip_pad")]
        for number, pad in enumerate(pads):
            name = f"{finger}_pad{number}"
            pad.set("name", name)
            ET.SubElement(contact, "pair", {"geom1": name, "geom2": _NAME})


def place_box(model: Any, width_m: float) -> None:
    """Put a box of this width between the fingers of a running simulator; 0 takes it away."""
    geom = model.geom(_NAME)
    geom.pos[2] = _AT_TIPS_M if width_m > 0.0 else _AWAY_M
    geom.size[1] = max(width_m, 0.001) / 2.0
    # Bodies farther apart than these spheres are not compared.
    geom.rbound[0] = float(sum(half**2 for half in geom.size)) ** 0.5
