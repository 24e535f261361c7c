"""moteus controllers on CAN-FD behind a serial adapter (fdcanusb), or by their UART. Needs the extra `moteus`."""
