"""Actuators with motor, gear, encoder and drive in one housing: what the bench does with each, whatever its protocol.

A kind brings an `Actuator` that speaks its protocol; it knows nothing of joint, signs and states, which are here.
"""
