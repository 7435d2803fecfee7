"""What reaches the pins: memory, a Raspberry Pi through gpiozero, a PLC through pymodbus. One file each."""
