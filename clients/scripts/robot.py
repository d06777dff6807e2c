#!/usr/bin/env python3
"""Lets a robot do something: python3 robot.py SOCKET [start|follow|drive|room [NUMBER]|rate]"""
import json
import math
import socket
import sys
import time

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


    def answered(self, number):
        return self.wait_for(lambda update: update["e"] == "done" and update["id"] == number)


def works(update):
    return update["e"] == "status" and update["state"] in ("starting", "cleaning")


def stop(robot):
    robot.say(c="stop", id=2)
    robot.answered(2)
    print("stopped")


def start(robot):
    """Starts it, follows it until it works, and stops it."""
    robot.say(c="watch", topics=["status", "pose"])
    robot.say(c="start", id=1)
    robot.answered(1)
    print("state:", robot.wait_for(works)["state"])
    pose = robot.wait_for(lambda update: update["e"] == "pose")
    print(f"place: {pose['x']:.2f} m, {pose['y']:.2f} m")
    stop(robot)


def follow(robot):
    """Says how old the newest telemetry is, five times."""
    robot.say(c="watch", topics=["device"])
    for _ in range(5):
        device = robot.wait_for(lambda update: update["e"] == "device")
        print(f"telemetry: {device['link']['age_ms']} ms old")


def drive(robot):
    """Drives two seconds backwards at 0.1 m/s, as from its dock. The lease of 300 ms is renewed; who lets go stops."""
    robot.say(c="watch", topics=["pose"])
    robot.say(c="drive", v=0, w=0, ttl=300, id=1)
    robot.answered(1)
    for _ in range(20):
        robot.say(c="drive", v=-0.1, w=0, ttl=300)
        time.sleep(0.1)
    robot.say(c="stop", id=2)
    poses = []

    def is_over(update):
        if update["e"] == "pose":
            poses.append((update["x"], update["y"]))
        return update["e"] == "done" and update["id"] == 2

    robot.wait_for(is_over)
    print("stopped")
    print(f"driven: {math.dist(poses[0], poses[-1]):.2f} m")


def room(robot):
    """Cleans the room of this number, or the first one that it knows."""
    robot.say(c="watch", topics=["home", "status"])
    rooms = robot.wait_for(lambda update: update["e"] == "home" and update.get("rooms"))["rooms"]
    number = int(sys.argv[3]) if len(sys.argv) > 3 else rooms[0]["id"]
    robot.say(c="clean", parts=[{"room": number}], id=1)
    robot.answered(1)
    print("state:", robot.wait_for(works)["state"])
    print("room:", number)
    stop(robot)


def rate(robot):
    """Says how many packets a second it understands, until another kind comes."""
    count, begin = 0, time.monotonic()
    try:
        while robot.hear()["e"] == "pose":
            count += 1
    except SystemExit:
        pass
    print(f"packets a second: {count / (time.monotonic() - begin):.0f}")


JOBS = {job.__name__: job for job in (start, follow, drive, room, rate)}
robot = Robot(sys.argv[1])
job = JOBS[sys.argv[2] if len(sys.argv) > 2 else "start"]
if job is not rate:
    robot.say(c="hello", name="a Python script")
    hello = robot.wait_for(lambda update: update["e"] == "hello")
    print("robot:", hello["robot"]["device"] if hello.get("robot") else "none")
job(robot)
