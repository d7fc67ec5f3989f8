// SPDX-License-Identifier: MIT
#pragma once
// Scopes of a picture, and the legend of its false colours, drawn into the host's present window. The numbers come from
// panels/show/scope_data.hpp; whoever shows a moving picture measures it as often as it cares to.

#include <imgui.h>

#include <span>

#include "panels/show/false_color.hpp"
#include "panels/show/scope_data.hpp"

namespace darkroom::panels {

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
