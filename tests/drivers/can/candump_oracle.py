# SPDX-License-Identifier: Apache-2.0
# Reads a candump log and writes it again, both by python3-can.
import sys

import can

with can.CanutilsLogWriter(sys.argv[2], channel="can0") as writer:
    for message in can.CanutilsLogReader(sys.argv[1]):
        writer.on_message_received(message)
