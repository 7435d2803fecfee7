"""The emulated controller that a driver in a cell is for."""

from __future__ import annotations

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


def test_it_guides_where_the_driver_listens_and_is_as_patient_as_the_driver() -> None:
    assert emulator_options(AbbOptions(host="127.0.0.5"), "irb4600").egm_client == ""
    anywhere = emulator_options(AbbOptions(host="127.0.0.5", egm=EgmOptions()), "irb4600")
    assert (anywhere.egm_client, anywhere.comm_timeout_s) == ("127.0.0.1:6510", 0.2)
    egm = EgmOptions(address="127.0.0.9", port=7000, stale_s=3.0)
    patient = emulator_options(AbbOptions(host="127.0.0.5", egm=egm), "irb4600")
    assert (patient.egm_client, patient.comm_timeout_s) == ("127.0.0.9:7000", 3.0)
