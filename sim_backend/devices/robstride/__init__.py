"""A RobStride actuator on a CAN bus, as RobStride's user manuals describe it."""
