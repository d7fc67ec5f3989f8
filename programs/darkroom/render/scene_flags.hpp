// SPDX-License-Identifier: MIT
#pragma once
// The flags of commands that draw scenes: size, camera, what is drawn. Everything that can be known without the scene
// and without a device is checked here.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "looks/camera_lens.hpp"
#include "programs/darkroom/flags/flags.hpp"
#include "render/renderer.hpp"
#include "scene/pose/snapshot.hpp"

namespace app {

/// Samples of the rasteriser, of which every device has four: where light is not accumulated.
inline constexpr std::uint32_t usual_msaa = 4;

/// What a camera says to looks that are seen through it.
[[nodiscard]] darkroom::CameraLens lens_of(const darkroom::scene::Camera& camera);

class SceneFlags {
  public:
    static constexpr const char* drawing_group = "What is drawn";

    /// `usual_extent`, `msaa`: where the flags say none.
    void add_to(CommandFlags command, VkExtent2D usual_extent, std::uint32_t usual_msaa, const std::string& seed_group);
    [[nodiscard]] darkroom::Result<darkroom::scene::OrbitOverride> orbit() const;
    /// Without `output`: that is for the look to say.
    [[nodiscard]] darkroom::Result<darkroom::render::RenderDesc> desc() const;
    [[nodiscard]] darkroom::Result<std::uint64_t> seed() const;
    [[nodiscard]] darkroom::scene::NamedFiles named_files() const {
        return has_own_files_ ? darkroom::scene::NamedFiles::Own : darkroom::scene::NamedFiles::Any;
    }
    [[nodiscard]] bool has_msaa() const { return msaa_.is_given(); }
    [[nodiscard]] bool is_tone_mapped() const { return !has_no_tone_mapping_; }

  private:
    void add_camera(CommandFlags command);
    void add_drawing(CommandFlags command);
    [[nodiscard]] darkroom::Result<VkExtent2D> extent() const;

    VkExtent2D default_extent_{};
    std::uint32_t usual_msaa_ = 1;
    // Optional, so that an empty text is a wrong value, not a missing one.
    std::optional<std::string> size_, target_, debug_mode_, shadow_filter_;
    // More pixels than any device takes. Its own limit is said once it is known.
    NumberFlag width_{"--width", {.least = 1, .most = 1e6, .is_whole = true, .unit = "px"}};
    NumberFlag height_{"--height", {.least = 1, .most = 1e6, .is_whole = true, .unit = "px"}};
    // The whole numbers that a double holds.
    NumberFlag seed_{"--seed", {.least = 0, .most = 9007199254740991, .is_whole = true}};
    NumberFlag distance_{"--distance", {.least = 0, .most = 1e9, .is_open = true, .unit = "m"}};
    NumberFlag yaw_{"--yaw", {.least = -1e6, .most = 1e6, .unit = "deg"}};
    NumberFlag pitch_{"--pitch", {.least = -90, .most = 90, .unit = "deg"}};
    NumberFlag field_of_view_{"--fov", {.least = 0, .most = 180, .is_open = true, .unit = "deg"}};
    NumberFlag shadow_resolution_{"--shadow-resolution",
                                  {.least = 16, .most = 16384, .is_whole = true, .unit = "texels"}};
    NumberFlag msaa_{"--msaa", {.least = 1, .most = 64, .is_whole = true}};
    bool has_no_grid_ = false, has_wireframe_overlay_ = false, has_normal_arrows_ = false;
    bool has_no_tone_mapping_ = false, has_no_shadows_ = false, has_own_files_ = false;
};

}  // namespace app
