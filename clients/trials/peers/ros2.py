#!/usr/bin/env python3
"""A peer on DDS that shares nothing with the bridge: Cyclone DDS, with types made from the definitions of ROS 2 that rosbags holds.

    ros2.py see DOMAIN SECONDS            what each topic says, and how often
    ros2.py drive DOMAIN V W SECONDS      drives by /cmd_vel, then falls silent: how far, and how soon the robot stood
    ros2.py call DOMAIN SERVICE           calls a service of std_srvs/Trigger
    ros2.py dock DOMAIN CANCEL_S          sends a goal of nav2_msgs/DockRobot and waits for its result, or cancels it after so long (0 never)

Prints one JSON object."""
import json
import math
import sys
import time
import uuid
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


HEAD = [("guid", types.uint64), ("seq", types.int64)]


class Service:
    """As rmw_cyclonedds does it: each request begins with who asks and its number, and the answer repeats them."""

    def __init__(self, participant, name, kind, fields):
        package, kind_of_file, last = kind.split("/")
        asked, told = ([(field, form) for field, form in part] for part in fields)
        self.asked = structure(f"{package}::{kind_of_file}::dds_::{last}_Request_", HEAD + asked)
        reply = structure(f"{package}::{kind_of_file}::dds_::{last}_Response_", HEAD + told)
        qos = quality(10)
        self.writer = DataWriter(participant, Topic(participant, f"rq/{name}Request", self.asked, qos=qos), qos=qos)
        self.answers = DataReader(participant, Topic(participant, f"rr/{name}Reply", reply, qos=qos), qos=qos)

    def wait(self, seconds=15):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if self.writer.get_matched_subscriptions() and self.answers.get_matched_publications():
                break
            time.sleep(0.05)
        # The other side finds its reader of answers a little later.
        time.sleep(0.5)

    def call(self, *values, seconds=15):
        me, number = time.time_ns(), 7
        self.writer.write(self.asked(me, number, *values))
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            for answer in self.answers.take(N=10):
                if (answer.guid, answer.seq) == (me, number):
                    return answer
            time.sleep(0.02)
        return None


def call(participant, service):
    trigger = Service(participant, service, "std_srvs/srv/Trigger",
                      ([("empty", types.uint8)], [("success", bool), ("message", str)]))
    trigger.wait()
    answer = trigger.call(0)
    if answer is None:
        return {"error": "no answer"}
    return {"success": answer.success, "message": answer.message}


def dock(participant, cancel_s):
    """By the definition of the action in Nav2; how goals are sent is that of rcl_action."""
    identity = types.array[types.uint8, 16]
    stamped = made("geometry_msgs/msg/PoseStamped")
    stamp = made("builtin_interfaces/msg/Time")
    goal = structure("nav2_msgs::action::dds_::DockRobot_Goal_", [
        ("use_dock_id", bool), ("dock_id", str), ("dock_pose", stamped), ("dock_type", str),
        ("max_staging_time", types.float32), ("navigate_to_staging_pose", bool)])
    outcome = structure("nav2_msgs::action::dds_::DockRobot_Result_", [
        ("success", bool), ("error_code", types.uint16), ("num_retries", types.uint16), ("error_msg", str)])
    place = "dock_robot/_action/"
    action = "nav2_msgs/action/DockRobot_"
    send = Service(participant, place + "send_goal", action + "SendGoal",
                   ([("goal_id", identity), ("goal", goal)], [("accepted", bool), ("stamp", stamp)]))
    result = Service(participant, place + "get_result", action + "GetResult",
                     ([("goal_id", identity)], [("status", types.int8), ("result", outcome)]))
    info = structure("action_msgs::msg::dds_::GoalInfo_", [("goal_id", identity), ("stamp", stamp)])
    cancel = Service(participant, place + "cancel_goal", "action_msgs/srv/CancelGoal",
                     ([("goal_info", info)], [("return_code", types.int8), ("goals_canceling", types.sequence[info])]))
    for service in (send, result, cancel):
        service.wait()
    name = list(uuid.uuid4().bytes)
    header = made("std_msgs/msg/Header")(stamp(0, 0), "map")
    vector, turn = made("geometry_msgs/msg/Point"), made("geometry_msgs/msg/Quaternion")
    pose = stamped(header, made("geometry_msgs/msg/Pose")(vector(0.0, 0.0, 0.0), turn(0.0, 0.0, 0.0, 1.0)))
    accepted = send.call(name, goal(True, "home", pose, "", 1000.0, True))
    if accepted is None or not accepted.accepted:
        return {"accepted": False}
    if float(cancel_s) > 0:
        time.sleep(float(cancel_s))
        cancelled = cancel.call(info(name, stamp(0, 0)))
        if cancelled is None:
            return {"error": "the cancel is not answered"}
    ended = result.call(name, seconds=300)
    if ended is None:
        return {"error": "no result"}
    return {"accepted": True, "status": ended.status, "success": ended.result.success,
            "error_code": ended.result.error_code, "error_msg": ended.result.error_msg}


def main():
    work = {"see": see, "drive": drive, "call": call, "dock": dock}[sys.argv[1]]
    print(json.dumps(work(DomainParticipant(int(sys.argv[2])), *sys.argv[3:])))


if __name__ == "__main__":
    main()
