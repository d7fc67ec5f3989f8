# SPDX-License-Identifier: MIT
"""OpenEXR files, as far as frames need it: scan lines, one part or several, uncompressed or ZIP.

After "OpenEXR File Layout" (openexr.com). What is packed otherwise is for programs that link OpenEXR, as `darkroom` does.
"""

import os
import struct
import zlib

import numpy

from ._error import Error, store

_TYPES = {0: numpy.dtype("<u4"), 1: numpy.dtype("<f2"), 2: numpy.dtype("<f4")}
_LINES = {0: 1, 2: 1, 3: 16}  # of a chunk, by compression: none, ZIPS, ZIP
_NAMES = {0: "none", 1: "rle", 2: "zips", 3: "zip", 4: "piz", 5: "pxr24", 6: "b44", 7: "b44a", 8: "dwaa", 9: "dwab"}
_MOST_PIXELS = 1 << 28


class _Reader:
    def __init__(self, path):
        self.path = os.fspath(path)
        try:
            with open(path, "rb") as file:
                self.data = file.read()
        except OSError as error:
            raise Error(f"{self.path}: {error.strerror}") from None
        self.at = 0

    def refuse(self, text):
        raise Error(f"{self.path}: {text}")

    def take(self, count):
        if count < 0 or self.at + count > len(self.data):
            self.refuse("the file ends too early")
        self.at += count
        return self.data[self.at - count : self.at]

    def unpack(self, form):
        return struct.unpack("<" + form, self.take(struct.calcsize("<" + form)))

    def word(self):
        end = self.data.find(b"\0", self.at)
        if end < 0 or end - self.at > 255:
            self.refuse("a name has no end")
        out = self.data[self.at : end].decode("utf-8", "replace")
        self.at = end + 1
        return out

    def header(self):
        """Attributes by name: (type, bytes); of channels their list. None: there is no further part."""
        out = {}
        while name := self.word():
            kind = self.word()
            (size,) = self.unpack("i")
            out[name] = (kind, self.take(size))
        return out or None


def _channels(data):
    at, out = 0, []
    while at < len(data) and data[at]:
        end = data.index(b"\0", at)
        kind, _, x, y = struct.unpack_from("<iiii", data, end + 1)
        out.append((data[at:end].decode("utf-8", "replace"), kind, x, y))
        at = end + 17
    return out


def _unzipped(packed, size, refuse):
    if len(packed) == size:
        return packed
    try:
        unpacker = zlib.decompressobj()
        raw = numpy.frombuffer(unpacker.decompress(packed, size), numpy.uint8)
    except zlib.error:
        refuse("a chunk cannot be unpacked")
    if raw.size != size:
        refuse("a chunk has another size than its lines")
    # Undo the predictor, then put the two halves together.
    raw = (numpy.cumsum(raw.astype(numpy.int64)) - 128 * numpy.arange(size)).astype(numpy.uint8)
    out = numpy.empty_like(raw)
    half = (size + 1) // 2
    out[0::2], out[1::2] = raw[:half], raw[half:]
    return out.tobytes()


class _Part:
    def __init__(self, header, refuse):
        self.attributes = header
        for name in ("channels", "compression", "dataWindow"):
            if name not in header:
                refuse(f"no attribute '{name}'")
        self.channels = _channels(header["channels"][1])
        self.compression = header["compression"][1][0]
        if self.compression not in _LINES:
            packed = _NAMES.get(self.compression, self.compression)
            refuse(f"packed by {packed}: allowed is none, zips or zip (darkroom develop --compression zip packs anew)")
        left, top, right, bottom = struct.unpack("<4i", header["dataWindow"][1])
        self.top, self.width, self.height = top, right - left + 1, bottom - top + 1
        if self.width < 1 or self.height < 1 or self.width * self.height > _MOST_PIXELS:
            refuse(f"{self.width}x{self.height} pixels: allowed are 1 to {_MOST_PIXELS}")
        for name, kind, x, y in self.channels:
            if kind not in _TYPES or x != 1 or y != 1:
                refuse(f"channel {name}: allowed are samples of every pixel")
        self.planes = {
            name: numpy.zeros((self.height, self.width), _TYPES[kind]) for name, kind, _, _ in self.channels
        }

    def chunks(self):
        return -(-self.height // _LINES[self.compression])

    def put(self, line, packed, refuse):
        first = line - self.top
        count = min(_LINES[self.compression], self.height - first)
        if first < 0 or count < 1:
            refuse(f"line {line} lies outside of the picture")
        row = sum(_TYPES[kind].itemsize for _, kind, _, _ in self.channels) * self.width
        data = _unzipped(packed, row * count, refuse) if self.compression else packed
        if len(data) != row * count:
            refuse("a chunk has another size than its lines")
        at = 0
        for y in range(first, first + count):
            for name, kind, _, _ in self.channels:
                size = _TYPES[kind].itemsize * self.width
                self.planes[name][y] = numpy.frombuffer(data, _TYPES[kind], self.width, at)
                at += size


def read(path):
    """The first part that has colour, else the first, and all parts by name: `planes` are the channels, arrays of height x
    width, beside `attributes`."""
    reader = _Reader(path)
    magic, flags = reader.unpack("ii")
    if magic != 20000630:
        reader.refuse("is not an OpenEXR file")
    is_multi_part = bool(flags & 0x1000)
    if flags & 0xA00:
        reader.refuse("tiles or deep data: allowed are scan lines")
    parts = []
    while header := reader.header():
        parts.append(_Part(header, reader.refuse))
        if not is_multi_part:
            break
    if not parts:
        reader.refuse("has no part")
    total = sum(part.chunks() for part in parts)
    reader.take(8 * total)
    for _ in range(total):
        number = reader.unpack("i")[0] if is_multi_part else 0
        line, size = reader.unpack("ii")
        if not 0 <= number < len(parts):
            reader.refuse(f"a chunk is of part {number}: there are {len(parts)}")
        parts[number].put(line, reader.take(size), reader.refuse)
    named = {part.attributes["name"][1].decode("utf-8", "replace"): part for part in parts if "name" in part.attributes}
    return next((part for part in parts if "R" in part.planes), parts[0]), named


def _attribute(name, kind, data):
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(data)) + data


def write(path, channels, attributes=()):
    """Writes channels (arrays of height x width, float16 or float32) by name as one part, packed by ZIP."""
    names = sorted(channels)
    height, width = channels[names[0]].shape
    listed = b"".join(
        name.encode() + b"\0" + struct.pack("<iiii", 1 if channels[name].dtype == numpy.float16 else 2, 0, 1, 1)
        for name in names
    )
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    head = struct.pack("<ii", 20000630, 2) + b"".join(
        [
            _attribute("channels", "chlist", listed + b"\0"),
            _attribute("compression", "compression", b"\3"),
            _attribute("dataWindow", "box2i", window),
            _attribute("displayWindow", "box2i", window),
            _attribute("lineOrder", "lineOrder", b"\0"),
            _attribute("pixelAspectRatio", "float", struct.pack("<f", 1)),
            _attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)),
            _attribute("screenWindowWidth", "float", struct.pack("<f", 1)),
            *(_attribute(*one) for one in attributes),
            b"\0",
        ]
    )
    chunks = []
    for top in range(0, height, 16):
        lines = range(top, min(top + 16, height))
        raw = b"".join(numpy.ascontiguousarray(channels[name][y]).tobytes() for y in lines for name in names)
        halves = numpy.frombuffer(raw, numpy.uint8)
        halves = numpy.concatenate([halves[0::2], halves[1::2]])
        steps = halves.copy()
        steps[1:] = halves[1:] - halves[:-1] + numpy.uint8(128)
        packed = zlib.compress(steps.tobytes(), 4)
        packed = packed if len(packed) < len(raw) else raw
        chunks.append(struct.pack("<ii", top, len(packed)) + packed)
    places, at = [], len(head) + 8 * len(chunks)
    for chunk in chunks:
        places.append(struct.pack("<q", at))
        at += len(chunk)
    store(path, b"".join([head, *places, *chunks]))
