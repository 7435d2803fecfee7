"""The simulator loses a sliding contact above the speed that its equations give, and not below."""

from __future__ import annotations

import pytest

from benchmarks.contact_sliding import DEFAULT, PAD, SKIN, TOOLS, Contact, Tool, fastest_m_s, slide

EACH_TOOL = pytest.mark.parametrize("tool", TOOLS, ids=[tool.name for tool in TOOLS])
EACH_CONTACT = pytest.mark.parametrize("contact", [PAD, DEFAULT, SKIN], ids=["pad", "default", "skin"])


@EACH_TOOL
@EACH_CONTACT
def test_a_tool_that_slides_slower_than_its_limit_is_pressed_evenly(tool: Tool, contact: Contact) -> None:
    made = slide(tool, contact, speed_m_s=0.9 * fastest_m_s(tool, contact))
    assert (made.lost, made.rms_n < 0.05) == (0.0, True)


@EACH_TOOL
@EACH_CONTACT
def test_a_tool_that_slides_faster_than_its_limit_hops(tool: Tool, contact: Contact) -> None:
    made = slide(tool, contact, speed_m_s=1.1 * fastest_m_s(tool, contact))
    assert made.lost > 0.005
    assert made.rms_n > 1.0


def test_a_soft_skin_lets_two_flat_pads_wipe_several_times_as_fast_as_the_default_contact() -> None:
    pads = TOOLS[-1]
    assert fastest_m_s(pads, SKIN) > 8.0 * fastest_m_s(pads, DEFAULT)
