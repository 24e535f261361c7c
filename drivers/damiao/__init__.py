"""Damiao actuators on a CAN bus, by the MIT protocol: torque by its feed-forward term, both gains zero."""
