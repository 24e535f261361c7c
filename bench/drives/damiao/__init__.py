"""Damiao actuators on a CAN bus."""
