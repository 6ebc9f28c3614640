# Answers what canmatrix makes of DBC files and frames: reads orders from standard input, one a line, answers on standard output.
#   file PATH             its messages and signals
#   decode ID EXT HEX     the signals of that frame, raw and physical
#   encode ID EXT NAME=RAW ..   its bytes
import io
import struct
import sys
from contextlib import redirect_stdout

with redirect_stdout(io.StringIO()):
    import canmatrix
    import canmatrix.formats


def real(value):
    return struct.pack(">d", float(value)).hex()


def raw(signal, value):
    return "f" + real(value) if signal.is_float else str(int(value))


def describe(frame):
    senders = ",".join(frame.transmitters)
    # A missing attribute of a message has its default, by position or by name.
    switches = int(frame.is_fd and frame.attribute("CANFD_BRS", db=matrix, default="1") == "1")
    print("frame", frame.arbitration_id.id, int(bool(frame.arbitration_id.extended)), frame.size, frame.name, int(frame.cycle_time), senders,
          int(frame.is_fd), switches, sep="\t")
    for s in frame.signals:
        names = ";".join(f"{value}={name.encode().hex()}" for value, name in s.values.items())
        print("signal", s.name, s.get_startbit(bit_numbering=1), s.size, int(s.is_little_endian), int(s.is_signed), int(bool(s.is_float)),
              real(s.factor), real(s.offset), real(s.min or 0), real(s.max or 0), s.unit.encode().hex(), ",".join(s.receivers), names, sep="\t")


matrix = None
for line in sys.stdin:
    order = line.split()
    if order[0] == "file":
        with redirect_stdout(io.StringIO()) as complaints:
            matrix = canmatrix.formats.loadp_flat(order[1], dbcImportEncoding="cp1252")
        for frame in matrix.frames:
            describe(frame)
        print("end", complaints.getvalue().replace("\n", " "), sep="\t")
        continue
    frame = matrix.frame_by_id(canmatrix.ArbitrationId(int(order[1]), extended=order[2] == "1"))
    if order[0] == "decode":
        found = frame.decode(bytearray.fromhex(order[3] if len(order) > 3 else ""))
        print("decoded", *(f"{name}={raw(v.signal, v.raw_value)};{real(v.phys_value)}" for name, v in sorted(found.items())), sep="\t")
    else:
        values = {}
        for each in order[3:]:
            name, value = each.split("=")
            values[name] = struct.unpack(">d", bytes.fromhex(value[1:]))[0] if value[0] == "f" else int(value)
        try:
            print("encoded", bytes(frame.encode(values)).hex(), sep="\t")
        except canmatrix.canmatrix.EncodingComplexMultiplexed:
            print("encoded", "never", sep="\t")
