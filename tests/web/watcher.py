"""A page without a browser: one WebSocket to the live view, over a plain socket."""
import base64
import os
import socket
import threading

FRAME = b"\3\0\0\0"
TAKEN = b"\5\0\0\0"


class Connection:
    def __init__(self, port, origin=None):
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=20)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        here = f"127.0.0.1:{port}"
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall(f"GET /live HTTP/1.1\r\nHost: {here}\r\nOrigin: {origin or 'http://' + here}\r\n"
                            "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                            f"Sec-WebSocket-Key: {key}\r\n\r\n".encode())
        self.file = self.socket.makefile("rb")
        self.kind, self.parts = 0, []  # of a message that is not whole yet
        answer = self.file.readline().split()
        if not answer:
            raise ConnectionError("closed before it answered")
        self.status = int(answer[1])
        while self.file.readline() not in (b"\r\n", b""):
            pass

    def read(self):
        """Kind and bytes of the next message, whole; None at the end."""
        while True:
            head = self.file.read(2)
            if len(head) < 2:
                return None
            size = head[1] & 127
            if size > 125:
                size = int.from_bytes(self.file.read(2 if size == 126 else 8), "big")
            last, kind, body = head[0] & 0x80, head[0] & 15, self.file.read(size)
            if kind > 2:  # a ping or the end, between the parts of a message too
                return kind, body
            self.kind = kind or self.kind
            self.parts.append(body)
            if last:
                whole, self.parts = b"".join(self.parts), []
                return self.kind, whole

    def send(self, body, kind=2):
        size = len(body)
        length = bytes([0x80 | size]) if size < 126 else b"\xff" + size.to_bytes(8, "big")
        self.socket.sendall(bytes([0x80 | kind]) + length + bytes(4) + body)


class Watcher(threading.Thread):
    """Takes every frame that it gets."""

    def __init__(self, port):
        super().__init__(daemon=True)
        self.frames = self.bytes = 0
        self.connection = Connection(port)

    def run(self):
        try:
            while (message := self.connection.read()) is not None:
                self.take(*message)
        except OSError:
            pass

    def take(self, kind, body):
        self.bytes += len(body)
        if kind == 9:
            self.connection.send(body, 10)
        if kind == 2 and body[:4] == FRAME:
            self.frames += 1
            self.connection.send(TAKEN + self.frames.to_bytes(4, "little"))
