// SPDX-License-Identifier: MIT
#pragma once
// Scopes of a picture, and the legend of its false colours, drawn into the host's present window. The numbers come from
// panels/show/scope_data.hpp; whoever shows a moving picture measures it as often as it cares to.

#include <imgui.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "panels/show/false_color.hpp"

namespace darkroom::panels {

// What scopes show of a picture: histogram, waveform, vectorscope. Numbers only, from a small copy of the picture in
// memory; panels/show/scopes.hpp draws them.

/// RGBA, top row first: `bytes` or `floats`, four to a pixel. Pixels that the span does not hold are not looked at.
struct ScopePicture {
    std::uint32_t width = 0, height = 0;
    std::span<const std::uint8_t> bytes;
    std::span<const float> floats;
    bool is_linear = false;  ///< linear Rec. 709, which is sRGB-encoded first; else encoded numbers, 1 is white
};

/// Red, green, blue, and luma: the Rec. 709 weights on encoded values.
inline constexpr std::size_t scope_channels = 4;
enum ScopeChannel : std::uint8_t { ScopeRed, ScopeGreen, ScopeBlue, ScopeLuma };

struct Histogram {
    static constexpr std::size_t bins = 256;                               ///< one a code
    std::array<std::array<std::uint32_t, bins>, scope_channels> counts{};  ///< clipped values in the outer bins
    std::array<std::uint32_t, scope_channels> black{}, white{};            ///< at or under 0, at or above 1
};

/// How often each level comes in each part of the picture's width.
struct Waveform {
    static constexpr std::size_t columns = 160, levels = 101;  ///< a level is a hundredth; the outer ones hold the rest
    std::array<std::vector<std::uint32_t>, scope_channels> counts;  ///< levels * columns, black first; empty: none yet
    std::uint32_t most = 0;                                         ///< the greatest of them
};

/// Colour difference (Rec. 709), [-0.5, 0.5] each: Cb to the right, Cr upwards.
struct Vectorscope {
    static constexpr std::size_t size = 96;
    std::vector<std::uint32_t> counts;  ///< size * size, top row first; empty: none yet
    std::uint32_t most = 0;
};

struct ScopeData {
    std::uint32_t pixels = 0;  ///< that were counted
    std::uint32_t broken = 0;  ///< NaN or infinite, and counted nowhere else
    Histogram histogram;
    Waveform waveform;
    Vectorscope vectorscope;
};

[[nodiscard]] ScopeData measure(const ScopePicture& picture);

/// Of an encoded colour: {Cb, Cr} of ITU-R BT.709-6, 3.3.
[[nodiscard]] std::array<float, 2> color_difference(const std::array<float, 3>& rgb);

/// Counts over codes, the channels added up where they overlap; those at black and white as high as the highest.
void draw_histogram(const ScopeData& data, bool is_logarithmic, ImVec2 size);

enum class WaveformKind : std::uint8_t { Rgb, Luma, Parade };
/// Levels over the picture's width: all channels in one, luma alone, or red, green and blue side by side.
void draw_waveform(const Waveform& waveform, WaveformKind kind, ImVec2 size);

/// Colour differences in a square: targets of the primaries and secondaries at 75 %, and the line of skin tones.
void draw_vectorscope(const Vectorscope& scope, float size);

/// A line for each band, with its colour and its name, as wide as the window.
void draw_legend(std::span<const FalseColorBand> bands);

/// All of them, side by side or one at a time.
class ScopesPanel {
  public:
    void set(ScopeData data) { data_ = std::move(data); }
    /// Fills the rest of the window.
    void draw();

  private:
    void draw_together(ImVec2 room) const;
    ScopeData data_;
    bool is_logarithmic_ = false;
    bool is_luma_ = false;
};

}  // namespace darkroom::panels
