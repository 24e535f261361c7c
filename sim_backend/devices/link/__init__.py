"""Byte lines between a host and a simulated device: pace, faults, pseudo-terminals and TCP."""
