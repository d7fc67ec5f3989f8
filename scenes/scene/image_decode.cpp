// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>

#include "core/thread/parallel.hpp"
#include "image/picture/picture_source.hpp"
#include "scene/assets.hpp"
#include "scene/image_batch.hpp"

namespace darkroom::scene {
namespace {

// GPUs take no larger textures.
constexpr std::uint32_t max_texture_side = 16384;

// What a batch may become, in pixels of four bytes: a few bytes of a damaged file must not ask for gigabytes.
constexpr std::size_t free_pixels = std::size_t{1} << 27;
constexpr std::size_t pixels_per_byte = 64;

// The nearest half that textures may hold: no light below 0, none that is infinite.
std::uint16_t half_of(float value, float most) { return glm::packHalf1x16(value > 0 ? std::min(value, most) : 0.0F); }
std::uint16_t half_of_light(float value) { return half_of(value, 65504); }
std::uint16_t half_of_alpha(float value) { return half_of(value, 1); }

/// A file whose header has been read and whose pixels have not.
class OpenedImage {
  public:
    [[nodiscard]] static Result<OpenedImage> open(std::span<const std::byte> bytes) {
        DARKROOM_TRY_VALUE(auto opened, open_source(bytes, 1));
        const FilePart& part = opened.source->parts().front();
        if (part.channels.empty()) return user_error("is not a flat picture");
        if (part.width > max_texture_side || part.height > max_texture_side)
            return user_error(fmt::format("the picture is {}x{}, [1, {}] a side is allowed", part.width, part.height,
                                          max_texture_side));
        return OpenedImage(std::move(opened.source), bytes.size());
    }

    [[nodiscard]] std::size_t pixel_count() const { return std::size_t{part().width} * part().height; }
    /// What a decoded picture takes, in pixels of four bytes.
    [[nodiscard]] std::size_t room() const { return pixel_count() * (kind() == SampleKind::Integer8 ? 1 : 2); }
    [[nodiscard]] std::size_t byte_count() const { return byte_count_; }

    [[nodiscard]] Result<Image> decode() {
        Image image{.width = part().width, .height = part().height};
        DARKROOM_TRY(read_into(image));
        return image;
    }

  private:
    OpenedImage(std::unique_ptr<PictureSource> source, std::size_t byte_count)
        : source_(std::move(source)), byte_count_(byte_count) {}
    [[nodiscard]] const FilePart& part() const { return source_->parts().front(); }
    [[nodiscard]] SampleKind kind() const { return part().kinds.front(); }
    [[nodiscard]] std::size_t channel_count() const { return std::min<std::size_t>(part().channels.size(), 4); }

    // One channel is grey, two are grey and alpha.
    template <class T, class Out, class ToColor, class ToAlpha>
    static void spread(std::span<const T> from, std::size_t channels, const ToColor& to_color, const ToAlpha& to_alpha,
                       Out opaque, std::vector<Out>& rgba) {
        const std::size_t count = from.size() / channels;
        rgba.resize(count * 4);
        const bool is_gray = channels < 3;
        for (std::size_t i = 0; i < count; ++i) {
            const T* pixel = from.data() + i * channels;
            for (std::size_t c = 0; c < 3; ++c) rgba[i * 4 + c] = to_color(pixel[is_gray ? 0 : c]);
            rgba[i * 4 + 3] = channels % 2 == 0 ? to_alpha(pixel[channels - 1]) : opaque;
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

    [[nodiscard]] Result<> read_into(Image& image) {
        if (kind() == SampleKind::Integer8) return read_integers(SampleKind::Integer8, image.rgba);
        if (kind() == SampleKind::Integer16 || kind() == SampleKind::Integer32) {
            image.kind = ImageKind::Codes16;
            return read_integers(SampleKind::Integer16, image.wide);
        }
        image.kind = ImageKind::Halves;
        std::vector<float> samples;
        DARKROOM_TRY(read(SampleKind::Float, samples));
        spread<float>(samples, channel_count(), half_of_light, half_of_alpha, half_of_alpha(1), image.wide);
        return {};
    }

    template <class T>
    [[nodiscard]] Result<> read_integers(SampleKind kind, std::vector<T>& rgba) {
        std::vector<T> samples;
        DARKROOM_TRY(read(kind, samples));
        const auto same = [](T value) { return value; };
        if (channel_count() == 4)
            rgba = std::move(samples);
        else
            spread<T>(samples, channel_count(), same, same, std::numeric_limits<T>::max(), rgba);
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
            auto file = read_image_file(sources[i].file, {.is_path_in_errors = false});
            if (!file) {
                results[i] = failure(std::move(file));
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
        if (opened[i]->room() <= allowed) {
            allowed -= opened[i]->room();
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
