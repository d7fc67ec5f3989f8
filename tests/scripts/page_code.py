# SPDX-License-Identifier: MIT
"""page_code.py TREE GENERATED C++COMPILER CCOMPILER BINDINGS: the C++ and the C of pages compile between what a host has, and what
pages quote stands in the file that they quote."""

import re
import subprocess
import sys
from pathlib import Path

COMPILED = ("README.md", "docs/embedding.md", "docs/interface.md", "docs/looks.md", "docs/console.md",
            "docs/controllers.md", "docs/temporal.md")
# Page, what its blocks begin with, and where they stand.
QUOTED = (("docs/embedding.md", "const auto device = darkroom::Device::adopt", "engine/gpu/device/adopt.cpp"),
          ("docs/embedding.md", "auto plan = composer.compile({.max_extent = {3840", "engine/compose/composer_run.cpp"),
          ("docs/embedding.md", "if (auto taken_back = composer.abandon()", "engine/compose/composer_run.cpp"),
          ("docs/embedding.md", "camera.depth = darkroom::DepthKind", "engine/plan/frame_inputs.cpp"),
          ("docs/embedding.md", "const auto duotone = darkroom::CustomEffect::load", "engine/custom/custom_effect.cpp"),
          ("docs/c.md", "DarkroomDevice device = NULL", "engine/c/usage.c"),
          ("docs/c.md", "DarkroomParameter intensity", "engine/c/usage.c"),
          ("docs/c.md", "for (uint32_t i = 0; i < darkroom_effect_count()", "engine/c/usage.c"),
          ("docs/embedding.md", "// Darkroom is told how the images are", "examples/embed.cpp"),
          ("docs/embedding.md", "// @effect duotone", "examples/duotone.glsl"),
          ("docs/hosts.md", "const DarkroomImage picture", "examples/swapchain.c"),
          ("docs/hosts.md", "const darkroom::Device", "examples/vma.cpp"),
          ("docs/hosts.md", "unsafe fn stack", "examples/ash.rs"),
          ("docs/hosts.md", "color.struct_size", "examples/cgo.go"),
          ("docs/hosts.md", "var adopt", "examples/Lwjgl.java"),
          ("docs/hosts.md", "let mut synchronization", "examples/wgpu.rs"),
          ("docs/embedding.md", "VkResult allocate", "examples/vma.cpp"),
          ("docs/custom_effects.md", "// @effect two_pass_blur", "examples/two_pass_blur.glsl"),
          ("docs/custom_effects.md", "// @effect histogram", "examples/histogram.glsl"),
          ("docs/custom_effects.md", "// @history trail", "examples/feedback_trail.glsl"),
          ("docs/tutorial.md", "struct Negative", "effects/negative/negative.hpp"),
          ("docs/tutorial.md", "constexpr auto negative_rows", "effects/negative/negative.cpp"),
          ("docs/tutorial.md", "vec4 negative", "effects/negative/negative.glsl"),
          ("docs/tutorial.md", "const EffectInfo& effect_info", "effects/negative/negative.cpp"))
HOST = """
#include <algorithm>
#include <bit>
#include <cstdio>
#include <darkroom/console.hpp>
#include <darkroom/controllers.hpp>
#include <darkroom/darkroom.hpp>
#include <darkroom/hud_inertia.hpp>
#include <darkroom/kernel_file.hpp>
#include <darkroom/look.hpp>
#include <darkroom/temporal_check.hpp>
namespace page {
struct Host : darkroom::AdoptDesc {};
struct Graph { template <class... Any> void barrier(const Any&...) {} };
template <class... Any> void report(const Any&...);
template <class... Any> void show(const Any&...);
template <class... Any> void save(const Any&...);
template <class T> T check(darkroom::Result<T>);
void log(const std::string&);
void draw_scene(const darkroom::Matrix&);
void draw_motion(const darkroom::Matrix&, const darkroom::Matrix&);
std::span<const std::uint32_t> words_of(const darkroom::Vec2&);
extern Host host;
extern Graph graph;
extern darkroom::Device device;
extern darkroom::Composer composer;
extern darkroom::Console console;
extern darkroom::HudInertia inertia;
extern darkroom::LogSink print;
extern const darkroom::Plan* plan;
extern darkroom::Handle bloom, encoded, warp;
extern darkroom::ImageRef target, hdr, interface, pixel, view, scene_color, mask, exposure_texel,
    color_before_glass_and_particles, depth, velocity;
extern darkroom::Camera camera;
extern darkroom::Light sun;
extern darkroom::CompileDesc desc, compile_desc;
extern darkroom::Frame frame;
extern darkroom::Look look;
extern darkroom::Matrix projection, previous_projection, previous_drawn_with;
extern std::span<const std::byte> kernels, bytes_of_the_file;
extern std::span<const float> depth_numbers, velocity_numbers;
extern std::array<float, 2> previous_jitter;
extern VkPhysicalDeviceFeatures available;
extern VkPhysicalDeviceFeatures2 features;
extern VkCommandBuffer commands;
extern VkExtent2D extent, output, scene, swapchain_extent;
extern VkImage swapchain_images[3];
extern VkImageView swapchain_views[3];
extern VkFormat swapchain_format;
extern VkImageUsageFlags usage;
extern VkSamplerCreateInfo sampler_info;
extern std::uint64_t frame_index;
extern std::int32_t x, y;
extern std::size_t index;
extern double seconds;
extern float dt, yaw_degrees, velocity_z;
extern bool is_on_ground, is_menu_open, is_cut;
"""
C_HOST = """
#include <darkroom/darkroom_load.h>
void report(const char*);
extern VkInstance instance;
extern VkPhysicalDevice gpu;
extern VkDevice vk_device;
extern uint32_t family;
extern VkPhysicalDeviceFeatures2 features;
extern DarkroomComposer composer;
extern DarkroomHandle bloom;
extern float pulse;
"""


def blocks_of(page):
    return re.findall(r"^```(\w+)\n(.*?)^```", page.read_text(), re.M | re.S)


def bare(text):
    return re.sub(r"\s+", "", re.sub(r"//.*", "", text))


def is_quoted(text, source):
    """Whether a file has what a page quotes; where the page leaves bodies out, its lines stand there in their order."""
    if "{ ... }" not in text:
        return bare(text) in bare(source)
    lines = iter(line.strip() for line in source.splitlines())
    wanted = [line.strip() for line in text.splitlines() if line.strip() and not line.startswith("// ...")]
    return all(any(line == want or line.startswith(want.removesuffix(" ... }")) and want.endswith(" ... }") for line in lines)
               for want in wanted)


def wrong_of(compiler, flags, folders, code):
    """What a compiler says of the code, if anything."""
    includes = [word for folder in folders for word in ("-I", folder)]
    run = subprocess.run([*compiler, *flags, "-fsyntax-only", *includes, "-"], input=code, capture_output=True,
                         text=True)
    return [run.stderr] if run.returncode else []


def functions_of(tree, page, kind):
    """The blocks of a page, each as a function."""
    out = []
    for number, (own, text) in enumerate(blocks_of(tree / page), 1):
        # Vma is not here; a fragment of an initializer is no statement.
        if own != kind or "Vma" in text or text.startswith("."):
            continue
        text = re.sub(r"^#include.*$", "", text, flags=re.M).replace(", ...}", "}")
        name = re.sub(r"\W", "_", page)
        out.append(f'void {name}_{number}(void) {{\n#line 1 "{page}, block {number}"\n{text}}}\n')
    return out


def main():
    if len(sys.argv) != 6:
        sys.exit(__doc__)
    tree, (generated, cpp, c, bindings) = Path(sys.argv[1]), sys.argv[2:]
    wrong = []
    for page, begin, source in QUOTED:
        quoted = [text for _, text in blocks_of(tree / page) if text.startswith(begin)]
        if not quoted or not is_quoted(quoted[0], (tree / source).read_text()):
            wrong.append(f"{page}: what begins with '{begin}' does not stand in {source}\n")
    folders = [f"{tree}/include", f"{generated}/include", f"{bindings}/include"]
    in_cpp = [block for page in COMPILED for block in functions_of(tree, page, "cpp")]
    in_c = functions_of(tree, "docs/c.md", "c")
    wrong += wrong_of([cpp, "-x", "c++"], ["-std=c++20", "-w"], folders, HOST + "".join(in_cpp) + "}\n")
    wrong += wrong_of([c, "-x", "c"], ["-std=c99", "-Werror=implicit-function-declaration"], folders, C_HOST + "".join(in_c))
    if len(in_cpp) < 25 or len(in_c) < 4:
        wrong.append(f"{len(in_cpp)} blocks of C++ and {len(in_c)} of C were found, 25 and 4 and more are there\n")
    print("".join(wrong), end="")
    sys.exit(1 if wrong else 0)

main()
