"""ODrive on a CAN bus."""
