"""The plant against theory, and the simulated drive against the contract."""
