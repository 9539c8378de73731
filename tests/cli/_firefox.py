# SPDX-License-Identifier: MIT
"""Firefox for Selenium without geckodriver, which Debian 12 does not have: a server on this machine that passes
WebDriver's requests on to Firefox's own remote control, Marionette, which has the same commands by other names."""

import http.server
import json
import os
import re
import shutil
import socket
import subprocess
import tempfile
import threading
import time

PROGRAM = shutil.which("firefox-esr") or shutil.which("firefox")

# Method, path below /session/ID, Marionette's name, what stands in the path.
COMMANDS = [(method, re.compile(path + "$"), name) for method, path, name in (
    ("DELETE", "", "DeleteSession"),
    ("POST", "/url", "Navigate"),
    ("POST", "/refresh", "Refresh"),
    ("POST", "/element", "FindElement"),
    ("POST", "/elements", "FindElements"),
    ("POST", "/element/(?P<id>[^/]+)/click", "ElementClick"),
    ("POST", "/element/(?P<id>[^/]+)/value", "ElementSendKeys"),
    ("GET", "/element/(?P<id>[^/]+)/text", "GetElementText"),
    ("GET", "/element/(?P<id>[^/]+)/rect", "GetElementRect"),
    ("POST", "/execute/sync", "ExecuteScript"),
    ("POST", "/actions", "PerformActions"),
    ("DELETE", "/actions", "ReleaseActions"),
    ("GET", "/screenshot", "TakeScreenshot"),
    ("GET", "/window/rect", "GetWindowRect"),
    ("POST", "/window/rect", "SetWindowRect"),
)]


class Marionette:
    """Messages are LENGTH:JSON: [0, number, command, parameters] and [1, number, error, result]."""

    def __init__(self, port):
        self.socket = socket.create_connection(("127.0.0.1", port))
        self.stream = self.socket.makefile("rb")
        self.number = 0
        self.receive()  # its greeting

    def receive(self):
        length = b""
        while not length.endswith(b":"):
            length += self.stream.read(1)
        return json.loads(self.stream.read(int(length[:-1])))

    def send(self, name, parameters):
        """(error, result), one of them None."""
        self.number += 1
        message = json.dumps([0, self.number, "WebDriver:" + name, parameters]).encode()
        self.socket.sendall(str(len(message)).encode() + b":" + message)
        _, _, error, result = self.receive()
        return error, result


class Handler(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    marionette = None

    def answer(self):
        body = self.rfile.read(int(self.headers.get("Content-Length") or 0))
        parameters = json.loads(body) if body else {}
        if self.path == "/session":
            name = "NewSession"
        else:
            below = re.sub("^/session/[^/]+", "", self.path)
            name, found = next(((n, m) for method, path, n in COMMANDS
                                if method == self.command and (m := path.match(below))), (None, None))
            if name:
                parameters = {**parameters, **found.groupdict()}
        error, result = self.marionette.send(name, parameters) if name else (
            {"error": "unknown command", "message": self.path, "stacktrace": ""}, None)
        if not error and isinstance(result, dict) and list(result) == ["value"]:
            result = result["value"]
        text = json.dumps({"value": error or result}).encode()
        self.send_response(500 if error else 200)
        self.send_header("Content-Type", "application/json")
        self.send_header("Content-Length", str(len(text)))
        self.end_headers()
        self.wfile.write(text)

    do_GET = do_POST = do_DELETE = answer

    def log_message(self, *_):
        pass


class Firefox:
    """A running one: `url` for Selenium, and what ends it."""

    def __init__(self, width, height):
        self.profile = tempfile.mkdtemp(prefix="h2mc-firefox-")
        with open(os.path.join(self.profile, "user.js"), "w", encoding="utf-8") as stream:
            stream.write('user_pref("marionette.port", 0);\n'
                         'user_pref("datareporting.policy.dataSubmissionEnabled", false);\n'
                         'user_pref("app.update.enabled", false);\n')
        self.process = subprocess.Popen(
            [PROGRAM, "--headless", "--marionette", "--no-remote", "--profile", self.profile,
             f"--width={width}", f"--height={height}"],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env={**os.environ, "HOME": self.profile})
        port = os.path.join(self.profile, "MarionetteActivePort")
        deadline = time.monotonic() + 60
        while not (os.path.exists(port) and os.path.getsize(port)):
            if time.monotonic() > deadline or self.process.poll() is not None:
                self.stop()
                raise RuntimeError("Firefox does not start")
            time.sleep(0.05)
        with open(port, encoding="ascii") as stream:
            handler = type("Handler", (Handler,), {"marionette": Marionette(int(stream.read()))})
        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
        threading.Thread(target=self.server.serve_forever, daemon=True).start()
        self.url = f"http://127.0.0.1:{self.server.server_port}"

    def stop(self):
        if hasattr(self, "server"):
            self.server.shutdown()
            self.server.server_close()
        self.process.terminate()
        self.process.wait()
        shutil.rmtree(self.profile, ignore_errors=True)
