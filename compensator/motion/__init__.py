"""Load of a joint in motion: General Kinetic Friction, its calibration, and the load estimator.

Pure: samples in, numbers out.
"""
