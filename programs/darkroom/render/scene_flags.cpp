// SPDX-License-Identifier: MIT
#include "scene_flags.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>

#include "core/text/param_text.hpp"
#include "programs/darkroom/flags/device_flags.hpp"
#include "programs/darkroom/run/report.hpp"

namespace app {

using darkroom::printable;
using darkroom::Result;
using darkroom::user_error;
using darkroom::render::DebugView;

namespace {

struct DebugMode {
    const char* name;
    DebugView view;
};
constexpr std::array debug_modes{
    DebugMode{"wireframe", DebugView::Wireframe}, DebugMode{"normals", DebugView::Normals},
    DebugMode{"depth", DebugView::Depth},         DebugMode{"uv", DebugView::Uv},
    DebugMode{"unlit", DebugView::Unlit},         DebugMode{"metalrough", DebugView::MetalRough}};

Result<DebugView> parse_debug_mode(const std::string& text) {
    std::vector<std::string> names;
    for (const DebugMode& mode : debug_modes) {
        if (text == mode.name) return mode.view;
        names.emplace_back(mode.name);
    }
    return user_error(fmt::format("--debug-mode {}{}", printable(text), darkroom::alternatives(text, names)));
}

Result<darkroom::render::ShadowFilter> parse_shadow_filter(const std::string& text) {
    const std::vector<std::string> names{"plain", "soft"};
    if (text == names[0]) return darkroom::render::ShadowFilter::Plain;
    if (text == names[1]) return darkroom::render::ShadowFilter::Soft;
    return user_error(fmt::format("--shadow-filter {}{}", printable(text), darkroom::alternatives(text, names)));
}

std::string_view trimmed(std::string_view text) {
    while (text.starts_with(' ')) text.remove_prefix(1);
    while (text.ends_with(' ')) text.remove_suffix(1);
    return text;
}

Result<darkroom::scene::vec3> parse_vec3(std::string_view flag, const std::string& text) {
    darkroom::scene::vec3 out;
    std::string_view rest = text;
    for (int i = 0; i < 3; ++i) {
        const std::size_t comma = rest.find(',');
        const bool is_last = comma == std::string_view::npos;
        const std::optional<double> number = darkroom::parse_number(trimmed(rest.substr(0, comma)));
        if (!number || is_last != (i == 2) || std::abs(*number) > std::numeric_limits<float>::max())
            return user_error(fmt::format("{} {}: expected three numbers, X,Y,Z", flag, printable(text)));
        out[i] = static_cast<float>(*number);
        if (!is_last) rest.remove_prefix(comma + 1);
    }
    return out;
}

}  // namespace

void SceneFlags::add_to(CommandFlags command, VkExtent2D usual_extent, std::uint32_t msaa,
                        const std::string& seed_group) {
    default_extent_ = usual_extent;
    usual_msaa_ = msaa;
    width_.add_to(command, "Width of the picture")
        .type_name("PIXELS")
        .default_str(fmt::format("{}", usual_extent.width));
    height_.add_to(command, "Height of the picture")
        .type_name("PIXELS")
        .default_str(fmt::format("{}", usual_extent.height));
    command.add_option("--size", size_, "Width and height").type_name("WxH");
    command.add_flag("--own-files", has_own_files_,
                     "Refuses files that the scene, its prefabs or models name outside of their folders");
    seed_.add_to(command, "Seed of the particles").type_name("N").default_str("0").group(seed_group);
    add_camera(command);
    add_drawing(command);
}

Result<VkExtent2D> SceneFlags::extent() const {
    if (size_) {
        if (width_.is_given() || height_.is_given())
            return user_error(fmt::format("--size {}: sets width and height already; leave out --{}", printable(*size_),
                                          width_.is_given() ? "width" : "height"));
        return parse_size(*size_);
    }
    VkExtent2D extent = default_extent_;
    DARKROOM_TRY(width_.read_to(extent.width));
    DARKROOM_TRY(height_.read_to(extent.height));
    return extent;
}

Result<darkroom::scene::OrbitOverride> SceneFlags::orbit() const {
    darkroom::scene::OrbitOverride out;
    for (const auto& [flag, to] : {std::pair(&distance_, &out.distance), std::pair(&yaw_, &out.yaw),
                                   std::pair(&pitch_, &out.pitch), std::pair(&field_of_view_, &out.field_of_view)})
        DARKROOM_TRY(flag->read_to(*to));
    if (target_) {
        DARKROOM_TRY_VALUE(out.target, parse_vec3("--target", *target_));
    }
    return out;
}

Result<darkroom::render::RenderDesc> SceneFlags::desc() const {
    darkroom::render::RenderDesc out;
    DARKROOM_TRY_VALUE(out.extent, extent());
    DARKROOM_TRY(shadow_resolution_.read_to(out.cascades.resolution));
    out.samples = usual_msaa_;
    DARKROOM_TRY(msaa_.read_to(out.samples));
    if (shadow_filter_) {
        DARKROOM_TRY_VALUE(out.cascades.filter, parse_shadow_filter(*shadow_filter_));
    }
    if (debug_mode_) {
        DARKROOM_TRY_VALUE(out.draw.debug, parse_debug_mode(*debug_mode_));
    }
    out.is_tone_mapped = !has_no_tone_mapping_;
    out.draw.has_shadows = !has_no_shadows_;
    out.draw.has_grid = !has_no_grid_;
    out.draw.has_wireframe_overlay = has_wireframe_overlay_;
    out.draw.has_normal_arrows = has_normal_arrows_;
    return out;
}

void SceneFlags::add_camera(CommandFlags command) {
    const std::string group = "The camera, each on top of the scene's own";
    distance_.add_to(command, "Distance from the target").type_name("METRES").group(group);
    yaw_.add_to(command, "Angle around the target").type_name("DEGREES").group(group);
    pitch_.add_to(command, "Angle above the target").type_name("DEGREES").group(group);
    command.add_option("--target", target_, "Point that the camera looks at; the camera moves with it")
        .type_name("X,Y,Z")
        .group(group);
    field_of_view_.add_to(command, "Vertical field of view").type_name("DEGREES").group(group);
}

void SceneFlags::add_drawing(CommandFlags command) {
    const std::string group = drawing_group;
    command.add_flag("--no-grid", has_no_grid_, "Draws no grid on the ground").group(group);
    command.add_option("--debug-mode", debug_mode_, "Instead of the picture; neither tone-mapped nor post-processed")
        .type_name("wireframe|normals|depth|uv|unlit|metalrough")
        .group(group);
    command.add_flag("--wireframe-overlay", has_wireframe_overlay_, "Draws the edges of all triangles on top")
        .group(group);
    command.add_flag("--show-normals", has_normal_arrows_, "Draws an arrow for the normal of every vertex")
        .group(group);
    command.add_flag("--no-tonemapping", has_no_tone_mapping_, "Cuts off light above 1").group(group);
    command.add_flag("--no-shadows", has_no_shadows_, "Lets no light cast shadows").group(group);
    shadow_resolution_.add_to(command, "Resolution of each cascade of a shadow map")
        .type_name("TEXELS")
        .default_str(fmt::format("{}", darkroom::render::RenderDesc().cascades.resolution))
        .group(group);
    command
        .add_option("--shadow-filter", shadow_filter_, "Edges of shadows: over a texel or two, or as wide as the sun's")
        .type_name("plain|soft")
        .default_str("soft")
        .group(group);
    msaa_.add_to(command, "Samples of the rasteriser a pixel, of the counts that the device has")
        .type_name("N")
        .default_str(fmt::format("{}", usual_msaa_))
        .group(group);
}

darkroom::CameraLens lens_of(const darkroom::scene::Camera& camera) {
    const darkroom::scene::Lens& lens = camera.lens;
    return {.aperture = lens.aperture, .focus = lens.focus, .sensor_height = lens.sensor_height};
}

Result<std::uint64_t> SceneFlags::seed() const {
    std::uint64_t seed = 0;
    DARKROOM_TRY(seed_.read_to(seed));
    return seed;
}

}  // namespace app
