"""The motor: current from duty and speed, eqs. (3), (7) and (8) of the paper, and its constants from samples.

Pure: samples in, numbers out.
"""
