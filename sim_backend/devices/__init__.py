"""Simulated devices: drives that speak their wire protocol, with the plant behind them, in wall-clock time."""
