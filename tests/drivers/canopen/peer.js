// SPDX-License-Identifier: Apache-2.0
// A foreign CANopen device (npm canopen), in step with the test's own time: it takes frames "f ID HEX" and times "t MS" from
// a socket, and answers each time with its own frames and its reports, "r TEXT", up to "d".
//     node peer.js values FILE.eds             the values of the file, as that package reads them
//     node peer.js device FILE.eds ID SOCKET   the device of the file
//     node peer.js client ID SOCKET            reads and writes the device ID by SDO
//     node peer.js bus FILE.eds=ID..           the devices of the files in real time, on a bus of Linux:
//                                              candump -L can0 | node peer.js bus .. | canplayer -t
'use strict';
const fs = require('fs');
const net = require('net');
const os = require('os');
const path = require('path');

const [, , mode, ...rest] = process.argv;

// Its timers run in the test's time, if the test has one.
let now = 0;
const timers = new Set();
class Timer {
    constructor(act, ms, repeats) {
        Object.assign(this, { act, ms: Math.max(1, ms), repeats });
        this.refresh();
    }
    refresh() {
        this.at = now + this.ms;
        timers.add(this);
        return this;
    }
    unref() { return this; }
}
if (mode !== 'bus') {
    global.setTimeout = (act, ms, ...rest) => new Timer(() => act(...rest), ms, false);
    global.setInterval = (act, ms, ...rest) => new Timer(() => act(...rest), ms, true);
    global.clearTimeout = global.clearInterval = (timer) => timers.delete(timer);
}
function advance(to) {
    for (;;) {
        let first = null;
        for (const timer of timers) if (timer.at <= to && (!first || timer.at < first.at)) first = timer;
        if (!first) break;
        now = first.at;
        timers.delete(first);
        if (first.repeats) first.refresh();
        first.act();
    }
    now = to;
}

// Replaces native code for block transfers, which are not used here: the package is installed without a compiler.
const Module = require('module');
const load = Module._load;
Module._load = (name, ...more) => name === 'node-crc'
    ? { crc() { throw new Error('a block transfer'); } }
    : load(name, ...more);
const { Device, Eds } = require('canopen');

/// The package does not know $NODEID: it is replaced beforehand.
function dictionary(file, id) {
    const text = fs.readFileSync(file, 'latin1')
        .replace(/=\$NODEID\+(0x[0-9A-Fa-f]+)/g, (all, number) => '=0x' + (Number(number) + id).toString(16));
    const place = path.join(fs.mkdtempSync(path.join(os.tmpdir(), 'peer')), 'device.eds');
    fs.writeFileSync(place, text, 'latin1');
    const eds = Eds.fromFile(place);
    fs.rmSync(path.dirname(place), { recursive: true });
    return eds;
}

function serve(device, place, tell) {
    const socket = net.connect(place);
    device.on('message', ({ id, data }) => socket.write(`f ${id.toString(16)} ${data.toString('hex')}\n`));
    let rest = '';
    let work = Promise.resolve();
    const settled = async () => {
        for (let i = 0; i < 20; ++i) await new Promise((done) => setImmediate(done));
    };
    async function take(line) {
        const [what, first, second] = line.split(' ');
        if (what === 'f') {
            const data = Buffer.from(second || '', 'hex');
            device.receive({ id: parseInt(first, 16), data, len: data.length });
            await settled();
        } else if (what === 't') {
            advance(Number(first));
            await settled();
            for (const text of tell()) socket.write(`r ${text}\n`);
            socket.write('d\n');
        }
    }
    socket.on('data', (bytes) => {
        const lines = (rest + bytes).split('\n');
        rest = lines.pop();
        for (const line of lines) work = work.then(() => take(line));
    });
    socket.on('close', () => process.exit(0));
}

if (mode === 'values') {
    const eds = dictionary(rest[0], 5);
    const show = (index, sub, entry) => {
        if (entry.dataType === undefined || entry.defaultValue === undefined) return;
        const value = typeof entry.value === 'string' ? entry.value : entry.raw.toString('hex');
        console.log([index, sub, entry.dataType, entry.accessType, value].join('|'));
    };
    for (const [, entry] of eds.entries()) {
        if (entry.subNumber === undefined) show(entry.index, 0, entry);
        else for (let i = 0; i < 255; ++i) if (entry[i]) show(entry.index, i, entry[i]);
    }
} else if (mode === 'device') {
    const id = Number(rest[1]);
    const eds = dictionary(rest[0], id);
    eds.addSdoServerParameter(id, 0x580 + id, 0x600 + id);
    const device = new Device({ eds, id });
    device.start();
    const get = (index) => device.eds.getEntry(index) && device.getValue(index);
    serve(device, rest[2], () => {
        for (const [index, value] of [[0x6041, 0x0231], [0x606C, -1234]]) // a reset clears them
            if (device.eds.getEntry(index) && get(index) !== value) device.setValue(index, value);
        return [`state ${device.state}`, `mapped ${device.eds.getTransmitPdos().map((pdo) => pdo.dataObjects.length)}`,
            `controlword ${get(0x6040)}`, `target ${get(0x60FF)}`];
    });
} else if (mode === 'bus') {
    const devices = rest.map((word) => {
        const [file, id] = [word.slice(0, word.lastIndexOf('=')), Number(word.slice(word.lastIndexOf('=') + 1))];
        const eds = dictionary(file, id);
        eds.addSdoServerParameter(id, 0x580 + id, 0x600 + id);
        const device = new Device({ eds, id });
        device.on('message', ({ id: to, data }) => process.stdout.write(
            `(0.000000) can0 ${to.toString(16).padStart(3, '0')}#${data.toString('hex')}\n`));
        device.start();
        return device;
    });
    let seen = '';
    setInterval(() => {
        const states = devices.map((device) => `${device.id}:${device.state}/${device.getValue(0x1017)}`).join(' ');
        if (states !== seen) console.error(`foreign nodes, state and heartbeat: ${states}`);
        seen = states;
    }, 20);
    require('readline').createInterface({ input: process.stdin }).on('line', (line) => {
        const [, id, hex] = line.match(/ ([0-9A-F]{3})#([0-9A-F]*)$/) || [];
        if (id === undefined) return;
        const data = Buffer.from(hex, 'hex');
        for (const device of devices) device.receive({ id: parseInt(id, 16), data, len: data.length });
    });
} else {
    const id = Number(rest[0]);
    const eds = new Eds();
    eds.addSdoClientParameter(id, 0x600 + id, 0x580 + id);
    eds.addEmcyConsumer(0x80 + id);
    eds.addHeartbeatConsumer(id, 1000);
    const device = new Device({ eds, id: 126 });
    const told = [];
    device.nmt.on('heartbeat', ({ deviceId, state }) => told.push(`heartbeat ${deviceId} ${state}`));
    device.emcy.on('emergency', ({ em }) => told.push(`emergency ${em.code}`));
    device.start();
    const failure = (error) => `abort ${(error.code >>> 0).toString(16)}`;
    async function work() {
        const read = async (index, subIndex, type) =>
            device.sdo.upload({ deviceId: id, index, subIndex, dataType: type }).catch(failure);
        const write = async (index, data, type) =>
            device.sdo.download({ deviceId: id, index, data, dataType: type }).then(() => 'written').catch(failure);
        told.push(`vendor ${await read(0x1018, 1, 0x7)}`);
        told.push(`name ${await read(0x1008, 0, 0x9)}`);
        told.push(`mode ${await write(0x6060, -3, 0x2)} ${await read(0x6060, 0, 0x2)}`);
        told.push(`missing ${await read(0x3000, 0, 0x7)}`);
        told.push(`read-only ${await write(0x6041, 1, 0x6)}`);
        told.push(`too long ${await write(0x6060, 1, 0x7)}`);
        told.push(`too high ${await write(0x6060, 11, 0x2)}`);
        told.push(`beat ${await write(0x1017, 50, 0x6)}`);
    }
    serve(device, rest[1], () => told.splice(0));
    setTimeout(() => work().catch((error) => told.push(`failed ${error}`)), 10);
}
