"""Where drives, compensator, store and service are wired into one bench."""
