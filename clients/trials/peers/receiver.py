#!/usr/bin/env python3
"""Takes requests and writes each as a line of JSON: receiver.py PORT FILE. Reads mails and calendars: receiver.py mail|calendar FILE"""
import base64
import email
import email.policy
import http.server
import json
import sys


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


if sys.argv[1] in ("mail", "calendar"):
    print(json.dumps(globals()[sys.argv[1]](sys.argv[2])))
else:
    http.server.HTTPServer(("127.0.0.1", int(sys.argv[1])), Receiver).serve_forever()
