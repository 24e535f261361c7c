"""A Modbus TCP server of libmodbus (C): registers that keep what is written, and no watchdog. Nothing here is ours."""

import ctypes
import ctypes.util
import socket
import threading
from contextlib import contextmanager

_LONGEST_FRAME = 260
_REGISTERS = 200


def library():
    """libmodbus, or None where it is not installed."""
    name = ctypes.util.find_library("modbus")
    if name is None:
        return None
    found = ctypes.CDLL(name)
    found.modbus_new_tcp.restype = ctypes.c_void_p
    found.modbus_mapping_new.restype = ctypes.c_void_p
    return found


@contextmanager
def libmodbus_server():
    """Serve one connection after the other, from a thread; yields the TCP port."""
    modbus = library()
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    context = ctypes.c_void_p(modbus.modbus_new_tcp(b"127.0.0.1", port))
    mapping = ctypes.c_void_p(modbus.modbus_mapping_new(0, 0, _REGISTERS, _REGISTERS))
    listener = ctypes.c_int(modbus.modbus_tcp_listen(context, 1))
    assert listener.value >= 0
    over = threading.Event()

    def serve():
        frame = (ctypes.c_uint8 * _LONGEST_FRAME)()
        while modbus.modbus_tcp_accept(context, ctypes.byref(listener)) >= 0 and not over.is_set():
            while (length := modbus.modbus_receive(context, frame)) >= 0:
                if length:
                    modbus.modbus_reply(context, frame, length, mapping)
            modbus.modbus_close(context)

    thread = threading.Thread(target=serve, daemon=True)
    thread.start()
    try:
        yield port
    finally:
        over.set()
        with socket.create_connection(("127.0.0.1", port)):  # wakes the thread
            pass
        thread.join(5.0)
        modbus.modbus_free(context)
