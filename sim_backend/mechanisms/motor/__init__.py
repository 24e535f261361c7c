"""Motor, power stage, supply and current sensor.

One law a file; `sim_backend.plant.step` asks each once.
"""
