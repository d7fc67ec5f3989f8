#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""readers.py TREE DARKROOM: docs/readers.md, what programs of today make of our pictures and we of theirs. The chart has
twelve colours, whose numbers in a file follow from the standards (BT.2100, IEC 61966-2-1, SMPTE EG 432-1, Radiance). A
program that reads gives them back as light of Rec. 709 in which 1 is white, by its own colour management where it has one.
What it gives is held against what is right, then against known misreadings, in closed form: the first that fits is the
cell. readers.sh brings the programs; ends with 77 where they are not there."""
import http.server
import itertools
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading

try:
    import imagecodecs
    import numpy as np
    import OpenImageIO as oiio
    import PyOpenColorIO as ocio
    import pyvips
    from PIL import ImageCms
except ImportError as error:
    print(f"skipped: {error}; tests/scripts/readers.sh brings what is needed")
    sys.exit(77)
programs = {name: shutil.which(os.environ.get(f"DARKROOM_{name.upper()}", path)) for name, path in (
    ("ffmpeg", "ffmpeg"), ("magick", "/usr/bin/convert"), ("chromium", "chromium"), ("blender_python", "python3"))}
modules = pathlib.Path(os.environ.get("DARKROOM_NODE_MODULES", "none"))
for name, path in [*programs.items(), ("node_modules", modules.is_dir())]:
    if not path:
        print(f"skipped: no {name} here; tests/scripts/readers.sh brings what is needed")
        sys.exit(77)
tree, program = pathlib.Path(sys.argv[1]).resolve(), os.path.abspath(sys.argv[2])

# The chart: 4 x 3 patches of 16 x 16 pixels. One colour is of P3 and not of Rec. 709; two are brighter than white.
columns, rows, side = 4, 3, 16
light = np.array([(0, 0, 0), (.02, .02, .02), (.18, .18, .18), (1, 1, 1), (.8, .1, .05), (.1, .6, .08), (.05, .1, .7),
                  (.6, .4, .3), (-.1, .6, .05), (.5, .5, .02), (2, 1.5, 1), (4, 4, 4)])
alpha = np.array([1, 1, .5, 1, 1, .25, 1, 1, 1, .5, 1, 1])


# Colours and codes, in closed form.
def to_d65(primaries, white):
    """Of light in a gamut its XYZ, whose white is D65 by Bradford's method."""
    def xyz_of(x, y):
        return np.array([x / y, 1, (1 - x - y) / y])
    xyz = np.array([xyz_of(*of) for of in primaries]).T
    cones = np.array([(.8951, .2664, -.1614), (-.7502, 1.7135, .0367), (.0389, -.0685, 1.0296)])
    gain = np.diag(cones @ xyz_of(.3127, .3290) / (cones @ xyz_of(*white)))
    return np.linalg.solve(cones, gain @ cones) @ (xyz * np.linalg.solve(xyz, xyz_of(*white)))


d65, d60 = (.3127, .3290), (.32168, .33767)
gamuts = {"Rec. 709": ([(.64, .33), (.3, .6), (.15, .06)], d65), "P3": ([(.68, .32), (.265, .69), (.15, .06)], d65),
          "Rec. 2020": ([(.708, .292), (.17, .797), (.131, .046)], d65),
          "AP1": ([(.713, .293), (.165, .83), (.128, .044)], d60), "AP0": ([(.7347, .2653), (0, 1), (.0001, -.077)], d60)}
to_rec709 = {name: np.linalg.solve(to_d65(*gamuts["Rec. 709"]), to_d65(*of)) for name, of in gamuts.items()}


def srgb_of(v):
    a = np.abs(v)
    return np.sign(v) * np.where(a <= .0031308, 12.92 * a, 1.055 * np.maximum(a, 1e-9) ** (1 / 2.4) - .055)


def of_srgb(v):
    a = np.abs(v)
    return np.sign(v) * np.where(a <= .04045, a / 12.92, ((a + .055) / 1.055) ** 2.4)


m1, m2, c1, c2, c3 = 2610 / 16384, 2523 / 32, 3424 / 4096, 2413 / 128, 2392 / 128
a_hlg, b_hlg, c_hlg = .17883277, .28466892, .55991073
luminance = np.array([.2627, .678, .0593])


def pq_of(v):
    y = (np.maximum(v, 0) * 203 / 10000) ** m1
    return ((c1 + c2 * y) / (1 + c3 * y)) ** m2


def of_pq(v):
    p = np.clip(v, 0, 1) ** (1 / m2)
    return (np.maximum(p - c1, 0) / (c2 - c3 * p)) ** (1 / m1) * 10000 / 203


def hlg_of(v):  # for a display of 1000 cd/m2, whose system gamma is 1.2
    display = np.maximum(v, 0) * .203
    y = display @ luminance
    e = display * np.where(y > 0, np.maximum(y, 1e-9) ** (1 / 1.2 - 1), 0)[..., None]
    return np.where(e <= 1 / 12, np.sqrt(3 * e), a_hlg * np.log(np.maximum(12 * e - b_hlg, 1e-9)) + c_hlg)


def of_hlg(v):
    e = np.where(v <= .5, v * v / 3, (np.exp((v - c_hlg) / a_hlg) + b_hlg) / 12)
    return e * ((e @ luminance) ** .2)[..., None] / .203


same = lambda v: v
curves = {"sRGB": (srgb_of, of_srgb), "PQ": (pq_of, of_pq), "HLG": (hlg_of, of_hlg), "light": (same, same)}


def radiance(v, more=.5):
    v = np.maximum(v, 0)
    exponent = np.frexp(v.max(-1, keepdims=True))[1]
    return np.where(v.max(-1, keepdims=True) > 0, (np.floor(np.ldexp(v, 8 - exponent)) + more) * 2.0 ** (exponent - 8), 0)


samples = {"8": lambda v: np.round(np.clip(v, 0, 1) * 255) / 255, "16": lambda v: np.round(np.clip(v, 0, 1) * 65535) / 65535,
           "half": lambda v: v.astype(np.float16).astype(float), "float": lambda v: v.astype(np.float32).astype(float),
           "rgbe": radiance}


class File:
    """What a file of the chart says, and what is right to read of it."""

    def __init__(self, kind="8", gamut="Rec. 709", curve="sRGB", loss=0, has_alpha=False, of=light):
        self.kind, self.gamut, self.curve, self.loss, self.has_alpha = kind, gamut, curve, loss, has_alpha
        encode, self.decode = curves[curve]
        inside = np.linalg.solve(to_rec709[gamut], of.T).T
        self.stored = samples[kind](encode(np.maximum(inside, 0) if kind in ("8", "16") else inside))

    def readings(self):
        """What may have been made of it: words, and the light."""
        right = self.decode(self.stored) @ to_rec709[self.gamut].T
        yield "equal", right
        if self.kind == "rgbe":
            yield "half a step darker", radiance(right, 0)
            yield "steps of 1/255", radiance(right, 0) * 256 / 255
        if self.gamut != "Rec. 709":
            yield f"{self.gamut} taken as Rec. 709", self.decode(self.stored)
        if self.curve in ("PQ", "HLG"):
            yield "2.03 times as bright, white being 100 cd/m2", right * 2.03
        if self.curve not in ("sRGB", "light"):
            yield "taken as sRGB", of_srgb(self.stored)
        if self.curve == "light":
            yield "light taken as codes", np.where(self.stored < 0, self.stored / 12.92, of_srgb(self.stored))
        else:
            yield "codes taken as light", self.stored
        if self.has_alpha:
            yield "colours stay multiplied", right * alpha[:, None]
            yield "straight taken as multiplied", self.decode(self.stored / alpha[:, None])

    def judge(self, found, bits):
        """`found`: four numbers a patch, the last alpha, with which the others are not multiplied."""
        def off(a, b):
            return np.abs(srgb_of(a[:, :3]) - srgb_of(b)).max() * 255
        # Codes of 8 bits that are multiplied by alpha on the way lose more than one.
        allowed = max(self.loss, {8: 1.02, 16: .3}[bits], .6 / alpha.min() if self.has_alpha and self.kind == "8" else 0)
        upside_down = found.reshape(rows, columns, 4)[::-1].reshape(-1, 4)
        cuts = {"": same, ", none below 0": lambda v: np.maximum(v, 0), ", none above 1": lambda v: np.minimum(v, 1),
                ", cut to 0 to 1": lambda v: np.clip(v, 0, 1)}
        fits = (text + turned + more for text, expected in self.readings() for more, cut in cuts.items()
                for turned, of in (("", found), (", upside down", upside_down)) if off(of, cut(expected)) <= allowed)
        right = next(self.readings())[1]
        if off(found[2:4], right[2:4]) > allowed:
            differs = f"0.18 is {found[2, 1]:.2g}, white {found[3, 1]:.2g}"
        else:
            worst = np.argmax(np.abs(srgb_of(found[:, :3]) - srgb_of(right)).max(1))
            differs = " is ".join(" ".join(f"{v:.2g}" for v in np.round(of[worst, :3], 3) + 0) for of in (right, found))
        words = next(fits, f"differs: {differs}")
        right_alpha = alpha if self.has_alpha else np.ones(len(alpha))
        if np.abs((upside_down if "upside" in words else found)[:, 3] - right_alpha).max() > .003:
            words += ", without alpha" if np.all(found[:, 3] == 1) else ", alpha differs"
        return words


def patches(pixels):
    """The mean of each patch, away from its edges; red, green, blue, alpha."""
    if pixels.ndim == 2:
        pixels = pixels[..., None]
    if pixels.shape[2] == 1:
        pixels = np.repeat(pixels, 3, axis=2)
    if pixels.shape[2] == 3:
        pixels = np.dstack([pixels, np.ones(pixels.shape[:2])])
    if pixels.shape[:2] != (rows * side, columns * side):
        raise RuntimeError(f"is read as {pixels.shape[1]}x{pixels.shape[0]}")
    tiles = pixels[..., :4].astype(float).reshape(rows, side, columns, side, 4)[:, 4:-4, :, 4:-4]
    return tiles.mean(axis=(1, 3)).reshape(-1, 4)


def chart(has_alpha=False, of=light):
    colors = np.concatenate([of * (alpha[:, None] if has_alpha else 1), (alpha if has_alpha else alpha * 0 + 1)[:, None]], 1)
    return np.kron(colors.reshape(rows, columns, 4), np.ones((side, side, 1))).astype(np.float32)


def divided(found):
    return np.concatenate([found[:, :3] / np.maximum(found[:, 3:], 1e-9), found[:, 3:]], 1)


def run(*arguments, **more):
    done = subprocess.run([str(of) for of in arguments], capture_output=True, timeout=900, **more)
    if done.returncode:
        raise RuntimeError((done.stderr.decode(errors="replace").strip().splitlines() or ["fails"])[-1])
    return done.stdout


# Programs that read: each gives of a file the patches' light of Rec. 709 and the bits of its numbers.
def read_oiio(path):
    read = oiio.ImageBuf(str(path))
    if not read.initialized or read.has_error:
        raise RuntimeError(read.geterror())
    is_float = read.spec().format.basetype in (oiio.HALF, oiio.FLOAT)
    space = read.spec().get_string_attribute("oiio:ColorSpace")
    if oiio.ColorConfig().getColorSpaceIndex(space) < 0:
        space = "lin_rec709_scene" if is_float else "srgb_rec709_scene"  # none, or one that it does not know itself
    made = oiio.ImageBufAlgo.colorconvert(read.copy(oiio.FLOAT), space, "lin_rec709_scene", unpremult=True)
    if made.has_error:
        raise RuntimeError(made.geterror())
    return divided(patches(made.get_pixels(oiio.FLOAT))), 16


def read_vips(path):
    image = pyvips.Image.new_from_file(str(path))
    if image.get_typeof("icc-profile-data"):
        image = image.icc_import(embedded=True, pcs="xyz")
    return patches(image.colourspace("scrgb").numpy()), 16


def read_magick(path):
    sixteen = run(programs["magick"], path, "-profile", "srgb.icc", "-colorspace", "sRGB", "-depth", 16, "rgba:-")
    codes = patches(np.frombuffer(sixteen, "<u2").reshape(rows * side, columns * side, 4) / 65535)
    return np.concatenate([of_srgb(codes[:, :3]), codes[:, 3:]], 1), 8


transfers = {"smpte2084": "PQ", "arib-std-b67": "HLG", "iec61966-2-1": "sRGB", "linear": "light"}
gamut_names = {"bt2020": "Rec. 2020", "smpte432": "P3"}


def read_ffmpeg(path):
    told = json.loads(run("ffprobe", "-v", "error", "-of", "json", "-show_streams", path))["streams"][0]
    of = told.get("pix_fmt", "")
    is_float, planes = "f32" in of, 4 if "gbrap" in of else 3
    # As they are, where they are floats: FFmpeg makes integers on the way from one kind to another.
    data = run(programs["ffmpeg"], "-v", "error", "-i", path, "-sws_flags", "accurate_rnd+full_chroma_int", "-f", "rawvideo",
               "-pix_fmt", of if is_float else "rgba64le", "-")
    if is_float:
        pixels = np.frombuffer(data, of[-2:].replace("le", "<f4").replace("be", ">f4"))
        pixels = np.moveaxis(pixels.reshape(planes, rows * side, columns * side)[[2, 0, 1, 3][:planes]], 0, 2)
    else:
        pixels = np.frombuffer(data, "<u2").reshape(rows * side, columns * side, 4) / 65535
    found = divided(patches(pixels)) if is_float else patches(pixels)
    curve = transfers.get(told.get("color_transfer"), "light" if is_float else "sRGB")
    turned = curves[curve][1](found[:, :3]) @ to_rec709[gamut_names.get(told.get("color_primaries"), "Rec. 709")].T
    return np.concatenate([turned, found[:, 3:]], 1), 16 if re.search("f32|48|64|16", of) else 8


def read_ultrahdr(path):
    return patches(imagecodecs.ultrahdr_decode(path.read_bytes()).astype(float)), 16


# Blender and Chromium take a while to start: they read all files at once.
blender = """
import bpy, json, sys, numpy
for path in json.load(sys.stdin):
    try:
        image = bpy.data.images.load(path)
        assert len(image.pixels), "is not read"
        pixels = numpy.empty(len(image.pixels), "f4")
        image.pixels.foreach_get(pixels)
        pixels.tofile(path + ".blender")
        told = [image.is_float, image.colorspace_settings.name, image.alpha_mode]
    except Exception as error:
        told = str(error).strip() or "is not read"
    print("told", json.dumps(told))
"""
blender_spaces = {"sRGB": ("sRGB", "Rec. 709"), "Display P3": ("sRGB", "P3"), "Rec.2100-PQ": ("PQ", "Rec. 2020"),
                  "Rec.2100-HLG": ("HLG", "Rec. 2020")}


def blender_of(paths):
    out = run(programs["blender_python"], "-B", "-c", blender, input=json.dumps([str(of) for of in paths]).encode())
    told = [json.loads(line[5:]) for line in out.decode().splitlines() if line.startswith("told ")]
    for path, of in zip(paths, told, strict=True):
        if isinstance(of, str):
            yield f"not read: {of}"
            continue
        is_float, space, mode = of
        pixels = np.fromfile(f"{path}.blender", "f4").reshape(rows * side, columns * side, 4)[::-1]
        found = patches(pixels)
        if is_float:  # light of the scene's space, which is Rec. 709's; multiplied by alpha
            yield divided(found), 16
            continue
        curve, gamut = blender_spaces[space]
        yield np.concatenate([curves[curve][1](found[:, :3]) @ to_rec709[gamut].T, found[:, 3:]], 1), 8


page = """<!doctype html><script type="importmap">{"imports": {"three": "/node/three/build/three.module.js",
"three/addons/": "/node/three/examples/jsm/", "@monogrid/gainmap-js": "/node/@monogrid/gainmap-js/dist/decode.js"}}</script>
<script type="module" src="/readers.mjs"></script>"""


def chromium_of(jobs):
    """What readers.mjs answers to `jobs`."""
    answer, done = [], threading.Event()

    class Handler(http.server.BaseHTTPRequestHandler):
        def log_message(self, *_):
            pass

        def do_GET(self):
            path = self.path.split("?")[0]
            if path == "/":
                kind, data = "text/html", page.encode()
            elif path == "/jobs":
                kind, data = "application/json", json.dumps(jobs).encode()
            else:
                file = modules / path[6:] if path.startswith("/node/") else \
                    tree / "tests/scripts/readers.mjs" if path == "/readers.mjs" else pathlib.Path(path[1:])
                if not file.is_file():
                    return self.send_error(404)
                kind = {".js": "text/javascript", ".mjs": "text/javascript", ".png": "image/png", ".jpg": "image/jpeg",
                        ".webp": "image/webp", ".wasm": "application/wasm"}.get(file.suffix, "application/octet-stream")
                data = file.read_bytes()
            self.send_response(200)
            self.send_header("content-type", kind)
            self.send_header("content-length", str(len(data)))
            self.end_headers()
            self.wfile.write(data)

        def do_POST(self):
            answer.append(json.loads(self.rfile.read(int(self.headers["content-length"]))))
            self.send_response(204)
            self.end_headers()
            done.set()

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        browser = subprocess.Popen(
            [programs["chromium"], "--headless", "--no-sandbox", "--disable-gpu-watchdog", "--enable-unsafe-swiftshader",
             "--use-gl=angle", "--use-angle=swiftshader", "--no-first-run", "--disable-background-networking",
             f"--user-data-dir={profile}", f"http://127.0.0.1:{server.server_port}/"],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
        done.wait(240)
        os.killpg(browser.pid, signal.SIGKILL)
        browser.wait()
    server.shutdown()
    if not answer:
        raise RuntimeError("Chromium gives no answer")
    return answer[0]


def pixels_of(answer):
    """Of an answer of readers.mjs: the picture, and the bits of its numbers."""
    data = np.array([float("nan") if of is None else of for of in answer["data"]], float)
    pixels = data.reshape(-1, answer["width"], answer["channels"])
    if answer.get("codes"):
        pixels = pixels / 255
        pixels[..., :3] = of_srgb(pixels[..., :3])
    return pixels, 8 if answer.get("codes") else 16


look = "format = 1\n[[stack]]\neffect = \"exposure\"\n"
spaces = {"srgb": ("Rec. 709", "sRGB"), "p3": ("P3", "sRGB"), "pq": ("Rec. 2020", "PQ"), "hlg": ("Rec. 2020", "HLG")}
packings = {"tif": ("none", "packbits", "lzw", "zip"),
            "exr": ("none", "rle", "zips", "zip", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab")}
losses = {"pxr24": .3, "b44": 4, "b44a": 4, "dwaa": 4, "dwab": 4}


def ours():
    """Each file that we write: its row, what tells it from others of the row, flags, end of name, and what it says."""
    for space, (gamut, curve) in spaces.items():
        for bits in ("8", "16"):
            if bits == "16" or space in ("srgb", "p3"):
                yield (f"PNG `--bits {bits}` `--output-space {space}`", "", ["--bits", bits, "--output-space", space], "png",
                       File(bits, gamut, curve))
    yield "PNG `--alpha`", "", ["--alpha"], "png", File("8", has_alpha=True)
    for chroma in ("4:4:4", "4:2:2", "4:2:0"):
        yield "JPEG", chroma, ["--chroma", chroma], "jpg", File("8", loss=4)
    for end, name in (("tif", "TIFF"), ("exr", "EXR")):
        for bits in ("8", "16", "float") if end == "tif" else ("half", "float"):
            curve = "sRGB" if bits in ("8", "16") else "light"
            for packing in packings[end]:
                yield (f"{name} `--bits {bits}`", packing, ["--bits", bits, "--compression", packing], end,
                       File(bits, curve=curve, loss=losses.get(packing, 0)))
            yield f"{name} `--bits {bits}` `--alpha`", "", ["--bits", bits, "--alpha"], end, File(bits, "Rec. 709", curve, 0, True)
    for space, gamut in (("p3", "P3"), ("rec2020", "Rec. 2020")):
        yield f"EXR `--output-space {space}`", "", ["--output-space", space], "exr", File("half", gamut, "light")
    yield "Radiance HDR", "", [], "hdr", File("rgbe", curve="light")
    yield "PFM", "", [], "pfm", File("float", curve="light")


def darkroom(*arguments):
    return run(program, *arguments, "-q").decode()


def read_darkroom(path, *flags):
    darkroom("develop", path, "--look", "nothing.toml", "--bits", "float", "-o", "back.exr", *flags)
    return divided(patches(oiio.ImageBuf("back.exr").get_pixels(oiio.FLOAT))), 16


one_by_one = {"OpenImageIO": read_oiio, "FFmpeg": read_ffmpeg, "ImageMagick": read_magick, "libvips": read_vips}
in_chromium = {"png": {"Chromium": "shown"}, "jpg": {"Chromium": "shown"}, "exr": {"three.js": "exr"},
               "hdr": {"three.js": "hdr"}, "tif": {"three.js": "tif"}}


def attempt(read, *arguments):
    try:
        return read(*arguments)
    except subprocess.TimeoutExpired:  # says something of the machine, and nothing of the file
        raise
    except Exception as error:
        return f"not read: {error}"


def readings_of(names, more=in_chromium):
    """Of each program and each file: what it made of it, or a text."""
    out = {reader: {name: attempt(read, pathlib.Path(name)) for name in names} for reader, read in one_by_one.items()}
    out["Blender"] = dict(zip(names, blender_of([os.path.abspath(of) for of in names])))
    jobs = [(reader, how, name) for name in names for reader, how in more.get(name.rsplit(".")[-1], {}).items()]
    for (reader, _, name), answer in zip(jobs, chromium_of([job[1:] for job in jobs]), strict=True):
        out.setdefault(reader, {})[name] = f"not read: {answer}" if isinstance(answer, str) else \
            (lambda pixels, bits: (patches(pixels), bits))(*pixels_of(answer))
    return out


def words_of(file, found):
    return "not read" if isinstance(found, str) else file.judge(*found)


def joined(cells):
    """Of what tells files apart and what became of them: what became of most, and those of which something else did."""
    said = {}
    for which, words in cells:
        said.setdefault(words, []).append(which)
    ordered = sorted(said.items(), key=lambda of: -len(of[1]))
    return "; ".join([ordered[0][0]] + [f"{', '.join(f'`{of}`' for of in which)}: {words}" for words, which in ordered[1:]])


def pictures_of_ours():
    files = list(ours())
    names = [f"{i}.{end}" for i, (_, _, _, end, _) in enumerate(files)]
    for name, (_, _, flags, _, file) in zip(names, files):
        darkroom("develop", "alpha.exr" if file.has_alpha else "chart.exr", "--look", "nothing.toml", *flags, "-o", name)
    found = readings_of(names)
    out = ["| File that we write | " + " | ".join(found) + " |", "|---" * (len(found) + 1) + "|"]
    for row in dict.fromkeys(of[0] for of in files):
        cells = []
        for reader in found.values():
            of = [(which, words_of(file, reader[name])) for name, (words, which, _, _, file) in zip(names, files)
                  if words == row and name in reader]
            cells.append(joined(of) if of else "")
        out.append(f"| {row} | " + " | ".join(cells) + " |")
    return out


# What programs write: each yields what the file is called, its path, and what it says.
def write_oiio():
    def write(name, words, file, kind, **attributes):
        spec = oiio.ImageSpec(columns * side, rows * side, 4 if file.has_alpha else 3, kind)
        for key, value in attributes.items():
            spec.attribute(*(value if isinstance(value, tuple) else (key.replace("_", ":"), value)))
        image = oiio.ImageBuf(oiio.ImageSpec(columns * side, rows * side, spec.nchannels, oiio.FLOAT))
        image.set_pixels(oiio.ROI.All, np.ascontiguousarray(chart(file.has_alpha, file.stored)[..., :spec.nchannels]))
        out = oiio.ImageOutput.create(name)
        if not out or not out.open(name, spec) or not out.write_image(image.get_pixels(oiio.FLOAT)) or not out.close():
            raise RuntimeError(f"{name}: {out.geterror() if out else oiio.geterror()}")
        return words, name, file
    kinds = {"8": oiio.UINT8, "16": oiio.UINT16, "half": oiio.HALF, "float": oiio.FLOAT}
    for bits in ("8", "16"):
        yield write(f"oiio{bits}.png", f"PNG {bits}", File(bits), kinds[bits])
        yield write(f"oiio{bits}.tif", f"TIFF {bits}", File(bits), kinds[bits])
    for space, cicp in (("p3", (12, 13, 0, 1)), ("pq", (9, 16, 0, 1)), ("hlg", (9, 18, 0, 1))):
        gamut, curve = spaces[space]
        yield write(f"oiio_{space}.png", f"PNG 16 with cICP: {cicp[0]} {cicp[1]}", File("16", gamut, curve), oiio.UINT16,
                    cicp=("CICP", oiio.TypeDesc("int[4]"), cicp))
    yield write("oiio.jpg", "JPEG", File(loss=4), oiio.UINT8, Compression="jpeg:98")
    yield write("oiio.webp", "WebP: lossless", File(), oiio.UINT8, compression="lossless")
    for bits in ("half", "float"):
        yield write(f"oiio_{bits}.tif", f"TIFF {bits}", File(bits, curve="light"), kinds[bits])
        for packing in (*packings["exr"], "htj2k256", "htj2k32", "zstd"):
            yield write(f"oiio_{bits}_{packing}.exr", f"EXR {bits}: {packing}",
                        File(bits, curve="light", loss=losses.get(packing, 0)), kinds[bits], compression=packing)
    for identity, gamut in (("lin_rec709_scene", "Rec. 709"), ("lin_p3d65_scene", "P3"), ("lin_rec2020_scene", "Rec. 2020"),
                            ("lin_ap1_scene", "AP1"), ("lin_ap0_scene", "AP0")):
        yield write(f"oiio_{identity}.exr", f"EXR with colorInteropID: {identity}", File("float", gamut, "light"), oiio.FLOAT,
                    oiio_ColorSpace=identity, colorInteropID=identity)
    yield write("oiio_alpha.exr", "EXR with alpha", File("float", curve="light", has_alpha=True), oiio.FLOAT)
    yield write("oiio.hdr", "Radiance HDR", File("rgbe", curve="light"), oiio.FLOAT)
    yield write("oiio.pfm", "PFM", File("float", curve="light"), oiio.FLOAT)


standard = np.clip(light, 0, 1)


def write_ffmpeg():
    codes = chart(of=File("16").stored)[..., :3]
    for words, name, file, more in (
            ("PNG 8", "ff8.png", File(), ["-pix_fmt", "rgb24"]), ("PNG 16", "ff16.png", File("16"), ["-pix_fmt", "rgb48be"]),
            ("TIFF 8", "ff8.tif", File(), ["-pix_fmt", "rgb24"]), ("TIFF 16", "ff16.tif", File("16"), ["-pix_fmt", "rgb48le"]),
            ("JPEG", "ff.jpg", File(loss=4), ["-pix_fmt", "yuvj444p", "-q:v", "1", "-qmin", "1"]),
            ("WebP: lossless", "ff.webp", File(), ["-lossless", "1", "-pix_fmt", "bgra"])):
        loss = max(file.loss, 1.02)  # of the way from 16 bits to 8
        run(programs["ffmpeg"], "-v", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgb48le", "-s", f"{columns * side}x{rows * side}",
            "-i", "-", "-sws_flags", "accurate_rnd+full_chroma_int", *more, "-frames:v", "1", name,
            input=np.round(codes * 65535).astype("<u2").tobytes())
        file.loss = loss
        yield words, name, file
    planes = np.moveaxis(chart()[..., [1, 2, 0]], 2, 0)
    for bits in ("half", "float"):
        run(programs["ffmpeg"], "-v", "error", "-y", "-f", "rawvideo", "-pix_fmt", "gbrpf32le", "-s", f"{columns * side}x{rows * side}",
            "-i", "-", "-c:v", "exr", "-format", bits, "-frames:v", "1", f"ff_{bits}.exr", input=planes.astype("<f4").tobytes())
        yield f"EXR {bits}", f"ff_{bits}.exr", File(bits, curve="light")


def write_magick():
    codes = np.round(chart(of=File("16").stored)[..., :3] * 65535).astype("<u2").tobytes()
    cut = dict(curve="light", loss=.5, of=standard)  # it has 16 bits, and nothing beyond
    for words, name, file, more in (
            ("PNG 8", "im8.png", File(loss=1.02), ["-depth", 8]), ("PNG 16", "im16.png", File("16"), []),
            ("TIFF 8", "im8.tif", File(loss=1.02), ["-depth", 8]), ("TIFF 16", "im16.tif", File("16"), []),
            ("JPEG", "im.jpg", File(loss=4), ["-quality", 98]), ("WebP: lossless", "im.webp", File(loss=1.02), ["-define", "webp:lossless=true"]),
            ("EXR of light", "im.exr", File("half", **cut), ["-colorspace", "RGB"]),
            ("Radiance HDR of light", "im.hdr", File("rgbe", **cut), ["-colorspace", "RGB"]),
            ("PFM of light", "im.pfm", File("float", **cut), ["-colorspace", "RGB"])):
        run(programs["magick"], "-size", f"{columns * side}x{rows * side}", "-depth", 16, "-endian", "LSB", "rgb:-", *more, name,
            input=codes)
        yield words, name, file


def write_vips():
    def image(numbers, most):
        made = pyvips.Image.new_from_array(np.round(chart(of=numbers)[..., :3] * most).astype("u1" if most == 255 else "u2"))
        return made.copy(interpretation="srgb" if most == 255 else "rgb16")
    for bits, most in (("8", 255), ("16", 65535)):
        image(File(bits).stored, most).pngsave(f"vips{bits}.png")
        yield f"PNG {bits}", f"vips{bits}.png", File(bits)
        image(File(bits).stored, most).tiffsave(f"vips{bits}.tif")
        yield f"TIFF {bits}", f"vips{bits}.tif", File(bits)
        for end in ("png", "tif"):
            file = File(bits, "P3")
            image(file.stored, most).write_to_file(f"vips{bits}_p3.{end}", profile="p3")
            yield f"{'PNG' if end == 'png' else 'TIFF'} {bits} with its profile of P3", f"vips{bits}_p3.{end}", \
                File(bits, "P3", loss=.3)
    image(File().stored, 255).jpegsave("vips.jpg", Q=98, subsample_mode="off")
    yield "JPEG", "vips.jpg", File(loss=4)
    image(File().stored, 255).webpsave("vips.webp", lossless=True)
    yield "WebP: lossless", "vips.webp", File()
    pyvips.Image.new_from_array(chart()[..., :3]).copy(interpretation="scrgb").tiffsave("vipsf.tif")
    yield "TIFF float", "vipsf.tif", File("float", curve="light")


blender_writes = """
import bpy, json, sys, numpy
pixels, size, files = json.load(sys.stdin)
image = bpy.data.images.new("chart", *size, alpha=True, float_buffer=True)
image.pixels.foreach_set(numpy.array(pixels, "f4"))
scene = bpy.context.scene
scene.view_settings.view_transform = "Standard"
for path, display, kind, depth, packing in files:
    settings = scene.render.image_settings
    scene.display_settings.display_device = display
    scene.view_settings.view_transform = "Standard"
    settings.file_format, settings.color_mode = kind, "RGB"
    settings.color_depth = depth
    settings.quality, settings.exr_codec = 100, packing
    image.save_render(path, scene=scene)
"""


def write_blender():
    half, whole = dict(kind="half", curve="light"), dict(kind="float", curve="light")
    of = [("PNG 8", "bl8.png", "sRGB", "PNG", "8", File()), ("PNG 16", "bl16.png", "sRGB", "PNG", "16", File("16")),
          ("PNG 16 of: Display P3", "blp3.png", "Display P3", "PNG", "16", File("16", "P3")),
          ("PNG 16 of: Rec. 2100 PQ", "blpq.png", "Rec.2100-PQ", "PNG", "16", File("16", "Rec. 2020", "PQ")),
          ("PNG 16 of: Rec. 2100 HLG", "blhlg.png", "Rec.2100-HLG", "PNG", "16", File("16", "Rec. 2020", "HLG")),
          ("TIFF 8", "bl8.tif", "sRGB", "TIFF", "8", File()), ("TIFF 16", "bl16.tif", "sRGB", "TIFF", "16", File("16")),
          ("JPEG", "bl.jpg", "sRGB", "JPEG", "8", File(loss=4)), ("WebP", "bl.webp", "sRGB", "WEBP", "8", File(loss=4)),
          ("Radiance HDR", "bl.hdr", "sRGB", "HDR", "32", File("rgbe", curve="light")),
          *((f"EXR {bits}: {codec.lower()}", f"bl{bits}{codec}.exr", "sRGB", "OPEN_EXR", "16" if bits == "half" else "32",
             File(bits, curve="light", loss=losses.get(codec.lower(), 0)), codec)
            for bits in ("half", "float") for codec in ("NONE", "ZIP", "PIZ", "PXR24", "DWAA"))]
    run(programs["blender_python"], "-B", "-c", blender_writes, input=json.dumps(
        [chart()[::-1].ravel().tolist(), [columns * side, rows * side],
         [(os.path.abspath(row[1]), *row[2:5], row[6] if len(row) > 6 else "ZIP") for row in of]]).encode())
    for words, name, _, _, _, file, *_ in of:
        file.loss = max(file.loss, .3)  # its tables
        yield words, name, file


def write_chromium():
    jobs = [("canvas", space, kind) for space in ("srgb", "display-p3") for kind in ("png", "jpeg", "webp")]
    codes = {"srgb": File(), "display-p3": File(gamut="P3")}
    answers = chromium_of([(how, [space, f"image/{kind}", columns * side,
                                  np.round(chart(of=codes[space].stored) * 255).astype(int).ravel().tolist()])
                           for how, space, kind in jobs] +
                          [("exporter", [bits, columns * side, chart()[::-1].ravel().tolist()]) for bits in ("half", "float")])
    for (_, space, kind), answer in zip(jobs, answers):
        name = f"canvas_{space}.{kind}"
        pathlib.Path(name).write_bytes(bytes(answer))
        yield f"canvas of {space}: {kind}", name, \
            File(gamut="Rec. 709" if space == "srgb" else "P3", loss={"png": .3}.get(kind, 5))
    for bits, answer in zip(("half", "float"), answers[len(jobs):]):
        pathlib.Path(f"three_{bits}.exr").write_bytes(bytes(answer))
        yield f"EXR of three.js: {bits}", f"three_{bits}.exr", File(bits, curve="light")


def listed(files):
    """Of "EXR: zip" and "EXR: rle": EXR (zip, rle)."""
    kinds = {}
    for kind, _, which in (words.partition(": ") for words in files):
        kinds.setdefault(kind, []).append(which)
    return ", ".join(f"{kind} ({', '.join(which)})" if any(which) else kind for kind, which in kinds.items())


def pictures_of_theirs():
    out = ["| Program | File that it writes | What we read |", "|---|---|---|"]
    for writer, write in (("OpenImageIO", write_oiio), ("FFmpeg", write_ffmpeg), ("ImageMagick", write_magick),
                          ("libvips", write_vips), ("Blender", write_blender), ("Chromium", write_chromium)):
        said = {}
        for words, name, file in write():
            found = attempt(read_darkroom, name, *(["--alpha"] if file.has_alpha else []))
            if isinstance(found, str):
                told = "refused: " + found.split(": ")[-1]
            else:
                told = file.judge(*found)
            said.setdefault(told, []).append(words)
        out += [f"| {writer} | {listed(files)} | {told} |" for told, files in said.items()]
    return out


def judged(readings):
    """A file of eight bits of which these are the readings."""
    file = File(loss=4)
    file.readings = lambda: readings
    return file


def gain_maps():
    pathlib.Path("bright.toml").write_text('format = 1\n[[stack]]\neffect = "tonemap"\ncurve = "bt2390"\nwhite = 5\npeak_nits = 1000\n')
    pathlib.Path("standard.toml").write_text(pathlib.Path("bright.toml").read_text().replace("1000", "203"))
    darkroom("develop", "chart.exr", "--look", "bright.toml", "--gain-map", "-o", "both.jpg")
    right, base = (np.maximum(patches(oiio.ImageBuf(name).get_pixels(oiio.FLOAT))[:, :3], 0) for name in (
        (darkroom("develop", "chart.exr", "--look", f"{of}.toml", "--bits", "float", "-o", f"{of}.exr"), f"{of}.exr")[1]
        for of in ("bright", "standard")))
    file = judged([("equal", right), ("the picture for displays of standard range", base), ("light taken as codes", of_srgb(right)),
                   ("that of standard range, light taken as codes", of_srgb(base))])
    found = readings_of(["both.jpg"], {"jpg": {"Chromium": "shown", "three.js": "ultra_hdr", "gainmap-js": "gain_map"}})
    found["libultrahdr"] = {"both.jpg": attempt(read_ultrahdr, pathlib.Path("both.jpg"))}
    out = ["| Program | What it makes of `--gain-map` |", "|---|---|"]
    out += [f"| {reader} | {words_of(file, of['both.jpg'])} |" for reader, of in found.items()]
    pathlib.Path("theirs.jpg").write_bytes(imagecodecs.ultrahdr_encode(np.maximum(chart(), 0).astype(np.float16), level=98))
    theirs = File(loss=6, of=np.maximum(light, 0))
    theirs.readings = lambda: [("equal", np.maximum(light, 0))]
    return out, [f"| libultrahdr | Ultra HDR JPEG | {words_of(theirs, attempt(read_darkroom, 'theirs.jpg'))} |"]


# Tables: what they make of twelve colours that are entries of theirs, so that no two interpolations differ.
steps = 16
entries = np.array([(0, 0, 0), (16, 16, 16), (8, 8, 8), (3, 3, 3), (16, 0, 0), (0, 16, 0), (0, 0, 16), (12, 4, 9), (1, 15, 7),
                    (5, 2, 14), (10, 11, 12), (16, 8, 2)]) / steps


def curve_of(v):
    return v * v


def mixed(v):
    """A table in which each channel hangs on two."""
    return np.stack([.9 * v[..., 0] * v[..., 0] + .1 * v[..., 1], .8 * v[..., 1] + .2 * v[..., 2], v[..., 2] * (1 - .5 * v[..., 0])], -1)


def lines(numbers):
    return "".join(" ".join(f"{v:.9g}" for v in row) + "\n" for row in numbers.reshape(-1, 3))


def grid(red_is_fastest):
    blue, green, red = np.meshgrid(*[np.arange(steps + 1) / steps] * 3, indexing="ij")
    return np.stack([red, green, blue] if red_is_fastest else [blue, green, red], -1)


def tables_of_ours():
    """Each table that we write: words, path, where its inputs end, and what is right of the entries."""
    ramp = np.repeat(np.arange(steps + 1)[:, None] / steps, 3, 1)
    for top in (1, 4):
        begin = f"DOMAIN_MAX {top} {top} {top}\n" if top > 1 else ""
        for kind, numbers, right in (("1D", curve_of(ramp), curve_of(entries)), ("3D", mixed(grid(True)), mixed(entries))):
            pathlib.Path("in.cube").write_text(f"{begin}LUT_{kind}_SIZE {steps + 1}\n{lines(numbers * top)}")
            darkroom("lut", "convert", "in.cube", "-o", f"{kind}_{top}.cube")
            yield f"{kind}, inputs from 0 to {top}", f"{kind}_{top}.cube", top, right * top
    # Behind a shaper whose entries are roots, so that the cube's are met at squares.
    fine = " ".join(f"{np.sqrt(i / 256):.9g}" for i in range(257))
    pathlib.Path("in.clf").write_text(f"""<?xml version="1.0" encoding="UTF-8"?>
<ProcessList compCLFversion="3" id="a"><LUT1D inBitDepth="32f" outBitDepth="32f"><Array dim="257 1">{fine}</Array></LUT1D>
<LUT3D inBitDepth="32f" outBitDepth="32f"><Array dim="{steps + 1} {steps + 1} {steps + 1} 3">
{lines(mixed(grid(False)))}</Array></LUT3D></ProcessList>
""")
    darkroom("lut", "convert", "in.clf", "-o", "shaper.cube")
    yield "3D behind a shaper", "shaper.cube", None, mixed(entries)


def by_ocio(path, colors, *_):
    config = ocio.Config.CreateRaw()
    processor = config.getProcessor(ocio.FileTransform(os.path.abspath(path), interpolation=ocio.INTERP_LINEAR))
    return np.array([processor.getDefaultCPUProcessor().applyRGB([float(v) for v in of]) for of in colors])


def by_ffmpeg(path, colors, words):
    planes = colors[:, [1, 2, 0]].T.astype("<f4")
    flags = ["-f", "rawvideo", "-pix_fmt", "gbrpf32le"]
    out = run(programs["ffmpeg"], "-v", "error", *flags, "-s", f"{len(colors)}x1", "-i", "-", "-vf",
              f"lut{words[:2].lower()}=file={path}", *flags, "-", input=planes.tobytes())
    return np.frombuffer(out, "<f4").reshape(3, -1)[[2, 0, 1]].T


def by_darkroom(path, colors):
    """Of a picture of these colours, in which the table takes light as it is."""
    pathlib.Path("table.toml").write_text(f'format = 1\n[[stack]]\neffect = "lut"\nlut = "{path}"\nspace = "linear"\n')
    image = oiio.ImageBuf(oiio.ImageSpec(len(colors), 1, 3, oiio.FLOAT))
    image.set_pixels(oiio.ROI.All, colors[None].astype(np.float32))
    image.write("colors.exr")
    darkroom("develop", "colors.exr", "--look", "table.toml", "--bits", "float", "-o", "tabled.exr")
    return oiio.ImageBuf("tabled.exr").get_pixels(oiio.FLOAT)[0, :, :3]


def table_words(found, right):
    if isinstance(found, str):
        return "not read"
    off = np.abs(found - right).max()
    return "equal" if off < 1e-3 * right.max() else f"differs, by up to {off:.2g}"


def tables():
    ours = list(tables_of_ours())
    made = chromium_of([("cube", path) for _, path, _, _ in ours])
    out = ["| Table that we write (`.cube`) | OpenColorIO | FFmpeg | three.js |", "|---|---|---|---|"]
    for (words, path, top, right), three in zip(ours, made, strict=True):
        colors = entries ** 2 if top is None else entries * top
        if not isinstance(three, str):  # its numbers, at the places of the colours
            numbers, size = np.array(three["data"], float).reshape(-1, 4)[:, :3], three["size"]
            at = np.rint((colors - three["min"]) / (np.array(three["max"]) - three["min"]) * (size - 1)).astype(int)
            three = numbers[np.clip(at, 0, size - 1) @ [1, size, size * size]] if len(numbers) == size ** 3 else "not a cube"
        cells = [table_words(attempt(by_ocio, path, colors), right), table_words(attempt(by_ffmpeg, path, colors, words), right),
                 table_words(three, right)]
        out.append(f"| {words} | {' | '.join(cells)} |")
    # Theirs, of a change of colours that is straight, so that it is the same between entries.
    change = np.array([(.7, .2, .1), (.1, .8, .1), (0, .3, .7)])
    said = {}
    def say(words, path, right):
        found = attempt(by_darkroom, path, entries)
        said.setdefault(f"refused: {found.split(': ')[-1]}" if isinstance(found, str) else table_words(found, right), []).append(words)
    for name, end in ocio.Baker.getFormats():
        path = f"baked_{name.split('/')[0]}.{end}"
        for matrix in (change, np.diag([.9, .8, .7])):
            config = ocio.Config.CreateRaw()
            for space, transform in (("in", None), ("out", ocio.MatrixTransform(np.pad(matrix, (0, 1)).ravel().tolist()))):
                of = ocio.ColorSpace(name=space)
                if transform:
                    of.setTransform(transform, ocio.COLORSPACE_DIR_FROM_REFERENCE)
                config.addColorSpace(of)
            baker = ocio.Baker(config=config, format=name, inputSpace="in", targetSpace="out", cubeSize=17)
            try:
                pathlib.Path(path).write_bytes(baker.bake().encode())
            except ocio.Exception:
                continue
            say(f"{name.split('/')[0]} (`.{end}`)", path, entries @ matrix.T)
            break
    table = ocio.Lut3DTransform(steps + 1)
    table.setData((grid(False) @ change.T).astype(np.float32).ravel())
    for name, end in (("Academy/ASC Common LUT Format", "clf"), ("Color Transform Format", "ctf")):
        pathlib.Path(f"written.{end}").write_text(ocio.GroupTransform([table]).write(formatName=name, config=ocio.Config.CreateRaw()))
        say(f"`.{end}` of a processor", f"written.{end}", entries @ change.T)
    return out, [f"| OpenColorIO | {', '.join(which)} | {words} |" for words, which in said.items()]


# Engines' tone curves: the name there, what asks for it in readers.mjs, the name here, what light is multiplied by, and how
# codes are made.
def gamma22(v):
    return np.maximum(v, 0) ** (1 / 2.2)


engine_curves = [
    ("three.js", "ACESFilmicToneMapping", "ACESFilmicToneMapping", "aces_hill", 1 / .6, srgb_of),
    ("three.js", "NeutralToneMapping", "NeutralToneMapping", "khronos_pbr_neutral", 1, srgb_of),
    ("three.js", "AgXToneMapping", "AgXToneMapping", "agx", 1, srgb_of),
    ("Babylon.js", "TONEMAPPING_ACES", "2", "aces_hill", 1, gamma22),
    ("Babylon.js", "TONEMAPPING_KHR_PBR_NEUTRAL", "3", "khronos_pbr_neutral", 1, gamma22),
    ("PlayCanvas", "TONEMAP_ACES", "tonemappingAces", "aces_narkowicz", 1, gamma22),
    ("PlayCanvas", "TONEMAP_ACES2", "tonemappingAces2", "aces_hill", 1 / .6, gamma22),
    ("PlayCanvas", "TONEMAP_NEUTRAL", "tonemappingNeutral", "khronos_pbr_neutral", 1, gamma22)]


def curves_of_engines():
    lights = np.maximum(light, 0)
    answers = chromium_of([("curve", [engine, asked, lights.ravel().tolist()]) for engine, _, asked, _, _, _ in engine_curves])
    out = ["| Engine | Curve there | Here | Encoded by | |", "|---|---|---|---|---|"]
    for (engine, name, _, ours, gain, encode), answer in zip(engine_curves, answers, strict=True):
        if isinstance(answer, str):
            raise RuntimeError(f"{engine} {name}: {answer}")
        pathlib.Path("curve.toml").write_text(f'format = 1\n[[stack]]\neffect = "exposure"\nexposure = {gain}\n'
                                              f'[[stack]]\neffect = "tonemap"\ncurve = "{ours}"\n')
        darkroom("develop", "lights.exr", "--look", "curve.toml", "--bits", "float", "-o", "curved.exr")
        codes = np.clip(encode(patches(oiio.ImageBuf("curved.exr").get_pixels(oiio.FLOAT))[:, :3]), 0, 1) * 255
        off = np.abs(codes - np.array(answer).reshape(-1, 4)[:, :3]).max()
        behind = f"`{ours}`" + (" behind an exposure of 1 / 0.6" if gain != 1 else "")
        out.append(f"| {engine} | `{name}` | {behind} | {'sRGB' if encode is srgb_of else 'a gamma of 2.2'} | "
                   f"{'equal' if off <= 1 else f'differs, by up to {off:.0f} codes'} |")
    return out


def prepare():
    """What all use, in the folder that is the current one."""
    pathlib.Path("nothing.toml").write_text(look)
    pathlib.Path("srgb.icc").write_bytes(ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes())
    for name, has_alpha, of in (("chart.exr", False, light), ("alpha.exr", True, light), ("lights.exr", False, np.maximum(light, 0))):
        image = oiio.ImageBuf(oiio.ImageSpec(columns * side, rows * side, 4, oiio.FLOAT))
        image.set_pixels(oiio.ROI.All, chart(has_alpha, of))
        image.write(name)


def version(*command, of):
    return re.search(of, run(*command).decode(errors="replace"))[1]


def versions():
    """Those of the machine change with its updates, those of registries with readers.sh."""
    package = json.loads((modules / "three/package.json").read_text())["version"]
    gain_map = json.loads((modules / "@monogrid/gainmap-js/package.json").read_text())["version"]
    of_blender = version(programs["blender_python"], "-c", "import bpy; print('is', bpy.app.version_string)", of=r"is (\S+)")
    return (f"OpenImageIO {oiio.VERSION_STRING}, OpenColorIO {ocio.__version__}, libvips "
            f"{'.'.join(str(pyvips.version(i)) for i in range(3))} (pyvips-binary), Blender {of_blender} (bpy) and libultrahdr "
            f"(imagecodecs {imagecodecs.__version__}) of PyPI; three.js {package} and gainmap-js {gain_map} of npm; FFmpeg "
            f"{version(programs['ffmpeg'], '-version', of=r'version ([0-9.]+)')}, ImageMagick "
            f"{version(programs['magick'], '--version', of=r'ImageMagick ([0-9.-]+)')} and Chromium "
            f"{version(programs['chromium'], '--version', of=r'Chromium ([0-9]+)')} of Debian 12.")


def made_page():
    ours, theirs, (gain_map, of_gain_maps), (cubes, of_tables) = pictures_of_ours(), pictures_of_theirs(), gain_maps(), tables()
    curves = curves_of_engines()
    return "\n".join([f"""# What others read of our files, and we of theirs

For example, ImageMagick shows a PNG of `--output-space pq` as though its codes were sRGB's: grey, and dull. The script
[readers.py](../tests/scripts/readers.py) makes this page; `.ci/more readers` holds it against the programs, in these versions:
{versions()}

A chart of twelve colours is written, and what a program reads is turned into light by its own colour management, or, where
it has none, by what it says of the file. The right numbers come from the standards. "Equal" is within one code of 8 bits
where 8 are read, a third of one in others, and the loss of packings that change numbers.

## Pictures

A cell is empty where the program is not asked. Chromium is what a page gets from a canvas of 8 bits.

""" + "\n".join(ours), f"""
## JPEG with a gain map

""" + "\n".join(gain_map), """
## Tables

""" + "\n".join(cubes), """
## Pictures and tables that others write

What is refused says so in one line. JPEG, lossy WebP and canvases are theirs; of light that a program cuts off we read what is
left.

""" + "\n".join(theirs + of_gain_maps + of_tables), """
## Tone curves by the names of engines

Their code runs on the lights of the chart, and its codes are held against ours ([tonemap](../effects/tonemap/tonemap.md)).

""" + "\n".join(curves)]) + "\n"


if __name__ == "__main__":
    page_path = tree / "docs/readers.md"
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        prepare()
        made = made_page()
        os.chdir(tree)
    if "DARKROOM_RENEW_PAGES" in os.environ:  # see docs/changing.md
        page_path.write_text(made)
    told = page_path.read_text()
    # A page says with which versions it was made; what they make of files is what has to be the same.
    differing = [(a, b) for a, b in itertools.zip_longest(made.splitlines(), told.splitlines()) if a != b
                 and not (a or "").startswith("OpenImageIO ")]
    for a, b in differing:
        print(f"docs/readers.md says\n  {b}\nand it is\n  {a}")
    sys.exit(bool(differing))
