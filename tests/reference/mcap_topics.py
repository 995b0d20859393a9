#!/usr/bin/env python3
"""The topics of an MCAP as its makers' own reader has them, as JSON: type, unit, log times [ns], and of each field of its messages the values by their bits.

    PYTHON tests/reference/mcap_topics.py FILE

PYTHON has mcap and mcap-ros2-support (`.ci/install_references`).
"""
import json
import struct
import sys

from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

NAN = 0x7FF8000000000000


def bits(value):
    return NAN if value != value else struct.unpack("<Q", struct.pack("<d", value))[0]


def numbers(message, path=""):
    """Fields of a message that are doubles, with their paths."""
    for name in message.__slots__:
        name = name.removeprefix("_")
        value = getattr(message, name)
        own = f"{path}{name}"
        if isinstance(value, float):
            yield own, value
        elif hasattr(value, "__slots__"):
            yield from numbers(value, f"{own}.")
        elif not isinstance(value, (str, bytes, int)):
            yield from ((f"{own}[{place}]", each) for place, each in enumerate(value) if isinstance(each, float))


topics = {}
factory = DecoderFactory()
decoders = {}
with open(sys.argv[1], "rb") as file:
    reader = make_reader(file, validate_crcs=True)
    assert reader.get_header().profile == "ros2", reader.get_header()
    for schema, channel, message in reader.iter_messages():
        topic = topics.setdefault(channel.topic, {"type": schema.name, "unit": channel.metadata.get("unit"), "times": [], "fields": {}, "messages": []})
        topic["times"].append(message.log_time)
        if channel.message_encoding == "json":
            topic["messages"].append(json.loads(message.data))
            continue
        if channel.id not in decoders:
            decoders[channel.id] = factory.decoder_for(channel.message_encoding, schema)
        decoded = decoders[channel.id](message.data)
        if hasattr(decoded, "header"):
            stamp = decoded.header.stamp
            assert stamp.sec * 10**9 + stamp.nanosec == message.log_time, channel.topic
        topic["names"] = list(getattr(decoded, "name", []))
        for path, value in numbers(decoded):
            topic["fields"].setdefault(path, []).append(bits(value))
json.dump(topics, sys.stdout)
