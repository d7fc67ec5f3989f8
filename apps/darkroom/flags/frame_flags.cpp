// SPDX-License-Identifier: MIT
#include "frame_flags.hpp"

namespace app {

using darkroom::Result;

void FrameFlags::add_to(CommandFlags command) {
    const std::string group = "The frame";
    command.add_option("--map", maps_, "What a layer is called in the file: depth=NAME, normals=, velocity=, color=")
        .type_name("LAYER=NAME")
        .repeated()
        .group(group);
    fov_.add_to(command, "Vertical field of view, where the file has no projection").type_name("DEGREES").group(group);
    command.add_option("--camera", camera_, "A camera file (TOML)").type_name("FILE").group(group);
}

Result<darkroom::FrameOptions> FrameFlags::options() const {
    darkroom::FrameOptions out;
    if (Result<> done = fov_.read_to(out.vertical_field_of_view); !done) return failure(std::move(done));
    for (const std::string& map : maps_)
        if (Result<> added = darkroom::add_mapping(out.names, map); !added) return failure(std::move(added));
    out.camera_file = camera_;
    return out;
}

}  // namespace app
