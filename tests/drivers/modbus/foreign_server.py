# SPDX-License-Identifier: Apache-2.0
# A foreign Modbus device (pymodbus). Register n of the input registers holds n + 1000, holding registers
# start at 0, every odd discrete input is set; from input register 40 on stand -305419896 and -12.625 in each of the four
# orders of bytes, as pymodbus builds them. Arguments: "tcp PORT" or "rtu DEVICE".
import asyncio
import sys

from pymodbus.constants import Endian
from pymodbus.datastore import ModbusSequentialDataBlock, ModbusServerContext, ModbusSlaveContext
from pymodbus.payload import BinaryPayloadBuilder
from pymodbus.server import StartAsyncSerialServer, StartAsyncTcpServer
from pymodbus.transaction import ModbusRtuFramer

inputs = [n + 1000 for n in range(100)]
for i, (in_word, words) in enumerate((b, w) for b in (Endian.Big, Endian.Little) for w in (Endian.Big, Endian.Little)):
    built = BinaryPayloadBuilder(byteorder=in_word, wordorder=words)
    built.add_32bit_int(-305419896)
    built.add_32bit_float(-12.625)
    inputs[40 + 4 * i : 44 + 4 * i] = built.to_registers()

device = ModbusSlaveContext(
    di=ModbusSequentialDataBlock(0, [n % 2 for n in range(100)]),
    co=ModbusSequentialDataBlock(0, [0] * 100),
    ir=ModbusSequentialDataBlock(0, inputs),
    hr=ModbusSequentialDataBlock(0, [0] * 100),
    zero_mode=True,
)
context = ModbusServerContext(slaves={1: device}, single=False)


async def serve(line, where):
    print("ready", flush=True)
    if line == "tcp":
        await StartAsyncTcpServer(context=context, address=("127.0.0.1", int(where)))
    else:
        await StartAsyncSerialServer(context=context, framer=ModbusRtuFramer, port=where, baudrate=19200, parity="N")


asyncio.run(serve(sys.argv[1], sys.argv[2]))
