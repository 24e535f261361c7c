"""Measured against predicted effort: by trial, regime, speed and load, and from run to run."""
