// SPDX-License-Identifier: MIT
#pragma once
// What an effect tells the Composer about itself, and how it declares its passes. An effect is a folder: a struct of
// parameters, its rows (describe.hpp), GLSL, passes, a CPU reference, tests and a page.
//
// effects/<name>/<name>.glsl, where the effect has a pointwise end, defines
//     vec4 <name>(vec4 color, Pixel pixel, <Struct> parameters)
// and may call sample_linear, load, ... (engine/gpu/kernel/kernel.hpp) on the side images it declared in `build`, and
// `vec4 <name>_custom(int)` for its end_constants. Every name at file scope begins with the effect's name. Alpha passes
// unchanged unless the effect is about alpha.
// An effect of touch Map defines `Place <name>(Place place, <Struct> parameters)` (effects/shared/place.glsl), one of
// touch Tap `vec4 <name>(vec4 color, Place place, <Struct> parameters)`, which calls `vec4 <name>_read(vec2 uv)`.
// A pass of its own lives in effects/<name>/<name>_<pass>.glsl and defines
//     vec4 shade(Pixel pixel)
// with `<Struct> <name>_parameters()` at hand, `frame_time` and its like, and custom[i] from the pass's constants; the
// camera is reached by the functions of effects/shared/camera.glsl.

#include <vulkan/vulkan.h>
#include <array>
#include <cstdint>
#include <darkroom/frame.hpp>
#include <darkroom/param.hpp>
#include <darkroom/pass_builder.hpp>
#include <darkroom/reference.hpp>
#include <darkroom/resource.hpp>
#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace darkroom {

/// How an effect touches the picture, and so what it can share a kernel with.
enum class Touch : std::uint8_t {
    Pointwise,  ///< reads the colour at its own pixel, and any side image: fuses with its neighbours
    Warp,       ///< reads the colour at moved coordinates: may only open a fused kernel
    /// Moves where the picture is read: uv to uv. Neighbours of this touch, and taps, are one reading: their maps
    /// compose, from the last to the first, into one sample, or three where a map parts the channels.
    Map,
    Tap,            ///< reads the picture at further places, behind the maps of its reading
    Neighbourhood,  ///< reads around its pixel: passes of its own
    History,        ///< reads an earlier frame: passes of its own
};

/// What of the frame an effect needs: images, as a set. Without one that nothing can stand in for, such as the depth,
/// it is left out of the plan.
struct Needs {
    std::uint32_t bits = 0;
    /// Its formula is of rays that meet in an eye: it is left out of frames whose camera has none (orthographic).
    bool perspective = false;
    constexpr Needs() = default;
    constexpr Needs(std::initializer_list<FrameImage> images) {
        for (const FrameImage image : images) add(image);
    }
    constexpr void add(FrameImage image) { bits |= 1u << static_cast<unsigned>(image); }
    [[nodiscard]] constexpr bool contains(FrameImage image) const {
        return (bits >> static_cast<unsigned>(image) & 1) != 0;
    }
    [[nodiscard]] constexpr Needs and_perspective() const {
        Needs out = *this;
        out.perspective = true;
        return out;
    }
};

/// Has the interface a part in it? Then its keys stand in the table [ui].
enum class UiPart : std::uint8_t {
    None,
    Picture,  ///< it works on the picture that the interface is laid over
    Layer,    ///< of the interface's own chain: see EntryDesc::is_ui
};

/// An effect's place in the flat [post_process] table: ranks in the two shipped orders, lowest first; negative: not in
/// the table.
struct FlatPlace {
    std::int32_t documented = -1;
    std::int32_t scene_linear = -1;
    bool starts_on = false;  ///< in scene_linear; what is otherwise in documented stands in files/looks/documented.hpp
    UiPart ui = UiPart::None;
    std::uint32_t toggle_key = 0;  ///< of a viewer: F1 .. F12 that switches it; 0: none

    [[nodiscard]] constexpr bool is_of_ui() const { return ui != UiPart::None; }
};

/// Extent of what an effect with a result of its own makes: a fraction of its input's or, of an upscaler, of what the
/// frame is finished at. That is the target's where CompileDesc::target_extent is given, else the scene's.
struct ResultScale {
    std::uint32_t numerator = 1;
    std::uint32_t denominator = 1;
    bool is_of_output = false;
};

/// Does an effect read a second picture (EntryDesc::second)?
enum class Second : std::uint8_t {
    None,
    Image,  ///< side image `second`
    /// Its text names no such image, but calls `vec4 <name>_second(Pixel pixel)`: a reading is then made in place.
    InPlace,
};

/// What an effect takes the picture's numbers for.
enum class WorkingSpace : std::uint8_t {
    Picture,  ///< what they are
    /// Colours, of which it makes no multiple: of a picture that is multiplied by its alpha it gets them divided, and
    /// they are multiplied again behind it.
    Straight,
    Encoded,  ///< code values of sRGB: where the picture is none, it gets those, straight, and back behind it
    /// Mixes the colours of several pixels, which is right in light alone. It reads and returns the picture's numbers;
    /// its text calls `vec4 <name>_light(vec4 color)`, multiplied by alpha where frames are, and `vec4
    /// <name>_coded(vec4 light)`. Of touch Warp.
    Light,
};
struct Works {
    WorkingSpace in = WorkingSpace::Picture;
    /// Of Encoded: luminance of the 1.0 that it works with; null: the picture's white.
    float (*white_nits)(const void* parameters) = nullptr;
};

/// A shader or page of an effect, compiled into the library.
struct EffectFile {
    std::string_view name;  ///< "bloom_downsample.glsl"
    std::string_view text;
    std::string_view shown{};  ///< what errors call it; empty: effects/<effect>/<name>
};
/// The files of effects/<effect>/, embedded at build time.
[[nodiscard]] std::span<const EffectFile> embedded_files(std::string_view effect);
/// The files of effects/shared/, named "shared/<file>": what `#include "shared/<file>"` in a shader reads.
[[nodiscard]] std::span<const EffectFile> shared_files();

struct EffectInfo {
    std::string_view name;  ///< snake_case, the folder's name
    std::string_view doc;   ///< one sentence
    ParamTable parameters;
    std::span<const EffectFile> files;
    Touch touch = Touch::Pointwise;
    /// Encoded are code values of a display of standard range. A pointwise effect that accepts them, but for the last
    /// step, gets others (PQ, HLG, scRGB) as sRGB's, and they are turned back behind it.
    Domains accepts = Domains::all();
    /// Of effects whose parameters leave fewer of them: what is remarked goes by these; null: all.
    Domains (*accepts_now)(const void* parameters) = nullptr;
    /// The state after the effect, given that before it and the parameters; null: unchanged.
    ColorState (*makes)(ColorState before, const void* parameters) = nullptr;
    Needs needs{};
    FlatPlace flat;
    ResultScale output_scale;
    Second second = Second::None;
    bool parts_channels = false;  ///< of a map: Place::barrel differs from channel to channel
    Works works;
    /// What a path tracer or a camera puts into its pictures itself: occlusion, light in the air, motion.
    bool is_in_traced_light = false;
    bool is_last_step = false;  ///< encode, dither: skipped where the target takes linear floats
    std::function<void(PassBuilder&)> build{};
    Reference reference{};  ///< the published equation in double precision
    /// What is wrong with values that are each allowed by themselves, as "end = 3: must lie beyond start = 5"; empty:
    /// nothing. Values of a frame may still be so (overrides): shaders must survive them.
    std::string (*conflict)(const void* parameters) = nullptr;
    /// For a frame's parameters: does the effect change nothing? Such an entry is treated as switched off.
    bool (*is_identity)(const void* parameters) = nullptr;
    /// Of effects that nobody sees where no channel of what they read is above a value: that value, for a frame's
    /// parameters. None: they are seen, or not, whatever they read.
    std::optional<float> (*threshold)(const void* parameters) = nullptr;
    /// The effect is the exposure of a look, which stays where the rest is switched off: its multiplier of light.
    float (*exposure)(const void* parameters) = nullptr;
    /// Of effects with a history: how many frames before a frame must have been developed so that its picture is within
    /// half a code of 8 bits of an unbroken run, given that what the effect reads is, and that frames are `delta_time`
    /// seconds apart. Null: none.
    std::function<std::uint32_t(const void* parameters, double delta_time)> pre_roll{};
    /// Of a description that was made at run time: who keeps it longer than its maker holds this.
    std::weak_ptr<const void> owner{};

    [[nodiscard]] bool has_second() const { return second != Second::None; }
    /// Is what the interface's chain has made its second picture, where the entry names none?
    [[nodiscard]] bool joins_ui() const { return has_second() && needs.contains(FrameImage::Ui); }
};

/// Every effect of this build, by name.
[[nodiscard]] std::span<const EffectInfo* const> all_effects();
/// The effect of that name; null: none.
[[nodiscard]] const EffectInfo* find_effect(std::string_view name);

}  // namespace darkroom
