"""Masks and pictures: PNG files of 8 or 16 bits a channel."""

from __future__ import annotations

import struct
import zlib

import numpy as np

from .errors import PathLike, RunError, refuse
from .files import read_bytes

_CHANNELS = {0: 1, 2: 3, 4: 2, 6: 4}  # By colour type.


def _chunks(path: PathLike, data: bytes) -> list[tuple[bytes, bytes]]:
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        refuse(path, "no PNG signature", "a PNG file")
    chunks, at = [], 8
    while at + 12 <= len(data):
        (size,) = struct.unpack(">I", data[at : at + 4])
        body = data[at + 8 : at + 8 + size]
        chunks.append((data[at + 4 : at + 8], body))
        at += 12 + size
    if not chunks or chunks[0][0] != b"IHDR" or chunks[-1][0] != b"IEND":
        refuse(path, f"{len(data)} bytes", "a whole PNG file")
    return chunks


def _average(row: np.ndarray, above: np.ndarray, step: int) -> None:
    line, over = row.tolist(), above.tolist()
    for i in range(len(line)):
        left = line[i - step] if i >= step else 0
        line[i] = (line[i] + (left + over[i]) // 2) & 255
    row[:] = line


def _paeth(row: np.ndarray, above: np.ndarray, step: int) -> None:
    line, over = row.tolist(), above.tolist()
    for i in range(len(line)):
        a = line[i - step] if i >= step else 0
        c = over[i - step] if i >= step else 0
        b = over[i]
        pa, pb, pc = abs(b - c), abs(a - c), abs(a + b - 2 * c)
        near = a if pa <= pb and pa <= pc else b if pb <= pc else c
        line[i] = (line[i] + near) & 255
    row[:] = line


def _unfilter(path: PathLike, rows: np.ndarray, step: int) -> np.ndarray:
    """Undoes the filter of each row; `rows` has its kind as first byte."""
    out = rows[:, 1:].copy()
    above = np.zeros(out.shape[1], np.uint8)
    for kind, row in zip(rows[:, 0], out):
        if kind == 1:
            pixels = row.reshape(-1, step)
            np.cumsum(pixels, axis=0, dtype=np.uint8, out=pixels)
        elif kind == 2:
            row += above
        elif kind == 3:
            _average(row, above, step)
        elif kind == 4:
            _paeth(row, above, step)
        elif kind != 0:
            refuse(f"{path}: filter", kind, "0..4")
        above = row
    return out


def read_png(path: PathLike) -> np.ndarray:
    """An image, height x width (x channels where there are several), uint8 or
    uint16; channels in the order red, green, blue(, alpha)."""
    chunks = _chunks(path, read_bytes(path))
    if len(chunks[0][1]) != 13:
        refuse(f"{path}: IHDR", f"{len(chunks[0][1])} bytes", "13")
    width, height, bits, color, _, _, interlaced = struct.unpack(
        ">IIBBBBB", chunks[0][1]
    )
    if bits not in (8, 16) or color not in _CHANNELS or interlaced:
        refuse(
            path,
            f"{bits} bits, colour type {color}, interlaced {interlaced}",
            "8 or 16 bits a channel, no palette, not interlaced",
        )
    channels = _CHANNELS[color]
    step = channels * bits // 8
    try:
        raw = zlib.decompress(b"".join(b for k, b in chunks if k == b"IDAT"))
    except zlib.error:
        raise RunError(
            f"{path}: is damaged: expected a whole PNG file"
        ) from None
    if len(raw) != height * (1 + width * step):
        refuse(path, f"{len(raw)} bytes of pixels", f"{height} rows of {width}")
    rows = np.frombuffer(raw, np.uint8).reshape(height, 1 + width * step)
    pixels = _unfilter(path, rows, step)
    if bits == 16:
        pixels = pixels.view(">u2").astype(np.uint16)
    return pixels.reshape(
        (height, width) + ((channels,) if channels > 1 else ())
    )
