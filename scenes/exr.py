# SPDX-License-Identifier: MIT
"""Reads and writes small OpenEXR files with the standard library alone: scan lines of 32-bit floats,
red, green and blue, uncompressed or ZIP, which is what h2mc writes too."""

import struct
import zlib


def read(path):
    """(attributes as bytes, width, height, three lists of floats in rows from the top: r, g, b)."""
    attributes, width, height, planes = read_planes(path)
    return attributes, width, height, [planes[name] for name in "RGB"]


def read_planes(path):
    """The same with all channels, as lists of floats by their names."""
    with open(path, "rb") as stream:
        data = stream.read()
    if data[:4] != b"\x76\x2f\x31\x01":
        raise ValueError(f"{path} is not an OpenEXR file")
    at, attributes = 8, {}
    while data[at]:
        end = data.index(b"\0", at)
        name = data[at:end].decode()
        at = data.index(b"\0", end + 1)
        size = struct.unpack_from("<i", data, at + 1)[0]
        attributes[name] = data[at + 5:at + 5 + size]
        at += 5 + size
    at += 1
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    channels, k, text = [], 0, attributes["channels"]
    while text[k]:
        end = text.index(b"\0", k)
        channels.append(text[k:end].decode())
        if struct.unpack_from("<i", text, end + 1)[0] != 2:
            raise ValueError(f"{path}: expected 32-bit floats")
        k = end + 17
    lines = {0: 1, 2: 1, 3: 16}[attributes["compression"][0]]
    blocks = (height + lines - 1) // lines
    planes = {name: [0.0] * (width * height) for name in channels}
    for offset in struct.unpack_from(f"<{blocks}Q", data, at):
        y, size = struct.unpack_from("<2i", data, offset)
        rows = min(lines, height - (y - y0))
        expected = rows * width * 4 * len(channels)
        block = data[offset + 8:offset + 8 + size]
        if size < expected:
            block = unfilter(zlib.decompress(block))
        values = struct.unpack(f"<{rows * width * len(channels)}f", block)
        for row in range(rows):
            for c, name in enumerate(channels):
                first = (row * len(channels) + c) * width
                to = (y - y0 + row) * width
                planes[name][to:to + width] = values[first:first + width]
    return attributes, width, height, planes


def unfilter(data):
    """Undoes ZIP's differences and its halves of even and odd bytes."""
    total, out = data[0], bytearray(data)
    for i in range(1, len(out)):
        total = (total + out[i] - 128) & 255
        out[i] = total
    half = (len(out) + 1) // 2
    result = bytearray(len(out))
    result[0::2], result[1::2] = out[:half], out[half:]
    return bytes(result)


def filtered(data):
    halves = data[0::2] + data[1::2]
    return bytes([halves[0]] + [(b - a + 128) & 255 for a, b in zip(halves, halves[1:])])


def write(path, width, height, planes, texts=(), compress=True):
    """planes: r, g, b as lists of floats in rows from the top. texts: (name, text) for the header.
    Files that have to be the same on every machine are better not compressed."""
    def attribute(name, kind, value):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value
    channels = b"".join(name + b"\0" + struct.pack("<iB3xii", 2, 0, 1, 1) for name in (b"B", b"G", b"R"))
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    header = b"\x76\x2f\x31\x01" + struct.pack("<i", 2)
    header += attribute("channels", "chlist", channels + b"\0")
    header += attribute("compression", "compression", bytes([3 if compress else 0]))
    header += attribute("dataWindow", "box2i", window) + attribute("displayWindow", "box2i", window)
    header += attribute("lineOrder", "lineOrder", b"\0")
    header += attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
    header += attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0))
    header += attribute("screenWindowWidth", "float", struct.pack("<f", 1))
    for name, text in texts:
        header += attribute(name, "string", text.encode())
    header += b"\0"
    lines = 16 if compress else 1
    blocks = []
    for y in range(0, height, lines):
        data = b"".join(struct.pack(f"<{width}f", *plane[row * width:(row + 1) * width])
                        for row in range(y, min(y + lines, height)) for plane in reversed(planes))
        if compress:
            packed = zlib.compress(filtered(data), 9)
            data = packed if len(packed) < len(data) else data
        blocks.append(struct.pack("<2i", y, len(data)) + data)
    offset = len(header) + 8 * len(blocks)
    with open(path, "wb") as out:
        out.write(header)
        for block in blocks:
            out.write(struct.pack("<Q", offset))
            offset += len(block)
        for block in blocks:
            out.write(block)
