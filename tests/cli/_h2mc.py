# SPDX-License-Identifier: MIT
"""What the tests of the program share: running it, small scenes and images, EXR headers."""

import json
import os
import pathlib
import re
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest
import zlib

BINARY = os.environ.get("H2MC_BINARY", "")
SOURCE_DIR = os.environ.get("H2MC_SOURCE_DIR",
                            os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
RING = os.path.join(SOURCE_DIR, "scenes", "ring", "ring.xml")
SAMPLERS = ("path", "bdpt", "photon")
TOURS = ("erpt", "restore")
CHAINS = ("mmlt", "h2mc", "lmc", "rjmlt", "mlt", "pssmlt", "remlt")
INTEGRATORS = (*SAMPLERS, *CHAINS, *TOURS)


def wait_for_handler(process, seconds=60):
    """Returns when the process is ready for a SIGINT: on a busy machine that takes a while."""
    end = time.monotonic() + seconds
    while time.monotonic() < end and process.poll() is None:
        status = pathlib.Path(f"/proc/{process.pid}/status").read_text(encoding="ascii")
        caught = int(re.search(r"^SigCgt:\s*([0-9a-f]+)", status, re.MULTILINE).group(1), 16)
        if caught >> (signal.SIGINT - 1) & 1:
            return
        time.sleep(0.05)


def quick(integrator, *options):
    """The integrator for -i, with less preparation than it makes for a real image."""
    if integrator in TOURS:
        length = {"erpt": "chainLength=10", "restore": "tourLength=10"}[integrator]
        options = ("luminanceSamples=4000", length, *options)
    elif integrator in CHAINS:
        options = ("bootstrapSamples=4000", "chains=32", *options)
    return integrator + (":" if options else "") + ",".join(options)


# A grey box without a front under a lamp, seen by a small film.
SCENE = """<scene version="0.6.0">
  <default name="width" value="24"/>
  <default name="radiance" value="4"/>
  <sensor type="perspective">
    <float name="fov" value="40"/>
    <transform name="toWorld"><lookat origin="0, 1, 5" target="0, 1, 0" up="0, 1, 0"/></transform>
    <film type="hdrfilm">
      <integer name="width" value="$width"/>
      <integer name="height" value="16"/>
      <rfilter type="box"/>
    </film>
  </sensor>
  <bsdf type="diffuse" id="grey"><rgb name="reflectance" value="0.5, 0.5, 0.5"/></bsdf>
  <shape type="rectangle">
    <transform name="toWorld"><rotate x="1" angle="-90"/><scale value="2"/></transform>
    <ref id="grey"/>
  </shape>
  <shape type="rectangle">
    <transform name="toWorld"><scale value="2"/><translate z="-2"/></transform>
    <ref id="grey"/>
  </shape>
  <shape type="sphere">
    <point name="center" x="0" y="0.5" z="0"/>
    <float name="radius" value="0.5"/>
    <ref id="grey"/>
  </shape>
  <shape type="rectangle">
    <transform name="toWorld"><rotate x="1" angle="90"/><translate y="3"/></transform>
    <ref id="grey"/>
    <emitter type="area"><rgb name="radiance" value="$radiance, $radiance, $radiance"/></emitter>
  </shape>
</scene>
"""


class Test(unittest.TestCase):
    """Each test has a folder of its own, which is the current folder of what it runs."""

    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="h2mc_cli_")
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        with open(self.path(name), "w", encoding="utf-8") as out:
            out.write(text)
        return name

    def report(self, name):
        """What a JSON file holds."""
        with open(self.path(name), encoding="utf-8") as stream:
            return json.load(stream)

    def files(self):
        return sorted(os.listdir(self.folder))

    def run_h2mc(self, *arguments, timeout=300):
        return subprocess.run([BINARY, *map(str, arguments)], cwd=self.folder, timeout=timeout,
                              stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)

    def succeeds(self, *arguments):
        result = self.run_h2mc(*arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result

    def fails(self, code, *arguments, says=()):
        """It ends with this code and with a message that holds all of `says`, on stderr."""
        files = self.files()
        result = self.run_h2mc(*arguments)
        self.assertEqual(result.returncode, code, f"{arguments}: {result.stderr}")
        for words in [says] if isinstance(says, str) else says:
            self.assertIn(words, result.stderr, arguments)
        self.assertNotEqual(result.stderr.strip(), "")
        self.assertEqual(self.files(), files, "a failure leaves nothing behind")
        return result

    def refuses_at_once(self, *arguments, says, megabytes):
        """Exit code 2 and a message that holds all of `says`, within 10 s of processor time and so much memory.
        Returns the message."""
        with subprocess.Popen([BINARY, *map(str, arguments)], cwd=self.folder, stdin=subprocess.DEVNULL,
                              stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as process:
            message = process.stderr.read()
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
        self.assertEqual(process.returncode, 2, f"{arguments}: {message}")
        self.assertLess(usage.ru_utime + usage.ru_stime, 10, arguments)
        if "san" not in BINARY:  # sanitizers keep what was freed
            self.assertLess(usage.ru_maxrss / 1024, megabytes, arguments)
        for words in says:
            self.assertIn(words, message, arguments)
        return message

    def picture(self, name):
        """read_exr() without what differs from run to run, for equal renders."""
        attributes, pixels = self.read_exr(name)
        return {key: value for key, value in attributes.items()
                if key not in ("wallSeconds", "cpuSeconds", "threads")}, pixels

    def write_png(self, name, width, height, pixel):
        """8 bits a channel; pixel(x, y) gives (r, g, b)."""
        def chunk(kind, data):
            return (struct.pack(">I", len(data)) + kind + data
                    + struct.pack(">I", zlib.crc32(kind + data)))
        rows = b"".join(b"\0" + bytes(v for x in range(width) for v in pixel(x, y))
                        for y in range(height))
        with open(self.path(name), "wb") as out:
            out.write(b"\x89PNG\r\n\x1a\n"
                      + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
                      + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))
        return name

    def read_exr(self, name):
        """(attributes, the bytes that follow the header). Attributes: text, numbers, else bytes."""
        with open(self.path(name), "rb") as stream:
            data = stream.read()
        self.assertEqual(data[:4], b"\x76\x2f\x31\x01")
        position, attributes = 8, {}
        while data[position] != 0:
            end = data.index(b"\0", position)
            key = data[position:end].decode()
            position = data.index(b"\0", end + 1)
            kind = data[end + 1:position].decode()
            size = struct.unpack_from("<i", data, position + 1)[0]
            value = data[position + 5:position + 5 + size]
            position += 5 + size
            if kind == "string":
                value = value.decode()
            elif kind in ("int", "float", "double"):
                value = struct.unpack("<" + kind[0], value)[0]
            attributes[key] = value
        return attributes, data[position + 1:]

    def pixel_rows(self, name):
        """Rows of (r, g, b) of an EXR as h2mc writes them: floats in zip-compressed blocks of 16 rows."""
        attributes, data = self.read_exr(name)
        left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"])
        width, height = right - left + 1, bottom - top + 1
        start = os.path.getsize(self.path(name)) - len(data)  # offsets count from the file's beginning
        rows = [None] * height
        for offset in struct.unpack_from(f"<{(height + 15) // 16}Q", data):
            first, size = struct.unpack_from("<2i", data, offset - start)
            packed = data[offset - start + 8:offset - start + 8 + size]
            count = min(16, bottom + 1 - first)
            if size == count * width * 12:
                raw = packed
            else:
                raw = bytearray(zlib.decompress(packed))
                for i in range(1, len(raw)):
                    raw[i] = (raw[i - 1] + raw[i] - 128) & 255
                half = (len(raw) + 1) // 2
                joined = bytearray(len(raw))
                joined[0::2], joined[1::2] = raw[:half], raw[half:]
                raw = bytes(joined)
            for row in range(count):
                line = struct.unpack_from(f"<{3 * width}f", raw, row * width * 12)
                # Channels lie one after the other in the order of their names: B, G, R.
                rows[first - top + row] = list(zip(line[2 * width:], line[width:2 * width], line[:width]))
        return rows


def main():
    if not BINARY:
        print("H2MC_BINARY does not say where the program is", file=sys.stderr)
        sys.exit(77)
    unittest.main()
