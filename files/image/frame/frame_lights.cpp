// SPDX-License-Identifier: MIT
#include "image/frame/frame_lights.hpp"

#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFloatVectorAttribute.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfVecAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "image/frame/channels.hpp"

namespace darkroom {
namespace {

constexpr const char* count_name = "darkroom:lights";
std::string attribute_name(std::size_t light, std::string_view what) {
    return fmt::format("darkroom:light{}.{}", light, what);
}
std::string matrix_name(std::size_t cascade) { return fmt::format("worldToCascade{}", cascade); }
std::string part_name(std::size_t shadow) { return fmt::format("shadow{}", shadow); }
std::string channel_name(std::size_t cascade) { return fmt::format("cascade{}", cascade); }

bool is_finite(std::span<const float> values) {
    return std::all_of(values.begin(), values.end(), [](float value) { return std::isfinite(value); });
}

Result<> check_side(std::string_view what, std::uint32_t width, std::uint32_t height) {
    if (width == height && width >= 1 && width <= max_cascade_side) return {};
    return user_error(fmt::format("{}: cascades of {}x{} texels; squares of [1, {}] a side are allowed", what, width,
                                  height, max_cascade_side));
}

Result<> check_total(std::uint64_t texels) {
    if (texels <= max_cascade_texels) return {};
    return user_error(
        fmt::format("the cascades of all lights have {} texels, at most {} are allowed", texels, max_cascade_texels));
}

Result<> check_light(const FrameLight& light, std::string_view what) {
    if (!is_finite(light.direction) || !is_finite(light.color) || !is_finite(light.volumetric_color) ||
        !std::isfinite(light.volumetric_intensity))
        return user_error(fmt::format("{}: a number is not finite", what));
    if (light.cascades.size() > FrameLight::max_cascades)
        return user_error(fmt::format("{}: {} cascades, at most {} are allowed", what, light.cascades.size(),
                                      FrameLight::max_cascades));
    for (const FrameCascade& cascade : light.cascades) {
        const Plane<1>& depth = cascade.depth;
        if (!is_finite(cascade.world_to_cascade) || !std::isfinite(cascade.split))
            return user_error(fmt::format("{}: a number of a cascade is not finite", what));
        DARKROOM_TRY(check_side(what, depth.width, depth.height));
        if (depth.width != light.cascades.front().depth.width ||
            depth.values.size() != std::size_t{depth.width} * depth.height)
            return user_error(fmt::format("{}: its cascades differ in size", what));
    }
    return {};
}

class LightReader {
  public:
    LightReader(Decoder& decoder, std::size_t part, const FrameOptions& options, FrameFile& frame)
        : decoder_(decoder), part_(part), options_(options), frame_(frame) {}

    Result<> read() {
        const double count = decoder_.number(part_, count_name).value_or(0);
        if (!is_whole(count, max_frame_lights))
            return user_error(
                fmt::format("{} = {}; whole numbers in [0, {}] are allowed", count_name, count, max_frame_lights));
        for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) DARKROOM_TRY(read_light(i));
        warn_of_unused_parts();
        return {};
    }

  private:
    static bool is_whole(double value, std::size_t most) {
        return value >= 0 && value <= static_cast<double>(most) && value == std::floor(value);
    }

    void warn_of_unused_parts() {
        std::string first;
        std::size_t more = 0;
        const std::span<const FilePart> parts = decoder_.parts();
        for (std::size_t i = 0; i < parts.size(); ++i) {
            if (!is_shadow_part(parts[i]) || std::find(used_.begin(), used_.end(), i) != used_.end()) continue;
            more += !first.empty();
            if (first.empty()) first = one_printable_line(parts[i].name);
        }
        if (first.empty()) return;
        frame_.warnings.push_back(fmt::format("no light has the shadows {}{}: left out", first,
                                              more > 0 ? fmt::format(" and {} more", more) : ""));
    }

    Result<> read_numbers(std::size_t light, std::string_view what, std::span<float> to) const {
        const std::string name = attribute_name(light, what);
        const std::vector<float> values = decoder_.numbers(part_, name);
        if (values.size() != to.size() || !is_finite(values))
            return user_error(fmt::format("{} is missing or damaged; it has {} finite numbers", name, to.size()));
        std::copy(values.begin(), values.end(), to.begin());
        return {};
    }

    Result<> read_light(std::size_t number) {
        FrameLight light;
        DARKROOM_TRY(read_numbers(number, "direction", light.direction));
        DARKROOM_TRY(read_numbers(number, "color", light.color));
        DARKROOM_TRY(read_numbers(number, "volumetricColor", light.volumetric_color));
        DARKROOM_TRY(read_numbers(number, "volumetricIntensity", {&light.volumetric_intensity, 1}));
        if (const auto shadow = decoder_.number(part_, attribute_name(number, "shadow")))
            DARKROOM_TRY(read_shadow(number, *shadow, light));
        frame_.lights.push_back(std::move(light));
        return {};
    }

    /// Which part of the file the number stands for. No two lights share one.
    Result<std::size_t> find_part(std::size_t light, double shadow) {
        const std::string name = attribute_name(light, "shadow");
        if (!is_whole(shadow, max_frame_shadows - 1))
            return user_error(
                fmt::format("{} = {}; whole numbers in [0, {}] are allowed", name, shadow, max_frame_shadows - 1));
        const std::span<const FilePart> parts = decoder_.parts();
        const auto found = std::find_if(parts.begin(), parts.end(), [&](const FilePart& part) {
            return part.name == part_name(static_cast<std::size_t>(shadow));
        });
        if (found == parts.end())
            return user_error(fmt::format("{} = {}; the file has no part shadow{}", name, shadow, shadow));
        const auto index = static_cast<std::size_t>(found - parts.begin());
        if (std::find(used_.begin(), used_.end(), index) != used_.end())
            return user_error(fmt::format("{} = {}; each light has shadows of its own", name, shadow));
        used_.push_back(index);
        return index;
    }

    Result<> read_shadow(std::size_t number, double shadow, FrameLight& light) {
        DARKROOM_TRY_VALUE(const std::size_t index, find_part(number, shadow));
        const FilePart& part = decoder_.parts()[index];
        const std::size_t count = part.channels.size();
        std::vector<std::size_t> cascade_of(count);  // by the channel's place in the file
        for (std::size_t i = 0; i < count; ++i) {
            const auto is_named = [&](std::size_t cascade) { return part.channels[i] == channel_name(cascade); };
            while (cascade_of[i] < count && !is_named(cascade_of[i])) ++cascade_of[i];
            if (count > FrameLight::max_cascades || cascade_of[i] == count)
                return user_error(
                    fmt::format("{} has {} channels with {} among them; cascade0 to cascade{} are allowed", part.name,
                                count, one_printable_line(part.channels[i]), FrameLight::max_cascades - 1));
            if (part.kinds[i] == SampleKind::Integer32)
                return user_error(fmt::format("{} has 32-bit integers; half or float is needed", part.name));
        }
        DARKROOM_TRY(check_side(part.name, part.width, part.height));
        texels_ += std::uint64_t{part.width} * part.height * count;
        DARKROOM_TRY(check_total(texels_));

        std::vector<float> splits(count);
        DARKROOM_TRY(read_numbers(number, "splits", splits));
        light.cascades.resize(count);
        for (std::size_t i = 0; i < count; ++i) {
            FrameCascade& cascade = light.cascades[i];
            cascade.split = splits[i];
            DARKROOM_TRY(read_numbers(number, matrix_name(i), cascade.world_to_cascade));
        }
        return options_.has_shadow_depths ? read_depths(index, cascade_of, light) : Result<>{};
    }

    Result<> read_depths(std::size_t index, const std::vector<std::size_t>& cascade_of, FrameLight& light) {
        const FilePart& part = decoder_.parts()[index];
        for (FrameCascade& cascade : light.cascades) cascade.depth = Plane<1>(part.width, part.height);
        const std::size_t count = cascade_of.size();
        std::size_t outside = 0;
        const auto take = [&](std::uint32_t row, std::uint32_t rows, std::span<const float> samples) {
            const std::size_t first = std::size_t{row} * part.width;
            const std::size_t texels = std::size_t{rows} * part.width;
            for (std::size_t i = 0; i < count; ++i) {
                float* out = light.cascades[cascade_of[i]].depth.values.data() + first;
                for (std::size_t texel = 0; texel < texels; ++texel) {
                    const float depth = samples[texel * count + i];
                    const bool is_known = std::isfinite(depth);
                    frame_.counts.not_finite_other += !is_known;
                    outside += is_known && (depth < 0 || depth > 1);
                    out[texel] = is_known ? std::clamp(depth, 0.0f, 1.0f) : 1.0f;
                }
            }
        };
        DARKROOM_TRY(decoder_.read(index, 0, static_cast<std::uint32_t>(count), take));
        if (outside > 0)
            frame_.warnings.push_back(fmt::format("{}: {} depths are not in [0, 1]: clamped", part.name, outside));
        return {};
    }

    Decoder& decoder_;
    std::size_t part_;
    const FrameOptions& options_;
    FrameFile& frame_;
    std::vector<std::size_t> used_;  // parts that lights have
    std::uint64_t texels_ = 0;
};

}  // namespace

Result<> check_lights(std::span<const FrameLight> lights) {
    const auto shadows = static_cast<std::size_t>(
        std::count_if(lights.begin(), lights.end(), [](const FrameLight& light) { return !light.cascades.empty(); }));
    if (lights.size() > max_frame_lights || shadows > max_frame_shadows)
        return user_error(fmt::format("{} lights, {} of them with cascades; at most {} and {} are allowed",
                                      lights.size(), shadows, max_frame_lights, max_frame_shadows));
    std::uint64_t texels = 0;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        DARKROOM_TRY(check_light(lights[i], fmt::format("light {}", i)));
        for (const FrameCascade& cascade : lights[i].cascades) texels += cascade.depth.values.size();
    }
    return check_total(texels);
}

void add_lights(Imf::Header& frame, std::span<const FrameLight> lights) {
    if (lights.empty()) return;
    frame.insert(count_name, Imf::IntAttribute(static_cast<int>(lights.size())));
    int shadow = 0;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const FrameLight& light = lights[i];
        const auto add = [&](std::string_view what, const Imf::Attribute& value) {
            frame.insert(attribute_name(i, what), value);
        };
        const auto vector = [](const std::array<float, 3>& v) {
            return Imf::V3fAttribute(Imath::V3f(v[0], v[1], v[2]));
        };
        add("direction", vector(light.direction));
        add("color", vector(light.color));
        add("volumetricColor", vector(light.volumetric_color));
        add("volumetricIntensity", Imf::FloatAttribute(light.volumetric_intensity));
        if (light.cascades.empty()) continue;
        add("shadow", Imf::IntAttribute(shadow++));
        std::vector<float> splits;
        for (std::size_t c = 0; c < light.cascades.size(); ++c) {
            splits.push_back(light.cascades[c].split);
            Imath::M44f matrix;
            std::copy_n(light.cascades[c].world_to_cascade.begin(), 16, matrix.getValue());
            add(matrix_name(c), Imf::M44fAttribute(matrix));
        }
        add("splits", Imf::FloatVectorAttribute(splits));
    }
}

std::vector<ExrPart> shadow_parts(const Imf::Header& frame, std::span<const FrameLight> lights) {
    std::vector<ExrPart> parts;
    for (const FrameLight& light : lights) {
        if (light.cascades.empty()) continue;
        const std::uint32_t side = light.cascades.front().depth.width;
        ExrPart part{.header = exr_header(side, side)};
        part.header.displayWindow() = frame.displayWindow();
        part.header.setName(part_name(parts.size()));
        for (std::size_t c = 0; c < light.cascades.size(); ++c)
            part.channels.push_back(
                {.name = channel_name(c), .kind = SampleKind::Float, .values = light.cascades[c].depth.values.data()});
        parts.push_back(std::move(part));
    }
    return parts;
}

Result<> read_lights(Decoder& decoder, std::size_t part, const FrameOptions& options, FrameFile& frame) {
    return LightReader(decoder, part, options, frame).read();
}

}  // namespace darkroom
