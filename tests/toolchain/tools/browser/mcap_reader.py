# SPDX-License-Identifier: Apache-2.0
# Reads MCAP by its specification (mcap.dev/spec) with Python's standard library alone, and knows nothing of who wrote it:
# checks what the specification demands, then prints one JSON object a message.
#   mcap_reader.py FILE [--cut]     --cut: the file may end anywhere
import json
import struct
import sys
import zlib

MAGIC = b"\x89MCAP0\r\n"


def fail(what):
    sys.exit("mcap_reader: " + what)


class Fields:
    def __init__(self, data):
        self.data, self.at = data, 0

    def number(self, code):
        size = struct.calcsize("<" + code)
        if self.at + size > len(self.data):
            fail("a record ends within a number")
        (value,) = struct.unpack_from("<" + code, self.data, self.at)
        self.at += size
        return value

    def bytes(self):
        size = self.number("I")
        if self.at + size > len(self.data):
            fail("a record ends within a text")
        value = self.data[self.at : self.at + size]
        self.at += size
        return value

    def text(self):
        return self.bytes().decode("utf-8")

    def map(self):
        inner, found = Fields(self.bytes()), {}
        while inner.at < len(inner.data):
            key = inner.text()
            if key in found:
                fail("a map has the key '%s' twice" % key)
            found[key] = inner.text()
        return found

    def end(self):
        if self.at != len(self.data):
            fail("a record is longer than its fields")


def fits(value, schema):
    names = {bool: "boolean", int: "integer", float: "number", str: "string", list: "array", dict: "object", type(None): "null"}
    wanted = schema["type"] if isinstance(schema["type"], list) else [schema["type"]]
    own = names[type(value)]
    if own not in wanted and not (own == "integer" and "number" in wanted):
        return False
    if own == "array":
        return all(fits(each, schema["items"]) for each in value)
    if own == "object":
        return set(value) == set(schema["properties"]) and all(fits(value[k], s) for k, s in schema["properties"].items())
    return True


def main(name, cut):
    file = open(name, "rb").read()
    if not file.startswith(MAGIC):
        fail("no magic")
    at, schemas, channels, opcodes, in_chunk, times = len(MAGIC), {}, {}, [], 0, (0, 0)
    while at < len(file):
        if file[at:] == MAGIC and opcodes[-1:] == [0x02]:
            break
        if at + 9 > len(file) or at + 9 + struct.unpack_from("<Q", file, at + 1)[0] > len(file):
            if cut:
                break
            fail("ends within a record")
        opcode, (length,) = file[at], struct.unpack_from("<Q", file, at + 1)
        fields = Fields(file[at + 9 : at + 9 + length])
        at += 9 + length
        if not opcodes and opcode != 0x01:
            fail("does not begin with a header")
        if 0x0F in opcodes and opcode == 0x05:
            fail("has a message after the end of its data")
        opcodes.append(opcode)
        if opcode == 0x01:
            fields.text(), fields.text(), fields.end()
        elif opcode == 0x03:
            number, _, encoding, data = fields.number("H"), fields.text(), fields.text(), fields.bytes()
            fields.end()
            if number == 0 or schemas.get(number, json.loads(data)) != json.loads(data) or encoding != "jsonschema":
                fail("schema %d stands twice, otherwise, or is none" % number)
            schemas[number] = json.loads(data)
        elif opcode == 0x04:
            number, schema, topic, encoding = fields.number("H"), fields.number("H"), fields.text(), fields.text()
            fields.map()
            fields.end()
            if schema not in schemas or channels.get(number, (topic, schemas[schema])) != (topic, schemas[schema]) or encoding != "json":
                fail("channel '%s' has no schema before it, or stands twice, otherwise" % topic)
            channels[number] = (topic, schemas[schema])
        elif opcode == 0x05:
            number, sequence, time, sent = fields.number("H"), fields.number("I"), fields.number("Q"), fields.number("Q")
            if number not in channels:
                fail("a message is of no channel")
            if at <= in_chunk and not times[0] <= time <= times[1]:
                fail("a message is of no time of its chunk")
            topic, schema = channels[number]
            message = json.loads(fields.data[fields.at :])
            if not fits(message, schema):
                fail("a message of '%s' is not as its schema says: %s" % (topic, message))
            print(json.dumps({"topic": topic, "sequence": sequence, "time": time, "message": message}))
        elif opcode == 0x06:
            first, last, size, checksum, packed = fields.number("Q"), fields.number("Q"), fields.number("Q"), fields.number("I"), fields.text()
            records = fields.data[fields.at + 8 :]
            if packed or fields.number("Q") != size or size != len(records) or checksum != zlib.crc32(records):
                fail("a chunk is packed, or not as it says itself")
            file = file[:at] + records + file[at:]  # read next, as if they stood there
            in_chunk, times = at + len(records), (first, last)
        elif opcode == 0x0C:
            fields.text(), fields.map(), fields.end()
        elif opcode == 0x0F:
            fields.number("I"), fields.end()
        elif opcode == 0x02:
            fields.number("Q"), fields.number("Q"), fields.number("I"), fields.end()
        else:
            fail("opcode %d, which nobody wrote" % opcode)
    if not cut and opcodes[-2:] != [0x0F, 0x02]:
        fail("does not end with the end of its data and a footer")


main(sys.argv[1], "--cut" in sys.argv)
