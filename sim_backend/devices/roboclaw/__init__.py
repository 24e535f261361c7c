"""A RoboClaw motor controller (Basicmicro), packet serial, as its user manual describes it."""
