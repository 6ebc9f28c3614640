# SPDX-License-Identifier: Apache-2.0
# A foreign client of tappet-gateway, written from the guide's page alone: python3-websockets and the standard library.
#   peer.py SCENARIO ADDRESS [MACHINE] [ARGUMENT...]     ADDRESS: ws://127.0.0.1:8080 or wss://127.0.0.1:8443
# Prints what it saw, a JSON object a line; ends with code 1 and a sentence when the gateway broke the protocol.
import asyncio
import base64
import json
import socket
import ssl
import struct
import sys
import time

import websockets

MAGIC = 0x31465054
HEAD = struct.Struct("<IIIIqqH")
KINDS = ["none", "real", "integer", "natural", "boolean", "text", "duration"]
FLAGS = ["busy", "forced", "stale", "never_written", "unread"]


def fail(what):
    sys.exit("peer: " + what)


def show(**fields):
    print(json.dumps(fields), flush=True)


def frame_of(data):
    """Decodes a binary frame: header and values by index."""
    magic, watch, sequence, lost, machine_ns, age_ns, count = HEAD.unpack_from(data, 0)
    if magic != MAGIC:
        fail("a frame does not begin with TPF1")
    at, values = HEAD.size, {}
    for _ in range(count):
        index, flags, kind, stamp = struct.unpack_from("<HBBq", data, at)
        at += 12
        name = KINDS[kind]
        if name == "none":
            value = None
        elif name == "boolean":
            value, at = data[at] == 1, at + 1
        elif name == "text":
            (length,) = struct.unpack_from("<H", data, at)
            value, at = data[at + 2 : at + 2 + length].decode("utf-8"), at + 2 + length
        else:
            (value,) = struct.unpack_from({"real": "<d", "natural": "<Q"}.get(name, "<q"), data, at)
            at += 8
        values[index] = (value, [each for bit, each in enumerate(FLAGS) if flags >> bit & 1], stamp)
    if at != len(data):
        fail("a frame has bytes behind its values")
    return {"watch": watch, "sequence": sequence, "lost": lost, "machine_ns": machine_ns, "age_ns": age_ns, "values": values}


def tls():
    context = ssl.create_default_context()
    context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
    return context


def connect(address, **options):
    if address.startswith("wss"):
        options["ssl"] = tls()
    options.setdefault("subprotocols", ["tappet.v1"])
    return websockets.connect(address + "/v1", max_queue=None, **options)


class Client:
    def __init__(self, wire):
        self.wire, self.last, self.frames, self.packets = wire, 0, [], []

    async def ask(self, do, **fields):
        self.last += 1
        await self.wire.send(json.dumps({"id": self.last, "do": do, **fields}))
        return await self.answer(self.last)

    async def answer(self, number):
        while True:
            message = await asyncio.wait_for(self.wire.recv(), 10)
            if isinstance(message, bytes):
                self.frames.append(frame_of(message))
                continue
            message = json.loads(message)
            if message["id"] == number and "ok" in message:
                return message
            self.packets.append(message)

    async def next_frame(self):
        while not self.frames:
            message = await asyncio.wait_for(self.wire.recv(), 10)
            if isinstance(message, bytes):
                self.frames.append(frame_of(message))
            else:
                self.packets.append(json.loads(message))
        return self.frames.pop(0)


async def walk(address, machine):
    """What a client does first: machines, facets, a watch, a change, a refusal."""
    async with connect(address) as wire:
        client = Client(wire)
        machines = await client.ask("machines")
        show(machines=[each["name"] for each in machines["machines"] if each["answers"]])
        facets = await client.ask("facets", machine=machine)
        show(components=[each["component"] for each in facets["facets"]])
        name = machine + ".line.speed"
        watch = await client.ask("watch", names=[name, machine + ".wheel.valid"], rate_hz=20)
        show(watch=watch)
        first = await client.next_frame()
        show(speed=first["values"][0][0], kinds=watch["kinds"])
        show(set=await client.ask("request", machine=machine, line="set line.speed 1.25"))
        show(refused=await client.ask("request", machine=machine, line="set line.speed 99"))
        for _ in range(20):
            frame = await client.next_frame()
            if 0 in frame["values"]:
                show(speed=frame["values"][0][0], fresh=frame["age_ns"] < 1e9)
                break
        else:
            fail("the new speed came in no frame")
        ages = [(await client.next_frame())["age_ns"] for _ in range(20)]
        show(oldest_ms=max(ages) / 1e6)


async def login(address, user, password):
    async with connect(address) as wire:
        client = Client(wire)
        show(before=(await client.ask("machines"))["code"])
        reply = await client.ask("login", user=user, password=password)
        show(ok=reply["ok"], role=reply.get("role"), error=reply.get("error"))
        if reply["ok"]:
            show(machines=len((await client.ask("machines"))["machines"]))


async def request(address, user, password, machine, line):
    async with connect(address) as wire:
        client = Client(wire)
        if user != "-" and not (await client.ask("login", user=user, password=password))["ok"]:
            fail("the login failed")
        show(**await client.ask("request", machine=machine, line=line))


async def run(address, *words):
    """A command line of tappet-browse in the gateway: its output, its files, its exit code."""
    async with connect(address) as wire:
        client = Client(wire)
        show(ok=(await client.ask("run", words=list(words)))["ok"])
        out, errors, files = "", "", {}
        while True:
            if client.packets:
                message = client.packets.pop(0)
            else:
                message = json.loads(await asyncio.wait_for(wire.recv(), 10))
            if "exit" in message:
                break
            out, errors = out + message.get("out", ""), errors + message.get("err", "")
            if "file" in message:
                files[message["file"]] = files.get(message["file"], 0) + len(base64.b64decode(message["part"]))
        show(out=out, err=errors, files=files, exit=message["exit"])


async def origin(address, *origins):
    for each in origins:
        try:
            async with connect(address, origin=each):
                show(origin=each, status=101)
        except websockets.InvalidStatusCode as refused:
            show(origin=each, status=refused.status_code)


async def malformed(address):
    """Each on a connection of its own; the gateway must serve the next one."""
    for what in ["not json", '{"id": 1}', "[" * 60000, '{"id": 1, "do": "machines", "x": "' + "y" * 60000 + '"}']:
        async with connect(address) as wire:
            await wire.send(what)
            reply = json.loads(await asyncio.wait_for(wire.recv(), 10))
            show(sent=what[:20], ok=reply["ok"], code=reply["code"])
    for what in ["x" * 70000, b"binary"]:
        async with connect(address) as wire:
            await wire.send(what)
            try:
                await asyncio.wait_for(wire.recv(), 10)
                fail("the connection went on")
            except websockets.ConnectionClosed as closed:
                show(sent=len(what), closed=closed.rcvd.code if closed.rcvd else 1006)


async def many(address, machine, clients, seconds):
    """Clients at 20 Hz, each with an address of its own: every frame is counted."""

    async def one(number):
        async with connect(address, local_addr=("127.0.1.%d" % (number % 250 + 1), 0)) as wire:
            client = Client(wire)
            components = (await client.ask("facets", machine=machine))["facets"]
            names = [machine + "." + each["component"] + "." + facet["name"] for each in components for facet in each["facets"] if facet["has_value"]]
            reply = await client.ask("watch", names=names[:32], rate_hz=20)
            if not reply["ok"]:
                fail(reply["error"])
            end, frames, last = time.monotonic() + seconds, 0, None
            while time.monotonic() < end:
                frame = await client.next_frame()
                if last and frame["sequence"] - last["sequence"] - 1 != frame["lost"] - last["lost"]:
                    fail("a frame was lost uncounted")
                last, frames = frame, frames + 1
            return frames, last["lost"]

    results = await asyncio.gather(*[one(number) for number in range(clients)])
    show(clients=len(results), frames=sum(each[0] for each in results), lost=sum(each[1] for each in results))


async def slow(address, machine):
    """Does not read for a while: frames are lost, counted, and the values come again."""
    host, port = address.split("//")[1].split(":")
    narrow = socket.socket()
    narrow.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    narrow.connect((host, int(port)))
    async with connect(address, sock=narrow, read_limit=1024, max_size=None, ping_interval=None) as wire:
        client = Client(wire)
        components = (await client.ask("facets", machine=machine))["facets"]
        names = [machine + "." + each["component"] + "." + facet["name"] for each in components for facet in each["facets"] if facet["has_value"]]
        for _ in range(16):
            await client.ask("watch", names=names[:256], rate_hz=20)
        time.sleep(8)  # nothing reads meanwhile
        lost, counted = 0, {}
        end = time.monotonic() + 4
        while time.monotonic() < end:
            frame = await client.next_frame()
            before = counted.get(frame["watch"])
            if before and frame["sequence"] - before["sequence"] - 1 != frame["lost"] - before["lost"]:
                fail("a frame was lost uncounted")
            counted[frame["watch"]] = frame
        show(lost=sum(each["lost"] for each in counted.values()), watches=len(counted))


async def life(address, machine):
    """Tells when the machine ends and starts again, until it has."""
    async with connect(address) as wire:
        client = Client(wire)
        show(watch=(await client.ask("watch", names=[machine + ".line.speed"], rate_hz=20))["ok"])
        await client.next_frame()
        show(ready=True)
        ended = False
        while True:
            message = await asyncio.wait_for(wire.recv(), 30)
            if isinstance(message, bytes):
                continue
            message = json.loads(message)
            show(**message)
            if message["id"] == 0 and not message["packet"]["machine"]["answers"]:
                ended = True
            if message["id"] == 0 and ended and message["packet"]["machine"]["answers"]:
                break
        show(again=(await client.ask("watch", names=[machine + ".line.speed"], rate_hz=20))["ok"])


async def flood(address, machine):
    """Changes a value as fast as it can until the gateway dies; then says what was answered."""
    sent, done, wire = 0, 0, None
    try:
        async with connect(address) as wire:
            client = Client(wire)
            show(ready=True)
            while True:
                sent += 1
                reply = await client.ask("request", machine=machine, line="set line.speed %.3f" % (1 + sent % 1000 / 1000))
                done += reply["ok"]
    except (websockets.ConnectionClosed, OSError, asyncio.IncompleteReadError):
        show(sent=sent, done=done)


def raw(address, secret):
    host, port = address.split("//")[1].split(":")
    wire = socket.create_connection((host, int(port)), 20)
    return tls().wrap_socket(wire) if secret else wire


def all_of(wire):
    data = b""
    try:
        while part := wire.recv(65536):
            data += part
    except (ConnectionError, ssl.SSLError, TimeoutError):
        pass
    return data


async def http(address):
    """Broken and huge requests of HTTP: each gets its refusal."""
    secret = address.startswith("wss")
    host = address.split("//")[1].encode()
    cases = {
        "huge header": b"GET / HTTP/1.1\r\nHost: " + host + b"\r\nX: " + b"x" * 20000 + b"\r\n\r\n",
        "huge body": b"POST /login HTTP/1.1\r\nHost: " + host + b"\r\nContent-Length: 100000\r\n\r\n" + b"x" * 100000,
        "nonsense": b"\x00\x01\x02\r\n\r\n",
        "method": b"DELETE / HTTP/1.1\r\nHost: " + host + b"\r\nConnection: close\r\n\r\n",
        "schema": b"GET /v1/schema.json HTTP/1.1\r\nHost: " + host + b"\r\nConnection: close\r\n\r\n",
    }
    for name, data in cases.items():
        wire = raw(address, secret)
        wire.sendall(data)
        answer = all_of(wire)
        show(case=name, status=int(answer.split()[1]) if answer else 0, safe=b"default-src 'self'" in answer)
        if name == "schema":
            schema = json.loads(answer.split(b"\r\n\r\n", 1)[1])
            show(schema=schema["title"][:26])


async def half_open(address):
    """Connections that say nothing, or half of a handshake or a header, are closed in time; others are served meanwhile."""
    secret = address.startswith("wss")
    begun = time.monotonic()
    silent = raw(address, False)
    half = raw(address, False)
    half.sendall(b"\x16\x03\x01\x02\x00\x01\x00" if secret else b"GET / HT")
    dripping = raw(address, secret)
    dripping.sendall(b"GET / HTTP/1.1\r\nX: ")
    async with connect(address) as wire:
        await wire.ping()
    for name, wire in (("silent", silent), ("half", half), ("header", dripping)):
        all_of(wire)
        show(case=name, seconds=round(time.monotonic() - begun))


SCENARIOS = {each.__name__: each for each in (walk, login, request, run, origin, malformed, many, slow, life, flood, http, half_open)}
words = sys.argv[2:]
if sys.argv[1] == "many":
    words[2:] = [int(each) for each in words[2:]]
asyncio.run(SCENARIOS[sys.argv[1]](*words))
