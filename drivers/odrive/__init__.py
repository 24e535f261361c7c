"""ODrive on a CAN bus, by its CANSimple protocol."""
