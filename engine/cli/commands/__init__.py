"""The commands, one file each, and what one of them needs only for itself."""
