// SPDX-License-Identifier: MIT
#include "image/frame/layer_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <type_traits>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "core/text/param_text.hpp"
#include "image/frame/channels.hpp"

namespace darkroom {
namespace {

// Those of a set, each once: a grey picture has one channel for all three.
FileLayer layer_of(std::string name, const ChannelSet& set) {
    FileLayer layer{.name = std::move(name), .file_name = set.prefix, .part = set.part};
    for (const int channel : set.channels)
        if (channel >= 0 && std::ranges::count(layer.channels, static_cast<std::uint32_t>(channel)) == 0)
            layer.channels.push_back(static_cast<std::uint32_t>(channel));
    return layer;
}

std::string prefix_of(const std::string& channel) {
    const std::size_t dot = channel.rfind('.');
    return dot == std::string::npos ? std::string() : channel.substr(0, dot);
}

}  // namespace

template <class Sample>
void SampleRange::add(std::span<const Sample> samples, std::size_t stride) {
    for (std::size_t i = 0; i < samples.size(); i += stride) {
        const double value = samples[i];
        if (std::isfinite(value)) {
            least = std::min(least, value);
            most = std::max(most, value);
        } else {
            ++(std::isnan(value) ? nan : infinite);
        }
    }
}

void SampleRange::add(const SampleRange& other) {
    least = std::min(least, other.least);
    most = std::max(most, other.most);
    nan += other.nan;
    infinite += other.infinite;
}

Result<LayerFile> LayerFile::open(const std::filesystem::path& path) {
    DARKROOM_TRY_VALUE(Decoder decoder, Decoder::open(path));
    LayerFile file(path.string(), std::move(decoder));
    file.list_layers();
    return file;
}

Failure LayerFile::error(std::string_view text) const {
    return user_error(fmt::format("{}: {}", printable(path_), text));
}

void LayerFile::list_layers() {
    const std::span<const FilePart> parts = decoder_.parts();
    if (const Result<FrameChannels> found = find_channels(parts, {})) {
        layers_.push_back(layer_of("color", found->color));
        if (found->depth) layers_.push_back(layer_of("depth", *found->depth));
        if (found->normals) layers_.push_back(layer_of("normals", *found->normals));
        if (found->velocity) layers_.push_back(layer_of("velocity", *found->velocity));
    } else {
        why_no_frame_ = found.error().text;
    }
    std::set<std::pair<std::size_t, std::uint32_t>> taken;
    std::unordered_set<std::string> names;
    for (const FileLayer& layer : layers_) {
        names.insert(layer.name);
        for (const std::uint32_t channel : layer.channels) taken.emplace(layer.part, channel);
    }
    for (std::size_t part = 0; part < parts.size(); ++part) {
        const std::size_t first = layers_.size();
        std::unordered_map<std::string, std::size_t> places;  // of this part's layers
        for (std::uint32_t channel = 0; channel < parts[part].channels.size(); ++channel) {
            if (taken.contains({part, channel})) continue;
            // Plain channels are a layer together only where they have a part of their own.
            std::string name = prefix_of(parts[part].channels[channel]);
            if (name.empty()) name = parts.size() > 1 ? parts[part].name : parts[part].channels[channel];
            const auto [place, is_new] = places.try_emplace(name, layers_.size());
            if (is_new) layers_.push_back({.name = name, .file_name = name, .part = part});
            layers_[place->second].channels.push_back(channel);
        }
        // Two parts may have layers of one name, as the two views of a stereo picture do.
        for (std::size_t i = first; i < layers_.size(); ++i)
            if (names.contains(layers_[i].file_name))
                layers_[i].name = fmt::format("{}.{}", part, layers_[i].file_name);
        for (std::size_t i = first; i < layers_.size(); ++i) names.insert(layers_[i].name);
    }
}

Result<FileLayer> LayerFile::find(std::string_view name) const {
    const std::string_view wanted = name == "motion" ? "velocity" : name;
    for (const FileLayer& layer : layers_)
        if (layer.name == wanted) return layer;
    for (const FileLayer& layer : layers_)
        if (!layer.file_name.empty() && layer.file_name == name) return layer;
    const std::vector<std::string> channels = darkroom::channel_names(decoder_.parts());
    std::size_t index = 0;
    for (std::size_t part = 0; part < decoder_.parts().size(); ++part)
        for (std::uint32_t channel = 0; channel < decoder_.parts()[part].channels.size(); ++channel, ++index)
            if (channels[index] == name)
                return FileLayer{
                    .name = std::string(name), .file_name = channels[index], .part = part, .channels = {channel}};
    if (name == "color") return error(why_no_frame_);
    std::vector<std::string> known;
    for (const FileLayer& layer : layers_) known.push_back(one_printable_line(layer.name));
    return error(fmt::format("has no layer '{}'{}", printable(name), alternatives(name, known, "there are")));
}

std::vector<std::string> LayerFile::channel_names(const FileLayer& layer) const {
    std::vector<std::string> names;
    for (const std::uint32_t channel : layer.channels)
        names.push_back(one_printable_line(decoder_.parts()[layer.part].channels[channel]));
    return names;
}

FileLayer LayerFile::of_kind(const FileLayer& layer, bool is_wide_integer) const {
    const std::vector<SampleKind>& kinds = decoder_.parts()[layer.part].kinds;
    FileLayer out = layer;
    std::erase_if(out.channels,
                  [&](std::uint32_t c) { return (kinds[c] == SampleKind::Integer32) != is_wide_integer; });
    return out;
}

template <class Sample>
Result<> LayerFile::read_samples(const FileLayer& layer, LayerSamples& out, std::vector<Sample>& to) {
    const FilePart& part = decoder_.parts()[layer.part];
    const std::size_t count = out.channels, row_samples = count * part.width;
    to.resize(std::size_t{out.width} * out.height * count);
    const std::int64_t left = std::max<std::int64_t>(0, -std::int64_t{part.x});
    const std::int64_t right = std::min<std::int64_t>(part.width, std::int64_t{part.display_width} - part.x);
    const std::uint32_t band = decoder_.band_rows(layer.part, row_samples * sizeof(Sample));
    std::vector<Sample> samples(row_samples * std::min(band, part.height));
    std::vector<SamplePlace> places;
    for (std::size_t c = 0; c < count; ++c)
        places.push_back({.channel = layer.channels[c],
                          .kind = std::is_same_v<Sample, float> ? SampleKind::Float : SampleKind::Integer32,
                          .first = reinterpret_cast<std::byte*>(samples.data() + c),
                          .pixel_bytes = static_cast<std::ptrdiff_t>(count * sizeof(Sample)),
                          .row_bytes = static_cast<std::ptrdiff_t>(row_samples * sizeof(Sample))});
    for (std::uint32_t row = 0; row < part.height; row += band) {
        const std::uint32_t rows = std::min(band, part.height - row);
        DARKROOM_TRY(decoder_.read_rows(layer.part, row, rows, places));
        for (std::uint32_t i = 0; i < rows && left < right; ++i) {
            const std::int64_t y = std::int64_t{row} + i + part.y;
            if (y < 0 || y >= part.display_height) continue;
            const Sample* const from = &samples[row_samples * i + static_cast<std::size_t>(left) * count];
            std::copy(from, from + static_cast<std::size_t>(right - left) * count,
                      &to[(static_cast<std::size_t>(y) * out.width + static_cast<std::size_t>(left + part.x)) * count]);
        }
    }
    return {};
}

Result<LayerSamples> LayerFile::read(const FileLayer& layer) {
    const FilePart& part = decoder_.parts()[layer.part];
    const bool is_wide = part.kinds[layer.channels.front()] == SampleKind::Integer32;
    if (of_kind(layer, is_wide).channels.size() != layer.channels.size())
        return error(
            fmt::format("the layer {} has 32-bit integers beside other numbers", one_printable_line(layer.name)));
    const auto count = static_cast<std::uint32_t>(layer.channels.size());
    if (std::uint64_t{part.display_width} * part.display_height > max_samples / std::max(count, 4U))
        return error(fmt::format("the layer {} is {}x{} with {} channels, at most {} samples are allowed",
                                 one_printable_line(layer.name), part.display_width, part.display_height, count,
                                 max_samples));
    LayerSamples out{.width = part.display_width, .height = part.display_height, .channels = count};
    DARKROOM_TRY(is_wide ? read_samples(layer, out, out.integers) : read_samples(layer, out, out.values));
    return out;
}

Result<std::vector<SampleRange>> LayerFile::ranges(std::size_t part) {
    const FilePart& from = decoder_.parts()[part];
    const auto count = static_cast<std::uint32_t>(from.channels.size());
    std::vector<SampleRange> ranges(count);
    const auto is_wide = [&](std::uint32_t channel) { return from.kinds[channel] == SampleKind::Integer32; };
    const auto add = [&](std::uint32_t, std::uint32_t, std::span<const float> samples) {
        for (std::uint32_t c = 0; c < count; ++c)
            if (!is_wide(c)) ranges[c].add(samples.subspan(c), count);
    };
    DARKROOM_TRY(decoder_.read(part, 0, count, add));
    // Of these a float holds 24 bits.
    std::vector<std::uint32_t> wide;
    for (std::uint32_t c = 0; c < count; ++c)
        if (is_wide(c)) wide.push_back(c);
    if (wide.empty()) return ranges;
    const std::size_t row_samples = wide.size() * from.width;
    const std::uint32_t band = decoder_.band_rows(part, row_samples * sizeof(std::uint32_t));
    std::vector<std::uint32_t> numbers(row_samples * std::min(band, from.height));
    std::vector<SamplePlace> places;
    for (std::size_t i = 0; i < wide.size(); ++i)
        places.push_back({.channel = wide[i],
                          .kind = SampleKind::Integer32,
                          .first = reinterpret_cast<std::byte*>(numbers.data() + i),
                          .pixel_bytes = static_cast<std::ptrdiff_t>(wide.size() * sizeof(std::uint32_t)),
                          .row_bytes = static_cast<std::ptrdiff_t>(row_samples * sizeof(std::uint32_t))});
    for (std::uint32_t row = 0; row < from.height; row += band) {
        const std::uint32_t rows = std::min(band, from.height - row);
        DARKROOM_TRY(decoder_.read_rows(part, row, rows, places));
        const auto read = std::span<const std::uint32_t>(numbers).first(row_samples * rows);
        for (std::size_t i = 0; i < wide.size(); ++i) ranges[wide[i]].add(read.subspan(i), wide.size());
    }
    return ranges;
}

}  // namespace darkroom
