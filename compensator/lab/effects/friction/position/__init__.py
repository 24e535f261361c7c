"""Friction that depends on the position, one effect a file."""
