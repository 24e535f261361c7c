"""Drives on Modbus RTU and TCP; the map of ours is docs/modbus-map.md."""
