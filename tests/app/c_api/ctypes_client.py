"""Runs a recording through libroomradar.so with ctypes alone, and makes wrong calls.

usage: ctypes_client.py LIBRARY MAP RECORDING
"""
import ctypes
import math
import sys
import threading

D, F, I32, I64, U32, U64, SIZE, P = (
    ctypes.c_double, ctypes.c_float, ctypes.c_int32, ctypes.c_int64, ctypes.c_uint32, ctypes.c_uint64,
    ctypes.c_size_t, ctypes.c_void_p)
OK, INVALID, CLOSED, STRUCT_SIZE, TOO_SMALL, FAILED, END = 0, 1, 2, 3, 4, 5, 7
Pose = D * 16


class Camera(ctypes.Structure):
    _fields_ = [("width", I32), ("height", I32), ("fx", D), ("fy", D), ("cx", D), ("cy", D)]


class Frame(ctypes.Structure):
    _fields_ = [
        ("struct_size", SIZE), ("index", I64), ("stamp_s", D), ("depth_camera", Camera), ("depth_m", P),
        ("colour_camera", Camera), ("colour_rgb", P), ("colour_after_depth_s", D), ("T_colour_depth", Pose),
        ("has_pose", I32), ("T_world_camera", Pose), ("has_gravity", I32), ("down_camera", D * 3),
        ("noise", F * 5), ("depth_readout_s", D), ("colour_readout_s", D), ("colour_delay_s", D)]


class Options(ctypes.Structure):
    _fields_ = [
        ("struct_size", SIZE), ("poses", I32), ("surfaces", I32), ("unknown_is_solid", I32),
        ("has_no_picture", I32), ("watches_changes", I32), ("adopt_after_s", D), ("may_adopt_late", I32),
        ("quality", ctypes.c_char_p)]


class State(ctypes.Structure):
    _fields_ = [
        ("is_in_room", I32), ("is_asleep", I32), ("is_carried", I32), ("is_stuck", I32), ("rests_on", I32),
        ("departures", I32), ("mass_kg", D), ("T_world_object", Pose), ("velocity", D * 3), ("turning", D * 3)]


class Query(ctypes.Structure):
    _fields_ = [("T_world_object", Pose), ("direction", D * 3), ("distance_m", D), ("margin_m", D)]


class Contact(ctypes.Structure):
    _fields_ = [
        ("status", I32), ("kind", I32), ("travel_m", D), ("lower_m", D), ("upper_m", D), ("point", D * 3),
        ("normal", D * 3)]


def sized(struct, **fields):
    return struct(struct_size=ctypes.sizeof(struct), **fields)


library = ctypes.CDLL(sys.argv[1])
library.roomradar_last_error.restype = ctypes.c_char_p
library.roomradar_session_error.restype = ctypes.c_char_p


def check(status, expected=OK):
    if status != expected:
        raise SystemExit(f"status {status}, not {expected}: {library.roomradar_last_error().decode()}")


def opened(function, *arguments):
    handle = P()
    check(getattr(library, function)(*arguments, ctypes.byref(handle)))
    return handle


def run(room, recording):
    """Returns the pot's pose after each frame."""
    source = opened("roomradar_source_open", recording)
    session = opened("roomradar_session_open", room, ctypes.byref(sized(Options, poses=2, has_no_picture=1)))
    check(library.roomradar_session_add_file(session, b"object", b"teapot", D(0.0), None))
    check(library.roomradar_session_drop(session, b"object", None, D(0.3)))
    frame, state, poses = sized(Frame), State(), []
    while (status := library.roomradar_source_next(source, ctypes.byref(frame))) != END:
        check(status)
        check(library.roomradar_session_step(session, ctypes.byref(frame), None))
        check(library.roomradar_session_object(session, b"object", ctypes.byref(state)))
        poses.append(tuple(state.T_world_object))
    query = Query(T_world_object=poses[-1], direction=(0, 0, -1), distance_m=5.0)
    contact = Contact()
    check(library.roomradar_session_query_object(session, b"object", ctypes.byref(query), SIZE(1),
                                                 ctypes.byref(contact)))
    assert contact.status in (3, 4) and contact.kind == 1 and abs(contact.travel_m) < 0.3, contact.travel_m
    query.distance_m = math.nan
    check(library.roomradar_session_query_object(session, b"object", ctypes.byref(query), SIZE(1),
                                                 ctypes.byref(contact)))
    assert contact.status == 0

    # Wrong calls: a status and a sentence each, and nothing changes.
    check(library.roomradar_session_step(session, ctypes.byref(Frame()), None), STRUCT_SIZE)
    check(library.roomradar_session_step(room, ctypes.byref(frame), None), CLOSED)
    check(library.roomradar_session_remove(session, b"nothing"), INVALID)
    assert b"no object named nothing" in library.roomradar_session_error(session)
    check(library.roomradar_session_save(session, b"/tmp/nowhere"), FAILED)
    assert b"watches_changes" in library.roomradar_session_error(session)
    check(library.roomradar_session_close(session))
    check(library.roomradar_session_close(session), CLOSED)
    check(library.roomradar_source_close(source))
    return poses


room = opened("roomradar_map_open", sys.argv[2].encode())
check(library.roomradar_map_open(b"/nowhere", ctypes.byref(P())), FAILED)
assert b"/nowhere" in library.roomradar_last_error()
first = run(room, sys.argv[3].encode())

# Four threads with a session each give the same poses, to the bit.
others = []
threads = [threading.Thread(target=lambda: others.append(run(room, sys.argv[3].encode()))) for _ in range(4)]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
assert len(others) == 4 and all(poses == first for poses in others)
check(library.roomradar_map_close(room))
for index, pose in enumerate(first):
    print("frame", index, "object", *(format(pose[i], ".17g") for i in (3, 7, 11)))
