// SPDX-License-Identifier: MIT
#include "frame_flags.hpp"

#include <fmt/format.h>

#include "core/text/param_text.hpp"
#include "image/color/configuration.hpp"
#include "image/frame/sequence.hpp"

namespace app {

using darkroom::Result;

void FrameFlags::add_to(CommandFlags command, bool is_window) {
    const std::string group = "The frame";
    command.add_option("--map", maps_, "Layers: depth=NAME, normals=, velocity=, color=; NAME none: without it")
        .type_name("LAYER=NAME")
        .repeated()
        .group(group);
    command.add_option("--eye", eye_, "View of a stereo picture: left, right, or another; both needs %V in OUT")
        .type_name("NAME")
        .group(group);
    command.add_flag("--overscan", keeps_overscan, "Develops all pixels, those outside of the display window, too")
        .group(group);
    depth_scale_.add_to(command, "Metres for each unit of the depth").type_name("N").group(group);
    command.add_flag("--depth-inverse", is_depth_inverse_, "The depth is 1 / distance, as Nuke's is").group(group);
    if (!is_window)
        fov_.add_to(command, "Vertical field of view, where the file has no projection")
            .type_name("DEGREES")
            .group(group);
    command.add_option("--camera", camera_, "A camera file (TOML); camera.####.toml of several frames: one for each")
        .type_name("FILE")
        .group(group);
    command
        .add_option("--normals-space", normals_space_,
                    "What the normals are told in; without it they are held against the depth")
        .type_name("world|view")
        .group(group);
    command.add_option("--up", up_, "Axis of the file's world that points up, whatever the camera file says")
        .type_name("y|z")
        .group(group);
    command
        .add_option("--input-space", input_space_,
                    fmt::format("Colour space of the file's numbers, whatever the file says: {}{}",
                                darkroom::input_space_names(), is_window ? "" : ", or a space of --ocio"))
        .type_name("SPACE")
        .group(group);
}

std::vector<std::string> FrameFlags::eyes() const {
    return eye_ == "both" ? std::vector<std::string>{"left", "right"} : std::vector{eye_};
}

Result<darkroom::FrameOptions> FrameFlags::options(const std::string& configuration, const std::string& eye) const {
    darkroom::FrameOptions out{.view = eye, .is_depth_inverse = is_depth_inverse_, .keeps_overscan = keeps_overscan};
    DARKROOM_TRY(depth_scale_.read_to(out.depth_scale));
    DARKROOM_TRY(fov_.read_to(out.vertical_field_of_view));
    for (const std::string& map : maps_) DARKROOM_TRY(darkroom::add_mapping(out.names, map));
    if (!normals_space_.empty()) {
        if (normals_space_ != "world" && normals_space_ != "view")
            return darkroom::user_error(
                fmt::format("--normals-space {}: allowed is world, view", darkroom::printable(normals_space_)));
        out.normals_space = normals_space_ == "view" ? darkroom::NormalsSpace::View : darkroom::NormalsSpace::World;
    }
    if (!up_.empty()) {
        if (up_ != "y" && up_ != "z")
            return darkroom::user_error(fmt::format("--up {}: allowed is y, z", darkroom::printable(up_)));
        out.up = up_ == "z" ? darkroom::UpAxis::Z : darkroom::UpAxis::Y;
    }
    out.camera_file = camera_;
    // What is wrong with it is told once, and before any work.
    if (!camera_.empty() && !darkroom::has_number_pattern(camera_)) DARKROOM_TRY(darkroom::read_camera(camera_));
    if (!input_space_.empty() && !configuration.empty()) {
        DARKROOM_TRY_VALUE(out.input_chain, darkroom::space_of_configuration(configuration, input_space_));
    } else if (!input_space_.empty()) {
        Result<darkroom::InputSpace> space = darkroom::find_input_space(input_space_);
        if (!space)
            return failure(darkroom::Error{space.error().fault, fmt::format("--input-space: {}", space.error().text)});
        out.input_space = *space;
    }
    return out;
}

}  // namespace app
