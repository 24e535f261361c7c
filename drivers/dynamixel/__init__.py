"""Dynamixel X servos (ROBOTIS) on a serial bus, protocol 2.0."""
