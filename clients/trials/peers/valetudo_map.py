#!/usr/bin/env python3
"""Draws a map with the package valetudo-map-parser, as MQTT Vacuum Camera does for Home Assistant: valetudo_map.py MAP.json PICTURE.png
X,Y... Prints what was drawn as one JSON object: where the picture lies in the map, the rooms, the middle of the robot, and the colour at
each place, in centimetres of the map."""
import asyncio
import json
import sys

from valetudo_map_parser import CameraSharedManager
from valetudo_map_parser.config.colors import ColorsManagement
from valetudo_map_parser.hypfer_handler import HypferMapImageHandler

ROBOT = (255, 255, 204)  # of the package's own palette


async def draw(path, picture, places):
    with open(path, encoding="utf-8") as file:
        told = json.load(file)
    shared = CameraSharedManager("robo", {"robot_size": 15, "margins": "0"}).get_instance()
    ColorsManagement(shared).set_initial_colours({"alpha_robot": 255.0})
    image, _ = await HypferMapImageHandler(shared).async_get_image(told)
    image.save(picture)
    first = shared.attr_calibration_points[0]
    left, top = (first["vacuum"][axis] - first["map"][axis] for axis in "xy")
    pixels = image.convert("RGB")
    robot = [
        (x + left, y + top)
        for y in range(image.height)
        for x in range(image.width)
        if pixels.getpixel((x, y)) == ROBOT
    ]
    colours = {}
    for place in places:
        x, y = (int(float(part)) for part in place.split(","))
        inside = 0 <= x - left < image.width and 0 <= y - top < image.height
        colours[place] = pixels.getpixel((x - left, y - top)) if inside else None
    return {
        "size": image.size,
        "rooms": {number: room["name"] for number, room in (shared.map_rooms or {}).items()},
        "charger": shared.charger_position,
        "robot": [sum(part) / len(robot) for part in zip(*robot)] if robot else None,
        "colours": colours,
    }


print(json.dumps(asyncio.run(draw(sys.argv[1], sys.argv[2], sys.argv[3:]))))
