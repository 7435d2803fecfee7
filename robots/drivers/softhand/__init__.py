"""qb SoftHand over a serial line: frames, transport, port and device; its emulator is in `emulation/`.

Experimental: never run on hardware, and no independent client has driven the emulator.
"""
