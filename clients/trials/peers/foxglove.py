#!/usr/bin/env python3
"""Looks at a server of Foxglove's WebSocket protocol as its app does: reads what is offered, follows all of it, and decodes each message by the
schema that came with its channel: foxglove.py ADDRESS SECONDS. Prints one JSON object."""
import asyncio
import base64
import json
import struct
import sys
import time

from google.protobuf import descriptor_pb2, descriptor_pool, json_format, message_factory
from websockets.asyncio.client import connect

MESSAGE = 1  # first byte of a message's data, before subscription, time and payload


def decoder(channel):
    """What reads a channel's messages, by the schema that it offers."""
    if channel["encoding"] == "json":
        return json.loads
    files = descriptor_pb2.FileDescriptorSet.FromString(base64.b64decode(channel["schema"]))
    pool = descriptor_pool.DescriptorPool()
    for file in files.file:
        pool.Add(file)
    kind = message_factory.GetMessageClass(pool.FindMessageTypeByName(channel["schemaName"]))
    return lambda data: json_format.MessageToDict(kind.FromString(data), preserving_proto_field_name=True)


def digest(value):
    """Long bytes and lists by their length."""
    if isinstance(value, dict):
        return {key: digest(inner) for key, inner in value.items()}
    if isinstance(value, (list, str)) and len(value) > 200:
        return {"length": len(value)}
    return [digest(inner) for inner in value] if isinstance(value, list) else value


async def look(address, seconds):
    seen, readers = {}, {}
    async with connect(address, subprotocols=["foxglove.sdk.v1"], max_size=None) as socket:
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            try:
                said = await asyncio.wait_for(socket.recv(), left)
            except TimeoutError:
                break
            if isinstance(said, bytes):
                if said[0] == MESSAGE:
                    number, _ = struct.unpack_from("<IQ", said, 1)
                    topic, read = readers[number]
                    seen[topic]["count"] += 1
                    seen[topic]["last"] = digest(read(said[13:]))
                continue
            told = json.loads(said)
            if told["op"] == "serverInfo":
                seen["server"] = told["name"]
            if told["op"] == "advertise":
                wanted = []
                for channel in told["channels"]:
                    readers[channel["id"]] = (channel["topic"], decoder(channel))
                    seen[channel["topic"]] = {"schema": channel["schemaName"], "count": 0}
                    wanted.append({"id": channel["id"], "channelId": channel["id"]})
                await socket.send(json.dumps({"op": "subscribe", "subscriptions": wanted}))
    return seen


if __name__ == "__main__":
    print(json.dumps(asyncio.run(look(sys.argv[1], float(sys.argv[2])))))
