#!/usr/bin/env python3
"""Starts the robot, follows it until it works, and stops it: python3 robot.py SOCKET"""
import json
import socket
import sys

SEPARATOR = b"\x1f"


class Robot:
    """A connection to the daemon: JSON objects, each ended by 0x1F."""

    def __init__(self, path):
        self.stream = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        self.stream.settimeout(30)
        self.stream.connect(path)
        self.received = b""

    def say(self, **request):
        self.stream.sendall(json.dumps(request).encode() + SEPARATOR)

    def hear(self):
        while SEPARATOR not in self.received:
            part = self.stream.recv(65536)
            if not part:
                sys.exit("the daemon has closed the connection")
            self.received += part
        message, self.received = self.received.split(SEPARATOR, 1)
        return json.loads(message)

    def wait_for(self, fits):
        while True:
            update = self.hear()
            if update["e"] == "failed":
                sys.exit(f"refused ({update['reason']}): {update['text']}")
            if fits(update):
                return update


robot = Robot(sys.argv[1])
robot.say(c="hello", name="a Python script")
hello = robot.wait_for(lambda update: update["e"] == "hello")
print("robot:", hello["robot"]["device"] if hello.get("robot") else "none")
robot.say(c="watch", topics=["status", "pose"])
robot.say(c="start", id=1)
robot.wait_for(lambda update: update["e"] == "done" and update["id"] == 1)
status = robot.wait_for(lambda update: update["e"] == "status" and update["state"] in ("starting", "cleaning"))
print("state:", status["state"])
pose = robot.wait_for(lambda update: update["e"] == "pose")
print(f"place: {pose['x']:.2f} m, {pose['y']:.2f} m")
robot.say(c="stop", id=2)
robot.wait_for(lambda update: update["e"] == "done" and update["id"] == 2)
print("stopped")
