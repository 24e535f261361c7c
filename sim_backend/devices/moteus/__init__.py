"""A moteus controller behind an fdcanusb adapter or by its UART, as mjbots' documentation describes it."""
