# SPDX-License-Identifier: AGPL-3.0-or-later
"""A headless Chromium that is told what to do while its pages run, by the DevTools protocol on a pipe."""
import base64
import fcntl
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

PATIENCE = 60  # s


class Chromium:
    """One page at a time. `fresh` gives the next one, which finds nothing that the last has stored: a tenth of the
    time that a browser takes to start."""

    def __init__(self, program, *options, width=1280, height=1120):
        if program.endswith("-NOTFOUND"):
            sys.exit("Chromium not found: install the Debian package chromium")
        self.profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)  # its helpers may still be writing there
        down, self.commands = os.pipe()
        self.answers, up = os.pipe()
        self.number, self.left, self.session, self.context, self.size = 0, b"", None, None, (width, height)

        def on_3_and_4():
            low, high = (fcntl.fcntl(end, fcntl.F_DUPFD, 64) for end in (down, up))  # neither is 3 or 4
            os.dup2(low, 3), os.dup2(high, 4)

        self.process = subprocess.Popen(
            [program, "--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", *options,
             f"--user-data-dir={self.profile.name}", "--remote-debugging-pipe", "about:blank"],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, preexec_fn=on_3_and_4, pass_fds=(3, 4))
        os.close(down)
        os.close(up)
        self.fresh()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        os.close(self.commands)
        self.process.kill()
        self.process.wait()
        os.close(self.answers)
        self.profile.cleanup()

    def fresh(self, width=None, height=None):
        """A new page, as large as the browser was told or as is told here."""
        self.session = None
        if self.context:
            self.call("Target.disposeBrowserContext", browserContextId=self.context)
        self.context = self.call("Target.createBrowserContext")["browserContextId"]
        target = self.call("Target.createTarget", url="about:blank", browserContextId=self.context, newWindow=True,
                           width=width or self.size[0], height=height or self.size[1])["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]

    def call(self, method, **parameters):
        self.number += 1
        command = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            command["sessionId"] = self.session
        os.write(self.commands, json.dumps(command).encode() + b"\0")
        while True:
            message = json.loads(self.message())
            if message.get("id") == self.number:
                if "error" in message:
                    raise RuntimeError(f"{method}: {message['error']}")
                return message["result"]

    def message(self):
        while b"\0" not in self.left:
            more = os.read(self.answers, 1 << 20)
            if not more:
                raise RuntimeError("the browser has ended")
            self.left += more
        first, self.left = self.left.split(b"\0", 1)
        return first

    def open(self, address):
        self.call("Page.navigate", url=address)
        self.wait("document.readyState === 'complete'")

    def play(self, address, seconds=60):
        """Opens a fresh page whose clock does not wait: it jumps to the next timer, for so many seconds of its own."""
        self.fresh()
        self.call("Emulation.setVirtualTimePolicy", policy="pause")  # the empty page would use the time up
        self.call("Page.navigate", url=address)
        self.call("Emulation.setVirtualTimePolicy", policy="pauseIfNetworkFetchesPending", budget=1000 * seconds,
                  maxVirtualTimeTaskStarvationCount=9999)

    def value(self, expression):
        """What the page computes."""
        said = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in said:
            raise RuntimeError(said["exceptionDetails"]["exception"].get("description", str(said)))
        return said["result"].get("value")

    def wait(self, expression):
        """Until it is true in the page."""
        end = time.monotonic() + PATIENCE
        while not self.value(expression):
            if time.monotonic() > end:
                raise RuntimeError(f"it did not come true: {expression}")
            time.sleep(0.05)

    def said(self):
        """What the page leaves as JSON in its element `said`, once it does."""
        self.wait("document.getElementById('said')?.textContent > ''")
        return json.loads(self.value("document.getElementById('said').textContent"))

    def document(self):
        return self.value("document.documentElement.outerHTML")

    def picture(self, path):
        pathlib.Path(path).write_bytes(base64.b64decode(self.call("Page.captureScreenshot")["data"]))

    def printed(self):
        """The PDF of the page."""
        return base64.b64decode(self.call("Page.printToPDF")["data"])
