// SPDX-License-Identifier: MIT
#include "image/frame/kept_layers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>

#include "core/text/lower.hpp"
#include "core/text/param_text.hpp"
#include "image/codec/decoder.hpp"

namespace darkroom {
namespace {

class Reader {
  public:
    Reader(Decoder& decoder, const FrameChannels& found, bool is_depth_inverse, KeptLayers& layers)
        : decoder_(decoder), found_(found), is_depth_inverse_(is_depth_inverse), layers_(layers) {
        const FilePart& of_color = decoder.parts()[found.color.part];
        layers_.width = of_color.display_width;
        layers_.height = of_color.display_height;
        // Channels without the name of an eye are the first one's.
        if (!of_color.views.empty() && found.view != of_color.views.front() && !found.view.empty())
            layers_.color_prefix = found.view + ".";
    }

    Result<> run() {
        for (std::size_t part = 0; part < decoder_.parts().size(); ++part)
            if (!is_shadow_part(decoder_.parts()[part])) DARKROOM_TRY(read(part));
        return {};
    }

  private:
    void warn(std::string_view what, std::string_view why) {
        layers_.warnings.push_back(fmt::format("{} is not kept: {}", one_printable_line(what), why));
    }

    [[nodiscard]] bool is_kept(std::size_t number, std::size_t channel) {
        const FilePart& part = decoder_.parts()[number];
        const std::string& name = part.channels[channel];
        if (number == found_.color.part) {
            if (std::ranges::count(found_.color.channels, static_cast<int>(channel)) > 0) return false;
            if (std::ranges::any_of(std::string_view("RGBA"),
                                    [&](char c) { return name == layers_.color_prefix + c; })) {
                warn(name, "the picture has a channel of this name");
                return false;
            }
        }
        if (part.kinds[channel] != SampleKind::Integer32) return true;
        warn(name, "it has 32-bit integers");
        return false;
    }

    /// Z of a layer that is no vector, or what the frame's depth is.
    [[nodiscard]] bool is_depth(std::size_t number, std::size_t channel) const {
        if (found_.depth && found_.depth->part == number && found_.depth->channels[0] == static_cast<int>(channel))
            return true;
        const std::vector<std::string>& names = decoder_.parts()[number].channels;
        const std::string& name = names[channel];
        if (!name.ends_with("Z") && !name.ends_with("z")) return false;
        const std::string prefix = name.substr(0, name.size() - 1);
        return (prefix.empty() || prefix.ends_with(".")) && std::ranges::count(names, prefix + "X") == 0 &&
               std::ranges::count(names, prefix + "x") == 0;
    }

    Result<> read(std::size_t number) {
        const FilePart& part = decoder_.parts()[number];
        const bool is_of_color = number == found_.color.part;
        KeptLayers::Part kept{.name = part.name,
                              .window = is_of_color ? PixelWindow{0, 0, layers_.width, layers_.height}
                                                    : PixelWindow{part.x, part.y, part.width, part.height},
                              .views = part.views,
                              .attributes = decoder_.attributes(number, ExrAttributes::Of::Layers)};
        if (is_of_color) layers_.color_part = layers_.parts.size();
        std::vector<std::optional<std::size_t>> places(part.channels.size());
        for (std::size_t c = 0; c < part.channels.size(); ++c) {
            if (!is_kept(number, c)) continue;
            places[c] = kept.channels.size();
            kept.channels.push_back({.name = part.channels[c], .kind = part.kinds[c]});
        }
        if (kept.channels.empty() && !is_of_color) return {};
        if (part.display_width != layers_.width || part.display_height != layers_.height) {
            warn(part.name, fmt::format("it is {}x{}, the picture {}x{}", part.display_width, part.display_height,
                                        layers_.width, layers_.height));
            return {};
        }
        count_ += kept.channels.size();
        const std::uint64_t pixels = std::uint64_t{kept.window.width} * kept.window.height;
        samples_ += pixels * kept.channels.size();
        if (samples_ > max_samples)
            return user_error(fmt::format("{} layers of {}x{}: at most {} numbers can be kept", count_, layers_.width,
                                          layers_.height, max_samples));
        for (std::size_t c = 0; c < places.size(); ++c)
            if (places[c])
                kept.channels[*places[c]].values.resize(pixels,
                                                        is_depth(number, c) && !is_depth_inverse_ ? sky_depth : 0.0F);
        const auto channels = static_cast<std::uint32_t>(part.channels.size());
        if (!kept.channels.empty()) {
            Result<> done = decoder_.read(
                number, 0, channels, [&](std::uint32_t row, std::uint32_t rows, std::span<const float> samples) {
                    for (std::uint32_t i = 0; i < rows; ++i)
                        put_row(part, row + i, samples.subspan(std::size_t{i} * part.width * channels), places, kept);
                });
            if (!done) return done;
        }
        layers_.parts.push_back(std::move(kept));
        return {};
    }

    /// What lies outside of the window is dropped.
    static void put_row(const FilePart& part, std::uint32_t row, std::span<const float> samples,
                        std::span<const std::optional<std::size_t>> places, KeptLayers::Part& kept) {
        const std::int64_t x_offset = std::int64_t{part.x} - kept.window.x;
        const std::int64_t y = std::int64_t{row} + part.y - kept.window.y;
        if (y < 0 || y >= kept.window.height) return;
        const std::int64_t left = std::max<std::int64_t>(0, -x_offset);
        const std::int64_t right = std::min<std::int64_t>(part.width, std::int64_t{kept.window.width} - x_offset);
        for (std::size_t c = 0; c < places.size(); ++c) {
            if (!places[c]) continue;
            float* const to = &kept.channels[*places[c]].values[static_cast<std::size_t>(y) * kept.window.width];
            for (std::int64_t x = left; x < right; ++x)
                to[x + x_offset] = samples[static_cast<std::size_t>(x) * places.size() + c];
        }
    }

    Decoder& decoder_;
    const FrameChannels& found_;
    bool is_depth_inverse_;
    KeptLayers& layers_;
    std::uint64_t count_ = 0, samples_ = 0;  // of all parts
};

}  // namespace

Result<KeptLayers> read_kept_layers(const std::filesystem::path& path, const FrameOptions& options) {
    DARKROOM_TRY_VALUE(Decoder decoder, Decoder::open(path, options.max_threads, DecodingPlace::FramesHere));
    const auto refuse = [&](const Error& error) {
        return failure(Error{error.fault, fmt::format("{}: {}", printable(path.string()), error.text)});
    };
    const Result<FrameChannels> found = find_channels(decoder.parts(), options.names, options.view);
    if (!found) return refuse(found.error());
    KeptLayers layers;
    if (Result<> done = Reader(decoder, *found, options.is_depth_inverse, layers).run(); !done)
        return refuse(done.error());
    const auto is_red = [](const KeptLayers::Channel& channel) {
        const std::string name = lower(channel.name.substr(channel.name.rfind('.') + 1));
        return name == "r" || name == "red";
    };
    if (std::ranges::any_of(layers.parts,
                            [&](const KeptLayers::Part& part) { return std::ranges::any_of(part.channels, is_red); }))
        if (const auto coding = decoder.color(found->color.part).coding) layers.primaries = coding->primaries;
    return layers;
}

}  // namespace darkroom
