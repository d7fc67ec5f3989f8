// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "core/srgb.hpp"
#include "core/thread/parallel.hpp"
#include "image/picture/picture_source.hpp"
#include "scene/assets.hpp"
#include "scene/image_batch.hpp"

namespace darkroom::scene {
namespace {

// GPUs take no larger textures.
constexpr std::uint32_t most_texture_side = 16384;

// What a batch may become, in pixels: a few bytes of a damaged file must not ask for gigabytes.
constexpr std::size_t free_pixels = std::size_t{1} << 27;
constexpr std::size_t pixels_per_byte = 64;

// IEC 61966-2-1: colour textures are decoded as sRGB where they are used.
std::uint8_t encoded(float linear) {
    if (!(linear > 0)) return 0;
    return static_cast<std::uint8_t>(std::lround(std::min(srgb_encode(linear), 1.0F) * 255));
}

std::uint8_t unencoded(float value) {
    return value > 0 ? static_cast<std::uint8_t>(std::lround(std::min(value, 1.0F) * 255)) : std::uint8_t{0};
}

/// A file whose header has been read and whose pixels have not.
class OpenedImage {
  public:
    [[nodiscard]] static Result<OpenedImage> open(std::span<const std::byte> bytes) {
        auto opened = open_source(bytes, 1);
        if (!opened) return failure(std::move(opened));
        const FilePart& part = opened->source->parts().front();
        if (part.channels.empty()) return user_error("is no flat picture");
        if (part.width > most_texture_side || part.height > most_texture_side)
            return user_error(fmt::format("the picture is {}x{}, [1, {}] a side is allowed", part.width, part.height,
                                          most_texture_side));
        return OpenedImage(std::move(opened->source), bytes.size());
    }

    [[nodiscard]] std::size_t pixel_count() const { return std::size_t{part().width} * part().height; }
    [[nodiscard]] std::size_t byte_count() const { return byte_count_; }

    [[nodiscard]] Result<Image> decode() {
        Image image{.width = part().width, .height = part().height};
        const SampleKind kind = part().kinds.front();
        const bool is_float = kind == SampleKind::Half || kind == SampleKind::Float;
        if (auto done = is_float ? read_floats(image) : read_integers(image); !done) return failure(std::move(done));
        return image;
    }

  private:
    OpenedImage(std::unique_ptr<PictureSource> source, std::size_t byte_count)
        : source_(std::move(source)), byte_count_(byte_count) {}
    [[nodiscard]] const FilePart& part() const { return source_->parts().front(); }
    [[nodiscard]] std::size_t channel_count() const { return std::min<std::size_t>(part().channels.size(), 4); }

    // One channel is grey, two are grey and alpha.
    template <class T, class ToColor, class ToAlpha>
    static void spread(std::span<const T> from, std::size_t channels, const ToColor& to_color, const ToAlpha& to_alpha,
                       std::vector<std::uint8_t>& rgba) {
        const std::size_t count = from.size() / channels;
        rgba.resize(count * 4);
        const bool is_gray = channels < 3;
        for (std::size_t i = 0; i < count; ++i) {
            const T* pixel = from.data() + i * channels;
            for (std::size_t c = 0; c < 3; ++c) rgba[i * 4 + c] = to_color(pixel[is_gray ? 0 : c]);
            rgba[i * 4 + 3] = channels % 2 == 0 ? to_alpha(pixel[channels - 1]) : std::uint8_t{255};
        }
    }

    /// All samples of the first channels, interleaved.
    template <class T>
    [[nodiscard]] Result<> read(SampleKind kind, std::vector<T>& samples) {
        const std::size_t channels = channel_count();
        samples.resize(pixel_count() * channels);
        std::vector<SamplePlace> places;
        for (std::size_t c = 0; c < channels; ++c)
            places.push_back({.channel = c,
                              .kind = kind,
                              .first = reinterpret_cast<std::byte*>(samples.data() + c),
                              .pixel_bytes = static_cast<std::ptrdiff_t>(channels * sizeof(T)),
                              .row_bytes = static_cast<std::ptrdiff_t>(channels * sizeof(T) * part().width)});
        return source_->read_rows(0, 0, part().height, places);
    }

    [[nodiscard]] Result<> read_integers(Image& image) {
        std::vector<std::uint8_t> samples;
        if (auto done = read(SampleKind::Integer8, samples); !done) return done;
        const auto same = [](std::uint8_t value) { return value; };
        if (channel_count() == 4)
            image.rgba = std::move(samples);
        else
            spread<std::uint8_t>(samples, channel_count(), same, same, image.rgba);
        return {};
    }

    [[nodiscard]] Result<> read_floats(Image& image) {
        std::vector<float> samples;
        if (auto done = read(SampleKind::Float, samples); !done) return done;
        spread<float>(samples, channel_count(), encoded, unencoded, image.rgba);
        return {};
    }

    std::unique_ptr<PictureSource> source_;
    std::size_t byte_count_ = 0;
};

}  // namespace

std::vector<Result<Image>> decode_images(std::span<const EncodedImage> sources) {
    std::vector<Result<Image>> results(sources.size());
    std::vector<std::vector<std::byte>> files(sources.size());
    std::vector<std::optional<OpenedImage>> opened(sources.size());
    parallel_for(sources.size(), 0, [&](std::size_t i) {
        std::span<const std::byte> bytes = sources[i].bytes;
        if (bytes.empty() && !sources[i].file.empty()) {
            auto file = read_image_file(sources[i].file);
            if (!file) {
                // The caller names the file.
                std::string text = file.error().text;
                const std::string start = sources[i].file.string() + ": ";
                if (text.starts_with(start)) text.erase(0, start.size());
                results[i] = failure({file.error().fault, std::move(text)});
                return;
            }
            files[i] = std::move(*file);
            bytes = files[i];
        }
        auto image = OpenedImage::open(bytes);
        if (image)
            opened[i] = std::move(*image);
        else
            results[i] = failure(std::move(image));
    });
    std::size_t allowed = free_pixels;
    for (const auto& image : opened)
        if (image) allowed += image->byte_count() * pixels_per_byte;
    for (std::size_t i = 0; i < opened.size(); ++i) {
        if (!opened[i]) continue;
        const std::size_t count = opened[i]->pixel_count();
        if (count <= allowed) {
            allowed -= count;
            continue;
        }
        results[i] = user_error(
            fmt::format("{} pixels in {} bytes: larger than its file can be worth", count, opened[i]->byte_count()));
        opened[i].reset();
    }
    parallel_for(sources.size(), 0, [&](std::size_t i) {
        if (!opened[i]) return;
        results[i] = opened[i]->decode();
        if (results[i]) results[i]->name = sources[i].name;
        opened[i].reset();
        files[i] = {};
    });
    return results;
}

Result<Image> decode_image(std::span<const std::byte> bytes, std::string name) {
    const EncodedImage source{.name = std::move(name), .bytes = bytes};
    Result<Image> image = std::move(decode_images({&source, 1}).front());
    if (!image) return user_error(fmt::format("{}: {}", source.name, image.error().text));
    return image;
}

Result<Image> read_image(const std::filesystem::path& path) {
    const EncodedImage source{.name = path.filename().string(), .file = path};
    Result<Image> image = std::move(decode_images({&source, 1}).front());
    if (!image) return failure({image.error().fault, fmt::format("{}: {}", path.string(), image.error().text)});
    return image;
}

}  // namespace darkroom::scene
