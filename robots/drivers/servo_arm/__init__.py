"""A servo arm on an Arduino: its lines of text, and the controller that sends set points.

`flexcell_servo_arm/` is the sketch of the board, `emulation/` an emulator of it. Never run on hardware.
Hobby servos report no position: what is measured is what was written to them.
"""
