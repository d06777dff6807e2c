#!/usr/bin/env python3
"""A client of the REST interface that Valetudo's clients speak; it uses only what is written about it.

dialect.py ADDRESS USER PASSWORD read PATH...             what GET answers, by path
dialect.py ADDRESS USER PASSWORD put CAPABILITY JSON      status and text of a command
dialect.py ADDRESS USER PASSWORD follow STREAM SECONDS    what is pushed
dialect.py ADDRESS USER PASSWORD crowd STREAM COUNT       which of so many followers are left by the others
dialect.py ADDRESS USER PASSWORD drive VELOCITY ANGLE SECONDS
                                                          moves ten times a second, then falls silent without a word
Prints one JSON object."""
import base64
import http.client
import json
import sys
import time
from urllib.parse import urlsplit


class Robot:
    def __init__(self, address, user, password):
        self.place = urlsplit(address)
        coded = base64.b64encode(f"{user}:{password}".encode()).decode()
        self.headers = {"Authorization": f"Basic {coded}"} if password else {}

    def connect(self, timeout=30):
        return http.client.HTTPConnection(self.place.hostname, self.place.port, timeout=timeout)

    def ask(self, method, path, body=None, connection=None):
        connection = connection or self.connect()
        headers = dict(self.headers)
        if body is not None:
            headers["Content-Type"] = "application/json"
        connection.request(method, f"{self.place.path}/{path}", body, headers)
        answer = connection.getresponse()
        return answer.status, answer.read().decode()

    def read(self, path):
        code, text = self.ask("GET", path)
        return json.loads(text) if code == 200 else {"code": code, "text": text}

    def put(self, capability, value, connection=None):
        code, text = self.ask("PUT", f"robot/capabilities/{capability}", json.dumps(value), connection)
        return {"code": code, "text": text}

    def follow(self, stream, timeout):
        connection = self.connect(timeout)
        connection.request("GET", f"{self.place.path}/{stream}/sse", headers=self.headers)
        answer = connection.getresponse()
        if answer.status != 200 or "text/event-stream" not in answer.getheader("Content-Type", ""):
            raise SystemExit(f"no stream: {answer.status}")
        return answer


def follow(robot, stream, seconds):
    answer = robot.follow(stream, 8)  # A sign of life comes every five seconds.
    end, events, life, name = time.monotonic() + seconds, [], 0, None
    while time.monotonic() < end:
        line = answer.readline()
        if not line:
            return {"events": events, "life": life, "ended": True}
        line = line.decode().rstrip("\n")
        if line.startswith(":"):
            life += line == ": sse-keep-alive"
        elif line.startswith("event: "):
            name = line.removeprefix("event: ")
        elif line.startswith("data: "):
            events.append({"name": name, "data": json.loads(line.removeprefix("data: "))})
    return {"events": events, "life": life, "ended": False}


def crowd(robot, stream, count):
    """Who is sent away gets the end of the stream at once; the others a sign of life after five seconds."""
    followers = [robot.follow(stream, 8) for _ in range(count)]
    left = []
    for number, answer in enumerate(followers):
        while line := answer.readline():
            if line == b": sse-keep-alive\n":
                break
        else:
            left.append(number)
    return {"left": left}


def drive(robot, velocity, angle, seconds):
    seat = robot.connect()
    enabled = robot.put("HighResolutionManualControlCapability", {"action": "enable"}, seat)
    codes, last = [], ""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        move = {"action": "move", "vector": {"velocity": velocity, "angle": angle}}
        told = robot.put("HighResolutionManualControlCapability", move, seat)
        codes.append(told["code"])
        last = told["text"]
        time.sleep(0.1)
    return {"enabled": enabled, "codes": codes, "last": last}


def main(address, user, password, verb, *words):
    robot = Robot(address, user, password)
    if verb == "read":
        told = {path: robot.read(path) for path in words}
    elif verb == "put":
        told = robot.put(words[0], json.loads(words[1]))
    elif verb == "follow":
        told = follow(robot, words[0], float(words[1]))
    elif verb == "crowd":
        told = crowd(robot, words[0], int(words[1]))
    else:
        told = drive(robot, *map(float, words))
    print(json.dumps(told))


main(*sys.argv[1:])
