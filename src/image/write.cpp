// SPDX-License-Identifier: MIT
#include "image/write.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <exception>
#include <limits>
#include <string>

#include "core/assert.hpp"
#include "core/files.hpp"
#include "image/encoder.hpp"
#include "image/exr_check.hpp"

namespace darkroom {
namespace {

constexpr std::array<std::pair<std::string_view, FileKind>, 7> extensions{{{".png", FileKind::Png},
                                                                           {".jpg", FileKind::Jpeg},
                                                                           {".jpeg", FileKind::Jpeg},
                                                                           {".tif", FileKind::Tiff},
                                                                           {".tiff", FileKind::Tiff},
                                                                           {".exr", FileKind::OpenExr},
                                                                           {".hdr", FileKind::Radiance}}};

struct Format {
    const char* writer;
    std::span<const SampleKind> samples;  // the first is the default
    bool has_alpha;
};

Format format_of(FileKind kind) {
    using enum SampleKind;
    static constexpr std::array png{Integer8, Integer16};
    static constexpr std::array jpeg{Integer8};
    static constexpr std::array tiff{Integer8, Integer16, Float};
    static constexpr std::array exr{Half, Float};
    static constexpr std::array radiance{Float};
    switch (kind) {
        case FileKind::Png:
            return {"png", png, true};
        case FileKind::Jpeg:
            return {"jpeg", jpeg, false};
        case FileKind::Tiff:
            return {"tiff", tiff, true};
        case FileKind::OpenExr:
            return {"openexr", exr, true};
        case FileKind::Radiance:
            return {"hdr", radiance, false};
    }
    DARKROOM_ASSERT(false);
    return {};
}

OIIO::TypeDesc type_of(SampleKind samples) {
    switch (samples) {
        case SampleKind::Integer8:
            return OIIO::TypeUInt8;
        case SampleKind::Integer16:
            return OIIO::TypeUInt16;
        case SampleKind::Half:
            return OIIO::TypeHalf;
        default:
            return OIIO::TypeFloat;
    }
}

// JPEG has 16 bits for a side (ITU-T T.81); libpng refuses more than a million; the others have 31.
Result<> check_size(const std::filesystem::path& path, FileKind kind, std::uint32_t width, std::uint32_t height) {
    const std::uint32_t most = kind == FileKind::Jpeg ? 65500 : 65536;
    if (width >= 1 && height >= 1 && width <= most && height <= most) return {};
    return user_error(fmt::format("{}: a picture of {}x{}; 1 to {} a side is allowed in {}", path.string(), width,
                                  height, most, name_of(kind)));
}

OIIO::ImageSpec describe(FileKind kind, SampleKind samples, std::uint32_t width, std::uint32_t height,
                         const WriteOptions& options) {
    OIIO::ImageSpec spec(static_cast<int>(width), static_cast<int>(height), options.alpha ? 4 : 3, type_of(samples));
    // OpenImageIO would write the time of day, and no file would be the same twice.
    spec.attribute("DateTime", "1970:01:01 00:00:00");
    // Alpha is carried, never applied: without this, writers divide colour by it.
    spec.attribute("oiio:UnassociatedAlpha", 1);
    if (kind == FileKind::Jpeg) spec.attribute("Compression", fmt::format("jpeg:{}", options.jpeg_quality));
    if (kind == FileKind::OpenExr) spec.attribute("compression", "zip");
    return spec;
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

Result<> check_quality(const std::filesystem::path& path, const WriteOptions& options) {
    if (options.jpeg_quality >= 1 && options.jpeg_quality <= 100) return {};
    return user_error(
        fmt::format("{}: a JPEG quality of {}; 1 to 100 is allowed", path.string(), options.jpeg_quality));
}

}  // namespace

Result<FileKind> file_kind(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    for (const auto& [known, kind] : extensions)
        if (extension == known) return kind;
    return user_error(fmt::format("{}: {}; .png .jpg .jpeg .tif .tiff .exr .hdr can be written", path.string(),
                                  extension.empty() ? "no extension" : fmt::format("unknown extension {}", extension)));
}

Result<SampleKind> sample_kind(const std::filesystem::path& path, const WriteOptions& options) {
    const auto kind = file_kind(path);
    if (!kind) return failure(kind.error());
    const Format format = format_of(*kind);
    if (options.alpha && !format.has_alpha)
        return user_error(fmt::format("{}: {} has no alpha; .png .tif .exr have", path.string(), name_of(*kind)));
    const SampleKind samples = options.samples.value_or(format.samples.front());
    if (std::find(format.samples.begin(), format.samples.end(), samples) != format.samples.end()) return samples;
    std::string allowed;
    for (const SampleKind known : format.samples)
        allowed += (allowed.empty() ? "" : ", ") + std::string(name_of(known));
    return user_error(
        fmt::format("{}: {} samples in {}; allowed: {}", path.string(), name_of(samples), name_of(*kind), allowed));
}

namespace {

Failure encode_error(const std::filesystem::path& path, FileKind kind, std::string_view why) {
    return machine_error(fmt::format("{}: cannot be written as {}: {}", path.string(), name_of(kind),
                                     why.empty() ? "unknown reason" : one_printable_line(why)));
}

}  // namespace

Result<> encode_to_file(const std::filesystem::path& path, FileKind kind, const OIIO::ImageSpec& spec,
                        OIIO::TypeDesc type, const void* samples) {
    const char* writer = format_of(kind).writer;
    const auto error = [&](std::string_view why) { return encode_error(path, kind, why); };
    OIIO::Filesystem::IOVecOutput memory;
    try {
        auto output = OIIO::ImageOutput::create(writer);
        if (!output) return error("OpenImageIO was built without it");
        if (!output->set_ioproxy(&memory)) return error("not into memory");
        if (!output->open(fmt::format("memory.{}", writer), spec)) return error(output->geterror());
        if (!output->write_image(type, samples)) return error(output->geterror());
        if (!output->close()) return error(output->geterror());
    } catch (const std::exception& exception) {
        return error(exception.what());
    }
    return write_file(path, std::as_bytes(std::span(memory.buffer())));
}

// OpenImageIO before 2.5.12 writes several parts to a path alone. OpenEXR swallows errors when it closes a file, and
// leaves places of chunks unwritten then: the check finds them.
Result<> encode_parts_to_file(const std::filesystem::path& path, std::span<const EncodedPart> parts) {
    const auto error = [&](std::string_view why) { return encode_error(path, FileKind::OpenExr, why); };
    auto temporary = AtomicPath::beside(path);
    if (!temporary) return failure(std::move(temporary));
    const std::string name = temporary->path().string();
    std::vector<OIIO::ImageSpec> specs;
    for (const EncodedPart& part : parts) specs.push_back(part.spec);
    try {
        auto output = OIIO::ImageOutput::create(format_of(FileKind::OpenExr).writer);
        if (!output) return error("OpenImageIO was built without it");
        if (!output->open(name, static_cast<int>(specs.size()), specs.data())) return error(output->geterror());
        for (std::size_t i = 0; i < parts.size(); ++i) {
            if (i > 0 && !output->open(name, specs[i], OIIO::ImageOutput::AppendSubimage))
                return error(output->geterror());
            const std::vector<float> samples = parts[i].samples();
            if (!output->write_image(OIIO::TypeFloat, samples.data())) return error(output->geterror());
        }
        if (!output->close()) return error(output->geterror());
    } catch (const std::exception& exception) {
        return error(exception.what());
    }
    const auto written = read_file(temporary->path());
    if (!written) return failure(written.error());
    if (const auto checked = check_exr(*written); !checked) return error(checked.error().text);
    return temporary->commit();
}

Result<> write_picture(const std::filesystem::path& path, const Picture& picture, const WriteOptions& options) {
    DARKROOM_ASSERT(picture.pixels.size() == std::size_t{picture.width} * picture.height * 4);
    const auto samples = sample_kind(path, options);
    if (!samples) return failure(samples.error());
    const FileKind kind = *file_kind(path);
    if (auto checked = check_size(path, kind, picture.width, picture.height); !checked) return checked;
    if (auto checked = check_quality(path, options); !checked) return checked;
    const OIIO::ImageSpec spec = describe(kind, *samples, picture.width, picture.height, options);
    const std::uint32_t channels = options.alpha ? 4 : 3;
    if (*samples == SampleKind::Integer8)
        return encode_to_file(path, kind, spec, OIIO::TypeUInt8, integers<std::uint8_t>(picture, channels).data());
    if (*samples == SampleKind::Integer16)
        return encode_to_file(path, kind, spec, OIIO::TypeUInt16, integers<std::uint16_t>(picture, channels).data());
    // Radiance: no negative values, and a shared exponent of at most 2^127.
    constexpr float largest_half = 65504.0f;
    constexpr float largest_radiance = 1.7e38f;
    float largest = *samples == SampleKind::Half ? largest_half : std::numeric_limits<float>::max();
    float smallest = -largest;
    if (kind == FileKind::Radiance) {
        largest = largest_radiance;
        smallest = 0;
    }
    return encode_to_file(path, kind, spec, OIIO::TypeFloat, floats(picture, channels, smallest, largest).data());
}

Result<> write_bytes(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height,
                     std::span<const std::uint8_t> rgba, const WriteOptions& options) {
    DARKROOM_ASSERT(rgba.size() == std::size_t{width} * height * 4);
    WriteOptions bytes = options;
    bytes.samples = SampleKind::Integer8;
    const auto samples = sample_kind(path, bytes);
    if (!samples) return failure(samples.error());
    const FileKind kind = *file_kind(path);
    if (auto checked = check_size(path, kind, width, height); !checked) return checked;
    if (auto checked = check_quality(path, options); !checked) return checked;
    const OIIO::ImageSpec spec = describe(kind, *samples, width, height, options);
    if (options.alpha) return encode_to_file(path, kind, spec, OIIO::TypeUInt8, rgba.data());
    std::vector<std::uint8_t> opaque;
    opaque.reserve(rgba.size() / 4 * 3);
    for (std::size_t i = 0; i < rgba.size(); i += 4) opaque.insert(opaque.end(), &rgba[i], &rgba[i] + 3);
    return encode_to_file(path, kind, spec, OIIO::TypeUInt8, opaque.data());
}

}  // namespace darkroom
