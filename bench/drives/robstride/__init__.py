"""RobStride actuators on a CAN bus."""
