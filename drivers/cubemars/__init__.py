"""CubeMars AK actuators on a CAN bus, by the MIT protocol."""
