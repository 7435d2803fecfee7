"""The emulated controller that a driver in a cell is for."""

from __future__ import annotations

import pytest

from engine.errors import CellError
from robots.drivers.abb.abb_options import AbbOptions, GripperStrings
from robots.drivers.abb.egm.egm_options import EgmOptions
from robots.drivers.abb.emulation.abb_emulator import emulator_options
from robots.drivers.abb.rws.rws_options import RwsOptions


def test_it_serves_the_ports_that_the_driver_uses() -> None:
    driver = AbbOptions(host="127.0.0.5", gripper=GripperStrings(port=11004), rws=RwsOptions(port=8080))
    options = emulator_options(driver, "irb4600")
    assert (options.host, options.gripper_port, options.rws_port) == ("127.0.0.5", 11004, 8080)
    assert options.rws_user == "Default User"
    assert emulator_options(AbbOptions(host="127.0.0.5"), "irb4600").rws_port == 0


def test_guided_motion_is_refused_by_name() -> None:
    with pytest.raises(CellError, match="no guided motion"):
        emulator_options(AbbOptions(host="127.0.0.5", egm=EgmOptions()), "irb4600")
