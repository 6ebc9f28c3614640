# SPDX-License-Identifier: Apache-2.0
# A Modbus device that is not ours: 100 holding registers that all read 42, on TCP port 1502.
import asyncio

from pymodbus.datastore import ModbusSequentialDataBlock, ModbusServerContext, ModbusSlaveContext
from pymodbus.server import StartAsyncTcpServer

registers = ModbusSlaveContext(hr=ModbusSequentialDataBlock(0, [42] * 100))
asyncio.run(StartAsyncTcpServer(context=ModbusServerContext(slaves=registers, single=True), address=("127.0.0.1", 1502)))
