"""Commands to a pitviper stream, and what it says of its frames: lines of JSON over TCP or a Unix socket. Standard library only."""
import json
import socket
import time


class Commands:
    """`place`: "7380", "127.0.0.1:7380", or the path of a Unix socket, as given to `pitviper stream --commands`."""

    def __init__(self, place="7380", wait_s=30.0):
        until = time.monotonic() + wait_s
        while True:
            try:
                if "/" in place:
                    self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
                    self._socket.connect(place)
                else:
                    host, _, port = place.rpartition(":")
                    self._socket = socket.create_connection((host or "127.0.0.1", int(port)))
                    self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                break
            except OSError:
                if time.monotonic() >= until:
                    raise
                time.sleep(0.05)
        self._lines = self._socket.makefile("r", encoding="utf-8")

    def send(self, **command):
        """`send(command="light", light="flare", level=0)`; the words are those of a scenario's `commands`."""
        self._socket.sendall((json.dumps(command) + "\n").encode())

    def read(self):
        """The next line that comes: a frame's, an answer. ValueError with what pitviper says of a command that is none; EOFError at the stream's end."""
        line = self._lines.readline()
        if not line:
            raise EOFError("the stream has ended")
        said = json.loads(line)
        if "error" in said:
            raise ValueError(said["error"])
        return said

    def step(self, ticks=1, **command):
        """Lockstep: lets the clock go on, with a command if there is one; returns what is said of the frame, once it is out."""
        self.send(step=ticks, **command)
        while "frame" not in (said := self.read()):
            pass
        return said
