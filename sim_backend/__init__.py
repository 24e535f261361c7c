"""Plant physics and the drives and devices that simulate it."""
