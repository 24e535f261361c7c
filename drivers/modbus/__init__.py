"""Drives over Modbus RTU and TCP: what each register means is data, one TOML file per family of drives."""
