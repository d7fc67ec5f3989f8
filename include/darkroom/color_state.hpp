// SPDX-License-Identifier: MIT
#pragma once
// What the numbers of a picture mean: data that goes with the picture from entry to entry, with the values of a frame.

#include <cstdint>

namespace darkroom {

/// What the numbers of the picture are. display_linear: tone-mapped, [0,1], linear light.
enum class Domain : std::uint8_t { SceneLinear, DisplayLinear, Encoded };
struct Domains {
    std::uint8_t bits = 0;
    [[nodiscard]] constexpr bool contains(Domain domain) const {
        return (bits >> static_cast<unsigned>(domain) & 1) != 0;
    }
    [[nodiscard]] static constexpr Domains all() { return {7}; }
    [[nodiscard]] static constexpr Domains only(Domain domain) {
        return {static_cast<std::uint8_t>(1u << static_cast<unsigned>(domain))};
    }
    friend constexpr Domains operator|(Domains a, Domains b) { return {static_cast<std::uint8_t>(a.bits | b.bits)}; }
};

enum class Primaries : std::uint8_t { Rec709, Rec2020, P3 };  ///< all with a white of D65
/// From light to numbers. Of light itself it is Linear.
enum class Transfer : std::uint8_t {
    Linear,   ///< 1.0 is ColorState::white_nits
    Srgb,     ///< IEC 61966-2-1; 1.0 is white_nits
    Gamma22,  ///< a power of 2.2; 1.0 is white_nits
    Pq,       ///< SMPTE ST 2084; 1.0 is 10000 cd/m2
    Hlg,      ///< ARIB STD-B67, ITU-R BT.2100; 1.0 is peak_nits
    Scrgb,    ///< linear; 1.0 is 80 cd/m2
};

/// The state of a picture.
struct ColorState {
    Domain domain = Domain::SceneLinear;
    Primaries primaries = Primaries::Rec709;
    Transfer transfer = Transfer::Linear;
    float white_nits = 203;  ///< of a diffuse white: ITU-R BT.2408
    float peak_nits = 0;     ///< of the brightest that it holds; 0: there is no end, as in a scene
    /// Its numbers were multiplied by alpha, as OpenEXR has them; else alpha only goes along, as in PNG.
    bool is_associated = false;

    /// Luminance of 1.0 behind the transfer.
    [[nodiscard]] constexpr float unit_nits() const {
        if (transfer == Transfer::Pq) return 10000;
        if (transfer == Transfer::Hlg) return peak_nits;
        return transfer == Transfer::Scrgb ? 80 : white_nits;
    }
    /// Code values as displays of standard range take them, whatever their primaries.
    [[nodiscard]] constexpr bool is_standard_code() const {
        return domain == Domain::Encoded && (transfer == Transfer::Srgb || transfer == Transfer::Gamma22);
    }
    friend bool operator==(const ColorState&, const ColorState&) = default;
};
/// What an sRGB display or file takes, and what a UI image is.
inline constexpr ColorState srgb_color{
    .domain = Domain::Encoded, .transfer = Transfer::Srgb, .white_nits = 203, .peak_nits = 203};
inline constexpr ColorState p3_color{Domain::Encoded, Primaries::P3, Transfer::Srgb, 203, 203};
/// HDR10, BT.2100 HLG and scRGB, for a display of 1000 cd/m2.
inline constexpr ColorState pq_color{Domain::Encoded, Primaries::Rec2020, Transfer::Pq, 203, 1000};
inline constexpr ColorState hlg_color{Domain::Encoded, Primaries::Rec2020, Transfer::Hlg, 203, 1000};
inline constexpr ColorState scrgb_color{Domain::Encoded, Primaries::Rec709, Transfer::Scrgb, 203, 1000};

}  // namespace darkroom
