"""The figures that the compensator is to reach, measured on the simulated bench: over seeds, and over rigs."""
