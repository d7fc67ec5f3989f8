// SPDX-License-Identifier: MIT
#include "image/frame/kept_layers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "core/text/param_text.hpp"
#include "image/codec/decoder.hpp"

namespace darkroom {
namespace {

class Reader {
  public:
    Reader(Decoder& decoder, const ChannelSet& color, KeptLayers& layers)
        : decoder_(decoder), color_(color), layers_(layers) {
        layers_.width = decoder.parts()[color.part].display_width;
        layers_.height = decoder.parts()[color.part].display_height;
    }

    Result<> run() {
        for (std::size_t part = 0; part < decoder_.parts().size(); ++part)
            if (!is_shadow_part(decoder_.parts()[part]))
                if (Result<> done = read(part); !done) return done;
        return {};
    }

  private:
    void warn(std::string_view what, std::string_view why) {
        layers_.warnings.push_back(fmt::format("{} is not kept: {}", one_printable_line(what), why));
    }

    [[nodiscard]] bool is_kept(std::size_t part, std::size_t channel, const std::string& name) {
        if (part == color_.part && std::ranges::count(color_.channels, static_cast<int>(channel)) > 0) return false;
        if (decoder_.parts()[part].kinds[channel] == SampleKind::Integer32)
            warn(name, "it has 32-bit integers");
        else if (std::ranges::count(std::array{"R", "G", "B", "A"}, name) > 0)
            warn(name, "the picture has a channel of this name");
        else if (std::ranges::find(layers_.channels, name, &KeptLayers::Channel::name) != layers_.channels.end())
            warn(name, "there is another of this name");
        else
            return true;
        return false;
    }

    Result<> read(std::size_t number) {
        const FilePart& part = decoder_.parts()[number];
        const std::size_t first_kept = layers_.channels.size();
        std::vector<std::optional<std::size_t>> places(part.channels.size());
        for (std::size_t c = 0; c < part.channels.size(); ++c) {
            const std::string name = number == color_.part ? part.channels[c] : part.name + "." + part.channels[c];
            if (!is_kept(number, c, name)) continue;
            places[c] = layers_.channels.size();
            layers_.channels.push_back({.name = name, .kind = part.kinds[c]});
        }
        if (layers_.channels.size() == first_kept) return {};
        if (part.display_width != layers_.width || part.display_height != layers_.height) {
            warn(part.name, fmt::format("it is {}x{}, the picture {}x{}", part.display_width, part.display_height,
                                        layers_.width, layers_.height));
            layers_.channels.resize(first_kept);
            return {};
        }
        const std::uint64_t pixels = std::uint64_t{layers_.width} * layers_.height;
        if (pixels * layers_.channels.size() > most_samples)
            return user_error(fmt::format("{} layers of {}x{}: at most {} numbers can be kept", layers_.channels.size(),
                                          layers_.width, layers_.height, most_samples));
        for (std::size_t i = first_kept; i < layers_.channels.size(); ++i) layers_.channels[i].values.resize(pixels);
        const auto count = static_cast<std::uint32_t>(part.channels.size());
        return decoder_.read(
            number, 0, count, [&](std::uint32_t row, std::uint32_t rows, std::span<const float> samples) {
                for (std::uint32_t i = 0; i < rows; ++i)
                    put_row(part, row + i, samples.subspan(std::size_t{i} * part.width * count), places);
            });
    }

    /// What lies outside of the display window is dropped.
    void put_row(const FilePart& part, std::uint32_t row, std::span<const float> samples,
                 std::span<const std::optional<std::size_t>> places) {
        const std::int64_t y = std::int64_t{row} + part.y;
        if (y < 0 || y >= layers_.height) return;
        const std::int64_t left = std::max<std::int64_t>(0, -std::int64_t{part.x});
        const std::int64_t right = std::min<std::int64_t>(part.width, std::int64_t{layers_.width} - part.x);
        for (std::size_t c = 0; c < places.size(); ++c) {
            if (!places[c]) continue;
            float* const to = &layers_.channels[*places[c]].values[static_cast<std::size_t>(y) * layers_.width];
            for (std::int64_t x = left; x < right; ++x)
                to[x + part.x] = samples[static_cast<std::size_t>(x) * places.size() + c];
        }
    }

    Decoder& decoder_;
    const ChannelSet& color_;
    KeptLayers& layers_;
};

}  // namespace

Result<KeptLayers> read_kept_layers(const std::filesystem::path& path, const LayerNames& names,
                                    std::size_t max_threads) {
    Result<Decoder> decoder = Decoder::open(path, max_threads, DecodingPlace::FramesHere);
    if (!decoder) return failure(std::move(decoder));
    const auto refuse = [&](const Error& error) {
        return failure(Error{error.fault, fmt::format("{}: {}", printable(path.string()), error.text)});
    };
    const Result<FrameChannels> found = find_channels(decoder->parts(), names);
    if (!found) return refuse(found.error());
    KeptLayers layers;
    if (Result<> done = Reader(*decoder, found->color, layers).run(); !done) return refuse(done.error());
    return layers;
}

}  // namespace darkroom
