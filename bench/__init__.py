"""Where drives, compensator, store and service are wired into one bench."""

__version__ = "0.2.0"
