"""An ODrive axis on a CAN bus, CANSimple of firmware 0.6, as ODrive's manual describes it."""
