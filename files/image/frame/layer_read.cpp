// SPDX-License-Identifier: MIT
#include "image/frame/layer_read.hpp"

#include <Imath/half.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <vector>

#include "image/frame/frame_file.hpp"

namespace darkroom {
namespace {

/// Copies of one component of a layer over another: grey is red, green and blue.
struct Repeat {
    const LayerPlace* layer = nullptr;
    std::uint32_t from = 0, to = 0;
};

void repeat(const Repeat& what, std::size_t pixels) {
    const std::size_t size = size_of(what.layer->kind), pixel = size * what.layer->components;
    std::byte* at = what.layer->plane;
    for (std::size_t i = 0; i < pixels; ++i, at += pixel) std::memcpy(at + what.to * size, at + what.from * size, size);
}

bool is_inside_display(const FilePart& part) {
    return part.x >= 0 && part.y >= 0 &&
           std::uint64_t{part.width} + static_cast<std::uint32_t>(part.x) <= part.display_width &&
           std::uint64_t{part.height} + static_cast<std::uint32_t>(part.y) <= part.display_height;
}

// `places` are those of the display window's first pixel. OpenEXR needs no room of its own and is given all rows.
Result<> read_inside(Decoder& decoder, std::size_t number, std::vector<SamplePlace> places) {
    const FilePart& part = decoder.parts()[number];
    for (SamplePlace& place : places) place.first += part.y * place.row_bytes + part.x * place.pixel_bytes;
    const std::uint32_t band = &decoder.format() == &exr_format()
                                   ? part.height
                                   : decoder.band_rows(number, part.width * part.channels.size() * sizeof(float));
    for (std::uint32_t row = 0; row < part.height; row += band) {
        const std::uint32_t rows = std::min(band, part.height - row);
        DARKROOM_TRY(decoder.read_rows(number, row, rows, places));
        for (SamplePlace& place : places) place.first += static_cast<std::ptrdiff_t>(rows) * place.row_bytes;
    }
    return {};
}

// By way of bands as wide as the data window.
Result<> read_cropped(Decoder& decoder, std::size_t number, std::span<const SamplePlace> places) {
    const FilePart& part = decoder.parts()[number];
    const std::int64_t left = std::max<std::int64_t>(0, -std::int64_t{part.x});
    const std::int64_t right = std::min<std::int64_t>(part.width, std::int64_t{part.display_width} - part.x);
    const std::size_t row_bytes = std::size_t{part.width} * sizeof(float);
    const std::uint32_t band = decoder.band_rows(number, row_bytes * places.size());
    std::vector<std::vector<std::byte>> bands(places.size(), std::vector<std::byte>(row_bytes * band));
    std::vector<SamplePlace> into(places.begin(), places.end());
    for (std::size_t i = 0; i < into.size(); ++i) {
        into[i].first = bands[i].data();
        into[i].pixel_bytes = sizeof(float);
        into[i].row_bytes = static_cast<std::ptrdiff_t>(row_bytes);
    }
    for (std::uint32_t row = 0; row < part.height; row += band) {
        const std::uint32_t rows = std::min(band, part.height - row);
        DARKROOM_TRY(decoder.read_rows(number, row, rows, into));
        for (std::size_t i = 0; i < places.size(); ++i)
            for (std::uint32_t r = 0; r < rows; ++r) {
                const std::int64_t y = std::int64_t{row} + r + part.y;
                if (y < 0 || y >= part.display_height) continue;
                const std::byte* from =
                    bands[i].data() + r * row_bytes + static_cast<std::size_t>(left) * sizeof(float);
                std::byte* to = places[i].first + y * places[i].row_bytes + (left + part.x) * places[i].pixel_bytes;
                for (std::int64_t x = left; x < right; ++x, from += sizeof(float), to += places[i].pixel_bytes)
                    std::memcpy(to, from, size_of(places[i].kind));
            }
    }
    return {};
}

}  // namespace

// All parts of an OpenEXR file should have one display window; a plane of another size than the picture has no meaning.
Result<> check_layer(const FilePart& part, const ChannelSet& set, std::uint32_t components, std::string_view what,
                     std::uint32_t width, std::uint32_t height) {
    if (part.display_width != width || part.display_height != height)
        return user_error(fmt::format("{} is {}x{}, the color is {}x{}; one display window is needed", what,
                                      part.display_width, part.display_height, width, height));
    for (std::uint32_t i = 0; i < components; ++i) {
        if (set.channels[i] < 0) continue;
        const auto channel = static_cast<std::size_t>(set.channels[i]);
        if (part.kinds[channel] == SampleKind::Integer32)
            return user_error(fmt::format("channel {} for {} has 32-bit integers; half or float is needed",
                                          one_printable_line(part.channels[channel]), what));
    }
    return {};
}

Result<> read_layers(Decoder& decoder, std::span<const LayerPlace> layers) {
    // A channel has one place in a reading; whoever else wants it comes in the next, but for repeats within a layer.
    std::map<std::size_t, std::vector<std::vector<SamplePlace>>> readings;  // by part
    std::vector<Repeat> repeats;
    for (const LayerPlace& layer : layers) {
        const FilePart& part = decoder.parts()[layer.source.part];
        const auto size = static_cast<std::ptrdiff_t>(size_of(layer.kind));
        for (std::uint32_t i = 0; i < std::min(layer.components, layer.read); ++i) {
            const int channel = layer.source.channels[i];
            if (channel < 0) continue;
            const auto before = std::find(layer.source.channels.begin(), layer.source.channels.begin() + i, channel);
            if (before != layer.source.channels.begin() + i) {
                repeats.push_back({&layer, static_cast<std::uint32_t>(before - layer.source.channels.begin()), i});
                continue;
            }
            const SamplePlace place{
                .channel = static_cast<std::size_t>(channel),
                .kind = layer.kind,
                .first = layer.plane + i * size,
                .pixel_bytes = size * layer.components,
                .row_bytes = size * layer.components * static_cast<std::ptrdiff_t>(part.display_width)};
            auto& of_part = readings[layer.source.part];
            const auto is_free = [&](const std::vector<SamplePlace>& reading) {
                return std::ranges::none_of(reading, [&](const SamplePlace& p) { return p.channel == place.channel; });
            };
            auto reading = std::find_if(of_part.begin(), of_part.end(), is_free);
            if (reading == of_part.end()) reading = of_part.insert(of_part.end(), std::vector<SamplePlace>{});
            reading->push_back(place);
        }
    }
    for (const auto& [part, of_part] : readings)
        for (const std::vector<SamplePlace>& places : of_part) {
            DARKROOM_TRY(is_inside_display(decoder.parts()[part]) ? read_inside(decoder, part, places)
                                                                  : read_cropped(decoder, part, places));
        }
    for (const Repeat& what : repeats) {
        const FilePart& part = decoder.parts()[what.layer->source.part];
        repeat(what, std::size_t{part.display_width} * part.display_height);
    }
    return {};
}

void widen(FrameFile& frame) {
    const auto take = [](std::vector<std::uint16_t>& from, std::size_t kept, std::size_t of, std::vector<float>& to) {
        if (from.empty()) return;
        to.resize(from.size() / of * kept);
        for (std::size_t i = 0; i < to.size(); ++i) to[i] = imath_half_to_float(from[i / kept * of + i % kept]);
        from = {};
    };
    take(frame.halves.color, 4, 4, frame.color.pixels);
    if (frame.normals) take(frame.halves.normals, 3, 4, frame.normals->values);
    if (frame.velocity) take(frame.halves.velocity, 2, 2, frame.velocity->values);
}

Result<std::optional<double>> read_frame_time(const std::filesystem::path& path, const LayerNames& names) {
    DARKROOM_TRY_VALUE(const auto decoder, Decoder::open(path));
    DARKROOM_TRY_VALUE(const auto found, find_channels(decoder.parts(), names));
    const std::optional<double> time = decoder.number(found.color.part, "darkroom:time");
    return time && std::isfinite(*time) ? time : std::nullopt;
}

}  // namespace darkroom
