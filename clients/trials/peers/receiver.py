#!/usr/bin/env python3
"""Takes requests and writes each as a line of JSON: receiver.py PORT FILE. Reads mails, calendars and maps: receiver.py mail|calendar|card FILE"""
import base64
import email
import email.policy
import http.server
import json
import struct
import sys
import zlib


def picture(data):
    """Whether these bytes are a PNG file, by its first bytes."""
    return data.startswith(b"\x89PNG\r\n\x1a\n")


class Receiver(http.server.BaseHTTPRequestHandler):
    def do_POST(self):
        body = self.rfile.read(int(self.headers["Content-Length"]))
        seen = {"path": self.path, "picture": picture(body), "title": self.headers.get("Title", ""),
                "message": self.headers.get("Message", ""), "priority": self.headers.get("Priority", "")}
        if self.headers.get("Content-Type") == "application/json":
            told = json.loads(body)
            seen["picture"] = picture(base64.b64decode(told.pop("picture_png") or ""))
            seen["told"] = told
        with open(sys.argv[2], "a", encoding="utf-8") as file:
            file.write(json.dumps(seen) + "\n")
        self.send_response(200)
        self.end_headers()

    def log_message(self, *words):
        pass


def mail(path):
    with open(path, "rb") as file:
        message = email.message_from_binary_file(file, policy=email.policy.default)
    parts = {part.get_content_type(): part.get_content() for part in message.walk() if not part.is_multipart()}
    return {"subject": message["Subject"], "to": message["To"], "text": parts["text/plain"],
            "picture": picture(parts.get("image/png", b"")), "defects": [str(defect) for defect in message.defects]}


def calendar(path):
    import icalendar
    with open(path, "rb") as file:
        whole = icalendar.Calendar.from_ical(file.read())
    events = [{"title": str(event["SUMMARY"]), "start": event.decoded("DTSTART").isoformat(),
               "minutes": (event.decoded("DTEND") - event.decoded("DTSTART")).total_seconds() / 60,
               "errors": len(event.errors)} for event in whole.walk("VEVENT")]
    return {"name": str(whole["X-WR-CALNAME"]), "errors": len(whole.errors), "events": events}


def card(path):
    """What a card for Valetudo's maps looks for in such a picture; an error where it is not as they read it."""
    with open(path, "rb") as file:
        rest = file.read()[8:]
    whole = None
    while rest:
        length, kind = struct.unpack(">I4s", rest[:8])
        data, crc = rest[8:8 + length], rest[8 + length:12 + length]
        assert zlib.crc32(kind + data) == struct.unpack(">I", crc)[0], kind
        if kind == b"zTXt" and data.startswith(b"ValetudoMap\0\0"):
            whole = json.loads(zlib.decompress(data[13:]))
        rest = rest[12 + length:]
    assert whole["__class"] == "ValetudoMap" and whole["metaData"]["version"] == 2 and whole["pixelSize"] == 5
    total = 0
    for layer in whole["layers"]:
        assert layer["__class"] == "MapLayer" and layer["pixels"] == [], layer["type"]
        runs = layer["compressedPixels"]
        assert len(runs) % 3 == 0 and runs, layer["type"]
        pixels = [(x + along, y) for x, y, count in zip(runs[::3], runs[1::3], runs[2::3]) for along in range(count)]
        assert pixels == sorted(set(pixels), key=lambda pixel: (pixel[1], pixel[0])), "each pixel once, row by row"
        for axis, side in enumerate("xy"):
            values = [pixel[axis] for pixel in pixels]
            there = layer["dimensions"][side]
            assert (there["min"], there["max"]) == (min(values), max(values)), there
            assert max(values) * 5 < whole["size"][side], there
        assert layer["dimensions"]["pixelCount"] == len(pixels)
        assert layer["metaData"]["area"] == len(pixels) * 25
        total += len(pixels) * 25
    assert whole["metaData"]["totalLayerArea"] == total and whole["metaData"]["nonce"]
    for entity in whole["entities"]:
        assert isinstance(entity["metaData"], dict) and len(entity["points"]) % 2 == 0
        assert all(isinstance(value, int) for value in entity["points"])
    return {"layers": sorted(layer["type"] for layer in whole["layers"]),
            "entities": sorted(entity["type"] for entity in whole["entities"])}


if sys.argv[1] in ("mail", "calendar", "card"):
    print(json.dumps(globals()[sys.argv[1]](sys.argv[2])))
else:
    http.server.HTTPServer(("127.0.0.1", int(sys.argv[1])), Receiver).serve_forever()
