"""Dynamixel X servos on a serial bus."""
