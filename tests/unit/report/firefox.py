"""Firefox as it is installed, asked by Marionette, the protocol that it brings: it wants no driver.

A message is its length, a colon, and JSON: `[0, number, command, parameters]` to Firefox, and
`[1, number, error, result]` back.
"""

import base64
import json
import os
import socket
import subprocess
import time

from browsing import found_firefox

PREFERENCES = {
    "app.normandy.enabled": False,
    "app.update.disabledForTesting": True,
    "browser.shell.checkDefaultBrowser": False,
    "datareporting.policy.dataSubmissionEnabled": False,
    "marionette.port": 0,
    "network.dns.disabled": True,
    "toolkit.telemetry.reportingpolicy.firstRun": False,
    "webgl.force-enabled": True,
}
PATIENCE = 60.0
"""How long it may take to start or to answer [s]."""

WRONG = """
const told = Services.console.getMessageArray().filter(m => m instanceof Ci.nsIScriptError);
const own = told.filter(m => m.sourceName.startsWith("file:") || m.category.includes("CSP"));
return own.map(m => m.errorMessage);
"""
DRAWN = "requestAnimationFrame(() => requestAnimationFrame(arguments[0]));"


class StartError(RuntimeError):
    """What is installed does not start."""


class Display:
    """A screen that nobody sees: without one Firefox does not draw in 3D."""

    def __init__(self):
        reader, writer = os.pipe()
        screen = ("-screen", "0", "1400x1000x24")
        self._process = subprocess.Popen(
            ["Xvfb", "-displayfd", str(writer), *screen],
            pass_fds=[writer],
            stderr=subprocess.DEVNULL,
        )
        os.close(writer)
        with os.fdopen(reader) as told:
            number = told.readline().strip()
        if not number:
            self._process.wait()
            raise StartError("Xvfb does not start")
        self.name = f":{number}"

    def close(self):
        self._process.terminate()
        self._process.wait()


class Firefox:
    """A window of Firefox with a profile of its own on a display."""

    def __init__(self, profile, display):
        lines = (f"user_pref({json.dumps(k)}, {json.dumps(v)});" for k, v in PREFERENCES.items())
        (profile / "user.js").write_text("\n".join(lines), encoding="utf-8")
        command = [found_firefox(), "--marionette", "--remote-allow-system-access", "--no-remote"]
        environment = {**os.environ, "DISPLAY": display, "MOZ_ENABLE_WAYLAND": "0"}
        environment.pop("WAYLAND_DISPLAY", None)
        self._process = subprocess.Popen(
            [*command, "--profile", str(profile)],
            env=environment,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        self._socket = self._stream = None
        self._number = 0
        try:
            self._connect(profile / "MarionetteActivePort")
        except BaseException:
            self.close()
            raise

    def _connect(self, port):
        end = time.monotonic() + PATIENCE
        while not (port.exists() and port.read_text()):
            if time.monotonic() > end or self._process.poll() is not None:
                raise StartError("Firefox does not start")
            time.sleep(0.05)
        self._socket = socket.create_connection(("127.0.0.1", int(port.read_text())), PATIENCE)
        self._stream = self._socket.makefile("rb")
        self._read()
        self.ask("WebDriver:NewSession")

    def _read(self):
        digits = b""
        while (digit := self._stream.read(1)) != b":":
            if not digit:
                raise RuntimeError("Firefox has gone")
            digits += digit
        return json.loads(self._stream.read(int(digits)))

    def ask(self, command, **parameters):
        """The result of a command."""
        self._number += 1
        message = json.dumps([0, self._number, command, parameters]).encode()
        self._socket.sendall(b"%d:%s" % (len(message), message))
        _, _, error, result = self._read()
        if error:
            raise RuntimeError(f"{command}: {error['message']}")
        return result

    def run(self, script):
        """What a script returns in the page."""
        return self.ask("WebDriver:ExecuteScript", script=script, args=[], sandbox=None)["value"]

    def open(self, file):
        self.ask("WebDriver:Navigate", url=file.resolve().as_uri())

    def press(self, *keys):
        """Press keys one after the other."""
        actions = [{"type": kind, "value": key} for key in keys for kind in ("keyDown", "keyUp")]
        source = {"type": "key", "id": "keys", "actions": actions}
        self.ask("WebDriver:PerformActions", actions=[source])

    def picture(self, selector):
        """An element as it is drawn once the page has come to draw, as a PNG."""
        self.ask("WebDriver:ExecuteAsyncScript", script=DRAWN, args=[], sandbox=None)
        element = self.ask("WebDriver:FindElement", using="css selector", value=selector)["value"]
        (name,) = element.values()
        shot = self.ask("WebDriver:TakeScreenshot", id=name, full=False, hash=False)
        return base64.b64decode(shot["value"])

    def wrong(self):
        """What it has told of errors in pages since it forgot."""
        return self._run_inside(WRONG)

    def forget(self):
        """Let it forget what it has told."""
        self._run_inside("Services.console.reset();")

    def _run_inside(self, script):
        """What a script returns that is not of the page, but of the browser."""
        self.ask("Marionette:SetContext", value="chrome")
        try:
            return self.run(script)
        finally:
            self.ask("Marionette:SetContext", value="content")

    def close(self):
        """End it, whatever state it is in."""
        for connection in filter(None, (self._stream, self._socket)):
            connection.close()
        self._process.terminate()
        try:
            self._process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
