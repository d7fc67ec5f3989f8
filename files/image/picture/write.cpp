// SPDX-License-Identifier: MIT
#include "image/picture/write.hpp"
#include "image/color/configuration.hpp"

#include <OpenEXR/ImfStandardAttributes.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "core/assert.hpp"
#include "core/files.hpp"
#include "core/own_file.hpp"
#include "core/text/lower.hpp"
#include "formats/jpeg/gain_map_write.hpp"
#include "formats/jpeg/jpeg_source.hpp"
#include "image/codec/codecs.hpp"
#include "image/exr/write.hpp"
#include "image/picture/alpha.hpp"

namespace darkroom {
namespace {

Result<> check_size(const std::filesystem::path& path, const FileFormat& format, std::uint32_t width,
                    std::uint32_t height) {
    const std::uint32_t most = format.max_side;
    if (width >= 1 && height >= 1 && width <= most && height <= most) return {};
    return user_error(fmt::format("{}: a picture of {}x{}; [1, {}] a side is allowed in {}", path.string(), width,
                                  height, most, format.name));
}

template <class T>
std::vector<T> integers(const Picture& picture, std::uint32_t channels) {
    constexpr float largest = std::numeric_limits<T>::max();
    std::vector<T> values;
    values.reserve(picture.pixels.size() / 4 * channels);
    for (std::size_t i = 0; i < picture.pixels.size(); i += 4)
        for (std::uint32_t c = 0; c < channels; ++c) {
            const float value = picture.pixels[i + c];
            // The order of the comparison sends NaN to 0.
            const float clamped = value > 0 ? std::min(value, 1.0f) : 0.0f;
            values.push_back(static_cast<T>(clamped * largest + 0.5f));
        }
    return values;
}

std::vector<float> floats(const Picture& picture, std::uint32_t channels, float smallest, float largest) {
    std::vector<float> values;
    values.reserve(picture.pixels.size() / 4 * channels);
    for (std::size_t i = 0; i < picture.pixels.size(); i += 4)
        for (std::uint32_t c = 0; c < channels; ++c) {
            const float value = picture.pixels[i + c];
            values.push_back(std::isnan(value) ? 0.0f : std::clamp(value, smallest, largest));
        }
    return values;
}

Result<> check_coding(const std::filesystem::path& path, const FileFormat& format, const WriteOptions& options) {
    if (options.quality && !format.has_quality)
        return user_error(fmt::format("{}: {} has no quality; .jpg has", path.string(), format.name));
    if (options.quality && (*options.quality < 1 || *options.quality > 100))
        return user_error(
            fmt::format("{}: a JPEG quality of {}; [1, 100] is allowed", path.string(), *options.quality));
    if (!options.chroma.empty() && !format.has_quality)
        return user_error(fmt::format("{}: {} has no chroma of its own; .jpg has", path.string(), format.name));
    constexpr std::array<std::string_view, 3> chromas{"4:4:4", "4:2:2", "4:2:0"};
    if (!options.chroma.empty() && std::ranges::find(chromas, options.chroma) == chromas.end())
        return user_error(fmt::format("{}: chroma {} in JPEG; allowed: {}", path.string(),
                                      one_printable_line(options.chroma), fmt::join(chromas, ", ")));
    const std::span<const std::string_view> known = format.compressions;
    if (options.compression.empty() || std::ranges::find(known, options.compression) != known.end()) return {};
    return user_error(fmt::format("{}: compression {} in {}; allowed: {}", path.string(),
                                  one_printable_line(options.compression), format.name,
                                  known.empty() ? "none can be chosen" : fmt::format("{}", fmt::join(known, ", "))));
}

Result<> check_space(const std::filesystem::path& path, const FileFormat& format, SampleKind samples,
                     const WriteOptions& options) {
    if (!options.space) return {};
    const std::string_view name = options.space->name;
    if (options.view)
        return user_error(fmt::format("{}: {} cannot be given with a view of a display, which has its own space",
                                      path.string(), name));
    if (!format.has_color_space && name != "srgb")
        return user_error(
            fmt::format("{}: {} cannot be marked as {}; {} can", path.string(), format.name, name,
                        written_extensions([](const FileFormat& other) { return other.has_color_space; })));
    if (samples == SampleKind::Integer8 && (name == "pq" || name == "hlg"))
        return user_error(fmt::format("{}: {} in 8 bits shows steps (ITU-R BT.2100 asks for 10); --bits 16 is allowed",
                                      path.string(), name));
    if (color_of(options, samples)) return {};
    return user_error(fmt::format("{}: {} in {} samples; allowed: {}", path.string(), name, name_of(samples),
                                  output_space_names_of(is_integer(samples))));
}

}  // namespace

std::optional<ColorState> color_of(const WriteOptions& options, SampleKind samples) {
    if (!options.space) return std::nullopt;
    return is_integer(samples) ? options.space->integers : options.space->floats;
}

Result<const FileFormat*> written_format(const std::filesystem::path& path) {
    const std::string extension = lower(path.extension().string());
    for (const FileFormat* const format : all_formats())
        if (!format->samples.empty() && std::ranges::find(format->extensions, extension) != format->extensions.end())
            return format;
    return user_error(fmt::format("{}: {}; {} can be written", path.string(),
                                  extension.empty() ? "no extension" : fmt::format("unknown extension {}", extension),
                                  written_extensions()));
}

Result<SampleKind> sample_kind(const std::filesystem::path& path, const WriteOptions& options) {
    DARKROOM_TRY_VALUE(const FileFormat* const format, written_format(path));
    if (options.alpha && !format->has_alpha)
        return user_error(fmt::format("{}: {} has no alpha; {} have", path.string(), format->name,
                                      written_extensions([](const FileFormat& other) { return other.has_alpha; })));
    DARKROOM_TRY(check_coding(path, *format, options));
    SampleKind samples = options.samples.value_or(format->samples.front());
    // Eight bits show steps where the codes reach further than sRGB's.
    if (!options.samples && samples == SampleKind::Integer8 && format->has_color_space && options.space &&
        options.space->integers != srgb_color)
        samples = SampleKind::Integer16;
    DARKROOM_TRY(check_space(path, *format, samples, options));
    if (options.view && !is_integer(samples))
        return user_error(fmt::format(
            "{}: {} samples hold light, not a view of a display; {} hold one", path.string(), name_of(samples),
            written_extensions([](const FileFormat& other) { return is_integer(other.samples.front()); })));
    if (std::ranges::find(format->samples, samples) != format->samples.end()) return samples;
    std::string allowed;
    for (const SampleKind known : format->samples)
        allowed += (allowed.empty() ? "" : ", ") + std::string(name_of(known));
    return user_error(
        fmt::format("{}: {} samples in {}; allowed: {}", path.string(), name_of(samples), format->name, allowed));
}

namespace {

/// What a path and options ask for, checked: an EncodeDesc but for the samples.
struct Written {
    const FileFormat* format = nullptr;
    EncodeDesc desc;
    std::shared_ptr<const Picture> light;  ///< WriteOptions::light
    bool follows_links = true;             ///< as there
};

/// A map as good as the picture, which makes up for what the picture has lost in JPEG.
Result<std::vector<std::byte>> with_gain_map(const Written& to, std::span<const std::byte> base, const Codecs& others) {
    DARKROOM_TRY_VALUE(const std::vector<float> light, light_of_jpeg(base));
    const MadeGainMap map = make_gain_map(light, to.light->pixels);
    EncodeDesc desc = to.desc;
    desc.samples = map.codes.data();
    DARKROOM_TRY_VALUE(const std::vector<std::byte> picture, others.encode(*to.format, desc));
    return join_gain_map(base, picture, map);
}

/// Samples of 8 or 16 bits, or floats, into any format but OpenEXR.
Result<> write_samples(const std::filesystem::path& path, const Written& to) {
    const auto encode = [&]() -> Result<std::vector<std::byte>> {
        if (to.format->encode != nullptr) return to.format->encode(to.desc);
        DARKROOM_TRY_VALUE(const Codecs* const others, codecs());
        if (!to.light) return others->encode(*to.format, to.desc);
        DARKROOM_TRY_VALUE(const std::vector<std::byte> base, others->encode(*to.format, to.desc));
        return with_gain_map(to, base, *others);
    };
    const auto bytes = encode();
    if (!bytes) return failure({bytes.error().fault, fmt::format("{}: {}", path.string(), bytes.error().text)});
    return to.follows_links ? write_file(path, *bytes) : write_own_file(path, *bytes, FileOwner::Anyone);
}

void add_channels(const KeptLayers::Part& from, ExrPart& to) {
    for (const KeptLayers::Channel& channel : from.channels)
        to.channels.push_back(
            {.name = channel.name, .kind = channel.kind, .values = channel.values.data(), .is_clamped = false});
}

/// The picture's part among those of the frame, in their order. What its compression would change is in a part beside
/// it.
Result<std::vector<ExrPart>> with_layers(const std::filesystem::path& path, const Picture& picture,
                                         const KeptLayers& layers, ExrPart part) {
    if (layers.width != picture.width || layers.height != picture.height)
        return user_error(
            fmt::format("{}: the layers of the frame are {}x{}, the picture {}x{}; they are kept at their size",
                        path.string(), layers.width, layers.height, picture.width, picture.height));
    for (ExrChannel& channel : part.channels) channel.name.insert(0, layers.color_prefix);
    const auto is_changed = [&](const KeptLayers::Channel& channel) {
        return is_changed_by(part.header.compression(), channel.name, channel.kind);
    };
    const auto is_taken = [&](const std::string& name) {
        return std::ranges::find(layers.parts, name, &KeptLayers::Part::name) != layers.parts.end();
    };
    const auto header_of = [&](const KeptLayers::Part& kept, bool is_lossless) {
        Imf::Header header = exr_header(picture.width, picture.height);
        if (!is_lossless) header.compression() = part.header.compression();
        const auto [x, y, width, height] = kept.window;
        const Imath::V2i first(x, y), size(static_cast<int>(width), static_cast<int>(height));
        header.dataWindow() = {first, first + size - Imath::V2i(1)};
        if (kept.attributes) kept.attributes->add_to(header);
        if (!kept.views.empty()) Imf::addMultiView(header, kept.views);
        return header;
    };
    std::vector<ExrPart> out;
    for (std::size_t i = 0; i < layers.parts.size(); ++i) {
        const KeptLayers::Part& kept = layers.parts[i];
        const bool is_lossless = std::ranges::any_of(kept.channels, is_changed);
        ExrPart* to = nullptr;
        if (i == layers.color_part) {
            if (!kept.views.empty()) Imf::addMultiView(part.header, kept.views);
            if (kept.attributes && !kept.channels.empty()) kept.attributes->add_cryptomatte_to(part.header);
            to = &out.emplace_back(part);
            to->header.setName(kept.name.empty() ? "picture" : kept.name);
        }
        if (to == nullptr || is_lossless) {
            if (kept.channels.empty()) continue;
            std::string name = kept.name;
            if (to != nullptr) {
                name = kept.name.empty() ? "layers" : kept.name + ".layers";
                while (is_taken(name)) name += "_";
            }
            to = &out.emplace_back(ExrPart{.header = header_of(kept, is_lossless)});
            to->header.setName(name);
        }
        add_channels(kept, *to);
    }
    if (out.size() == 1) out.front().header.erase("name");
    return out;
}

Result<> write_floats(const std::filesystem::path& path, const Picture& picture, SampleKind samples,
                      const WriteOptions& options) {
    ExrPart part{.header = exr_header(picture.width, picture.height, options.compression)};
    if (options.display) {
        const auto [x, y, width, height] = *options.display;
        const Imath::V2i first(-x, -y), size(static_cast<int>(width), static_cast<int>(height));
        part.header.dataWindow() = {first, first + part.header.dataWindow().max};
        part.header.displayWindow() = {{0, 0}, size - Imath::V2i(1)};
    }
    const std::optional<ColorState> color = color_of(options, samples);
    add_primaries(part.header, color ? chromaticities_of(color->primaries) : Chromaticities{});
    if (options.attributes) options.attributes->add_to(part.header, options.is_cropped, options.is_stretched);
    constexpr std::array names{"R", "G", "B", "A"};
    for (std::size_t c = 0; c < (options.alpha ? 4 : 3); ++c)
        part.channels.push_back({.name = names[c], .kind = samples, .values = picture.pixels.data() + c, .stride = 4});
    const auto write = [&](std::span<const ExrPart> parts) {
        return write_exr(path, parts, options.max_threads, options.follows_links);
    };
    if (!options.layers) return write({&part, 1});
    const Result<std::vector<ExrPart>> parts = with_layers(path, picture, *options.layers, std::move(part));
    return parts ? write(*parts) : failure(parts.error());
}

Result<Written> describe(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height,
                         const WriteOptions& options) {
    DARKROOM_TRY_VALUE(const auto samples, sample_kind(path, options));
    const FileFormat& format = **written_format(path);
    DARKROOM_TRY(check_size(path, format, width, height));
    Written out{.format = &format,
                .desc = {.kind = samples,
                         .width = width,
                         .height = height,
                         .channels = options.alpha ? 4U : 3U,
                         .quality = options.quality,
                         .chroma = options.chroma,
                         .is_associated = options.alpha && !is_integer(samples),
                         .compression = options.compression,
                         .color = color_of(options, samples)},
                .light = options.light,
                .follows_links = options.follows_links};
    if (!options.space && options.view == nullptr) out.desc.color = srgb_color;
    return out;
}

}  // namespace

std::uint64_t clamped_by_compression(const std::filesystem::path& path, const Picture& picture,
                                     const WriteOptions& options) {
    const auto format = written_format(path);
    if (!format || *format != &exr_format() || !options.compression.starts_with("dwa")) return 0;
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < picture.pixels.size(); i += 4)
        count += std::any_of(&picture.pixels[i], &picture.pixels[i + 3],
                             [](float value) { return std::abs(value) > largest_in_dwa; });
    return count;
}

Result<> write_picture(const std::filesystem::path& path, const Picture& picture, const WriteOptions& options) {
    DARKROOM_ASSERT(picture.pixels.size() == std::size_t{picture.width} * picture.height * 4);
    DARKROOM_TRY_VALUE(Written to, describe(path, picture.width, picture.height, options));
    EncodeDesc& desc = to.desc;
    if (to.format == &exr_format()) return write_floats(path, picture, desc.kind, options);
    const auto write = [&](const auto& samples) {
        desc.samples = samples.data();
        return write_samples(path, to);
    };
    const auto write_integers = [&](const Picture& encoded) {
        return desc.kind == SampleKind::Integer8 ? write(integers<std::uint8_t>(encoded, desc.channels))
                                                 : write(integers<std::uint16_t>(encoded, desc.channels));
    };
    const bool makes_alpha = options.has_alpha_of_glow && is_integer(desc.kind);
    if (options.view || makes_alpha) {
        Picture made = picture;
        if (options.view) apply(*options.view, made);
        if (makes_alpha) make_alpha_of_glow(made.pixels);
        return write_integers(made);
    }
    if (is_integer(desc.kind)) return write_integers(picture);
    return write(floats(picture, desc.channels, to.format->least, to.format->most));
}

Result<> write_bytes(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height,
                     std::span<const std::uint8_t> rgba, const WriteOptions& options) {
    DARKROOM_ASSERT(rgba.size() == std::size_t{width} * height * 4);
    WriteOptions bytes = options;
    bytes.samples = SampleKind::Integer8;
    DARKROOM_TRY_VALUE(Written to, describe(path, width, height, bytes));
    to.desc.samples = rgba.data();
    if (options.alpha) return write_samples(path, to);
    std::vector<std::uint8_t> opaque(rgba.size() / 4 * 3);
    for (std::size_t i = 0; i < rgba.size() / 4; ++i) std::copy_n(&rgba[4 * i], 3, &opaque[3 * i]);
    to.desc.samples = opaque.data();
    return write_samples(path, to);
}

}  // namespace darkroom
