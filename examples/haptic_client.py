#!/usr/bin/env python3
"""A device for `calot haptics --device network`, or `calot view --haptics network`: the smallest program that speaks its protocol.

It pretends to be hardware: a hand that goes down by 14 mm and comes up again, and prints what it feels. To connect a real device, replace
`hand()` by reading yours and `feel()` by commanding its motors. docs/haptics.md describes the packets.

    calot haptics --device network --seconds 12 &
    python3 examples/haptic_client.py
"""
import argparse
import math
import socket
import struct
import sys
import time
import zlib

MAGIC, VERSION = 0x48544C43, 1
HELLO, WELCOME, HAND, FORCE, BYE = 1, 2, 3, 4, 5
TIMEOUT_S = 0.02  # without a force for so long, the motors must be off
FAULTS = ["none", "nobody connected", "disconnected", "device error", "motors warm", "not calibrated", "not a number", "simulation late"]


def packet(kind, session, sequence, content=b""):
    body = struct.pack("<IHHII", MAGIC, VERSION, kind, session, sequence & 0xFFFFFFFF) + content
    return body + struct.pack("<I", zlib.crc32(body))


def parse(data):
    """(kind, session, sequence, content), or None for what is not a good packet."""
    if len(data) < 20 or struct.unpack("<I", data[-4:])[0] != zlib.crc32(data[:-4]):
        return None
    magic, version, kind, session, sequence = struct.unpack("<IHHII", data[:16])
    return (kind, session, sequence, data[16:-4]) if (magic, version) == (MAGIC, VERSION) else None


class Calot:
    def __init__(self, host, port, name):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.connect((host, port))
        self.sequence = 0
        self.session = 0
        self.name = name

    def connect(self, patience_s=10.0):
        workspace = (-0.08, -0.06, -0.035, 0.08, 0.06, 0.035)
        content = struct.pack("<8d32s", 3.3, 0.05, *workspace, self.name.encode()[:31])
        until = time.monotonic() + patience_s
        while time.monotonic() < until:
            self.sequence += 1
            try:
                self.socket.send(packet(HELLO, 0, self.sequence, content))
                self.socket.settimeout(0.2)
                good = parse(self.socket.recv(256))
            except (TimeoutError, socket.timeout, ConnectionRefusedError):
                time.sleep(0.05)
                continue
            if good and good[0] == WELCOME:
                max_force_n, _, answer = struct.unpack("<ddI", good[3])
                if answer:
                    sys.exit({1: "Calot is busy with another client", 2: "Calot speaks another version"}.get(answer, "refused"))
                self.session = good[1]
                return max_force_n
        sys.exit("Calot does not answer: is it running with the network device?")

    def exchange(self, position_m, velocity_m_per_s, buttons=0, orientation=(1.0, 0.0, 0.0, 0.0)):
        """Sends the hand; returns (force, fault). The force is zero when no answer comes in time."""
        self.sequence += 1
        content = struct.pack("<10d2I", *position_m, *orientation, *velocity_m_per_s, buttons, 1)
        self.socket.send(packet(HAND, self.session, self.sequence, content))
        until = time.monotonic() + TIMEOUT_S
        while (left := until - time.monotonic()) > 0:
            self.socket.settimeout(left)
            try:
                good = parse(self.socket.recv(256))
            except (TimeoutError, socket.timeout):
                break
            if good and good[1] == self.session and good[0] == BYE:
                raise EOFError
            if good and good[1] == self.session and good[0] == FORCE:
                fx, fy, fz, answers, fault = struct.unpack("<3d2I", good[3])
                if answers == self.sequence:
                    return (fx, fy, fz), fault
        return (0.0, 0.0, 0.0), 3

    def close(self):
        self.sequence += 1
        self.socket.send(packet(BYE, self.session, self.sequence))


def hand(seconds, length):
    """Where the hand is: down by 14 mm and up again. Replace by your device."""
    depth, speed = 0.014, 2 * math.pi / length
    return (0.0, -depth * 0.5 * (1 - math.cos(speed * seconds)), 0.0), (0.0, -depth * 0.5 * speed * math.sin(speed * seconds), 0.0)


def feel(force_n):
    """Commands the motors. Replace by your device."""


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--host", default="127.0.0.1")
    arguments.add_argument("--port", type=int, default=5460)
    arguments.add_argument("--seconds", type=float, default=6.0)
    arguments.add_argument("--rate", type=float, default=1000.0, help="exchanges a second")
    options = arguments.parse_args()

    calot = Calot(options.host, options.port, "example client")
    print(f"connected; at most {calot.connect():.1f} N")
    start = time.monotonic()
    exchanges, greatest, shown = 0, 0.0, -1.0
    try:
        while (now := time.monotonic() - start) < options.seconds:
            position, velocity = hand(now, options.seconds)
            force, fault = calot.exchange(position, velocity)
            feel(force)
            exchanges += 1
            greatest = max(greatest, math.hypot(*force))
            if now - shown > 0.5:
                print(f"{now:5.1f} s  {1e3 * position[1]:7.2f} mm  {force[1]:6.3f} N  {FAULTS[fault]}")
                shown = now
            time.sleep(max(0.0, start + exchanges / options.rate - time.monotonic()))
    except EOFError:
        print("Calot said goodbye")
    feel((0.0, 0.0, 0.0))
    calot.close()
    print(f"{exchanges} exchanges, greatest force {greatest:.3f} N")


if __name__ == "__main__":
    main()
