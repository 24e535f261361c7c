"""RoboClaw motor controllers on a serial port."""
