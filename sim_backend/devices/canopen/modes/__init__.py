"""Modes of operation (0x6060): what torque they ask for."""
