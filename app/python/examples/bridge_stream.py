#!/usr/bin/python3
"""Turns the JSON lines of a run into poses, masks and contacts for another program, without the module.

usage: roomradar run SOURCE --map MAP --stream - | bridge_stream.py [HOST:PORT]

Messages have the content of ROS's geometry_msgs/PoseStamped, sensor_msgs/Image (mono8) and a list of contacts. Each is a
line of JSON, to standard output or a TCP server; a ROS node replaces bridge() by its publishers.
"""
import base64
import json
import socket
import sys
from typing import Any, Iterator, TextIO


def header(line: dict[str, Any], frame_id: str) -> dict[str, Any]:
    seconds = int(line["stamp_s"])
    return {"seq": line["frame"], "stamp": {"sec": seconds, "nanosec": int((line["stamp_s"] - seconds) * 1e9)},
            "frame_id": frame_id}


def pose(line: dict[str, Any], of: dict[str, Any]) -> dict[str, Any]:
    position, orientation = (dict(zip("xyzw", of[key])) for key in ("position_m", "orientation_xyzw"))
    return {"header": header(line, "map"), "pose": {"position": position, "orientation": orientation}}


def image(line: dict[str, Any], mask: dict[str, Any]) -> dict[str, Any]:
    pixels = bytearray(mask["width_px"] * mask["height_px"])
    for first, length in zip(mask["runs"][::2], mask["runs"][1::2]):
        pixels[first:first + length] = b"\xff" * length
    return {"header": header(line, "camera"), "width": mask["width_px"], "height": mask["height_px"],
            "encoding": "mono8", "step": mask["width_px"], "data": base64.b64encode(pixels).decode()}


def messages(line: dict[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yields topic and content of the messages of a line; see frame-stream.schema.json."""
    if line["type"] != "frame" or line["camera"] is None:
        return
    yield "camera/pose", pose(line, line["camera"])
    if line["moved_mask"] is not None:
        yield "camera/moved_mask", image(line, line["moved_mask"])
    for item in line["objects"]:
        if item["state"] != "outside":
            yield f"objects/{item['name']}/pose", pose(line, item)
            yield f"objects/{item['name']}/contacts", {"header": header(line, "map"), "contacts": item["contacts"]}


def bridge(lines: TextIO, out: TextIO) -> None:
    for text in lines:
        for topic, content in messages(json.loads(text)):
            out.write(json.dumps({"topic": topic, "msg": content}) + "\n")
        out.flush()


if __name__ == "__main__":
    if sys.argv[1:] in (["-h"], ["--help"]):
        print(__doc__)
    elif len(sys.argv) == 1:
        bridge(sys.stdin, sys.stdout)
    else:
        host, port = sys.argv[1].rsplit(":", 1)
        with socket.create_connection((host, int(port))) as server, server.makefile("w") as out:
            bridge(sys.stdin, out)
