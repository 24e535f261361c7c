"""Friction that depends on the load, one effect a file."""
