"""What stands between a joint and its power: safe torque off, and the holding brake.

A joint without power is held by its brake alone, and safe torque off takes the power away at any time.
"""
