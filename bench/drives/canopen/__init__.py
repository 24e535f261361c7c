"""CiA 402 drives on a CAN bus."""
