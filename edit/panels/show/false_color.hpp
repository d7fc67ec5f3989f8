// SPDX-License-Identifier: MIT
#pragma once
// The bands of the false-colour views, which the shader of panes (window/pane.hpp) and the legend share. Between bands
// that have a colour the picture stays grey, as on a film camera's monitor (ARRI, "ALEXA false color", 2010: purple and
// blue at the black end, green about middle grey, pink a stop above it, yellow and red at the white end).

#include <array>
#include <limits>
#include <span>
#include <string_view>

namespace darkroom::panels {

struct FalseColorBand {
    double from = 0;               ///< the first value in it; it ends where the next one begins
    std::array<float, 3> color{};  ///< sRGB-encoded
    bool is_grey = false;          ///< shows the picture's grey
    std::string_view name;
};

inline constexpr double lowest_band = -std::numeric_limits<double>::infinity();

/// By log2(luminance / 0.18), for linear light: a colour each stop, from six under middle grey to six above.
inline constexpr std::array stop_bands{
    FalseColorBand{lowest_band, {0.10f, 0.04f, 0.16f}, false, "under -6"},
    FalseColorBand{-6, {0.29f, 0.12f, 0.47f}, false, "-6"},
    FalseColorBand{-5, {0.36f, 0.23f, 0.72f}, false, "-5"},
    FalseColorBand{-4, {0.20f, 0.33f, 0.80f}, false, "-4"},
    FalseColorBand{-3, {0.16f, 0.52f, 0.84f}, false, "-3"},
    FalseColorBand{-2, {0.16f, 0.66f, 0.70f}, false, "-2"},
    FalseColorBand{-1, {0.18f, 0.56f, 0.40f}, false, "-1"},
    FalseColorBand{-0.25, {0.46f, 0.46f, 0.46f}, false, "18 %"},
    FalseColorBand{0.25, {0.50f, 0.74f, 0.30f}, false, "+1/4"},
    FalseColorBand{1, {0.95f, 0.62f, 0.68f}, false, "+1"},
    FalseColorBand{2, {0.95f, 0.86f, 0.32f}, false, "+2"},
    FalseColorBand{3, {0.96f, 0.63f, 0.18f}, false, "+3"},
    FalseColorBand{4, {0.90f, 0.38f, 0.12f}, false, "+4"},
    FalseColorBand{5, {0.80f, 0.12f, 0.10f}, false, "+5"},
    FalseColorBand{6, {1.00f, 1.00f, 1.00f}, false, "+6 and over"},
};

/// By luma, the Rec. 709 weights on sRGB-encoded values. Middle grey is at 0.461, a stop above it at 0.636.
inline constexpr std::array code_bands{
    FalseColorBand{lowest_band, {0.44f, 0.16f, 0.58f}, false, "black, under 2.5 %"},
    FalseColorBand{0.025, {0.16f, 0.36f, 0.84f}, false, "near black, 2.5 to 6 %"},
    FalseColorBand{0.06, {}, true, "as it is"},
    FalseColorBand{0.44, {0.24f, 0.68f, 0.30f}, false, "middle grey, 44 to 48 %"},
    FalseColorBand{0.48, {}, true, "as it is"},
    FalseColorBand{0.61, {0.95f, 0.62f, 0.68f}, false, "a stop over it, 61 to 66 %"},
    FalseColorBand{0.66, {}, true, "as it is"},
    FalseColorBand{0.94, {0.95f, 0.88f, 0.25f}, false, "near white, 94 to 99 %"},
    FalseColorBand{0.99, {0.86f, 0.12f, 0.10f}, false, "white, 99 % and over"},
};

}  // namespace darkroom::panels
