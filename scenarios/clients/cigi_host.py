#!/usr/bin/env python3
"""A host of CIGI 3.3: flies one entity along a line or a circle, with a view on it, and waits for the image generator's Start of Frame.

Each message is one datagram: IG Control, Entity Control, View Control (and View Definition in the first). In lockstep, the next is sent when
the Start of Frame that names the last one has arrived, not before 1 / rate has passed. Standard library only.
"""
import argparse
import math
import socket
import statistics
import struct
import sys
import time

# WGS 84.
EQUATOR_M, FLATTENING = 6378137.0, 1 / 298.257223563
GRAVITY_M_S2 = 9.80665
MODES = ["standby", "operate", "debug", "maintenance"]


# Packets: CIGI 3.3 (TST08I016), chapter 4. `order` is '<' or '>': a host writes its own byte order, and the magic number 0x8000 tells which.

def ig_control(order, frame, timestamp_10us, last_ig_frame, mode):
    flags = 3 << 4 | 1 << 2 | mode  # minor version, timestamp valid
    return struct.pack(order + "BBBbBBHIIII", 1, 24, 3, 0, flags, 0, 0x8000, frame, timestamp_10us, last_ig_frame, 0)


def entity_control(order, entity, position, roll, pitch, yaw, parent=None, state=1, alpha=255, kind=0):
    """Position: latitude, longitude [deg], height [m]; of an attached one x forward, y right, z down [m]. Angles in degrees."""
    flags = state | (0 if parent is None else 1 << 2)
    return struct.pack(order + "BBHBBBBHHfffddd", 2, 48, entity, flags, 0, alpha, 0, kind, parent or 0, roll, pitch, yaw, *position)


def component_control(order, component, instance, component_class, state, words):
    """Six words, or two in a short one."""
    number, size = (4, 32) if len(words) == 6 else (5, 16)
    return struct.pack(f"{order}BBHHBB{len(words)}I", number, size, component, instance, component_class, state, *words)


def part_control(order, entity, part, offsets, angles):
    """Offsets x, y, z [m] and angles roll, pitch, yaw [deg]; None: as before."""
    six = list(offsets) + list(angles)
    flags = 1 | sum(2 << i for i, value in enumerate(six) if value is not None)
    return struct.pack(order + "BBHBBH6f", 6, 32, entity, part, flags, 0, *[value or 0 for value in six])


def short_part_control(order, entity, first, second):
    """Each: part, degree of freedom (1 x, 2 y, 3 z, 4 yaw, 5 pitch, 6 roll), value [m or deg]."""
    flags = first[1] | second[1] << 3 | 0xC0
    return struct.pack(order + "BBHBBBBff", 7, 16, entity, first[0], second[0], flags, 0, first[2], second[2])


def rate_control(order, entity, linear, angular, part=None, own_axes=False):
    flags = (0 if part is None else 1) | (2 if own_axes else 0)
    return struct.pack(order + "BBHBBH6f", 8, 32, entity, part or 0, flags, 0, *linear, *angular)


def view_control(order, view, entity, offset, angles, group=0):
    """Offset x forward, y right, z down [m]; angles roll, pitch, yaw [deg]; all six enabled."""
    return struct.pack(order + "BBHBBH6f", 16, 32, view, group, 0x3F, entity, *offset, *angles)


def sensor_control(order, view, sensor, gain, level, black_hot=False, noise=0.0):
    return struct.pack(order + "BBHBBBB4f", 17, 24, view, sensor, 1 | (2 if black_hot else 0), 0, 0, gain, level, 0.0, noise)


def view_definition(order, view, wide, high, group=0):
    """Full angles of a symmetric view [deg]; near and far planes are left as they are."""
    return struct.pack(order + "BBHBBBB6f", 21, 32, view, group, 0x3C, 0, 0, 0, 0, -wide / 2, wide / 2, high / 2, -high / 2)


def read_start_of_frame(datagram):
    """Its fields; None where the datagram does not begin with one."""
    if len(datagram) < 24 or datagram[0] != 101 or datagram[1] != 24 or datagram[2] != 3:
        return None
    order = {b"\x80\x00": ">", b"\x00\x80": "<"}.get(bytes(datagram[6:8]))
    if order is None:
        return None
    database, status, flags = struct.unpack_from(order + "bBB", datagram, 3)
    ig_frame, timestamp_10us, host_frame = struct.unpack_from(order + "III", datagram, 8)
    return {"ig_frame": ig_frame, "host_frame": host_frame, "mode": MODES[flags & 3], "status": status, "database": database,
            "timestamp_s": timestamp_10us * 1e-5 if flags & 4 else None, "version": f"3.{flags >> 4}"}


# The path.

def moved(position, east_m, north_m):
    """So far away over the ellipsoid: good to a part in 1000 within 100 km, away from the poles."""
    latitude, longitude, height = position
    e2, sine = FLATTENING * (2 - FLATTENING), math.sin(math.radians(latitude))
    across = EQUATOR_M / math.sqrt(1 - e2 * sine * sine)
    along = across * (1 - e2) / (1 - e2 * sine * sine)
    return (latitude + math.degrees(north_m / (along + height)),
            longitude + math.degrees(east_m / ((across + height) * math.cos(math.radians(latitude)))), height)


def place(args, t):
    """Position and roll, pitch, yaw [deg] at a time [s]."""
    start = (args.latitude, args.longitude, args.height)
    if args.path == "line":
        heading, way = math.radians(args.heading), args.speed * t
        return moved(start, way * math.sin(heading), way * math.cos(heading)), (0.0, 0.0, args.heading % 360)
    # Clockwise around the place, banked as in a turn without slip.
    around = args.heading - 90 + math.degrees(args.speed * t / args.radius)
    bank = math.degrees(math.atan(args.speed**2 / (GRAVITY_M_S2 * args.radius)))
    place_on = moved(start, args.radius * math.sin(math.radians(around)), args.radius * math.cos(math.radians(around)))
    return place_on, (bank, 0.0, (around + 90) % 360)


def message(args, frame, t, last_ig_frame):
    order = ">" if args.big_endian else "<"
    position, angles = place(args, t)
    packets = [ig_control(order, frame & 0xFFFFFFFF, int(round(t * 1e5)) & 0xFFFFFFFF, last_ig_frame, MODES.index(args.mode)),
               entity_control(order, args.entity, position, *angles, kind=args.type)]
    if frame == args.first_frame and args.field_of_view:
        packets.append(view_definition(order, args.view, *args.field_of_view))
    packets.append(view_control(order, args.view, args.entity, args.view_offset, args.view_angles))
    if frame == args.first_frame and args.one_of_each:
        packets += [entity_control(order, args.entity + 1, (10.5, 2.25, -1.5), 10, -20, 30, parent=args.entity, alpha=128),
                    component_control(order, 3, args.entity, 0, 1, [1, 2, 3, 4, 5, 6]),
                    component_control(order, 4, args.view, 3, 2, [7, 8]),
                    part_control(order, args.entity, 2, (0.5, None, -0.25), (None, 15, -45)),
                    short_part_control(order, args.entity, (3, 4, 60.0), (4, 1, 0.75)),
                    rate_control(order, args.entity, (args.speed, 0, 0), (0, 0, 1.5), own_axes=True),
                    sensor_control(order, args.view, 1, 0.75, 0.5, black_hot=True, noise=0.125)]
    return b"".join(packets)


# What is written of it.

class Pcap:
    """Datagrams as Wireshark reads them: tshark -r FILE -d udp.port==PORT,cigi -V."""

    def __init__(self, path):
        self.file = open(path, "wb")
        self.file.write(struct.pack("<IHHiIII", 0xA1B2C3D4, 2, 4, 0, 0, 65535, 228))  # IPv4 packets without link layer

    def add(self, seconds, source, target, payload):
        udp = struct.pack(">HHHH", source[1], target[1], 8 + len(payload), 0) + payload
        head = struct.pack(">BBHHHBBH4s4s", 0x45, 0, 20 + len(udp), 0, 0, 64, 17, 0, socket.inet_aton(source[0]), socket.inet_aton(target[0]))
        total = sum(struct.unpack(">10H", head))
        total = (total & 0xFFFF) + (total >> 16)
        total = (total & 0xFFFF) + (total >> 16)
        packet = head[:10] + struct.pack(">H", ~total & 0xFFFF) + head[12:] + udp
        self.file.write(struct.pack("<IIII", int(seconds), int(seconds % 1 * 1e6), len(packet), len(packet)) + packet)
        self.file.flush()


def wait_for(link, frame, deadline, record):
    """The Start of Frame that names this message; None when the time is over. Earlier ones and other datagrams are passed over."""
    while True:
        left = deadline - time.monotonic()
        if left <= 0:
            return None
        link.settimeout(left)
        try:
            datagram, sender = link.recvfrom(65536)
        except socket.timeout:
            return None
        except ConnectionRefusedError:  # nobody listens there (yet)
            time.sleep(min(0.05, max(0.0, deadline - time.monotonic())))
            continue
        record(sender, datagram)
        answer = read_start_of_frame(datagram)
        if answer is None:
            print(f"{len(datagram)} bytes from {sender[0]}:{sender[1]} are no Start of Frame of CIGI 3", file=sys.stderr)
        elif answer["host_frame"] == frame & 0xFFFFFFFF:
            return answer


def run(args):
    pcap = Pcap(args.pcap) if args.pcap else None
    hex_file = open(args.hex, "w", encoding="ascii") if args.hex else None
    link, target, own = None, ("127.0.0.1", 8004), ("127.0.0.1", args.listen or 8005)
    if args.target:
        target = (socket.gethostbyname(args.target[0]), args.target[1])
        link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        link.bind(("", args.listen))
        own = ("127.0.0.1", link.getsockname()[1])

    answers, round_trips_s, missed, last_ig_frame = 0, [], 0, 0
    begin = next_at = time.monotonic()
    for frame in range(args.first_frame, args.first_frame + args.frames):
        t = (frame - args.first_frame) / args.rate
        data = message(args, frame, t, last_ig_frame)
        if hex_file:
            hex_file.write(data.hex() + "\n")
        if pcap:
            pcap.add(t, own, target, data)
        if not link:
            continue
        time.sleep(max(0.0, next_at - time.monotonic()))
        next_at = max(next_at + 1 / args.rate, time.monotonic())
        sent = time.monotonic()
        link.sendto(data, target)
        answer = wait_for(link, frame, sent + args.timeout, lambda sender, d: pcap and pcap.add(time.monotonic() - begin, sender, own, d))
        if answer is None:
            missed += 1
            print(f"host frame {frame}: no Start of Frame within {args.timeout:g} s", file=sys.stderr)
            if missed >= args.attempts:
                print(f"{missed} in a row: given up", file=sys.stderr)
                break
            continue
        missed, answers, last_ig_frame = 0, answers + 1, answer["ig_frame"]
        round_trips_s.append(time.monotonic() - sent)
        if not args.quiet:
            stamp = "" if answer["timestamp_s"] is None else f", began at {answer['timestamp_s']:.5f} s"
            print(f"host frame {frame}: IG frame {answer['ig_frame']}, {answer['mode']}, status {answer['status']}{stamp}, "
                  f"round trip {1e3 * round_trips_s[-1]:.3f} ms", flush=True)
    if not link:
        return 0
    if round_trips_s:
        trips = [1e3 * s for s in (min(round_trips_s), statistics.median(round_trips_s), max(round_trips_s))]
        print(f"{answers} of {args.frames} frames answered; round trip {trips[0]:.3f} to {trips[2]:.3f} ms, median {trips[1]:.3f} ms")
    return 0 if answers == args.frames else 1


def address(text):
    host, colon, port = text.rpartition(":")
    if not colon or not host or not port.isdigit() or not 0 < int(port) < 65536:
        raise argparse.ArgumentTypeError(f"'{text}' is not HOST:PORT")
    return host, int(port)


def number(least, most, whole=False):
    def read(text):
        try:
            value = int(text) if whole else float(text)
        except ValueError:
            raise argparse.ArgumentTypeError(f"'{text}' is no {'whole ' if whole else ''}number") from None
        if not least <= value <= most:
            raise argparse.ArgumentTypeError(f"{text} is outside of {least:g} to {most:g}")
        return value
    return read


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter,
                                     epilog="Status: 0 where every message was answered, 1 where one was not, 2 for wrong arguments.\n"
                                            "Example: cigi_host.py localhost:8004 --path circle --speed 120 --radius 2000 --frames 600")
    add = parser.add_argument
    add("target", nargs="?", type=address, metavar="HOST:PORT", help="the image generator; without it nothing is sent: see --hex and --pcap")
    add("--rate", type=number(0.01, 10000), default=60.0, help="messages a second at most; a message's time is its number over this (default 60)")
    add("--frames", type=number(1, 10**9, True), default=60, help="messages in all (default 60)")
    add("--first-frame", type=number(0, 2**32 - 1, True), default=1, help="host frame number of the first (default 1)")
    add("--timeout", type=number(0.001, 3600), default=2.0, help="wait so long for a Start of Frame [s] (default 2)")
    add("--attempts", type=number(1, 10**6, True), default=5, help="give up after so many messages in a row without answer (default 5)")
    add("--listen", type=number(0, 65535, True), default=0, metavar="PORT", help="own port, to which the answers come (default: any free one)")
    add("--mode", choices=MODES[:3], default="operate", help="of the image generator (default operate)")
    add("--path", choices=["line", "circle"], default="line", help="along the heading, or clockwise around the place (default line)")
    add("--latitude", type=number(-89, 89), default=47.0, help="of the line's start or the circle's centre [deg] (default 47)")
    add("--longitude", type=number(-180, 180), default=8.0, help="the same [deg] (default 8)")
    add("--height", type=number(-20000, 1e8), default=1000.0, help="above the ellipsoid [m] (default 1000)")
    add("--heading", type=number(-360, 360), default=90.0, help="at the beginning, clockwise from north [deg] (default 90)")
    add("--speed", type=number(0, 1e5), default=100.0, help="[m/s] (default 100)")
    add("--radius", type=number(1, 1e6), default=1000.0, help="of the circle [m] (default 1000)")
    add("--entity", type=number(0, 65534, True), default=1, help="number of what flies (default 1)")
    add("--type", type=number(0, 65535, True), default=0, help="its entity type (default 0)")
    add("--view", type=number(0, 65535, True), default=1, help="number of the view on it (default 1)")
    add("--view-offset", type=float, nargs=3, default=[0, 0, 0], metavar=("X", "Y", "Z"), help="of the view: forward, right, down [m] (default 0 0 0)")
    add("--view-angles", type=number(-360, 360), nargs=3, default=[0, 0, 0], metavar=("ROLL", "PITCH", "YAW"), help="of the view [deg] (default 0 0 0)")
    add("--field-of-view", type=number(0.001, 179), nargs=2, metavar=("WIDE", "HIGH"), help="full angles [deg], by a View Definition in the first message")
    add("--one-of-each", action="store_true", help="the first message also has one of each other packet that pitviper reads: for tests")
    add("--big-endian", action="store_true", help="write as a big-endian host does")
    add("--hex", metavar="FILE", help="also write each message as a line of hexadecimal digits")
    add("--pcap", metavar="FILE", help="also write messages and answers for Wireshark")
    add("--quiet", action="store_true", help="print the sum only, not each frame")
    args = parser.parse_args()
    if not args.target and not args.hex and not args.pcap:
        parser.error("a target HOST:PORT, --hex or --pcap is needed")
    return args


if __name__ == "__main__":
    try:
        sys.exit(run(arguments()))
    except KeyboardInterrupt:
        sys.exit(1)
    except OSError as error:
        sys.exit(f"cigi_host: {error}")
