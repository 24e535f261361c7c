"""A CANopen node (CiA 301) that is a servo drive (CiA 402)."""
