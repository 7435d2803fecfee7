"""What a page is told of the devices with a driver: their abilities, and their options with the schema."""

from __future__ import annotations

from pathlib import Path

from engine.cell import devices_of_cell
from engine.cell.cell_names import cell_names
from engine.cell.drivers import installed_drivers
from engine.document import load_cell
from engine.document.simulated_devices import with_simulated_devices
from engine.skills.jogging import JogJoints

CELL = """\
flexcell: 1
cell: bench
world: {kind: mujoco}
robots:
  arm: {model: servo_arm, driver: {kind: servo_arm, device: /dev/ttyACM7}}
  left:
    model: panda
    gripper: {model: softhand, driver: {kind: softhand, device: /dev/ttyUSB7, current_limit_ma: 900}}
  right: {model: ur10, driver: {kind: nowhere}}
"""


def test_each_device_has_its_driver_its_options_and_their_schema(tmp_path: Path) -> None:
    (tmp_path / "cell.yaml").write_text(CELL, encoding="utf-8")
    arm, hand, unknown = devices_of_cell(load_cell(tmp_path / "cell.yaml"))
    assert (arm.device, arm.address, arm.simulated) == ("arm", "arm", False)
    assert "streamed set points" in arm.can
    assert "impedance control" in arm.cannot
    # In the document every tool is the gripper of its robot; on the bus its address names its kind.
    assert (hand.device, hand.address, hand.can) == ("left/gripper", "left/hand", ("hand commands",))
    assert "ever run on hardware" in hand.proven
    assert hand.options == {"kind": "softhand", "device": "/dev/ttyUSB7", "current_limit_ma": 900.0}
    assert set(hand.options) <= set(hand.schema["$defs"]["SoftHandOptions"]["properties"])
    assert (unknown.device, unknown.can) == ("right", ())
    assert "nowhere" in unknown.problem


def test_a_device_that_is_simulated_instead_shows_its_options_too(tmp_path: Path) -> None:
    (tmp_path / "cell.yaml").write_text(CELL, encoding="utf-8")
    arm, _, unknown = devices_of_cell(with_simulated_devices(load_cell(tmp_path / "cell.yaml"), ["all"]))
    assert (arm.simulated, arm.options["device"]) == (True, "/dev/ttyACM7")
    assert unknown.simulated


def test_what_a_device_can_do_depends_on_its_options(tmp_path: Path) -> None:
    text = CELL.replace("{kind: nowhere}", "{kind: abb_irc5, host: 192.168.1.6OPTION}").replace("ur10", "irb4600")
    for option, streams in (("", False), (", egm: {}", True)):
        (tmp_path / "cell.yaml").write_text(text.replace("OPTION", option), encoding="utf-8")
        cell = load_cell(tmp_path / "cell.yaml")
        *_, right = devices_of_cell(cell)
        assert ("streamed set points" in right.can) is streams
        assert ("streamed set points" in right.cannot) is not streams
        reason = cell_names(cell).beyond_driver("robot", "right", (JogJoints,))
        assert reason.startswith("the driver abb_irc5 has no streamed set points" if not streams else "")
        assert bool(reason) is not streams


def test_a_cell_without_a_document_has_none() -> None:
    assert devices_of_cell(None) == ()


def test_every_driver_says_what_enabling_does() -> None:
    said = {driver.kind: driver.enabling for driver in installed_drivers().values()}
    assert {kind for kind, words in said.items() if len(words) < 40} == set()
