"""CiA 402: states, modes, units and objects of a drive.

Pure tables and functions, and the switching of the power stage; the bus is in `cia301`.
"""
