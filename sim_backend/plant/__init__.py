"""The plant: parameters, state, and the compiled integration of rotor and arm.

Each mechanism is a file of `sim_backend.mechanisms`; here they are asked and added up.
"""
