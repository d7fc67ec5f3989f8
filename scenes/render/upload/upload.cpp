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

/// `source(index)`: the linear number at that place. Where nothing is seen, the mean is that of all colours.
template <class Source>
LinearLevel halved(std::uint32_t width, std::uint32_t height, const Source& source, bool alpha_weighs) {
    LinearLevel out{.width = std::max(width / 2, 1U), .height = std::max(height / 2, 1U), .values = {}};
    out.values.resize(std::size_t{out.width} * out.height * 4);
    float* value = out.values.data();
    for (std::uint32_t y = 0; y < out.height; ++y) {
        const Taps down = taps_of(y, height);
        for (std::uint32_t x = 0; x < out.width; ++x, value += 4) {
            const Taps across = taps_of(x, width);
            std::array<float, 3> seen{};
            for (std::uint32_t j = 0; j < down.count; ++j) {
                for (std::uint32_t i = 0; i < across.count; ++i) {
                    const std::size_t place = (std::size_t{down.first + j} * width + across.first + i) * 4;
                    const float weight = down.weights[j] * across.weights[i];
                    for (std::size_t channel = 0; channel < 4; ++channel)
                        value[channel] += weight * source(place + channel);
                    if (!alpha_weighs) continue;
                    const float shown = weight * source(place + 3);
                    for (std::size_t channel = 0; channel < 3; ++channel)
                        seen[channel] += shown * source(place + channel);
                }
            }
            if (!alpha_weighs || !(value[3] > 0)) continue;
            for (std::size_t channel = 0; channel < 3; ++channel) value[channel] = seen[channel] / value[3];
        }
    }
    return out;
}

/// The colour of what is seen beside a pixel that is not, or where nothing is, of the level below.
template <class Source>
std::array<float, 3> color_beside(std::uint32_t x, std::uint32_t y, std::uint32_t width, std::uint32_t height,
                                  const Source& source, const LinearLevel& below) {
    std::array<float, 3> sum{};
    float total = 0;
    for (std::uint32_t row = y - (y > 0 ? 1U : 0U); row <= std::min(y + 1, height - 1); ++row) {
        for (std::uint32_t column = x - (x > 0 ? 1U : 0U); column <= std::min(x + 1, width - 1); ++column) {
            const std::size_t place = (std::size_t{row} * width + column) * 4;
            const float alpha = source(place + 3);
            total += alpha;
            for (std::size_t channel = 0; channel < 3; ++channel) sum[channel] += alpha * source(place + channel);
        }
    }
    if (total > 0) return {sum[0] / total, sum[1] / total, sum[2] / total};
    const std::size_t row = std::min(y / 2, below.height - 1), column = std::min(x / 2, below.width - 1);
    const float* const color = below.values.data() + (row * below.width + column) * 4;
    return {color[0], color[1], color[2]};
}

/// Calls `write(index, colour)` for every pixel whose alpha is 0.
template <class Source, class Write>
void fill_unseen(std::uint32_t width, std::uint32_t height, const Source& source, const LinearLevel& below,
                 const Write& write) {
    for (std::uint32_t y = 0; y < height; ++y) {
        for (std::uint32_t x = 0; x < width; ++x) {
            const std::size_t place = (std::size_t{y} * width + x) * 4;
            if (!(source(place + 3) > 0)) write(place, color_beside(x, y, width, height, source, below));
        }
    }
}

/// Alpha as a sampler filters it, at a place in pixels, whose centres are at halves. The picture repeats.
template <class Source>
float filtered_alpha(std::uint32_t width, std::uint32_t height, const Source& source, float x, float y) {
    const float left = std::floor(x - 0.5F), top = std::floor(y - 0.5F);
    const float across = x - 0.5F - left, down = y - 0.5F - top;
    const std::size_t column = (static_cast<std::size_t>(left + 1) + width - 1) % width, right = (column + 1) % width;
    const std::size_t row = (static_cast<std::size_t>(top + 1) + height - 1) % height, below = (row + 1) % height;
    const auto alpha = [&](std::size_t i, std::size_t j) { return source((j * width + i) * 4 + 3); };
    const float upper = std::lerp(alpha(column, row), alpha(right, row), across);
    return std::lerp(upper, std::lerp(alpha(column, below), alpha(right, below), across), down);
}

/// Calls `visit(x, y)` with sixteen places in each pixel, of large pictures in some of them.
template <class Visit>
void each_place(std::uint32_t width, std::uint32_t height, const Visit& visit) {
    constexpr std::size_t max_pixels = 1U << 14U;
    const std::size_t count = std::size_t{width} * height;
    // Odd, so that it walks through all columns.
    const std::size_t step = count <= max_pixels ? 1 : (count / max_pixels) | 1U;
    for (std::size_t pixel = 0; pixel < count; pixel += step)
        for (std::size_t i = 0; i < 16; ++i)
            visit(static_cast<float>(pixel % width) + (static_cast<float>(i % 4) + 0.5F) / 4,
                  static_cast<float>(pixel / width) + (static_cast<float>(i / 4) + 0.5F) / 4);
}

template <class Source>
float covered_share(std::uint32_t width, std::uint32_t height, const Source& source, float cutoff) {
    std::size_t covered = 0, places = 0;
    each_place(width, height, [&](float x, float y) {
        covered += filtered_alpha(width, height, source, x, y) >= cutoff ? 1 : 0;
        ++places;
    });
    return static_cast<float>(covered) / static_cast<float>(places);
}

/// By halving what alpha is compared with: the scale at which the share that is covered is the nearest. A sampler mixes
/// the level with the one before it, `finer(x, y)`, with its sides from 0 to 1: the share is the mean of mixtures, each
/// of which has less contrast than both.
template <class Finer>
void scale_alpha(LinearLevel& level, float cutoff, float wanted, const Finer& finer) {
    constexpr int mixtures = 4;
    std::vector<float> before;
    each_place(level.width, level.height, [&](float x, float y) {
        before.push_back(finer(x / static_cast<float>(level.width), y / static_cast<float>(level.height)));
    });
    const auto share = [&](float threshold) {
        const float scale = cutoff / threshold;
        const auto scaled = [&](std::size_t place) { return std::min(level.values[place] * scale, 1.0F); };
        std::size_t covered = 0, place = 0;
        each_place(level.width, level.height, [&](float x, float y) {
            const float own = filtered_alpha(level.width, level.height, scaled, x, y), other = before[place++];
            for (int i = 1; i <= mixtures; ++i)
                covered += std::lerp(other, own, static_cast<float>(i) / mixtures) >= cutoff ? 1 : 0;
        });
        return static_cast<float>(covered) / static_cast<float>(mixtures * before.size());
    };
    float low = 1e-4F, high = 1;
    for (int i = 0; i < 14; ++i) {
        const float middle = (low + high) / 2;
        (share(middle) > wanted ? low : high) = middle;
    }
    const float scale = cutoff / (share(low) - wanted < wanted - share(high) ? low : high);
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

/// Calls `keep(level)` with levels 1, 2, ... of what `source` gives, and `fill(level 1)` before where alpha weighs.
template <class Source, class Keep, class Fill>
void each_level(std::uint32_t width, std::uint32_t height, const Source& source, AlphaUse alpha, const Keep& keep,
                const Fill& fill) {
    if (width <= 1 && height <= 1) return;
    std::vector<LinearLevel> levels;
    levels.push_back(halved(width, height, source, alpha.weighs));
    while (levels.back().width > 1 || levels.back().height > 1) {
        if (!alpha.weighs) keep(levels.back());
        const LinearLevel& last = levels.back();
        LinearLevel next = halved(
            last.width, last.height, [&](std::size_t place) { return last.values[place]; }, alpha.weighs);
        // Only what is filled needs all levels at once.
        if (!alpha.weighs) levels.clear();
        levels.push_back(std::move(next));
    }
    if (!alpha.weighs) return keep(levels.back());
    for (std::size_t i = levels.size() - 1; i-- > 0;) {
        LinearLevel& level = levels[i];
        const auto put = [&](std::size_t place, const std::array<float, 3>& color) {
            std::ranges::copy(color, level.values.begin() + static_cast<std::ptrdiff_t>(place));
        };
        fill_unseen(
            level.width, level.height, [&](std::size_t place) { return level.values[place]; }, levels[i + 1], put);
    }
    fill(levels.front());
    // What is scaled is made of what is measured, not of what was scaled.
    const float wanted = alpha.cutoff > 0 ? covered_share(width, height, source, alpha.cutoff) : 0;
    for (std::size_t i = 0; alpha.cutoff > 0 && i < levels.size(); ++i)
        scale_alpha(levels[i], alpha.cutoff, wanted, [&](float x, float y) {
            if (i == 0)
                return filtered_alpha(width, height, source, x * static_cast<float>(width),
                                      y * static_cast<float>(height));
            const LinearLevel& before = levels[i - 1];
            return filtered_alpha(
                before.width, before.height, [&](std::size_t place) { return before.values[place]; },
                x * static_cast<float>(before.width), y * static_cast<float>(before.height));
        });
    for (const LinearLevel& level : levels) keep(level);
}

}  // namespace

std::vector<MipLevel> mip_levels(std::uint32_t width, std::uint32_t height, std::span<const std::uint8_t> rgba,
                                 bool is_srgb, AlphaUse alpha) {
    std::vector<MipLevel> levels;
    const std::array<float, 256>& colors = decoded_bytes(is_srgb);
    const std::array<float, 256>& alphas = decoded_bytes(false);
    const auto source = [&](std::size_t place) { return (place % 4 == 3 ? alphas : colors)[rgba[place]]; };
    each_level(
        width, height, source, alpha, [&](const LinearLevel& level) { levels.push_back(encoded(level, is_srgb)); },
        [&](const LinearLevel& below) {
            levels.push_back({.width = width, .height = height, .rgba = {rgba.begin(), rgba.end()}});
            fill_unseen(width, height, source, below, [&](std::size_t place, const std::array<float, 3>& color) {
                for (std::size_t i = 0; i < 3; ++i)
                    levels[0].rgba[place + i] = is_srgb ? encoded_byte(color[i]) : to_byte(color[i]);
            });
        });
    return levels;
}

std::vector<WideMipLevel> wide_mip_levels(const scene::Image& image, bool is_srgb, bool as_codes, AlphaUse alpha) {
    static const std::vector<float> srgb = decoded_codes(true), linear = decoded_codes(false), half = decoded_halves();
    const bool has_codes = image.kind == scene::ImageKind::Codes16;
    const std::vector<float>& alphas = has_codes ? linear : half;
    const std::vector<float>& colors = has_codes && is_srgb ? srgb : alphas;
    const auto source = [&](std::size_t place) { return (place % 4 == 3 ? alphas : colors)[image.wide[place]]; };
    std::vector<WideMipLevel> levels{{.width = image.width, .height = image.height, .rgba = {}}};
    levels[0].rgba.reserve(image.wide.size());
    for (std::size_t i = 0; i < image.wide.size(); ++i) levels[0].rgba.push_back(wide_sample(source(i), as_codes));
    each_level(
        image.width, image.height, source, alpha,
        [&](const LinearLevel& level) { levels.push_back(wide(level, as_codes)); },
        [&](const LinearLevel& below) {
            fill_unseen(image.width, image.height, source, below,
                        [&](std::size_t place, const std::array<float, 3>& color) {
                            for (std::size_t i = 0; i < 3; ++i)
                                levels[0].rgba[place + i] = wide_sample(color[i], as_codes);
                        });
        });
    return levels;
}

}  // namespace darkroom::render
