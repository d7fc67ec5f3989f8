# SPDX-License-Identifier: MIT
"""Makes the pictures of all pages, docs/pictures, by Mesa's software driver: those whose paths below it begin as a NAME
says (effects/bloom, looks/*_window), without names all. Each scene is rendered once; its frame is developed for every
picture. With --check nothing is stored: it names pictures whose mean FLIP error against what the tree makes now is above
0.02, and effects of which one cannot see, or cannot bear to see, what they do; pictures.html in FOLDER has before and
after."""

import argparse
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from fnmatch import fnmatch
from pathlib import Path
from threading import Thread

tree = Path(__file__).resolve().parents[2]
stored = tree / "docs/pictures"
allowed_error = 0.02
device = ["--device", "llvmpipe"]

# What is rendered, 1280x720, and stored as the chain gets it: a scene, and flags.
frames = {
    "courtyard": "courtyard",
    "courtyard_gathered": "courtyard --taa --size 640x360 --fps 60 --frames 0-15",
    "courtyard_jagged": "courtyard --samples 1 --size 640x360",
    "courtyard_sun": "courtyard --target 1,4.5,0 --distance 6 --yaw 236 --pitch -32",
    "dungeon": "dungeon",
    "embers": "forge --samples 1 --msaa 4 --size 640x360 --target 0,1.7,0 --fov 22 --fps 60 --frames 233-240",
    "forge": "forge",
    "forge_small": "forge --samples 1 --size 640x360",
    "interior": "interior",
    "interior_near": "interior --target 0.45,0.88,-0.5 --distance 1.5 --yaw -36 --pitch 6 --fov 26",
    "interior_large": "interior --samples 1 --size 1920x1080",
    "pan": "../proof/lab/scenes/pan --fps 24 --time 1",
    "street": "street",
}


@dataclass
class Part:
    """A cut of the picture, so that pixels are seen: each as scale x scale of them."""
    x: int
    y: int
    scale: int = 4
    contrast: float = 1  # around the cut's mean


@dataclass
class Shot:
    """A picture that a look makes of a frame."""
    frame: str
    flags: str = ""
    part: Part | None = None
    width: int = 640
    look: str | Path | None = None  # a file, or the text of one; "": the defaults; without it the scene's own
    events: str | None = None  # the text of a timeline


@dataclass
class Pair:
    """An effect by itself: a frame without it, and with it."""
    frame: str
    on: str = ""
    off: str = ""
    part: Part | None = None
    look: str | None = None
    is_another: bool = False  # it makes another picture of it, as nobody would take for the first


visor = "--ui hud/visor.svg --game health=82 --game ammunition=24 --game reserve=120 --game heading=40 --game weapon=RIFLE"
tail = '[[stack]]\neffect = "exposure"\n[[stack]]\neffect = "tonemap"\n[[stack]]\neffect = "encode"\n'
effects = {
    "anamorphic_streaks": Pair("street", "--anamorphic-streaks-intensity 0.25"),
    "arena_bloom": Pair("forge", "--no-bloom --arena-bloom", "--no-bloom"),
    "arena_grade": Pair("interior", "--arena-grade --arena-grade-preset sepia --no-tonemap --exposure 0.7", is_another=True),
    "auto_exposure": Pair("dungeon", "--exposure 1 --auto-exposure --auto-exposure-compensation -2", "--exposure 1"),
    "bloom": Pair("street", "", "--no-bloom"),
    "box_blur": Pair("street", "--box-blur --box-blur-radius 12"),
    "chromatic_aberration": Pair("street", "--chromatic-aberration 0.4", part=Part(330, 120)),
    "classic_bloom": Pair("forge", "--no-bloom --classic-bloom-intensity 1 --classic-bloom-radius 32", "--no-bloom"),
    "color_grade": Pair("interior", "--color-grade-temperature 8500 --color-grade-shadows 0.75,0.9,1.25 "
                        "--color-grade-contrast 1.2 --color-grade-vibrance 0.3"),
    "contrast_gamma": Pair("street", f"{visor} --contrast-gamma-contrast 1.2 --contrast-gamma-gamma 0.9", visor),
    "depth_of_field": Pair("interior_near", "--depth-of-field --depth-of-field-focus-distance 1.5 --depth-of-field-f-stop 1.8"),
    "dither": Pair("forge", "", "--no-dither", part=Part(880, 60, 2, contrast=12)),
    "exposure": Pair("interior", "", "--exposure 0.7"),
    "film_grain": Pair("interior_large", "--film-grain-amount 0.015", part=Part(420, 240, 1)),
    "fog": Pair("courtyard", "--fog-density 0.03", "--no-fog"),
    "frame_blend": Pair("embers", "--frame-blend"),
    "fxaa": Pair("courtyard_jagged", "--fxaa", "--no-fxaa", part=Part(210, 60)),
    "gamut_compression": Pair("street", "--color-grade-saturation 1.6 --gamut-compression", "--color-grade-saturation 1.6"),
    "gaussian_blur": Pair("street", "--gaussian-blur --gaussian-blur-radius 12"),
    "god_rays": Pair("courtyard_sun", "--god-rays-intensity 0.4 --god-rays-radius 0.4"),
    "grayscale": Pair("street", "--grayscale"),
    "halation": Pair("street", "--no-bloom --halation-intensity 0.4", "--no-bloom"),
    "high_pass": Pair("street", "--high-pass --high-pass-threshold 0.6", is_another=True),
    "hsv_adjust": Pair("interior", "--hsv-adjust --hsv-adjust-hue 110", is_another=True),
    "kawase_blur": Pair("street", "--kawase-blur"),
    "lens_dirt": Pair("street", "--lens-dirt-intensity 6"),
    "lens_distortion": Pair("courtyard", "--lens-distortion 0.2 --lens-distortion-dispersion 0.01"),
    "lens_flare": Pair("street", "--lens-flare-intensity 0.03"),
    "lut": Pair("interior", "--lut {film} --lut-space scene_linear --lut-result display --no-tonemap"),
    "motion_blur": Pair("pan", "--motion-blur"),
    "negative": Pair("interior", "--negative", is_another=True),
    "perturb": Pair("courtyard", "--perturb --perturb-strength 16,10,1,1.5"),
    "posterize": Pair("courtyard", "--posterize"),
    "radial_blur": Pair("street", "--radial-blur 0.4"),
    "recursive_blend": Pair("embers", "--recursive-blend --recursive-blend-weight 0.9"),
    "sharpen": Pair("interior", "--sharpen --sharpen-stops 0", part=Part(560, 300)),
    "smaa": Pair("courtyard_jagged", "--no-fxaa --smaa", "--no-fxaa", part=Part(210, 60)),
    "ssao": Pair("interior", "--ssao-intensity 1", "--no-ssao"),
    "taa": Pair("courtyard_gathered", "--taa --no-fxaa", "--no-fxaa", part=Part(210, 60)),
    "tonemap": Pair("forge", "", "--tonemap-curve linear"),
    "ui_chroma": Pair("street", f"{visor} --ui-chroma-strength 0.006", visor, part=Part(0, 540)),
    "ui_composite": Pair("street", visor),
    "ui_echo": Pair("street", f"{visor} --ui-echo-strength 0.4 --ui-echo-size 1.05", visor, part=Part(0, 540, 2)),
    "ui_warp": Pair("street", f"{visor} --ui-warp-strength -0.3", visor),
    "upscale": Pair("forge_small", "--output-size 1280x720 --upscale --sharpen", "--output-size 1280x720", part=Part(700, 440)),
    "vignette": Pair("interior", "--vignette-intensity 0.5"),
    "volumetric": Pair("dungeon", "", "--no-volumetric"),
    "blend": Pair("street", look=f'[[stack]]\neffect = "gaussian_blur"\nradius = 24\noutput = "soft"\n[[stack]]\n'
                  f'effect = "blend"\ninput = "scene"\nsecond = "soft"\nmode = "screen"\namount = 0.5\n{tail}'),
}


def pictures_of(effect):
    """Names of an effect's pictures off and on. Where off is the scene as its look has it, it is one for all."""
    pair = effects[effect]
    plain = f"effects/{pair.frame}.jpg"
    is_plain = not pair.part and not pair.look
    return tuple(plain if is_plain and not flags else f"effects/{effect}{end}.jpg"
                 for flags, end in ((pair.off, "_off"), (pair.on, "")))


# The visor by events of a fight.
interface = {
    "rest": ("health = 82", ""),
    "hit": ("health = 61, face_pain = true", ""),
    "echo": ("health = 82", "--ui-echo-strength 0.5 --ui-echo-size 1.06"),
    "additive": ("health = 82", "--ui-composite-additive 1"),
    "low_health": ("health = 4", ""),
}

windows = ("play", "edit", "add", "looks", "scopes", "compare", "images", "pixel")


def block_before(page, picture):
    """The last block of TOML before the picture: it shows what the page says."""
    text = (tree / page).read_text().split(picture)[0]
    return re.findall(r"^```toml\n(.*?)^```", text, re.M | re.S)[-1]


def shots():
    """Every picture that a look makes of a frame, by its path."""
    out = {
        "before.jpg": Shot("forge", look='[[stack]]\neffect = "encode"', width=960),
        "after.jpg": Shot("forge", look="", width=960),
        "soft.jpg": Shot("window", look=block_before("docs/looks.md", "soft.jpg")),
    }
    for order in ("documented", "scene_linear"):
        out[f"{order}.jpg"] = Shot("window", "--vignette-intensity 0.7", look=tree / f"looks/{order}.toml")
    for name, flags in {"stops": "--exposure 1ev", "agx": "--tonemap-curve agx",
                        "film": "--tonemap-curve agx --lut {print}"}.items():
        out[f"recipes/{name}.jpg"] = Shot("window", flags, look="", width=480)
    for name, pair in effects.items():
        off, on = pictures_of(name)
        out[off] = Shot(pair.frame, pair.off, pair.part, look=pair.look and tail)
        out[on] = Shot(pair.frame, pair.on, pair.part, look=pair.look)
    for look in sorted((tree / "looks").glob("*.toml")):
        for frame in ("street", "window"):
            out[f"looks/{look.stem}_{frame}.jpg"] = Shot(frame, "--time 0.7", look=look, width=480)
    fighting = re.sub("^game = .*", rf'\g<0>\ncontrollers = ["{tree}/controllers/combat.lua"]',
                      (tree / "looks/visor.toml").read_text().replace('"../', f'"{tree}/'), flags=re.M)
    for name, (game, flags) in interface.items():
        out[f"interface_{name}.jpg"] = Shot("street", f"--time 1 {flags}", look=fighting,
                                            events=f"[[event]]\ntime = 1.0\ngame = {{ {game} }}\n")
    return out


class LeftOut(Exception):
    """Why a picture cannot be made on this machine."""


class Window:
    """`edit` in a display of its own, whose mouse and keys xdotool moves."""

    def __init__(self, maker, size):
        self.maker, self.size, self.lines, self.processes = maker, size, [], []
        for tool in ("Xvfb", "openbox", "xdotool"):
            if not shutil.which(tool):
                raise LeftOut(f"{tool} is not installed")
        if not (maker.build / "lib/darkroom/darkroom_viewer").exists():
            raise LeftOut("darkroom_viewer is not built")
        self.room = maker.work / "window"
        self.room.mkdir(exist_ok=True)
        # Panels as they lie at first, whatever who calls this has made of them. The window's frame needs room, too.
        self.environment = os.environ | {"XDG_CONFIG_HOME": str(self.room / "config")}
        read, write = os.pipe()
        self.start("Xvfb", "-displayfd", write, "-screen", "0", f"{size[0] + 100}x{size[1] + 100}x24", "-nolisten", "tcp",
                   "-noreset", pass_fds=[write])
        self.environment["DISPLAY"] = f":{os.read(read, 16).decode().strip()}"
        self.start("openbox", "--sm-disable")

    def start(self, *command, **others):
        others = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL} | others
        self.processes.append(subprocess.Popen([str(word) for word in command], cwd=self.room, env=self.environment,
                                               text=True, **others))
        return self.processes[-1]

    def close(self):
        for process in reversed(self.processes):
            process.terminate()
            process.wait()

    def open(self, *arguments):
        self.viewer = self.start(self.maker.darkroom, "edit", *arguments, "--size", "{}x{}".format(*self.size), *device,
                                 "--commands", stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        Thread(target=lambda: self.lines.extend(self.viewer.stdout), daemon=True).start()
        self.wait_for("ready", 0)
        window = self.xdotool("search", "--onlyvisible", "--name", "Darkroom").split()[-1]
        self.xdotool("windowactivate", "--sync", window)
        self.moved = ["mousemove", "--window", window]

    def xdotool(self, *words):
        return self.maker.run("xdotool", *words, env=self.environment)

    def tell(self, command):
        """To the console."""
        self.viewer.stdin.write(command + "\n")
        self.viewer.stdin.flush()

    def count(self, text):
        return sum(text in line for line in self.lines)

    def wait_for(self, text, count):
        """Until the viewer has said it more than so many times; gives the last such line."""
        for _ in range(1200):
            if self.count(text) > count:
                return [line for line in self.lines if text in line][-1]
            time.sleep(0.1)
        sys.exit(f"the viewer does not say '{text}':\n{''.join(self.lines)}")

    def key(self, key, text):
        """Presses it, and waits for what it says."""
        before = self.count(text)
        self.xdotool("key", key)
        return self.wait_for(text, before)

    def frame(self):
        """One that has seen what the mouse did."""
        for _ in range(2):
            before = self.count("frames: ")
            self.tell("frames")
            self.wait_for("frames: ", before)

    def point(self, x, y):
        """At a part of the window's width and height."""
        self.xdotool(*self.moved, int(self.size[0] * x), int(self.size[1] * y))
        self.frame()

    def press(self):
        for way in ("mousedown", "mouseup"):
            self.xdotool(way, "1")
            self.frame()

    def place(self, widget):
        """Left, top, right and bottom: the console knows, once it is drawn."""
        for _ in range(600):
            self.tell(f"places {widget}")
            time.sleep(0.1)
            if self.count(f"place {widget} "):
                break
        return [int(number) for number in self.wait_for(f"place {widget} ", 0).split()[-4:]]

    def click(self, widget):
        left, top, right, bottom = self.place(widget)
        self.point((left + right) / 2 / self.size[0], (top + bottom) / 2 / self.size[1])
        self.press()

    def picture(self, out, cut):
        """When nothing is told any more. Without the status line: its times are those of this machine."""
        begin = time.monotonic()
        self.frame()
        time.sleep(3 + 5 * (time.monotonic() - begin))
        file = self.key("shift+F12", "stored darkroom-window-").split()[1]
        self.maker.jpeg(out, self.room / file, "--cut", cut)


class Maker:
    def __init__(self, build, work):
        self.build, self.work = build, work
        self.darkroom = str(build / "bin/darkroom")
        # Of light, as another look has it, and of code values, as on faded paper.
        self.tables = {name: work / f"{name}.cube" for name in ("film", "print")}

    def run(self, *command, **others):
        done = subprocess.run([str(word) for word in command], cwd=tree, capture_output=True, text=True, **others)
        if done.returncode != 0:
            sys.exit(f"{shlex.join(map(str, command))}:\n{done.stdout}{done.stderr}")
        return done.stdout

    def frame(self, name):
        """Renders a scene, and stores what the chain gets of it."""
        scene, *flags = shlex.split(frames[name])
        file = self.work / (f"{name}.####.exr" if "--frames" in flags else f"{name}.exr")
        size = [] if "--size" in flags else ["--size", "1280x720"]
        self.run(self.darkroom, "render", f"scenes/{scene}.scene.toml", *size, *flags, *device, "-q",
                 "--save-frame", file, "-o", file.with_suffix(".png"))

    def make_tables(self):
        self.run(self.darkroom, "lut", "export", "--color-grade-temperature", 4800, "--color-grade-saturation", 0.5,
                 "--color-grade-contrast", 1.3, "-o", self.tables["film"])
        self.tables["print"].write_text("LUT_1D_SIZE 3\n0.08 0.05 0.07\n0.55 0.49 0.43\n1 0.93 0.8\n")

    def shot(self, path, shot, out):
        whole = self.work / f"{path.replace('/', '.')}.png"
        given = {"--look": shot.look, "--events": shot.events}
        for flag, text in given.items():
            if isinstance(text, str) and text:
                given[flag] = whole.with_suffix(flag.replace("--", ".") + ".toml")
                given[flag].write_text(text if "format = 1" in text or flag == "--events" else f"format = 1\n{text}")
        flags = shlex.split(shot.flags.format(**self.tables))
        file, named = tree / "samples/window.exr", whole
        if shot.frame != "window":
            scene, *rest = shlex.split(frames[shot.frame])
            if given["--look"] is None:
                given["--look"] = tree / f"scenes/{scene}.scene.toml"
            file = self.work / f"{shot.frame}.exr"
            if "--frames" in rest:
                # Of a sequence it is the last one.
                number = int(rest[rest.index("--frames") + 1].split("-")[1])
                flags += ["--frames", number]
                file, named = file.with_suffix(".####.exr"), whole.with_suffix(".####.png")
                whole = whole.with_suffix(f".{number:04}.png")
        flags += [word for flag, value in given.items() if value for word in (flag, value)]
        self.run(self.darkroom, "develop", file, *flags, *device, "-q", "-o", named)
        cut = []
        if shot.part:
            scale, contrast = shot.part.scale, shot.part.contrast
            cut = ["--cut", f"{shot.width // scale}x{shot.width * 9 // 16 // scale}+{shot.part.x}+{shot.part.y}"]
            if contrast != 1:
                cut += ["--subc", "{TOP.AVGCOLOR}", "--mulc", contrast, "--addc", "0.5,0.5,0.5"]
        out.parent.mkdir(parents=True, exist_ok=True)
        self.jpeg(out, whole, *cut, "--resize:filter=box" if shot.part else "--resize", f"{shot.width}x{shot.width * 9 // 16}")
        whole.unlink()

    def jpeg(self, out, *arguments):
        # It would write down its command, and with it the folders of this machine.
        self.run("oiiotool", "--nosoftwareattrib", *arguments, "--eraseattrib", ".*", "-d", "uint8", "--attrib",
                 "jpeg:subsampling", "4:4:4", "--compression", "jpeg:85", "-o", out)

    def ssao_truth(self, place):
        """Of rays that a test traces."""
        self.run(self.build / "bin/darkroom_tests", "--gtest_filter=SoakGpuSsaoTruth.Strip",
                 env=os.environ | {"DARKROOM_PICTURES": str(place("ssao_truth.jpg").parent)})


    def review(self, place):
        """What `compare` shows of a picture that is no more what it was."""
        for name, flags in (("expected", []), ("now", ["--no-ssao"])):
            (self.work / name).mkdir()
            self.run(self.darkroom, "render", "scenes/forge.scene.toml", "--size", "384x216", *flags, *device, "-q",
                     "-o", self.work / name / "forge.png")
        self.run(self.darkroom, "compare", self.work / "expected", self.work / "now", "-q", "--sheet", self.work / "sheet.png")
        place("recipes/review.jpg").parent.mkdir(exist_ok=True)
        self.jpeg(place("recipes/review.jpg"), self.work / "sheet.png")

    def viewer(self, place):
        """`play`, and `edit` with what is clicked there."""
        size = (1280, 720)
        # Parts are as wide as a page, so that their letters stay as large.
        whole, add, middle = "1280x693+0+0", "706x546+0+38", "680x655+300+38"
        window = Window(self, size)
        try:
            # Whatever is told at the start is gone after two seconds.
            self.run(self.darkroom, "play", "scenes/street.scene.toml", "--size", "{}x{}".format(*size), *device, "--fps", 1,
                     "--frames", 4, "--window-screenshot", self.work / "play.png", env=window.environment)
            self.jpeg(place("viewer_play.jpg"), self.work / "play.png")
            window.open(tree / "scenes/street.scene.toml")
            window.key("p", "P pause: on")
            window.click("stack/bloom")
            window.point(0.5, 0.4)
            window.picture(place("viewer_edit.jpg"), whole)
            window.click("stack/add")
            # Each effect's picture is made when it is seen.
            time.sleep(20)
            window.picture(place("viewer_add.jpg"), add)
            window.xdotool("key", "Escape")
            window.click("stack/looks")
            time.sleep(20)
            window.picture(place("viewer_looks.jpg"), add)
            window.xdotool("key", "Escape")
            window.click("tab/Scopes")
            window.click("view/false_colors")
            window.point(0.5, 0.4)
            window.picture(place("viewer_scopes.jpg"), middle)
            window.click("view/false_colors")
            window.click("view/compare")
            window.point(0.4, 0.4)
            window.picture(place("viewer_compare.jpg"), middle)
            window.click("view/compare")
            window.click("tab/Pixel")
            window.point(0.57, 0.3)
            window.press()
            window.place("pixel/values")
            window.picture(place("viewer_pixel.jpg"), middle)
        finally:
            window.close()
        window = Window(self, size)
        try:
            look = self.work / "blurred.toml"
            look.write_text("format = 1\n" + "".join(
                f'[[stack]]\neffect = "{name}"\n' for name in ("motion_blur", "tonemap", "encode")))
            window.open(tree / "proof/lab/scenes/disocclusion.scene.toml", "--look", look, "--fps", 24, "--time", 1)
            window.key("p", "P pause: on")
            window.click("tab/Images")
            window.click("image/velocity/0")
            window.point(0.5, 0.4)
            window.picture(place("viewer_images.jpg"), middle)
        finally:
            window.close()

    def flips(self, reference, test, *flags):
        """The mean FLIP error of each pair of two folders, by its name."""
        done = subprocess.run(
            [str(word) for word in (self.darkroom, "compare", reference, test, "--json", *flags)], capture_output=True, text=True)
        if not done.stdout:
            sys.exit(done.stderr)
        return {Path(pair["test"]).name: pair["layers"][0]["flip"]["mean"] for pair in json.loads(done.stdout)["pairs"]}


def check(maker, made, paths):
    """What is wrong with the stored pictures, of which `made` has new ones, flat in one folder; and with pairs."""
    flat = lambda path: path.replace("/", ".")
    folders = {name: maker.work / name for name in ("stored", "off", "on")}
    for folder in folders.values():
        folder.mkdir()
    for path in paths:
        if (stored / path).exists():
            (folders["stored"] / flat(path)).symlink_to(stored / path)
    page = maker.build / "pictures.html"
    found = maker.flips(folders["stored"], made, "--fail-flip", allowed_error, "--html", page)
    wrong = [f"{path}: is not stored, or has another size" for path in paths if flat(path) not in found]
    wrong += [f"{path}: is not what the tree makes, by a FLIP error of {found[flat(path)]:.3f}: before and after: {page}"
              for path in paths if found.get(flat(path), 0) > allowed_error]
    for name in effects:
        off, on = pictures_of(name)
        if off in paths and on in paths:
            (folders["off"] / f"{name}.jpg").symlink_to(made / flat(off))
            (folders["on"] / f"{name}.jpg").symlink_to(made / flat(on))
    if any(folders["off"].iterdir()):
        for name, error in maker.flips(folders["off"], folders["on"]).items():
            if error < allowed_error:
                wrong.append(f"{name}: one cannot tell off from on, by a FLIP error of {error:.3f}: show a part of it")
            elif error > 0.4 and not effects[Path(name).stem].is_another:
                wrong.append(f"{name}: nobody would want so much of it: a FLIP error of {error:.3f}")
    return wrong


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--check", action="store_true")
    arguments.add_argument("--build", type=Path, default=tree / "build", metavar="FOLDER", help="of the build")
    arguments.add_argument("names", nargs="*", metavar="NAME")
    given = arguments.parse_args()
    begin = time.monotonic()
    os.environ.setdefault("XDG_RUNTIME_DIR", tempfile.gettempdir())
    # Tests validate every call; these are for the eye.
    os.environ.pop("DARKROOM_VALIDATE", None)

    def say(what):
        print(f"{time.monotonic() - begin:5.0f} s: {what}", flush=True)

    def is_wanted(path):
        return not given.names or any(fnmatch(path, name + "*") for name in given.names)

    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(os.cpu_count()) as pool:
        maker = Maker(given.build.resolve(), Path(folder))
        made = maker.work / "made"
        made.mkdir()
        wanted = {path: shot for path, shot in shots().items() if is_wanted(path)}

        def place(path):
            return made / path.replace("/", ".") if given.check else stored / path

        maker.make_tables()
        scenes = sorted({shot.frame for shot in wanted.values()} - {"window"})
        list(pool.map(maker.frame, scenes))
        say(f"{len(scenes)} frames are rendered")
        list(pool.map(lambda path: maker.shot(path, wanted[path], place(path)), wanted))
        say(f"{len(wanted)} pictures are developed")
        others = {("ssao_truth.jpg",): maker.ssao_truth,
                  ("recipes/review.jpg",): maker.review,
                  tuple(f"viewer_{name}.jpg" for name in windows): maker.viewer}
        for paths, make in others.items():
            if any(map(is_wanted, paths)):
                try:
                    make(place)
                    wanted |= dict.fromkeys(paths)
                    say(f"{', '.join(paths)}: made")
                except LeftOut as reason:
                    say(f"{', '.join(paths)}: left out: {reason}")
        if given.check:
            wrong = check(maker, made, list(wanted))
            print(*wrong, sep="\n")
            say(f"{len(wrong)} of {len(wanted)} pictures are wrong")
            sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
