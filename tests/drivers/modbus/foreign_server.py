# SPDX-License-Identifier: Apache-2.0
# A Modbus device that is not ours (pymodbus). Register n of the input registers holds n + 1000, holding registers
# start at 0, every odd discrete input is set. Arguments: "tcp PORT" or "rtu DEVICE".
import asyncio
import sys

from pymodbus.datastore import ModbusSequentialDataBlock, ModbusServerContext, ModbusSlaveContext
from pymodbus.server import StartAsyncSerialServer, StartAsyncTcpServer
from pymodbus.transaction import ModbusRtuFramer

device = ModbusSlaveContext(
    di=ModbusSequentialDataBlock(0, [n % 2 for n in range(100)]),
    co=ModbusSequentialDataBlock(0, [0] * 100),
    ir=ModbusSequentialDataBlock(0, [n + 1000 for n in range(100)]),
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
