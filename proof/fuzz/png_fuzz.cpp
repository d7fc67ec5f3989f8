// SPDX-License-Identifier: MIT
// The writer of PNG files: what it writes passes the check that stands before
// every decoder, and libpng reads the samples that went in.

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "formats/png/png_check.hpp"
#include "formats/png/png_source.hpp"
#include "formats/png/png_write.hpp"
#include "fuzz/target.hpp"

namespace darkroom::fuzz::png_fuzz {
namespace {

/// Of a sample, as a decoder gives it: 0..1.
float number(const std::vector<std::uint8_t>& samples, std::size_t at, std::size_t bytes) {
    if (bytes == 1) return static_cast<float>(samples[at]) / 255;
    std::uint16_t wide = 0;
    std::memcpy(&wide, &samples[2 * at], sizeof wide);
    return static_cast<float>(wide) / 65535;
}

std::string wrong_picture(PictureSource& source, const EncodeDesc& desc, const std::vector<std::uint8_t>& samples) {
    const FilePart& part = source.parts().front();
    if (part.width != desc.width || part.height != desc.height || part.channels.size() != desc.channels)
        return "it is read with another size";
    std::vector<float> read(std::size_t{desc.width} * desc.height * desc.channels);
    std::vector<SamplePlace> places;
    for (std::size_t i = 0; i < desc.channels; ++i)
        places.push_back(
            {.channel = i,
             .first = reinterpret_cast<std::byte*>(read.data() + i),
             .pixel_bytes = static_cast<std::ptrdiff_t>(desc.channels * sizeof(float)),
             .row_bytes = static_cast<std::ptrdiff_t>(std::size_t{desc.width} * desc.channels * sizeof(float))});
    if (const Result<> done = source.read_rows(0, 0, desc.height, places); !done) return done.error().text;
    for (std::size_t i = 0; i < read.size(); ++i)
        if (std::abs(read[i] - number(samples, i, size_of(desc.kind))) > 1e-6F)
            return fmt::format("sample {} is {}", i, read[i]);
    return {};
}

std::string run(std::string_view input) {
    if (input.size() < 4) return {};
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(input[i]); };
    EncodeDesc desc{.kind = byte(2) / 2 % 2 == 0 ? SampleKind::Integer8 : SampleKind::Integer16,
                    .width = 1u + byte(0),
                    .height = 1u + byte(1) % 64,
                    .channels = 3u + byte(2) % 2,
                    .color = (byte(2) & 4) != 0 ? std::optional(srgb_color) : std::nullopt};
    if ((byte(2) & 8) != 0) desc.color = byte(3) % 2 == 0 ? pq_color : p3_color;
    if ((byte(2) & 16) != 0) desc.compression = std::to_string(byte(3) % 13);
    // The rest again and again.
    std::vector<std::uint8_t> samples(std::size_t{desc.width} * desc.height * desc.channels * size_of(desc.kind));
    for (std::size_t i = 0; i < samples.size() && input.size() > 4; ++i) samples[i] = byte(4 + i % (input.size() - 4));
    desc.samples = samples.data();
    const Result<std::vector<std::byte>> file = encode_png(desc);
    if (!file) return file.error().text;
    const Result<std::vector<std::byte>> checked = check_png(*file);
    if (!checked) return "the check refuses it: " + checked.error().text;
    for (const std::span<const std::byte> seen :
         {std::span<const std::byte>(*file), std::span<const std::byte>(*checked)}) {
        if (seen.empty()) continue;
        const auto source = open_png(seen);
        if (!source) return source.error().text;
        if (std::string wrong = wrong_picture(**source, desc, samples); !wrong.empty()) return wrong;
    }
    return {};
}

std::vector<std::string> seeds() {
    std::vector<std::string> out;
    for (int i = 0; i < 32; ++i)
        out.push_back(std::string{static_cast<char>(7 * i), static_cast<char>(5 * i), static_cast<char>(i),
                                  static_cast<char>(i)} +
                      "some bytes");
    return out;
}

const Registration png({.name = "png", .run = run, .seeds = seeds, .longest = 512});

}  // namespace
}  // namespace darkroom::fuzz::png_fuzz
