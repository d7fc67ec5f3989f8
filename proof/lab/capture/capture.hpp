// SPDX-License-Identifier: MIT
#pragma once
// What a capture is made of, and how it describes itself in its folder: docs/temporal_lab.md.

#include <cstdint>
#include <darkroom/result.hpp>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "image/frame/frame_set.hpp"
#include "programs/darkroom/run/json.hpp"
#include "render/renderer.hpp"
#include "scene/pose/snapshot.hpp"

namespace app {

inline constexpr std::string_view capture_description = "capture.json";

/// Frames that are smaller than the picture by one factor.
struct CaptureScale {
    double scale = 1;  ///< lines of the picture to those of a frame
    VkExtent2D extent{};
    /// As the picture has them, in whole pixels: what jitter and mip bias go by.
    float exact = 1;
    std::string folder;

    [[nodiscard]] std::string files() const { return folder + "/input.####.exr"; }
};

struct CaptureJob {
    std::filesystem::path folder;
    darkroom::render::RenderDesc desc;  ///< of the picture; its positions are the samples of the truth
    darkroom::scene::OrbitOverride orbit;
    std::uint64_t seed = 0;
    double frames_per_second = 24;
    std::vector<long long> frames, truth_frames;
    std::vector<CaptureScale> scales;

    [[nodiscard]] double time_of(long long frame) const { return static_cast<double>(frame) / frames_per_second; }
    [[nodiscard]] static std::string truth_files() { return "truth/truth.####.exr"; }
    /// At most, without what files gain by being packed.
    [[nodiscard]] std::uint64_t bytes() const;
};

/// "1,1.5,2" for pictures of this extent: one to eight factors of [1, 10], each once.
[[nodiscard]] darkroom::Result<std::vector<CaptureScale>> parse_scales(const std::string& text, VkExtent2D extent);

/// The same job gives the same text, whenever and wherever.
[[nodiscard]] Json describe(const CaptureJob& job, std::string_view scene_file);

/// The truth of a capture, as its folder describes it.
struct CapturedTruth {
    std::filesystem::path folder;
    std::string files;
    std::vector<long long> frames;
};
/// Errors: no folder, no description, one that says something else.
[[nodiscard]] darkroom::Result<CapturedTruth> read_capture(const std::filesystem::path& folder);

}  // namespace app
