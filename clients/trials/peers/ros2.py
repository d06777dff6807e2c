#!/usr/bin/env python3
"""A peer on DDS that shares nothing with the bridge: Cyclone DDS, with types made from the definitions of ROS 2 that rosbags holds.

    ros2.py see DOMAIN SECONDS            what each topic says, and how often
    ros2.py drive DOMAIN V W SECONDS      drives by /cmd_vel, then falls silent: how far, and how soon the robot stood
    ros2.py call DOMAIN SERVICE           calls a service of std_srvs/Trigger

Prints one JSON object."""
import json
import math
import sys
import time
from dataclasses import dataclass
from types import new_class

from cyclonedds.core import Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import IdlStruct, types
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration
from rosbags.typesys import Stores, get_typestore

STORE = get_typestore(Stores.ROS2_JAZZY)
BASES = {"bool": bool, "byte": types.uint8, "string": str,
         **{name: getattr(types, name) for name in
            ("int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64", "float32", "float64")}}
MADE = {}

TOPICS = {"/tf": "tf2_msgs/msg/TFMessage", "/odom": "nav_msgs/msg/Odometry",
          "/pose": "geometry_msgs/msg/PoseWithCovarianceStamped", "/map": "nav_msgs/msg/OccupancyGrid",
          "/plan": "nav_msgs/msg/Path", "/battery_state": "sensor_msgs/msg/BatteryState",
          "/diagnostics": "diagnostic_msgs/msg/DiagnosticArray"}
LATCHED = ("/map", "/pose", "/plan")


def structure(typename, fields):
    """A type of Cyclone DDS with these fields in this order."""
    def body(space):
        space["__annotations__"] = dict(fields)
        space["__module__"] = __name__
    return dataclass(new_class(typename.split("::")[-1], (IdlStruct,), {"typename": typename}, body))


def made(name):
    """The type of a message of ROS 2, by the definition that rosbags has of it."""
    if name not in MADE:
        package, kind, last = name.split("/")
        fields = [(field, kind_of(spec)) for field, spec in STORE.fielddefs[name][1]]
        MADE[name] = structure(f"{package}::{kind}::dds_::{last}_", fields)
    return MADE[name]


def kind_of(spec):
    node, detail = spec[0].name, spec[1]
    if node == "BASE":
        return BASES[detail[0]]
    if node == "NAME":
        return made(detail)
    if node == "ARRAY":
        return types.array[kind_of(detail[0]), detail[1]]
    return types.sequence[kind_of(detail[0])]


def quality(depth, latched=False):
    durability = Policy.Durability.TransientLocal if latched else Policy.Durability.Volatile
    return Qos(Policy.Reliability.Reliable(duration(seconds=1)), durability, Policy.History.KeepLast(depth))


def reader(participant, topic):
    qos = quality(100, topic in LATCHED)
    return DataReader(participant, Topic(participant, "rt" + topic, made(TOPICS[topic]), qos=qos), qos=qos)


def heading(quaternion):
    return 2 * math.atan2(quaternion.z, quaternion.w)


def see(participant, seconds):
    readers = {topic: reader(participant, topic) for topic in TOPICS}
    seen = {topic: [] for topic in TOPICS}
    end = time.monotonic() + float(seconds)
    while time.monotonic() < end:
        for topic, source in readers.items():
            seen[topic] += source.take(N=100)
        time.sleep(0.02)
    return {topic: {"count": len(all_of), **(DIGESTS[topic](all_of[-1]) if all_of else {})}
            for topic, all_of in seen.items()}


def digest_of_odometry(message):
    pose, twist = message.pose.pose, message.twist.twist
    return {"frame": message.header.frame_id, "child": message.child_frame_id, "x": pose.position.x,
            "y": pose.position.y, "heading": heading(pose.orientation), "v": twist.linear.x, "w": twist.angular.z,
            "variances": [message.pose.covariance[at] for at in (0, 7, 35)],
            "age_s": time.time() - message.header.stamp.sec - message.header.stamp.nanosec * 1e-9}


def digest_of_map(message):
    cells = list(message.data)
    return {"frame": message.header.frame_id, "resolution": message.info.resolution, "width": message.info.width,
            "height": message.info.height, "free": cells.count(0), "occupied": cells.count(100),
            "unknown": cells.count(-1), "origin": [message.info.origin.position.x, message.info.origin.position.y]}


DIGESTS = {
    "/tf": lambda message: {"links": [[link.header.frame_id, link.child_frame_id] for link in message.transforms],
                            "x": sum(link.transform.translation.x for link in message.transforms)},
    "/odom": digest_of_odometry,
    "/pose": lambda message: {"frame": message.header.frame_id, "x": message.pose.pose.position.x,
                              "y": message.pose.pose.position.y, "heading": heading(message.pose.pose.orientation)},
    "/map": digest_of_map,
    "/plan": lambda message: {"frame": message.header.frame_id, "corners": len(message.poses)},
    "/battery_state": lambda message: {"percentage": message.percentage, "voltage": message.voltage,
                                       "status": message.power_supply_status, "present": message.present},
    "/diagnostics": lambda message: {"parts": {part.name: [part.level, part.message] for part in message.status}},
}


def drive(participant, forward, turn, seconds):
    odometry = reader(participant, "/odom")
    kind = made("geometry_msgs/msg/Twist")
    vector = made("geometry_msgs/msg/Vector3")
    qos = quality(1)
    writer = DataWriter(participant, Topic(participant, "rt/cmd_vel", kind, qos=qos), qos=qos)
    matched = time.monotonic() + 10
    while not writer.get_matched_subscriptions() and time.monotonic() < matched:
        time.sleep(0.05)
    command = kind(vector(float(forward), 0.0, 0.0), vector(0.0, 0.0, float(turn)))
    way, last, fastest = 0.0, None, 0.0
    begun = time.monotonic()
    said = moved = begun
    while time.monotonic() < begun + float(seconds) + 2:
        now = time.monotonic()
        if now < begun + float(seconds):
            writer.write(command)
            said = now
        for message in odometry.take(N=100):
            place = message.pose.pose.position
            if last is not None:
                way += math.hypot(place.x - last.x, place.y - last.y)
            last = place
            twist = message.twist.twist
            fastest = max(fastest, abs(twist.linear.x))
            if abs(twist.linear.x) > 0.02 or abs(twist.angular.z) > 0.1:
                moved = time.monotonic()
        time.sleep(0.05)
    return {"way_m": way, "fastest_m_per_s": fastest, "stood_after_s": moved - said}


def call(participant, service):
    """As rmw_cyclonedds does it: each request begins with who asks and its number, and the answer repeats them."""
    head = [("guid", types.uint64), ("seq", types.int64)]
    asked = structure("std_srvs::srv::dds_::Trigger_Request_", head + [("empty", types.uint8)])
    told = structure("std_srvs::srv::dds_::Trigger_Response_", head + [("success", bool), ("message", str)])
    qos = quality(10)
    writer = DataWriter(participant, Topic(participant, f"rq/{service}Request", asked, qos=qos), qos=qos)
    answers = DataReader(participant, Topic(participant, f"rr/{service}Reply", told, qos=qos), qos=qos)
    end = time.monotonic() + 15
    while time.monotonic() < end and not (writer.get_matched_subscriptions() and answers.get_matched_publications()):
        time.sleep(0.05)
    # The other side finds its reader of answers a little later.
    time.sleep(0.5)
    me, number = time.time_ns(), 7
    writer.write(asked(me, number, 0))
    while time.monotonic() < end:
        for answer in answers.take(N=10):
            if (answer.guid, answer.seq) == (me, number):
                return {"success": answer.success, "message": answer.message}
        time.sleep(0.02)
    return {"error": "no answer"}


def main():
    work = {"see": see, "drive": drive, "call": call}[sys.argv[1]]
    print(json.dumps(work(DomainParticipant(int(sys.argv[2])), *sys.argv[3:])))


if __name__ == "__main__":
    main()
