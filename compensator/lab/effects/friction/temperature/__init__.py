"""Friction that depends on the temperature, one effect a file."""
