# SPDX-License-Identifier: MIT
"""A viewer that understands what tev does of its protocol, as far as h2mc speaks it."""

import socket
import struct
import threading


class Fields:
    def __init__(self, packet):
        self.packet, self.position = packet, 0

    def take(self, form):
        values = struct.unpack_from("<" + form, self.packet, self.position)
        self.position += struct.calcsize("<" + form)
        return values if len(values) > 1 else values[0]

    def text(self):
        end = self.packet.index(b"\0", self.position)
        value = self.packet[self.position:end].decode()
        self.position = end + 1
        return value


class Viewer:
    """Listens on a port of this machine. images: name -> {"size": (width, height), "rows": [rows of floats]}; updates:
    how many strips came; connections: how many times somebody connected."""

    def __init__(self, port=0):
        self.listener = socket.create_server(("127.0.0.1", port))
        self.port = self.listener.getsockname()[1]
        self.images, self.updates, self.connections, self.problems = {}, 0, 0, []
        self.connection = None
        self.came = threading.Event()  # a first update
        self.thread = threading.Thread(target=self.run, daemon=True)

    def start(self):
        self.thread.start()
        return self

    def run(self):
        while True:
            try:
                self.connection, _ = self.listener.accept()
            except OSError:
                return
            self.connections += 1
            try:
                while self.one_packet():
                    pass
            except OSError:
                pass
            except Exception as problem:  # pylint: disable=broad-except
                self.problems.append(repr(problem))
                return

    def exactly(self, count):
        parts = bytearray()
        while len(parts) < count:
            part = self.connection.recv(count - len(parts))
            if not part:
                if parts:
                    self.problems.append("ends within a packet")
                return None
            parts += part
        return bytes(parts)

    def one_packet(self):
        head = self.exactly(4)
        if head is None:
            return False
        packet = self.exactly(struct.unpack("<I", head)[0] - 4)
        if packet is None:
            return False
        fields = Fields(packet)
        kind, _grab, name = fields.take("B"), fields.take("B"), fields.text()
        if kind == 4:
            width, height, count = fields.take("3i")
            channels = [fields.text() for _ in range(count)]
            self.images[name] = {"size": (width, height), "channels": channels, "rows": [None] * height}
        elif kind == 6:
            count = fields.take("i")
            channels = [fields.text() for _ in range(count)]
            x, y, width, height = fields.take("4i")
            offsets, strides = fields.take(f"{count}q"), fields.take(f"{count}q")
            image = self.images[name]
            assert channels == image["channels"] and x == 0 and width == image["size"][0], "another picture"
            floats = max(o + (width * height - 1) * s + 1 for o, s in zip(offsets, strides))
            values = fields.take(f"{floats}f")
            for row in range(height):
                image["rows"][y + row] = [
                    tuple(values[o + (row * width + column) * s] for o, s in zip(offsets, strides))
                    for column in range(width)]
            self.updates += 1
            self.came.set()
        else:
            raise ValueError(f"packet of kind {kind}")
        assert fields.position == len(packet), "bytes are left over"
        return True

    def close(self):
        """As a viewer whose window is closed."""
        try:
            self.listener.shutdown(socket.SHUT_RDWR)  # accept() returns
        except OSError:
            pass
        self.listener.close()
        if self.connection:
            try:
                self.connection.shutdown(socket.SHUT_RDWR)
            except OSError:
                pass
            self.connection.close()
