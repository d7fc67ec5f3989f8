// SPDX-License-Identifier: MIT
#include "compose/chain/frame_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "gpu/device/context.hpp"
#include "gpu/resource/formats.hpp"
#include "plan/frame_inputs.hpp"

namespace darkroom::compose {

namespace {

using plan::HostImage;
using plan::InputExtent;
using Kind = HostImage::Kind;

/// An image of the frame that the plan uses, and what an error calls it: "depth", "lights[2].cascades".
struct Given {
    HostImage which{};
    std::size_t place = 0;  ///< in the frame: of the light whose cascades they are, or of what is watched
    const ImageRef* image = nullptr;

    [[nodiscard]] bool is_cascades() const { return which.kind == Kind::Shadow; }
    [[nodiscard]] bool is_watched() const { return which.kind == Kind::Watched; }
    [[nodiscard]] bool is_written() const { return which.kind == Kind::Target || is_watched(); }
    /// Of an input.
    [[nodiscard]] const plan::FrameInput& input() const { return plan::frame_inputs[which.number]; }
};

std::string name_of(const Given& given) {
    if (given.is_cascades()) return fmt::format("frame.lights[{}].cascades", given.place);
    if (given.is_watched()) return fmt::format("frame.watched[{}].target", given.place);
    if (given.which.kind == Kind::Input) return fmt::format("frame.{}", given.input().name);
    return given.which.kind == Kind::Color ? "frame.color" : "frame.target";
}

template <class... Arguments>
Failure refused(const Given& given, fmt::format_string<Arguments...> text, Arguments&&... arguments) {
    return user_error(
        fmt::format("record: {}{}", name_of(given), fmt::format(text, std::forward<Arguments>(arguments)...)));
}

const ImageUse& use_of(const CompileDesc& desc, const Given& given) {
    if (given.which.kind == Kind::Input) return desc.*given.input().use;
    return given.which.kind == Kind::Color ? desc.color : desc.target;
}

bool is_same(VkExtent2D a, VkExtent2D b) { return a.width == b.width && a.height == b.height; }
bool is_empty(VkExtent2D extent) { return extent.width == 0 || extent.height == 0; }

Result<> check_handles(const Given& given) {
    const ImageRef& image = *given.image;
    if (image.image == VK_NULL_HANDLE && image.view == VK_NULL_HANDLE)
        return refused(given, " is not given, and the plan {} it", given.is_written() ? "writes" : "reads");
    if (image.image == VK_NULL_HANDLE) return refused(given, ".image is null: barriers need it beside the view");
    if (image.view == VK_NULL_HANDLE) return refused(given, ".view is null: shaders need it beside the image");
    return {};
}

Result<> check_state(const Given& given, VkFormat format, std::string_view why) {
    const ImageRef& image = *given.image;
    if (image.format != format)
        return refused(given, ".format is {}: allowed is {}, {}", gpu::format_name(image.format),
                       gpu::format_name(format), why);
    if (image.layout == VK_IMAGE_LAYOUT_UNDEFINED && !given.is_written())
        return refused(given,
                       ".layout is UNDEFINED: allowed is the layout that the image is in, or its texels are lost");
    if (image.final_layout == VK_IMAGE_LAYOUT_PREINITIALIZED)
        return refused(given, ".final_layout is PREINITIALIZED: allowed is any layout that an image can be brought to");
    return {};
}

bool ends_inside(std::int32_t from, std::uint32_t length, std::uint32_t size) {
    return from >= 0 && std::uint64_t{static_cast<std::uint32_t>(from)} + length <= size;
}

Result<> check_region(const Given& given) {
    const ImageRef& image = *given.image;
    if (is_empty(image.extent))
        return refused(given, ".extent is {}x{}: allowed is that of the mip level that the view shows",
                       image.extent.width, image.extent.height);
    const VkRect2D region = image.used_region();
    if (!ends_inside(region.offset.x, region.extent.width, image.extent.width) ||
        !ends_inside(region.offset.y, region.extent.height, image.extent.height))
        return refused(given, ".region, {}x{} from ({}, {}), does not lie inside its {}x{} image", region.extent.width,
                       region.extent.height, region.offset.x, region.offset.y, image.extent.width, image.extent.height);
    return {};
}

Result<> check_picture(const Given& given, const plan::Program& program, const CompileDesc& desc, const Frame& frame) {
    const ImageRef& image = *given.image;
    DARKROOM_TRY(check_handles(given));
    DARKROOM_TRY(check_state(given, use_of(desc, given).format, "as compiled"));
    DARKROOM_TRY(check_region(given));
    if (image.layer_count != 1) return refused(given, ".layer_count is {}: allowed is 1", image.layer_count);
    const VkExtent2D extent = image.used_region().extent, color = frame.color.used_region().extent;
    const bool is_target = given.which.kind == Kind::Target;
    const VkExtent2D most = is_target ? desc.target_extent : desc.max_extent;
    if (given.which.kind == Kind::Color || (is_target && !is_empty(most))) {
        if (is_empty(extent) || extent.width > most.width || extent.height > most.height)
            return refused(given, " is {}x{}: allowed is 1x1 to {}x{}, as compiled; a part of an image is its region",
                           extent.width, extent.height, most.width, most.height);
        return {};
    }
    const InputExtent of = is_target ? InputExtent::Scene : given.input().extent;
    if (of == InputExtent::Texel) {
        if (is_same(extent, {1, 1})) return {};
        return refused(given, " is {}x{}: allowed is one texel", extent.width, extent.height);
    }
    if (of == InputExtent::Interface && !is_empty(desc.target_extent)) {
        const VkExtent2D target = frame.target.used_region().extent;
        if (is_same(extent, target)) return {};
        return refused(given, " is {}x{}: with a target of {}x{} it must be as large", extent.width, extent.height,
                       target.width, target.height);
    }
    const VkExtent2D wanted = is_target ? program.target_size.of(graph::Extents(color)) : color;
    if (!is_same(extent, wanted))
        return refused(given, " is {}x{}: with a color of {}x{} it must be {}x{}; a part of an image is its region",
                       extent.width, extent.height, color.width, color.height, wanted.width, wanted.height);
    return {};
}

Result<> check_cascades(const Given& given, const Light& light) {
    const ImageRef& image = *given.image;
    DARKROOM_TRY(check_handles(given));
    if (light.cascade_count > Light::max_cascades)
        return user_error(fmt::format("record: frame.lights[{}].cascade_count is {}: allowed is [0, {}]", given.place,
                                      light.cascade_count, Light::max_cascades));
    DARKROOM_TRY(check_state(given, VK_FORMAT_D32_SFLOAT, "for every light"));
    DARKROOM_TRY(check_region(given));
    if (image.extent.width != image.extent.height)
        return refused(given, ".extent is {}x{}: allowed are squares", image.extent.width, image.extent.height);
    if (!is_same(image.used_region().extent, image.extent))
        return refused(given, ".region is {}x{}: cascades fill their {}x{} image", image.region.extent.width,
                       image.region.extent.height, image.extent.width, image.extent.height);
    if (image.layer_count < light.cascade_count)
        return refused(given, ".layer_count is {}: allowed is cascade_count = {} and more", image.layer_count,
                       light.cascade_count);
    return {};
}

/// The images of one frame that the plan uses; no more than these, so that nothing is allocated.
struct AllGiven {
    std::array<Given, 2 + frame_image_count + max_shadow_lights> images;
    std::size_t count = 0;
};

Result<> check_lights(const plan::Program& program, const Frame& frame, AllGiven& all) {
    bool reads_shadows = false;
    for (const auto& which : program.imports) reads_shadows |= which && which->kind == Kind::Shadow;
    if (!reads_shadows) return {};
    std::uint32_t number = 0;
    for (std::size_t i = 0; i < frame.lights.size() && number < max_shadow_lights; ++i) {
        const Light& light = frame.lights[i];
        // Without cascades it casts no shadow, and is not one of the first four that do.
        const bool has_image = light.cascades.image != VK_NULL_HANDLE || light.cascades.view != VK_NULL_HANDLE;
        if (!has_image || light.cascade_count == 0) continue;
        const Given given{{Kind::Shadow, number}, i, &light.cascades};
        DARKROOM_TRY(check_cascades(given, light));
        all.images[all.count++] = given;
        ++number;
    }
    return {};
}

/// Two inputs may be one image only where no barrier has to move it: each would start from the layout the host named.
bool stays_readable(const Given& given, const CompileDesc& desc) {
    const ImageRef& image = *given.image;
    const bool is_sampled = given.is_cascades() || (use_of(desc, given).usage & VK_IMAGE_USAGE_STORAGE_BIT) == 0;
    return is_sampled && image.layout == VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL &&
           (image.final_layout == image.layout || image.final_layout == VK_IMAGE_LAYOUT_UNDEFINED);
}

Result<> check_watched(const AllGiven& all, const CompileDesc& desc, const Frame& frame) {
    const VkExtent2D color = frame.color.used_region().extent;
    for (std::size_t i = 0; i < frame.watched.size(); ++i) {
        const Watched& watched = frame.watched[i];
        const auto number = watch_with(desc, watched.id);
        if (!number || !watched.target.is_given()) continue;
        const Given given{{Kind::Watched, static_cast<std::uint32_t>(*number)}, i, &watched.target};
        DARKROOM_TRY(check_handles(given));
        DARKROOM_TRY(check_state(given, desc.watches[*number].target.format, "as compiled"));
        DARKROOM_TRY(check_region(given));
        if (watched.target.layer_count != 1)
            return refused(given, ".layer_count is {}: allowed is 1", watched.target.layer_count);
        const VkRect2D part = watched.region.extent.width == 0 ? VkRect2D{{}, color} : watched.region;
        if (is_empty(part.extent) || !ends_inside(part.offset.x, part.extent.width, color.width) ||
            !ends_inside(part.offset.y, part.extent.height, color.height))
            return user_error(fmt::format(
                "record: frame.watched[{}].region, {}x{} from ({}, {}), does not lie inside the {}x{} picture", i,
                part.extent.width, part.extent.height, part.offset.x, part.offset.y, color.width, color.height));
        for (std::size_t j = 0; j < all.count; ++j)
            if (overlap(*all.images[j].image, watched.target))
                return refused(given, ".image is that of {}, too: an image cannot be used while it is written",
                               name_of(all.images[j]));
        for (std::size_t j = 0; j < i; ++j) {
            const Watched& other = frame.watched[j];
            const bool is_alike = other.id == watched.id || overlap(other.target, watched.target);
            if (is_alike && other.target.is_given() && watch_with(desc, other.id))
                return refused(
                    given, " has the id or the image of frame.watched[{}]: allowed are an id and an image of its own",
                    j);
        }
    }
    return {};
}

Result<> check_overlaps(const AllGiven& all, const CompileDesc& desc) {
    for (std::size_t i = 0; i < all.count; ++i)
        for (std::size_t j = 0; j < i; ++j) {
            const Given &a = all.images[j], &b = all.images[i];
            if (!overlap(*a.image, *b.image)) continue;
            if (a.is_written() || b.is_written())
                return refused(a.is_written() ? b : a,
                               ".image is that of frame.target, too: an image "
                               "cannot be read while it is written");
            if (!stays_readable(a, desc) || !stays_readable(b, desc))
                return refused(b,
                               ".image is that of {}, too: allowed where both are compiled without STORAGE, and "
                               "their layout is and stays SHADER_READ_ONLY_OPTIMAL",
                               name_of(a));
        }
    return {};
}

/// Shaders sample and write numbers, no integers.
bool is_integer(VkFormat format) { return gpu::format_traits(format).numeric != gpu::Numeric::Float; }

Result<> check_input(const gpu::Context& context, std::string_view name, const ImageUse& use) {
    if ((use.usage & VK_IMAGE_USAGE_SAMPLED_BIT) == 0)
        return user_error(fmt::format("compile: {}.usage = {:#x}: allowed are usages with SAMPLED", name, use.usage));
    if (is_integer(use.format) || !context.supports(use.format, VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT))
        return user_error(fmt::format(
            "compile: {}.format = {}: allowed are formats that this device can sample, and none of integers", name,
            gpu::format_name(use.format)));
    return {};
}

Result<> check_target(const gpu::Context& context, const std::string& name, const ImageUse& use) {
    // Some devices store to depth formats; a shader of ours declares an image of colour.
    const bool is_color =
        gpu::format_traits(use.format).aspects == VK_IMAGE_ASPECT_COLOR_BIT && !is_integer(use.format);
    const auto supports = [&](VkFormatFeatureFlags features) {
        return is_color && context.supports(use.format, features);
    };
    const bool can_attach = supports(VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT);
    const bool can_store = supports(VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT);
    if (use.format == VK_FORMAT_UNDEFINED || (!can_attach && !can_store))
        return user_error(
            fmt::format("compile: {}.format = {}: allowed are colour formats that this device can render to or "
                        "store; depth, integer and block-compressed ones are none",
                        name, gpu::format_name(use.format)));
    const bool is_attached = (use.usage & VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT) != 0;
    const bool is_stored = (use.usage & VK_IMAGE_USAGE_STORAGE_BIT) != 0;
    if (!is_attached && !is_stored)
        return user_error(fmt::format("compile: {}.usage = {:#x}: allowed are usages with COLOR_ATTACHMENT or STORAGE",
                                      name, use.usage));
    if (!(is_attached && can_attach) && !(is_stored && can_store))
        return user_error(fmt::format("compile: {}.usage = {:#x}: {} needs {} on this device", name, use.usage,
                                      gpu::format_name(use.format), can_attach ? "COLOR_ATTACHMENT" : "STORAGE"));
    return {};
}

Result<> check_watches(const gpu::Context& context, const CompileDesc& desc) {
    if (desc.watches.size() > max_watches)
        return user_error(fmt::format("compile: {} watches: allowed are at most {}", desc.watches.size(), max_watches));
    for (std::size_t i = 0; i < desc.watches.size(); ++i) {
        const Watch& watch = desc.watches[i];
        if (*watch_with(desc, watch.id) != i)
            return user_error(
                fmt::format("compile: watches[{}].id = {}: watches[{}] has it, too; allowed is an id of its own", i,
                            watch.id, *watch_with(desc, watch.id)));
        DARKROOM_TRY(check_target(context, fmt::format("watches[{}].target", i), watch.target));
    }
    return {};
}

}  // namespace

bool overlap(const ImageRef& a, const ImageRef& b) {
    return a.image == b.image && a.mip_level == b.mip_level && a.array_layer < b.array_layer + b.layer_count &&
           b.array_layer < a.array_layer + a.layer_count;
}

const ImageRef& host_image(const Frame& frame, HostImage which) {
    if (which.kind == Kind::Input) return frame.*plan::frame_inputs[which.number].given;
    return which.kind == Kind::Color ? frame.color : frame.target;
}

Result<> check_images(const gpu::Context& context, const CompileDesc& desc) {
    if (desc.color.format == VK_FORMAT_UNDEFINED)
        return user_error("compile: color.format = UNDEFINED: allowed is the format of every frame's color");
    DARKROOM_TRY(check_input(context, "color", desc.color));
    for (const plan::FrameInput& input : plan::frame_inputs) {
        if (input.use == nullptr || !plan::is_given(desc, input)) continue;
        const ImageUse& use = desc.*input.use;
        if (input.can_hold != nullptr && !input.can_hold(use.format))
            return user_error(fmt::format("compile: {}.format = {}: allowed {}", input.name,
                                          gpu::format_name(use.format), input.allowed));
        DARKROOM_TRY(check_input(context, input.name, use));
    }
    // Where a frame has no cascades a map of ones is read, and only graphics clears an image of depth.
    if (desc.has_shadows && !context.traits.has_graphics)
        return user_error("compile: has_shadows: allowed where the device's queue family has graphics");
    DARKROOM_TRY(check_target(context, "target", desc.target));
    return check_watches(context, desc);
}

std::optional<std::size_t> watch_with(const CompileDesc& desc, std::uint32_t id) {
    const auto found = std::ranges::find(desc.watches, id, &Watch::id);
    if (found == desc.watches.end()) return std::nullopt;
    return static_cast<std::size_t>(found - desc.watches.begin());
}

bool fits(const plan::Program& program, const CompileDesc& desc, const Frame& frame, const CompileDesc& before) {
    const auto is_within = [](const ImageRef& image, VkExtent2D most) {
        const VkExtent2D extent = image.used_region().extent;
        return is_empty(most) || (extent.width <= most.width && extent.height <= most.height);
    };
    if (!is_within(frame.color, desc.max_extent) || !is_within(frame.target, desc.target_extent)) return false;
    if (frame.view >= desc.views || (desc.is_depth_planar && frame.camera.depth != DepthKind::Planar) ||
        (desc.is_velocity_plain && frame.camera.velocity != VelocityKind{}))
        return false;
    return std::ranges::all_of(program.imports, [&](const auto& which) {
        if (!which || which->kind == Kind::Shadow || which->kind == Kind::Watched) return true;
        const ImageRef& image = host_image(frame, *which);
        // One that a host has forgotten is an error, and nothing to wait for.
        const Given given{.which = *which};
        return image.is_given() ? image.format == use_of(desc, given).format
                                : use_of(before, given).format != VK_FORMAT_UNDEFINED;
    });
}

Result<> check_frame(const plan::Program& program, const CompileDesc& desc, const Frame& frame) {
    AllGiven all;
    // The colour first: the extents of the others are compared with its own.
    DARKROOM_TRY(check_picture({.image = &frame.color}, program, desc, frame));
    for (const auto& which : program.imports) {
        if (!which || which->kind == Kind::Shadow || which->kind == Kind::Watched) continue;
        const Given given{.which = *which, .image = &host_image(frame, *which)};
        DARKROOM_TRY(check_picture(given, program, desc, frame));
        all.images[all.count++] = given;
    }
    DARKROOM_TRY(check_lights(program, frame, all));
    DARKROOM_TRY(check_overlaps(all, desc));
    DARKROOM_TRY(check_watched(all, desc, frame));
    if (desc.is_depth_planar && frame.camera.depth != DepthKind::Planar)
        return user_error("record: frame.camera.depth is not Planar: compiled with is_depth_planar, it must be");
    if (desc.is_velocity_plain && frame.camera.velocity != VelocityKind{})
        return user_error(
            "record: frame.camera.velocity is not the default: compiled with is_velocity_plain, it must be");
    if (frame.view >= desc.views)
        return user_error(
            fmt::format("record: frame.view is {}: allowed is [0, {}], as compiled", frame.view, desc.views - 1));
    return {};
}

}  // namespace darkroom::compose
