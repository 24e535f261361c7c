"""Dynamixel X servos (ROBOTIS), protocol 2.0, as the e-Manual describes them."""
