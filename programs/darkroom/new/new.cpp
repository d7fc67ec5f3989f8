// SPDX-License-Identifier: MIT
// darkroom new: an effect, a look or a scene to begin with, which works as it is written and says what can be changed.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <darkroom/custom_effect.hpp>
#include <darkroom/effect.hpp>
#include <filesystem>
#include <memory>
#include <span>

#include "core/files.hpp"
#include "core/text/param_text.hpp"
#include "programs/darkroom/commands.hpp"
#include "programs/darkroom/run/outputs.hpp"
#include "programs/darkroom/run/report.hpp"
#include "programs/darkroom/run/shell_text.hpp"
#include "programs/darkroom/run/shipped.hpp"

namespace app {

namespace {

using darkroom::printable;
using darkroom::Result;
using darkroom::user_error;

// NAME is the effect's, STRUCT that of its parameters in GLSL.
constexpr std::string_view effect_text =
    R"(// What a line that begins with @ says is in docs/custom_effects.md; `darkroom effects NAME.glsl` shows its page.
//
// @effect NAME: Tints the shadows of the picture.
// The pictures that it is meant for: scene_linear, display_linear or encoded.
// @accepts display_linear
// A parameter is a key of looks, a flag, a slider and a member of STRUCT. `amount`: at 0 the effect is off.
// @param float amount = 1 in [0, 1] amount: Share of the tint.
// @param float reach = 0.25 in [0.01, 1]: Luminance up to which shadows reach.
// @param rgb tint = 0.1, 0.3, 0.8 in [0, 4]: Colour of the shadows, linear.

// Functions beside the effect's own begin with its name.
float NAME_luminance(vec3 color) { return dot(color, vec3(0.2126, 0.7152, 0.0722)); }

// Of a pixel's colour another one. pixel.texel and pixel.uv say where it is.
vec4 NAME(vec4 color, Pixel pixel, STRUCT parameters) {
    float luminance = NAME_luminance(color.rgb);
    float share = parameters.amount * (1.0 - smoothstep(0.0, parameters.reach, luminance));
    return vec4(mix(color.rgb, luminance * parameters.tint, share), color.a);
}
)";

constexpr std::string_view look_text =
    R"(# What there is to write here: `darkroom effects`. What becomes of it: `darkroom plan NAME.toml`.
format = 1

[post_process]
# The order of light; "documented" is that of older looks, and of tables that name none.
order = "scene_linear"

# A multiplier: 2 is one stop brighter.
exposure = 1.2

# A table has effects of its own, which `darkroom plan NAME.toml` lists: occlusion, where frames bring depth. Frames of a
# path tracer have theirs in the light; take this line out for those of a game.
ssao_enabled = false

# A value above 0 switches the effect on, 0 switches it off.
bloom_intensity = 0.06
bloom_threshold = 1.0
vignette_intensity = 0.25

# How light becomes what a display can show: `darkroom effects tonemap` lists the curves.
tonemap_curve = "agx"
)";

constexpr std::string_view scene_text =
    R"(# Tables and keys are in docs/scenes.md. Lengths are metres, colours linear, times seconds.
format = 1

[scene]
name = "NAME"
grid = false

[camera]
position = [4, 2.5, 5]
target = [0, 0.6, 0]
fov = 40

[environment]
ambient_color = [0.25, 0.3, 0.4]
background = [0.05, 0.06, 0.08]

# The direction is toward the light.
[entities.sun.light]
direction = [1, 1.2, 0.6]
color = [1, 0.95, 0.85]
intensity = 3

[entities.floor]
bounds = { min = [-6, -0.1, -6], max = [6, 0, 6] }
material = { color = [0.45, 0.45, 0.45], roughness = 0.9 }

[entities.box]
bounds = { min = [-0.5, 0, -0.5], max = [0.5, 1, 0.5] }
material = { color = [0.8, 0.25, 0.1], roughness = 0.4 }
transform = { position = [-0.8, 0, 0], rotation = [0, 30, 0] }

# What is emissive glows, by the bloom below.
[entities.lamp]
bounds = { min = [-0.2, 0, -0.2], max = [0.2, 1.4, 0.2] }
material = { color = [1, 1, 1], emissive = [1, 0.7, 0.3], emissive_strength = 6 }
transform = { position = [1.1, 0, 0.3] }

# The look; --look FILE takes its place.
[post_process]
order = "scene_linear"
bloom_intensity = 0.08
tonemap_curve = "agx"
)";

struct Kind {
    std::string_view name, extension, text;
    std::string_view next;  ///< what one does with it
};
constexpr std::array kinds{
    Kind{"effect", ".glsl", effect_text, "darkroom develop {frame} --effect {file} -o picture.png"},
    Kind{"look", ".toml", look_text, "darkroom develop {frame} --look {file} -o picture.png"},
    Kind{"scene", ".scene.toml", scene_text, "darkroom render {file} -o picture.png"}};

std::string pascal(std::string_view name) {
    std::string out;
    bool is_first = true;
    for (const char c : name) {
        if (c != '_') out += is_first ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
        is_first = c == '_';
    }
    return out;
}

void replace_all(std::string& text, std::string_view what, std::string_view by) {
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
        text.replace(at, what.size(), by);
}

struct Options {
    std::string kind, name;
    bool is_forced = false;
};

Result<> check_effect(const std::string& name, const std::string& text) {
    if (darkroom::find_effect(name) != nullptr)
        return user_error(fmt::format("new effect {}: an effect of this name is built in", printable(name)));
    const Result<darkroom::CustomEffect> effect = darkroom::CustomEffect::parse(text, name);
    if (effect) return {};
    return user_error(
        fmt::format("new effect {}: a name is of lower-case letters, digits and single underscores, begins with a "
                    "letter, and is no name of GLSL",
                    printable(name)));
}

Result<> make(const Options& options) {
    const auto kind = std::ranges::find(kinds, options.kind, &Kind::name);
    if (kind == kinds.end())
        return user_error(fmt::format("new {}: allowed is effect, look or scene", printable(options.kind)));
    std::string file = options.name;
    if (!file.ends_with(kind->extension)) file += kind->extension;
    const std::string file_name = std::filesystem::path(file).filename().string();
    const std::string name = file_name.substr(0, file_name.size() - kind->extension.size());
    if (name.empty() || name.find_first_of("\"\\\n") != std::string::npos)
        return user_error(fmt::format("new {} {}: a name is needed", kind->name, printable(options.name)));
    std::string text(kind->text);
    replace_all(text, "NAME", name);
    replace_all(text, "STRUCT", pascal(name));
    if (kind->name == "effect") DARKROOM_TRY(check_effect(name, text));
    DARKROOM_TRY(check_folder(std::filesystem::path(file).parent_path(), MissingFolders::Refused));
    std::error_code error;
    if (std::filesystem::exists(file, error) && !options.is_forced)
        return user_error(fmt::format("{}: exists already; --force replaces it", printable(file)));
    DARKROOM_TRY(darkroom::write_file(file, std::as_bytes(std::span(text))));
    const std::filesystem::path name_of_sample = "samples/window.exr", shipped = shipped_file(name_of_sample);
    const std::string frame = std::filesystem::exists(name_of_sample, error) ? name_of_sample.string()
                              : shipped.empty()                              ? "frame.exr"
                                                                             : shipped.string();
    tell(fmt::format("{}: {}", printable(file),
                     fmt::format(fmt::runtime(kind->next), fmt::arg("frame", shell_quoted(printable(frame))),
                                 fmt::arg("file", shell_quoted(printable(file))))));
    return {};
}

}  // namespace

static Command add_new(CommandFlags program) {
    const CommandFlags command =
        program.add_command("new", "Writes an effect, a look or a scene to begin with, with comments");
    command.examples(
        "darkroom new effect tinted_shadows\n"
        "darkroom new look evening\n"
        "darkroom new scene room --force");
    const auto options = std::make_shared<Options>();
    command.add_option("KIND", options->kind, "effect, look or scene").required().option_text("effect|look|scene");
    command.add_option("NAME", options->name, "Name of the thing and of its file: NAME.glsl, .toml or .scene.toml")
        .required();
    command.add_flag("--force", options->is_forced, "Replaces a file that is there already");
    return {command, [options] {
                const Result<> done = make(*options);
                return done ? exit_ok : fail(done.error());
            }};
}

CommandRow new_command() {
    return {.names = {"new"}, .place = 120, .add = [](const CommandHost& host) {
                return std::vector{add_new(host.program)};
            }};
}

}  // namespace app
