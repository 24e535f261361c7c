"""Drives made from data sheets, tried as a user would: opened, moved, left alone, cleared of a fault.

The sheets of `traits` are written here. Those of real drives are in a folder that FRICTION_BENCH_DICTIONARIES names;
tests that need it are skipped without it. `python -m tests.drivers.dictionaries FOLDER` prints the figures.
"""
