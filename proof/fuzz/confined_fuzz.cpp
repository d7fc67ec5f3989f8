// SPDX-License-Identifier: MIT
// What the confined processes are handed: pictures as a frame is read, those of
// OpenEXR in every compression, and documents that are drawn. Such a process
// gives a picture or one line that says what is wrong with the input; one that
// ends or hangs is a finding, and so is a sound file that is not read after it.

#include <fmt/format.h>

#include <algorithm>

#include "fuzz/target.hpp"
#include "hud/svg_process.hpp"
#include "hud/svg_text.hpp"
#include "image/exr/write.hpp"
#include "image/frame/frame_file.hpp"

namespace darkroom::fuzz::confined_fuzz {
namespace {

std::string made(std::string_view compression, std::uint32_t width, std::uint32_t height, SampleKind kind) {
    std::vector<float> values(std::size_t{width} * height);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i % 11) / 5;
    ExrPart part{.header = exr_header(width, height, compression), .channels = {}};
    for (const char* const name : {"R", "G", "B", "Z"})
        part.channels.push_back({.name = name, .kind = kind, .values = values.data()});
    const Result<std::vector<std::byte>> bytes = encode_exr({&part, 1}, 1);
    return bytes ? std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size()) : std::string();
}

std::string wrong_end(const Error& error) {
    for (const char* const end : {"was ended", "took more than", "ended with code", "it takes more than"})
        if (error.text.find(end) != std::string::npos) return "a confined process is lost: " + error.text;
    return wrong_error(error);
}

std::string wrong_drawing(std::string_view document) {
    static SvgProcess process;
    constexpr std::uint32_t max_elements = 1000, width = 48, height = 27;
    if (const Result<> checked = check_svg(document, max_elements); !checked) return {};
    const Result<HudPicture> drawn = process.draw(document, width, height);
    if (!drawn) return wrong_end(drawn.error());
    return drawn->rgba.size() == std::size_t{4} * width * height ? std::string() : "a drawing has another size";
}

std::string wrong_frame(std::string_view content) {
    const MemoryFile file(content);
    const Result<FrameFile> frame = read_frame(file.path(), {.max_threads = 1});
    if (!frame) return wrong_end(frame.error());
    for (const std::string& warning : frame->warnings)
        if (std::string wrong = wrong_line(warning); !wrong.empty()) return wrong;
    const bool is_whole = frame->color.pixels.size() == std::size_t{4} * frame->color.width * frame->color.height;
    return is_whole ? std::string() : "a picture has other pixels than its size";
}

std::string run(std::string_view input) {
    static const MemoryFile sound(made("piz", 5, 3, SampleKind::Half));
    if (input.starts_with('<')) return wrong_drawing(input);
    if (std::string wrong = wrong_frame(input); !wrong.empty()) return wrong;
    const Result<FrameFile> after = read_frame(sound.path(), {.max_threads = 1});
    return after ? std::string() : "a sound file is refused: " + after.error().text;
}

std::vector<std::string> seeds() {
    std::vector<std::string> out = files("hud/*.svg");
    for (const std::string_view compression : {"rle", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"})
        for (const SampleKind kind : {SampleKind::Half, SampleKind::Float})
            out.push_back(made(compression, 19, 13, kind));
    for (const char* const pattern : {"data/malformed/openexr_damaged/*", "data/malformed/tinyexr_regression/*",
                                      "data/malformed/exr_oiio/*", "data/hostile/*.exr"})
        std::ranges::move(files(pattern), std::back_inserter(out));
    return out;
}

const Registration confined({.name = "confined", .run = run, .seeds = seeds, .longest = 8192, .max_mebibytes = 1100});

}  // namespace
}  // namespace darkroom::fuzz::confined_fuzz
