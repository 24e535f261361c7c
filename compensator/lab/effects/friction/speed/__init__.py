"""Friction that depends on speed and direction, one effect a file."""
