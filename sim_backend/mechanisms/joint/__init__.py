"""Gear, shaft, arm and encoder.

One law a file; `sim_backend.plant.step` asks each once.
"""
