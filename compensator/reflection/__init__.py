"""What of a load reaches the operator: reflected torque, its delay and quality, and forces at a tip.

Pure: samples in, numbers out.
"""
