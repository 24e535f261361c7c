"""CubeMars actuators on a CAN bus."""
