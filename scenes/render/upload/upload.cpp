// SPDX-License-Identifier: MIT
#include "render/upload/upload.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "core/srgb.hpp"
#include "gpu/resource/barriers.hpp"

namespace darkroom::render {

namespace {

/// Beyond this much staging memory a submission is worth its wait.
constexpr std::size_t max_staged_bytes = std::size_t{256} << 20U;

}  // namespace

Result<VkBuffer> Uploader::stage(std::size_t size, std::byte*& mapped) {
    if (staged_bytes_ > 0 && staged_bytes_ + size > max_staged_bytes) DARKROOM_TRY(flush());
    DARKROOM_TRY_VALUE(gpu::Buffer staging, gpu::Buffer::create(*context_, size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                                                                gpu::Memory::Kind::Upload, "staging of scene assets"));
    mapped = staging.memory.mapped;
    staged_bytes_ += size;
    staging_.push_back(std::move(staging));
    return staging_.back().handle;
}

Result<gpu::Buffer> Uploader::buffer(std::span<const std::byte> bytes, VkBufferUsageFlags usage, std::size_t least_size,
                                     std::string_view name) {
    const std::size_t size = std::max(bytes.size(), least_size);
    DARKROOM_TRY_VALUE(gpu::Buffer made, gpu::Buffer::create(*context_, size, usage | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                                             gpu::Memory::Kind::Device, name));
    std::byte* mapped = nullptr;
    DARKROOM_TRY_VALUE(const VkBuffer source, stage(size, mapped));
    std::ranges::copy(bytes, mapped);
    std::fill(mapped + bytes.size(), mapped + size, std::byte{0});
    buffer_copies_.push_back({source, made.handle, size});
    return made;
}

Result<> Uploader::image(gpu::Image& out, VkFormat format, std::span<const Level> levels, std::string_view name) {
    DARKROOM_TRY_VALUE(
        out, gpu::Image::create(*context_, {.name = std::string(name),
                                            .format = format,
                                            .extent = {levels[0].width, levels[0].height, 1},
                                            .mip_levels = static_cast<std::uint32_t>(levels.size()),
                                            .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT}));
    std::size_t size = 0;
    for (const Level& level : levels) size += level.bytes.size();
    std::byte* mapped = nullptr;
    DARKROOM_TRY_VALUE(const VkBuffer source, stage(size, mapped));
    ImageCopy copy{.source = source, .target = &out, .regions = {}};
    std::size_t offset = 0;
    for (const Level& level : levels) {
        std::memcpy(mapped + offset, level.bytes.data(), level.bytes.size());
        copy.regions.push_back({.bufferOffset = offset,
                                .imageSubresource = {.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT,
                                                     .mipLevel = static_cast<std::uint32_t>(copy.regions.size()),
                                                     .layerCount = 1},
                                .imageExtent = {level.width, level.height, 1}});
        offset += level.bytes.size();
    }
    image_copies_.push_back(std::move(copy));
    return {};
}

Result<> Uploader::flush() {
    if (buffer_copies_.empty() && image_copies_.empty()) return {};
    const gpu::Dispatch& vk = context_->vk;
    Result<> done = gpu::submit_and_wait(*context_, "uploading the scene's assets", [&](VkCommandBuffer commands) {
        for (const BufferCopy& copy : buffer_copies_) {
            const VkBufferCopy region{.size = copy.size};
            vk.CmdCopyBuffer(commands, copy.source, copy.target, 1, &region);
        }
        for (const ImageCopy& copy : image_copies_) {
            gpu::transition(*context_, commands, *copy.target, VK_IMAGE_LAYOUT_UNDEFINED,
                            VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
            vk.CmdCopyBufferToImage(commands, copy.source, copy.target->handle, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                    static_cast<std::uint32_t>(copy.regions.size()), copy.regions.data());
            gpu::transition(*context_, commands, *copy.target, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                            VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
        }
        gpu::record_barrier(vk, commands, gpu::copied_to,
                            {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT});
    });
    buffer_copies_.clear();
    image_copies_.clear();
    staging_.clear();
    staged_bytes_ = 0;
    return done;
}

namespace {

constexpr std::size_t steps = 65536;

const std::array<float, 256>& decoded_bytes(bool is_srgb) {
    static const auto make = [](bool decodes) {
        std::array<float, 256> table{};
        for (std::size_t i = 0; i < table.size(); ++i) {
            const float value = static_cast<float>(i) / 255;
            table[i] = decodes ? srgb_decode(value) : value;
        }
        return table;
    };
    static const std::array<float, 256> srgb = make(true), linear = make(false);
    return is_srgb ? srgb : linear;
}

std::uint8_t to_byte(float value) { return static_cast<std::uint8_t>(std::clamp(value, 0.0F, 1.0F) * 255 + 0.5F); }

std::uint8_t encoded_byte(float linear) {
    static const std::vector<std::uint8_t> table = [] {
        std::vector<std::uint8_t> made(steps);
        for (std::size_t i = 0; i < steps; ++i)
            made[i] = to_byte(srgb_encode(static_cast<float>(i) / (static_cast<float>(steps) - 1)));
        return made;
    }();
    return table[static_cast<std::size_t>(std::clamp(linear, 0.0F, 1.0F) * (static_cast<float>(steps) - 1) + 0.5F)];
}

/// Taps of one output along one axis.
struct Taps {
    std::uint32_t first = 0, count = 1;
    std::array<float, 3> weights{1, 0, 0};
};

Taps taps_of(std::uint32_t output, std::uint32_t size) {
    if (size == 1) return {};
    if (size % 2 == 0) return {.first = 2 * output, .count = 2, .weights = {0.5F, 0.5F, 0}};
    const auto n = static_cast<float>(size), half = static_cast<float>(size / 2), i = static_cast<float>(output);
    return {.first = 2 * output, .count = 3, .weights = {(half - i) / n, half / n, (i + 1) / n}};
}

/// Linear numbers of a level, four a pixel.
struct LinearLevel {
    std::uint32_t width = 0, height = 0;
    std::vector<float> values;
};

/// `source(index)`: the linear number at that place.
template <class Source>
LinearLevel halved(std::uint32_t width, std::uint32_t height, const Source& source) {
    LinearLevel out{.width = std::max(width / 2, 1U), .height = std::max(height / 2, 1U), .values = {}};
    out.values.resize(std::size_t{out.width} * out.height * 4);
    float* value = out.values.data();
    for (std::uint32_t y = 0; y < out.height; ++y) {
        const Taps down = taps_of(y, height);
        for (std::uint32_t x = 0; x < out.width; ++x, value += 4) {
            const Taps across = taps_of(x, width);
            for (std::uint32_t j = 0; j < down.count; ++j) {
                for (std::uint32_t i = 0; i < across.count; ++i) {
                    const std::size_t place = (std::size_t{down.first + j} * width + across.first + i) * 4;
                    const float weight = down.weights[j] * across.weights[i];
                    for (std::size_t channel = 0; channel < 4; ++channel)
                        value[channel] += weight * source(place + channel);
                }
            }
        }
    }
    return out;
}

/// Share of the pixels whose alpha, scaled, reaches the cutoff.
float coverage(const LinearLevel& level, float cutoff, float scale) {
    std::size_t covered = 0;
    for (std::size_t i = 3; i < level.values.size(); i += 4) covered += level.values[i] * scale >= cutoff ? 1 : 0;
    return static_cast<float>(covered) / static_cast<float>(level.values.size() / 4);
}

/// By halving: the largest scale at which no more than this share is covered, or where there is none, none is.
void scale_alpha(LinearLevel& level, float cutoff, float wanted) {
    float low = 0, high = 8;
    for (int i = 0; i < 16; ++i) {
        const float middle = (low + high) / 2;
        (coverage(level, cutoff, middle) > wanted ? high : low) = middle;
    }
    // Of the two sides of the step the one that is nearer.
    const float scale = wanted - coverage(level, cutoff, low) < coverage(level, cutoff, high) - wanted ? low : high;
    for (std::size_t i = 3; i < level.values.size(); i += 4) level.values[i] = std::min(level.values[i] * scale, 1.0F);
}

MipLevel encoded(const LinearLevel& level, bool is_srgb) {
    MipLevel out{.width = level.width, .height = level.height, .rgba = {}};
    out.rgba.resize(level.values.size());
    for (std::size_t i = 0; i < out.rgba.size(); ++i)
        out.rgba[i] = is_srgb && i % 4 != 3 ? encoded_byte(level.values[i]) : to_byte(level.values[i]);
    return out;
}

/// Linear numbers of codes of 16 bits.
std::vector<float> decoded_codes(bool is_srgb) {
    std::vector<float> table(steps);
    for (std::size_t i = 0; i < steps; ++i) {
        const float value = static_cast<float>(i) / (static_cast<float>(steps) - 1);
        table[i] = is_srgb ? srgb_decode(value) : value;
    }
    return table;
}

std::vector<float> decoded_halves() {
    std::vector<float> table(steps);
    for (std::size_t i = 0; i < steps; ++i) table[i] = glm::unpackHalf1x16(static_cast<std::uint16_t>(i));
    return table;
}

std::uint16_t wide_sample(float value, bool as_code) {
    if (!as_code) return glm::packHalf1x16(value);
    return static_cast<std::uint16_t>(std::clamp(value, 0.0F, 1.0F) * 65535 + 0.5F);
}

WideMipLevel wide(const LinearLevel& level, bool as_codes) {
    WideMipLevel out{.width = level.width, .height = level.height, .rgba = {}};
    out.rgba.reserve(level.values.size());
    for (const float value : level.values) out.rgba.push_back(wide_sample(value, as_codes));
    return out;
}

/// Calls `keep(level)` with levels 1, 2, ... of what `source` gives.
template <class Source, class Keep>
void each_level(std::uint32_t width, std::uint32_t height, const Source& source, std::optional<float> alpha_cutoff,
                const Keep& keep) {
    if (width <= 1 && height <= 1) return;
    const std::size_t count = std::size_t{width} * height * 4;
    std::size_t covered = 0;
    if (alpha_cutoff)
        for (std::size_t i = 3; i < count; i += 4) covered += source(i) >= *alpha_cutoff ? 1 : 0;
    const float wanted = static_cast<float>(covered) / static_cast<float>(count / 4);
    LinearLevel level = halved(width, height, source);
    while (true) {
        if (alpha_cutoff) {
            // The next level is made of what is measured, not of what was scaled.
            LinearLevel scaled = level;
            scale_alpha(scaled, *alpha_cutoff, wanted);
            keep(scaled);
        } else {
            keep(level);
        }
        if (level.width == 1 && level.height == 1) return;
        level = halved(level.width, level.height, [&](std::size_t place) { return level.values[place]; });
    }
}

}  // namespace

std::vector<MipLevel> mip_levels(std::uint32_t width, std::uint32_t height, std::span<const std::uint8_t> rgba,
                                 bool is_srgb, std::optional<float> alpha_cutoff) {
    std::vector<MipLevel> levels;
    const std::array<float, 256>& color = decoded_bytes(is_srgb);
    const std::array<float, 256>& alpha = decoded_bytes(false);
    each_level(
        width, height, [&](std::size_t place) { return place % 4 == 3 ? alpha[rgba[place]] : color[rgba[place]]; },
        alpha_cutoff, [&](const LinearLevel& level) { levels.push_back(encoded(level, is_srgb)); });
    return levels;
}

std::vector<WideMipLevel> wide_mip_levels(const scene::Image& image, bool is_srgb, bool as_codes,
                                          std::optional<float> alpha_cutoff) {
    static const std::vector<float> srgb = decoded_codes(true), linear = decoded_codes(false), half = decoded_halves();
    const bool has_codes = image.kind == scene::ImageKind::Codes16;
    const std::vector<float>& alpha = has_codes ? linear : half;
    const std::vector<float>& color = has_codes && is_srgb ? srgb : alpha;
    const auto source = [&](std::size_t place) { return (place % 4 == 3 ? alpha : color)[image.wide[place]]; };
    std::vector<WideMipLevel> levels{{.width = image.width, .height = image.height, .rgba = {}}};
    levels[0].rgba.reserve(image.wide.size());
    for (std::size_t i = 0; i < image.wide.size(); ++i) levels[0].rgba.push_back(wide_sample(source(i), as_codes));
    each_level(image.width, image.height, source, alpha_cutoff,
               [&](const LinearLevel& level) { levels.push_back(wide(level, as_codes)); });
    return levels;
}

}  // namespace darkroom::render
