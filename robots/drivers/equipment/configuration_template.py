"""The commented example of an equipment document for a kind of hardware."""

from __future__ import annotations

from engine.document.equipment import GpiozeroPins, ModbusPins, PinBackend

_HEAD = """\
# An equipment document: check it with `flexcell check FILE`.
flexcell: 1
equipment: my_module
"""
_PINS = """\
# The longest silence of the client in seconds until all outputs are at their safe values; at most 0.2.
silence_s: 0.2
# The name of a pin is the name of its service.
pins:
  clamp:
    kind: digital_output
    pin: {output}
    # The value at the start, at the end, and when the client is silent or gone: a clamp that holds stays closed.
    safe: true
    # STOP: `keep` the value, or set the `safe` one.
    at_stop: keep
    # On at the low level, as many relay boards are.
    active_low: false
  part_there:
    kind: digital_input
    pin: {input}
"""
_GPIO = """\
# factory: lgpio (pins of this computer), pigpio (a pigpiod over the network), mock (nothing; to try it)
backend: {kind: gpiozero, factory: lgpio}
"""
_MODBUS = """\
# The coils of the PLC are outputs, its discrete inputs are inputs; both count from 0.
backend: {kind: modbus_tcp, host: 192.168.1.20, port: 502, unit: 1}
"""
_PWM = """\
    # none, up or down
    pull: up
  blow:
    kind: pwm
    pin: 18
    safe: 0.0
    frequency_hz: 50.0
"""


def configuration_template(backend: PinBackend) -> str:
    """Return the example for the hardware of a back end."""
    match backend:
        case ModbusPins():
            return _HEAD + _MODBUS + _PINS.format(output=0, input=0)
        case GpiozeroPins():
            return _HEAD + _GPIO + _PINS.format(output=17, input=27) + _PWM
        case _:
            return _HEAD + "backend: {kind: simulated}\n" + _PINS.format(output=17, input=27)
