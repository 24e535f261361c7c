"""What resists motion on either side of the gear.

One law a file; `sim_backend.plant.resistance` adds them up.
"""
