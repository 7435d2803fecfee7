"""Identification of the payload of an arm and of the friction of its joints, by least squares."""
