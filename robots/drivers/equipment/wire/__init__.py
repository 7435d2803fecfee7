"""The wire of the equipment server: its messages, and the blocking client that programs and drivers use."""
