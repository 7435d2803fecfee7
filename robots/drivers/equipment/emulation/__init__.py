"""An emulated pigpiod, for the real client pigpio."""
