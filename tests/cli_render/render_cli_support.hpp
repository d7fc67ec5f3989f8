// SPDX-License-Identifier: MIT
#pragma once
// A scene of everything, and `darkroom render` of it.

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "image/frame/frame_file.hpp"
#include "tests/cli/cli_support.hpp"

namespace darkroom::test {

// Sun, floor, a box that moves to the right, a lamp, sparks. Half a metre of everything, so that a few pixels show it.
inline constexpr const char* yard_scene = R"([scene]
name = "Yard"
[camera]
position = [3, 2, 4]
target = [0, 0.5, 0]
fov = 50
[post_process]
exposure = 0.6
[entities.sun.light]
direction = [-1, 0.8, 0.5]
intensity = 4
volumetric_intensity = 2
[entities.floor]
archetype = "floor"
bounds = { min = [-2, -0.1, -2], max = [2, 0, 2] }
[entities.box]
bounds = { min = [-0.5, 0, -0.5], max = [0.5, 1, 0.5] }
material = { color = [0.8, 0.3, 0.1], metallic = 0.5, roughness = 0.4 }
[[entities.box.transform.path]]
time = 0
position = [0, 0, 0]
[[entities.box.transform.path]]
time = 4
position = [2, 0, 0]
[entities.lamp]
bounds = { min = [0.8, 0.6, -0.3], max = [1.1, 0.9, 0] }
material = { color = [1, 1, 1], emissive = [4, 3, 2], emissive_strength = 3 }
[entities.sparks.transform]
position = [0, 1, 0]
[entities.sparks.particle_emitter]
emission_rate = 40
size_start = 0.3
size_end = 0.2
)";

class CliRender : public CliFixture {
  protected:
    void make_files() override { write("yard.scene.toml", yard_scene); }

    /// A small picture of the yard. Flags that say a size win, since CLI texts are taken in order only for lists.
    [[nodiscard]] Outcome render(std::vector<std::string> flags, const std::string& out = "out.png") const {
        flags.insert(flags.begin(), {"render", path("yard.scene.toml"), "-o", path(out)});
        const bool has_size = std::any_of(flags.begin(), flags.end(), [](const std::string& flag) {
            return flag == "--size" || flag == "--width" || flag == "--height";
        });
        if (!has_size) flags.insert(flags.end(), {"--size", "48x32"});
        const bool has_frame = std::ranges::find(flags, "--frame") != flags.end();
        if (has_frame) flags.insert(flags.end(), {"--shadow-resolution", "256"});  // it holds them
        return run(flags);
    }
    /// Each list of flags gives another picture than all others.
    void expect_all_differ(const std::vector<std::vector<std::string>>& cases) const {
        std::map<std::string, std::string> seen;
        for (const std::vector<std::string>& flags : cases) {
            std::string shown;
            for (const std::string& flag : flags) shown += flag + " ";
            const Outcome outcome = render(flags);
            ASSERT_EQ(outcome.code, 0) << shown << outcome.err;
            const auto [other, is_new] = seen.try_emplace(content(path("out.png")), shown);
            EXPECT_TRUE(is_new) << "'" << shown << "' gives the picture of '" << other->second << "'";
        }
    }
    void expect_render_refused(std::vector<std::string> flags, const std::string& part) const {
        flags.insert(flags.begin(), {"render", path("yard.scene.toml"), "-o", path("x.png")});
        expect_refused(flags, 1, part);
    }
    [[nodiscard]] FrameFile frame(const std::string& name) const {
        Result<FrameFile> read = read_frame(path(name));
        EXPECT_TRUE(read) << read.error().text;
        return read ? std::move(*read) : FrameFile{};
    }
};

}  // namespace darkroom::test
