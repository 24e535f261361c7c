"""RoboClaw motor controllers over packet serial (Basicmicro, RoboClaw Series User Manual)."""
