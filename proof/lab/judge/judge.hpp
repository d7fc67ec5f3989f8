// SPDX-License-Identifier: MIT
#pragma once
// How far a sequence of pictures is from its truth, in the terms that tell temporal filters apart: error, flicker,
// where edges and thin things are, where a surface was hidden, and how soon it is right again. Of pictures in main
// memory alone; which is too far is the caller's to say.

#include <array>
#include <cstdint>
#include <darkroom/result.hpp>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "image/frame/frame_file.hpp"
#include "image/picture/picture.hpp"

namespace darkroom {

/// The numbers that a viewer of 8 bits is shown, 0 to 255, three a pixel.
using ShownCodes = Plane<3>;

/// sRGB codes of c / (1 + max c): scene-linear light in the range of a display, whatever its exposure; below 0 is 0.
[[nodiscard]] ShownCodes codes_of_light(const Picture& light);
/// Of a display-encoded picture, 0 to 1, that has been mapped so already.
[[nodiscard]] ShownCodes codes_of_display(const Picture& encoded);
/// The codes as a display-encoded, opaque picture, as FLIP takes it.
[[nodiscard]] Picture picture_of(const ShownCodes& codes);

/// Where the errors of temporal filters lie. A pixel may be in several.
enum class JudgedRegion : std::uint8_t {
    Edges,          ///< planar depth of 3x3 differs by more than 5 %
    Thin,           ///< within two pixels of what is nearer by 5 % than what lies two pixels off on both sides
    Disoccluded,    ///< the frame before had something else in front, nearer by more than 2 %
    MovingTexture,  ///< no edge, more than half a pixel of motion, and 16 codes between the neighbours
};
inline constexpr std::size_t judged_region_count = 4;
[[nodiscard]] std::string_view name_of(JudgedRegion region);

/// How many frames ago a pixel's surface was disoccluded, up to the last of these.
inline constexpr std::size_t max_recovery_frames = 8;

/// Of a frame, from its layers and those of the frame before.
class RegionMap {
  public:
    [[nodiscard]] bool has(std::size_t pixel, JudgedRegion region) const {
        return (bits_[pixel] & (1U << static_cast<unsigned>(region))) != 0;
    }
    /// [0, max_recovery_frames]: frames since it was disoccluded; the largest: longer ago, or never.
    [[nodiscard]] std::uint8_t age(std::size_t pixel) const { return ages_[pixel]; }
    [[nodiscard]] std::size_t size() const { return bits_.size(); }

  private:
    friend class RegionFinder;
    std::vector<std::uint8_t> bits_, ages_;
};

/// Finds the regions of frame after frame. Frames come in order.
class RegionFinder {
  public:
    /// `frame` has depth, velocity and a camera, `codes` are those of its colour. Errors: what it lacks.
    [[nodiscard]] Result<RegionMap> find(const FrameFile& frame, const ShownCodes& codes);

  private:
    void find_edges(const FrameFile& frame, RegionMap& map) const;
    void find_texture(const FrameFile& frame, const ShownCodes& codes, RegionMap& map) const;
    void find_disoccluded(const FrameFile& frame, RegionMap& map) const;

    Plane<1> depth_before_;
    std::vector<std::uint8_t> ages_before_;
};

/// Squared errors of codes, and how many there are.
struct ErrorSum {
    double squares = 0;
    std::uint64_t samples = 0;

    void add(double square, std::uint64_t count) {
        squares += square;
        samples += count;
    }
    /// In dB against 255; infinite without an error, NaN without a sample.
    [[nodiscard]] double psnr() const;
};

struct FrameVerdict {
    long long number = 0;
    double psnr = 0;
    double flip = 0;  ///< mean LDR FLIP
};

struct Verdict {
    ErrorSum error;
    ErrorSum flicker;                                          ///< of the change of the error from frame to frame
    double flip_mean = 0;                                      ///< mean of the frames
    std::array<ErrorSum, judged_region_count> regions;         ///< error
    std::array<ErrorSum, judged_region_count> region_flicker;  ///< where both frames are in the region
    std::array<ErrorSum, max_recovery_frames> recovery;        ///< error of what was disoccluded so many frames ago
    std::vector<FrameVerdict> frames;
};

/// Gathers frame after frame, in order.
class Judge {
  public:
    /// Pictures of one size. Errors: those of flip().
    [[nodiscard]] Result<> add(long long number, const ShownCodes& truth, const ShownCodes& test, const RegionMap& map);
    [[nodiscard]] const Verdict& verdict() const { return verdict_; }

  private:
    Verdict verdict_;
    std::vector<float> error_before_;
    RegionMap map_before_;
    double flips_ = 0;
};

// How sharp a picture is, from the picture of one straight edge that is slanted against the pixels: its modulation
// transfer function, after ISO 12233.

struct EdgeSharpness {
    double mtf50 = 0;          ///< cycles a pixel, where half of the contrast is left; at most 1
    double angle_degrees = 0;  ///< of the edge against the axis of the pixels that is nearest to it
    double contrast = 0;       ///< of its sides
};

/// `luminance`: of light (not of codes), an edge between two even sides that crosses the picture from top to bottom or
/// from left to right. Errors: smaller than 16x16, no contrast, an edge along the pixels or at 45 degrees.
[[nodiscard]] Result<EdgeSharpness> edge_sharpness(const Plane<1>& luminance);

}  // namespace darkroom
