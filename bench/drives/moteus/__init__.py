"""moteus controllers behind a serial adapter."""
