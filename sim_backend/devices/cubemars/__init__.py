"""A CubeMars actuator on a CAN bus, MIT protocol, as CubeMars' driver manual describes it."""
