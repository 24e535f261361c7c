"""What goes wrong on a bench, when, and what that does to plant and samples.

Faults are scripted; nothing here is random.
"""
