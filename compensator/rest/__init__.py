"""Load and friction of a joint at rest: breakaway currents on both sides, eqs. (9) and (10) of the paper.

Pure: samples in, numbers out.
"""
