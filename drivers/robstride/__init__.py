"""RobStride actuators on a CAN bus, by their own protocol: the MIT command in wider words."""
