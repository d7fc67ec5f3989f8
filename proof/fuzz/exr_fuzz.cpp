// SPDX-License-Identifier: MIT
// OpenEXR files as frames are read: structure, header, and chunks that are not
// packed or by ZIP, all in the program itself. Chunks of other compressions are
// a confined process's.

#include <fmt/format.h>

#include <algorithm>

#include "formats/exr/exr_check.hpp"
#include "formats/exr/exr_source.hpp"
#include "fuzz/target.hpp"
#include "image/exr/write.hpp"

namespace darkroom::fuzz::exr_fuzz {
namespace {

constexpr std::uint64_t max_samples = 1 << 20;
constexpr std::byte untouched{0xa5};

/// All rows of some channels, between two rows that nobody may touch.
std::string wrong_rows(PictureSource& source, std::size_t number) {
    const FilePart& part = source.parts()[number];
    if (part.kinds.size() != part.channels.size()) return "a part has other kinds than channels";
    const std::size_t channels = std::min<std::size_t>(part.channels.size(), 5);
    if (std::uint64_t{part.width} * part.height * channels > max_samples) return {};
    const std::size_t pixel = channels * sizeof(float), row = pixel * part.width;
    std::vector<std::byte> memory(row * (part.height + std::size_t{2}), untouched);
    std::vector<SamplePlace> places;
    for (std::size_t i = 0; i < channels; ++i)
        places.push_back({.channel = i,
                          .kind = SampleKind::Float,
                          .first = memory.data() + row + i * sizeof(float),
                          .pixel_bytes = static_cast<std::ptrdiff_t>(pixel),
                          .row_bytes = static_cast<std::ptrdiff_t>(row)});
    const std::uint32_t half = part.height / 2;
    for (const auto& [first, count] : {std::pair(0u, part.height), std::pair(half, part.height - half)}) {
        std::vector<SamplePlace> here = places;
        for (SamplePlace& place : here) place.first += first * row;
        if (const Result<> done = source.read_rows(number, first, count, here); !done)
            if (std::string wrong = wrong_error(done.error()); !wrong.empty()) return wrong;
    }
    const std::span<const std::byte> all = memory;
    const auto is_untouched = [](std::byte b) { return b == untouched; };
    return std::ranges::all_of(all.first(row), is_untouched) && std::ranges::all_of(all.last(row), is_untouched)
               ? std::string()
               : "rows are written that were not asked for";
}

std::string run(std::string_view input) {
    if (const Result<> checked = check_exr(bytes_of(input)); !checked) return wrong_error(checked.error());
    try {
        const auto source = ExrSource::open(
            bytes_of(input), 1, [] { return Result<std::unique_ptr<PictureSource>>(user_error("not here")); });
        if (!source) return wrong_error(source.error());
        for (std::size_t i = 0; i < (*source)->parts().size(); ++i) {
            for (const std::string& name : (*source)->attributes(i)) static_cast<void>((*source)->numbers(i, name));
            if (std::string wrong = wrong_rows(**source, i); !wrong.empty()) return wrong;
        }
    } catch (const std::exception&) {
        // What OpenEXR says of a file; picture_source.cpp takes it for an error.
    }
    return {};
}

std::string made(std::uint32_t width, std::uint32_t height, std::string_view compression, std::size_t parts,
                 SampleKind kind) {
    std::vector<float> values(std::size_t{width} * height);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i % 7) / 3;
    std::vector<ExrPart> all;
    for (std::size_t i = 0; i < parts; ++i) {
        ExrPart& part = all.emplace_back(ExrPart{.header = exr_header(width, height, compression), .channels = {}});
        if (parts > 1) part.header.setName(fmt::format("part{}", i));
        for (const char* const name : {"R", "G", "B", "Z", "diffuse.R"})
            part.channels.push_back({.name = name, .kind = kind, .values = values.data()});
    }
    const Result<std::vector<std::byte>> bytes = encode_exr(all, 1);
    return bytes ? std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size()) : std::string();
}

std::vector<std::string> seeds() {
    std::vector<std::string> out;
    for (const std::string_view compression : {"none", "zips", "zip", "piz"})
        for (const SampleKind kind : {SampleKind::Half, SampleKind::Float}) {
            out.push_back(made(9, 5, compression, 1, kind));
            out.push_back(made(3, 20, compression, 2, kind));
        }
    for (const char* const pattern : {"data/malformed/openexr_damaged/*", "data/malformed/tinyexr_regression/*",
                                      "data/malformed/exr_oiio/*", "data/hostile/*.exr", "data/exr/*.exr"})
        std::ranges::move(files(pattern), std::back_inserter(out));
    return out;
}

const Registration exr({.name = "exr", .run = run, .seeds = seeds, .longest = 8192, .max_mebibytes = 1100});

}  // namespace
}  // namespace darkroom::fuzz::exr_fuzz
