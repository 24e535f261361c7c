"""How long the frames of one control cycle take on the bus. Pure."""

_OVERHEAD_BITS = 47  # of a frame with an 11-bit identifier, with the gap to the next (ISO 11898-1)
_STUFFING = 1.2  # stuff bits: one in five of what they apply to, at worst


def cycle_s(payload_bytes: tuple[int, ...], bitrate: int) -> float:
    """Longest time that frames need [s].

    Args:
        payload_bytes: of each frame.
        bitrate: of the bus [bit/s].
    """
    return sum((_OVERHEAD_BITS + 8 * size) * _STUFFING for size in payload_bytes) / bitrate
