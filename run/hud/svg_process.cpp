// SPDX-License-Identifier: MIT
#include "hud/svg_process.hpp"

#include <fmt/format.h>

#include <cstring>
#include <string>
#include <string_view>

#include "confined/messages.hpp"
#include "confined/shared_memory.hpp"
#include "core/text/param_text.hpp"
#include "hud/svg_messages.hpp"

namespace darkroom {

namespace {

/// The layers of a document as large as budgets allow; beyond it librsvg ends the process.
constexpr std::uint64_t max_memory = std::uint64_t{4} << 30;

Failure failed(const Error& error) { return failure(Error{error.fault, fmt::format("drawing SVG: {}", error.text)}); }

}  // namespace

Result<HudPicture> SvgProcess::draw(std::string_view document, std::uint32_t width, std::uint32_t height) {
    const std::uint64_t pixels = std::uint64_t{width} * height;
    if (width == 0 || height == 0 || width > limits_.side || height > limits_.side || pixels > limits_.pixels)
        return user_error(fmt::format("a picture of {}x{}: allowed is [1, {}] a side, at most {} pixels", width, height,
                                      limits_.side, limits_.pixels));
    if (document.size() > limits_.document_bytes)
        return user_error(fmt::format("{} bytes: allowed are {}", document.size(), limits_.document_bytes));
    if (auto started = process_.start(); !started) return failed(started.error());
    process_.limit_memory(max_memory);
    // A drawing ends itself in time; a second more, and it hangs.
    process_.limit_wait(limits_.seconds + 1);

    const std::size_t size = pixels * 4;
    const Result<SharedMemory> memory = SharedMemory::make(size);
    if (!memory) return failed(memory.error());
    const SvgRequest request{static_cast<std::uint32_t>(document.size()), width, height, limits_.seconds};
    const int descriptor = memory->descriptor();
    SvgReply reply;
    std::string error;
    bool is_answered = process_.send(&request, sizeof request, {&descriptor, 1}) &&
                       process_.send(document.data(), document.size()) && process_.receive(&reply, sizeof reply) &&
                       reply.error_size <= max_error_bytes;
    if (is_answered) {
        error.resize(reply.error_size);
        is_answered = process_.receive(error.data(), error.size());
    }
    if (!is_answered) {
        process_.stop();
        return user_error(fmt::format("it takes more than {} s or too much memory to draw", limits_.seconds));
    }
    // A second line quotes the document's bytes.
    if (!error.empty()) return user_error(printable(std::string_view(error).substr(0, error.find('\n'))));

    const Mapping drawn(memory->descriptor(), size, false);
    if (drawn.bytes().empty()) return failed(Error{Fault::Machine, "no room for a picture"});
    HudPicture picture{width, height, std::vector<std::uint8_t>(size)};
    std::memcpy(picture.rgba.data(), drawn.bytes().data(), size);
    return picture;
}

}  // namespace darkroom
