"""The commands for real devices and their emulators."""
