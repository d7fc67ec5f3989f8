// SPDX-License-Identifier: MIT
#pragma once
// The flags of `render` and what they ask for: moments, files, and what all that draw scenes have. Everything that can
// be known without the scene and without a device is checked here.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "image/picture/write.hpp"
#include "programs/darkroom/flags/device_flags.hpp"
#include "programs/darkroom/flags/flags.hpp"
#include "programs/darkroom/flags/look_flags.hpp"
#include "programs/darkroom/flags/number_flag.hpp"
#include "programs/darkroom/flags/run_flags.hpp"
#include "scene/scene.hpp"
#include "scene_flags.hpp"

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
    darkroom::DevelopTarget target = darkroom::DevelopTarget::Encoded8;
    std::optional<darkroom::ColorState> color;  ///< in place of that of the target
    std::optional<StreamDesc> stream;
    std::uint64_t seed = 0;
    double frames_per_second = 24;
    double render_scale = 1;   ///< of the frame's lines to those of the picture, whose extent `desc` has
    bool is_sequence = false;  ///< its frames follow each other

    [[nodiscard]] double time_of(std::uint64_t frame) const { return static_cast<double>(frame) / frames_per_second; }
};

class RenderFlags {
  public:
    void add_to(CommandFlags command, std::span<const darkroom::LookEntry> named);
    [[nodiscard]] darkroom::Result<RenderJob> job() const;

    SceneFlags drawn;
    LookFlags look;
    DeviceFlags device;
    WriteFlags write;
    RunFlags run;
    std::string scene;
    /// Do the flags say a time? Else it is the scene's.
    bool has_time() const { return time_.is_given() || frames_; }
    /// Places within a pixel that light is the mean of: those of the flag, else of the scene, else enough for edges
    /// within 0.02 FLIP of 256.
    [[nodiscard]] darkroom::Result<std::uint32_t> samples(std::uint32_t of_scene) const;
    [[nodiscard]] bool has_samples() const { return samples_.is_given(); }
    [[nodiscard]] bool has_lens() const { return aperture_.is_given(); }
    /// Of a lens what the scene's camera says and no flag does.
    void add_lens_of(const darkroom::scene::Camera& camera, darkroom::render::LensDesc& lens) const;

  private:
    void add_moments(CommandFlags command);
    [[nodiscard]] darkroom::Result<std::vector<Shot>> shots(const RenderJob& job) const;
    /// What becomes of the pictures: files or a stream.
    [[nodiscard]] darkroom::Result<> set_target(RenderJob& job) const;
    [[nodiscard]] darkroom::Result<> set_lens(RenderJob& job) const;
    [[nodiscard]] darkroom::Result<> check_files(const std::vector<Shot>& shots) const;

    // Optional, so that an empty text is a wrong value, not a missing one.
    std::string out_ = "render.png";
    std::optional<std::string> frame_, frames_;
    NumberFlag time_{"--time", {.least = 0, .most = 1e9, .unit = "s"}};
    NumberFlag frames_per_second_{"--fps", {.least = 0.001, .most = 1e6, .is_rate = true}};
    NumberFlag render_scale_{"--render-scale", {.least = 0.1, .most = 1}};
    NumberFlag aperture_{"--aperture", {.least = 0.5, .most = 64}};
    NumberFlag focus_{"--focus", {.least = 0.01, .most = 1e5, .unit = "m"}};
    NumberFlag sensor_height_{"--sensor-height", {.least = 1, .most = 1000, .unit = "mm"}};
    NumberFlag samples_{"--samples", {.least = 1, .most = darkroom::scene::max_samples, .is_whole = true}};
};

}  // namespace app
