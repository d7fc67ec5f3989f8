// SPDX-License-Identifier: MIT
#pragma once
// The flags of `render` and what they ask for: size, camera, moments, files, what is drawn. Everything that can be
// known without the scene and without a device is checked here.

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "device_flags.hpp"
#include "image/write.hpp"
#include "look_flags.hpp"
#include "number_flag.hpp"
#include "render/renderer.hpp"
#include "run_flags.hpp"
#include "scene/snapshot.hpp"

namespace app {

/// One picture: a moment of the scene and the files it becomes.
struct Shot {
    std::uint64_t number = 0;  ///< of the frame
    double time = 0;           ///< seconds
    double previous_time = 0;  ///< one frame before, but not before 0
    double delta_time = 0;
    std::filesystem::path picture;
    std::filesystem::path frame;  ///< empty: not asked for
    bool is_written = true;       ///< false: for the sake of effects with history alone
};

struct RenderJob {
    darkroom::render::RenderDesc desc;  ///< without `output`: that is for the look to say
    darkroom::scene::OrbitOverride orbit;
    std::vector<Shot> shots;
    darkroom::WriteOptions write;
    std::size_t jobs = 0;
    darkroom::SampleKind samples = darkroom::SampleKind::Integer8;  ///< of the pictures
    std::uint64_t seed = 0;
};

class RenderFlags {
  public:
    void add_to(CLI::App& command, std::span<const darkroom::LookEntry> named);
    [[nodiscard]] darkroom::Result<RenderJob> job() const;

    LookFlags look;
    DeviceFlags device;
    WriteFlags write;
    RunFlags run;
    std::string scene;
    bool is_tone_mapped() const { return !has_no_tone_mapping_; }
    /// Do the flags say a time? Else it is the scene's.
    bool has_time() const { return time_.is_given() || frames_; }

  private:
    void add_camera(CLI::App& command);
    void add_drawing(CLI::App& command);
    void add_moments(CLI::App& command);
    [[nodiscard]] darkroom::Result<VkExtent2D> extent() const;
    [[nodiscard]] darkroom::Result<darkroom::scene::OrbitOverride> orbit() const;
    [[nodiscard]] darkroom::Result<darkroom::render::RenderDesc> desc() const;
    [[nodiscard]] darkroom::Result<std::vector<Shot>> shots() const;
    [[nodiscard]] darkroom::Result<> check_files(const std::vector<Shot>& shots) const;

    // Optional, so that an empty text is a wrong value, not a missing one.
    std::string out_ = "render.png";
    std::optional<std::string> frame_, size_, target_, debug_mode_, frames_;
    std::vector<std::string> schemas_;
    // More pixels than any device takes. Its own limit is said once it is known.
    NumberFlag width_{"--width", {.least = 1, .most = 1e6, .is_whole = true, .unit = "px"}};
    NumberFlag height_{"--height", {.least = 1, .most = 1e6, .is_whole = true, .unit = "px"}};
    NumberFlag time_{"--time", {.least = 0, .most = 1e9, .unit = "s"}};
    NumberFlag frames_per_second_{"--fps", {.least = 0.001, .most = 1e6}};
    // The whole numbers that a double holds.
    NumberFlag seed_{"--seed", {.least = 0, .most = 9007199254740991, .is_whole = true}};
    NumberFlag distance_{"--distance", {.least = 0, .most = 1e9, .is_open = true, .unit = "m"}};
    NumberFlag yaw_{"--yaw", {.least = -1e6, .most = 1e6, .unit = "deg"}};
    NumberFlag pitch_{"--pitch", {.least = -90, .most = 90, .unit = "deg"}};
    NumberFlag field_of_view_{"--fov", {.least = 0, .most = 180, .is_open = true, .unit = "deg"}};
    NumberFlag shadow_resolution_{"--shadow-resolution",
                                  {.least = 16, .most = 16384, .is_whole = true, .unit = "texels"}};
    NumberFlag samples_{"--msaa", {.least = 1, .most = 64, .is_whole = true}};
    bool has_no_grid_ = false, has_wireframe_overlay_ = false, has_normal_arrows_ = false;
    bool has_no_tone_mapping_ = false, has_no_shadows_ = false;
};

}  // namespace app
