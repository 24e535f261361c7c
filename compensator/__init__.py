"""The paper's friction compensation and the model lab: pure numerics on arrays, no I/O."""
