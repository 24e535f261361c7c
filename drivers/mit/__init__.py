"""Actuators by the MIT protocol: torque by its feed-forward term. What Damiao, CubeMars and RobStride share.

The protocol is that of the MIT Mini Cheetah's actuator (B. Katz, "A low cost modular actuator for dynamic robots").
"""
