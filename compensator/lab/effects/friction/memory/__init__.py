"""Friction that depends on what the joint did before, one effect a file."""
