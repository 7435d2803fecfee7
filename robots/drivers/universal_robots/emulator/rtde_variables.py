"""The variables that RTDE offers, with their types, and where the emulated controller has their values."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from robots.drivers.universal_robots.emulator.controller_state import REGISTERS, ControllerState
from robots.drivers.universal_robots.rtde_codec import RtdeValue

OutputReader = Callable[[ControllerState], RtdeValue]
InputWriter = Callable[[ControllerState, RtdeValue], None]
ZERO6 = (0.0,) * 6

INPUTS: Mapping[str, str] = {
    "speed_slider_mask": "UINT32",
    "speed_slider_fraction": "DOUBLE",
    "standard_digital_output_mask": "UINT8",
    "standard_digital_output": "UINT8",
    "configurable_digital_output_mask": "UINT8",
    "configurable_digital_output": "UINT8",
    "tool_digital_output_mask": "UINT8",
    "tool_digital_output": "UINT8",
    "standard_analog_output_mask": "UINT8",
    "standard_analog_output_type": "UINT8",
    "standard_analog_output_0": "DOUBLE",
    "standard_analog_output_1": "DOUBLE",
    "input_bit_registers0_to_31": "UINT32",
    "input_bit_registers32_to_63": "UINT32",
    "external_force_torque": "VECTOR6D",
    **{f"input_int_register_{index}": "INT32" for index in range(REGISTERS)},
    **{f"input_double_register_{index}": "DOUBLE" for index in range(REGISTERS)},
}

_OUTPUTS: Mapping[str, tuple[str, OutputReader]] = {
    "timestamp": ("DOUBLE", lambda c: c.time_s),
    "target_q": ("VECTOR6D", lambda c: _six(c.arm.q)),
    "target_qd": ("VECTOR6D", lambda c: _six(c.arm.qd)),
    "target_qdd": ("VECTOR6D", lambda c: _six(c.arm.qdd)),
    "target_current": ("VECTOR6D", lambda _c: ZERO6),
    "target_moment": ("VECTOR6D", lambda _c: ZERO6),
    "actual_q": ("VECTOR6D", lambda c: _six(c.arm.measured_q)),
    "actual_qd": ("VECTOR6D", lambda c: _six(c.arm.measured_qd)),
    "actual_current": ("VECTOR6D", lambda _c: ZERO6),
    "actual_current_as_torque": ("VECTOR6D", lambda _c: ZERO6),
    "joint_control_output": ("VECTOR6D", lambda _c: ZERO6),
    "actual_TCP_pose": ("VECTOR6D", lambda c: tuple(c.arm.measured_tcp_pose())),
    "actual_TCP_speed": ("VECTOR6D", lambda c: tuple(c.arm.tcp_speed())),
    "actual_TCP_force": ("VECTOR6D", lambda c: c.tcp_force_n),
    "target_TCP_pose": ("VECTOR6D", lambda c: tuple(c.arm.tcp_pose())),
    "target_TCP_speed": ("VECTOR6D", lambda c: tuple(c.arm.tcp_speed())),
    "ft_raw_wrench": ("VECTOR6D", lambda c: c.tcp_force_n),
    "actual_digital_input_bits": ("UINT64", lambda c: c.digital_inputs),
    "actual_digital_output_bits": ("UINT64", lambda c: c.digital_outputs),
    "joint_temperatures": ("VECTOR6D", lambda _c: (30.0,) * 6),
    "actual_execution_time": ("DOUBLE", lambda _c: 0.0),
    "robot_mode": ("INT32", lambda c: int(c.safety.robot_mode)),
    "joint_mode": ("VECTOR6INT32", lambda c: (c.safety.joint_mode,) * 6),
    "safety_mode": ("INT32", lambda c: int(c.safety.safety_mode)),
    "safety_status": ("INT32", lambda c: int(c.safety.safety_mode)),
    "robot_status_bits": ("UINT32", lambda c: c.robot_status_bits),
    "safety_status_bits": ("UINT32", lambda c: c.safety.status_bits),
    "runtime_state": ("UINT32", lambda c: int(c.runtime_state)),
    "actual_tool_accelerometer": ("VECTOR3D", lambda _c: (0.0, 0.0, 0.0)),
    "speed_scaling": ("DOUBLE", lambda c: c.speed_scaling),
    "target_speed_fraction": ("DOUBLE", lambda c: c.speed_fraction),
    "actual_momentum": ("DOUBLE", lambda _c: 0.0),
    "actual_main_voltage": ("DOUBLE", lambda _c: 48.0),
    "actual_robot_voltage": ("DOUBLE", lambda c: 48.0 if c.safety.is_powered else 0.0),
    "actual_robot_current": ("DOUBLE", lambda _c: 0.0),
    "actual_joint_voltage": ("VECTOR6D", lambda _c: (48.0,) * 6),
    "standard_analog_input0": ("DOUBLE", lambda _c: 0.0),
    "standard_analog_input1": ("DOUBLE", lambda _c: 0.0),
    "standard_analog_output0": ("DOUBLE", lambda c: c.analog_outputs[0]),
    "standard_analog_output1": ("DOUBLE", lambda c: c.analog_outputs[1]),
    "tcp_offset": ("VECTOR6D", lambda c: tuple(c.arm.tcp_offset)),
    "payload": ("DOUBLE", lambda c: c.payload_kg),
    "payload_cog": ("VECTOR3D", lambda c: c.payload_cog_m),
    "payload_inertia": ("VECTOR6D", lambda c: c.payload_inertia_kgm2),
}


def output_variable(name: str) -> tuple[str, OutputReader] | None:
    """Return type and reader of an output, or None where the controller has none of this name."""
    if name in _OUTPUTS:
        return _OUTPUTS[name]
    for prefix, kind in (("output_int_register_", "INT32"), ("output_double_register_", "DOUBLE")):
        number = name.removeprefix(prefix)
        if number != name and number.isascii() and number.isdigit() and int(number) < REGISTERS:
            return kind, _register_reader(kind, int(number))
    return None


def _register_reader(kind: str, index: int) -> OutputReader:
    if kind == "INT32":
        return lambda c: c.output_ints[index]
    return lambda c: c.output_doubles[index]


def write_inputs(controller: ControllerState, values: Mapping[str, RtdeValue]) -> None:
    """Take the inputs of one data packet; outputs and the speed slider change where their mask says so."""
    for name, value in values.items():
        controller.note_input(name)
        prefix, _, index = name.rpartition("_")
        if prefix == "input_int_register" and isinstance(value, int):
            controller.input_ints[int(index)] = value
        elif prefix == "input_double_register" and isinstance(value, float):
            controller.input_doubles[int(index)] = value
    for prefix, shift in (("standard", 0), ("configurable", 8), ("tool", 16)):
        mask, bits = values.get(f"{prefix}_digital_output_mask"), values.get(f"{prefix}_digital_output")
        if isinstance(mask, int) and isinstance(bits, int):
            controller.set_digital_outputs(mask << shift, bits << shift)
    mask, fraction = values.get("speed_slider_mask"), values.get("speed_slider_fraction")
    if mask and isinstance(fraction, float):
        controller.set_speed_fraction(fraction)
    mask = values.get("standard_analog_output_mask")
    for channel in (0, 1):
        value = values.get(f"standard_analog_output_{channel}")
        if isinstance(mask, int) and mask & (1 << channel) and isinstance(value, float):
            controller.analog_outputs[channel] = value


def _six(values: object) -> tuple[float, ...]:
    return tuple(values.tolist())  # type: ignore[attr-defined]
