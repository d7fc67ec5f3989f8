// SPDX-License-Identifier: MIT
#pragma once
// What an effect tells the Composer about itself, and how it declares its passes. An effect is a folder: a struct of
// parameters, its rows (describe.hpp), GLSL, passes, a CPU reference, tests and a page.
//
// effects/<name>/<name>.glsl, where the effect has a pointwise end, defines
//     vec4 <name>(vec4 color, Pixel pixel, <Struct> parameters)
// and may call sample_linear, load, ... (src/gpu/kernel/kernel.hpp) on the side images it declared in `build`, and
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

/// Images of the frame that an effect reads, as a set. Without one that nothing can stand in for, such as the depth, it
/// is left out of the plan.
struct Needs {
    std::uint32_t bits = 0;
    constexpr Needs() = default;
    constexpr Needs(std::initializer_list<FrameImage> images) {
        for (const FrameImage image : images) add(image);
    }
    constexpr void add(FrameImage image) { bits |= 1u << static_cast<unsigned>(image); }
    [[nodiscard]] constexpr bool contains(FrameImage image) const {
        return (bits >> static_cast<unsigned>(image) & 1) != 0;
    }
};

/// An effect's place in the flat [post_process] table: ranks in the two shipped orders, lowest first; negative: not in
/// the table.
struct FlatPlace {
    std::int32_t documented = -1;
    std::int32_t scene_linear = -1;
    bool starts_on = false;  ///< in scene_linear; what is otherwise in documented stands in src/looks/documented.hpp
    bool is_of_ui = false;   ///< its keys stand in the table [ui]
};

/// Values that passes may depend on while recording.
struct PassContext {
    VkExtent2D scene_extent{};   ///< of the frame's colour
    VkExtent2D frame_extent{};   ///< of the picture that the effect gets
    VkExtent2D output_extent{};  ///< of the image that the pass writes
    double time = 0;
    double delta_time = 0;
    std::uint64_t frame_index = 0;
    const Camera* camera = nullptr;
    std::span<const Light> lights;
    bool has_history = false;  ///< for constants: do the effect's histories hold what an earlier frame wrote?
};

using PassVector = std::array<float, 4>;
/// Fills the custom vectors of a pass; runs while recording, so it allocates nothing.
using ConstantsFunction = void (*)(const void* parameters, const PassContext&, std::span<PassVector> out);
/// False: the pass is not recorded in this frame. What holds for an argument must hold for all smaller ones (levels of
/// a pyramid). Runs while recording.
using ConditionFunction = bool (*)(const void* parameters, const PassContext&, std::uint32_t argument);

/// Names an image that a pass builder made or was given. A picture that was written has a new name (src/graph).
struct PassImage {
    std::uint32_t index = ~0u;
};

struct PassImageDesc {
    std::string name;
    VkFormat format = VK_FORMAT_R16G16B16A16_SFLOAT;
    /// Mip level 0 is numerator / denominator of the effect's input: floored, at least 1.
    std::uint32_t numerator = 1;
    std::uint32_t denominator = 1;
    std::uint32_t mip_levels = 1;
    VkExtent2D extent{};        ///< where it is not 0: of mip level 0, whatever the frame's
    bool is_of_output = false;  ///< the fraction is one of what the frame is finished at, as EffectInfo::makes_output
};

/// A pass of one kernel.
struct KernelPassDesc {
    std::string name;         ///< label in plans and timings
    std::string_view shader;  ///< file in the effect's folder, without folder: "bloom_downsample.glsl"
    struct Input {
        std::string name;  ///< what the shader calls it
        PassImage image;
        std::uint32_t mip_level = 0;
        bool is_loaded = false;  ///< load() of it shall be as cheap as it can be, beside sampling
    };
    std::vector<Input> inputs;
    PassImage output;
    std::uint32_t output_mip_level = 0;
    /// Images of the same extent that it writes, too, at most three: add_all() tells their new names. The shader then
    /// defines `void shade(Pixel pixel, out vec4 result[N])`.
    std::vector<PassImage> more_outputs{};
    bool is_additive = false;          ///< adds to what `output` holds
    std::uint32_t custom_vectors = 0;  ///< at most 512
    ConstantsFunction constants = nullptr;
    ConditionFunction condition = nullptr;  ///< beside the entry's own toggle
    std::uint32_t argument = 0;             ///< handed to condition
};

/// A constant table: made at compile, uploaded by the first record, sampled by the effect.
struct TableDesc {
    std::string name;
    VkFormat format = VK_FORMAT_R8_UNORM;
    VkExtent3D extent{1, 1, 1};
    bool is_load_only = false;  ///< read by load() alone, which is then cheaper; the format must allow storage
    std::vector<std::byte> data;
};

/// What `build` of an effect declares its passes with. Runs at compile, never while recording.
class PassBuilder {
  public:
    virtual ~PassBuilder() = default;
    /// The picture at the effect's place, as an image.
    [[nodiscard]] virtual PassImage picture() = 0;
    /// The image that the entry's `source` names, else picture().
    [[nodiscard]] virtual PassImage source() = 0;
    /// A number that follows from the largest extent a frame may have here, such as the levels of a pyramid. The plan
    /// is kept for other extents that give the same.
    [[nodiscard]] virtual std::uint32_t from_max_extent(std::uint32_t (*question)(VkExtent2D)) = 0;
    /// Values at compile of the rows that are read then (`field().at_compile()`); of all others the defaults. The
    /// values of a frame may differ.
    [[nodiscard]] virtual const void* parameters() const = 0;
    /// What a parameter of kind Resource names; null: nothing. A plan that asks is made anew when such a one changes.
    [[nodiscard]] virtual const ResourceData* resource(Resource) const { return nullptr; }

    [[nodiscard]] virtual PassImage create(const PassImageDesc& desc) = 0;
    /// Are passes that write this format, or add to it, compute kernels here? They round the packed floats of 11 and 10
    /// bits, which drivers may cut off; blending does as the driver likes.
    [[nodiscard]] virtual bool is_stored(VkFormat) const { return false; }
    /// An image that outlives the frame: `current` is to be written, `previous` is what the last frame of this view
    /// wrote, zero after a cut or a frame in which the effect was off,
    /// and resampled where the frame has another extent.
    struct History {
        PassImage current, previous;
    };
    [[nodiscard]] virtual History history(const PassImageDesc& desc) = 0;
    /// An image of the host that the effect's needs name, at the size of picture(); of Shadows there is shadow_map().
    /// Where frames lack one that something can stand in for, one texel of that: load() gives it everywhere.
    [[nodiscard]] virtual PassImage frame_image(FrameImage which) = 0;
    /// Do frames have this image? For needs that are no more than wishes.
    [[nodiscard]] virtual bool has_frame_image(FrameImage which) const = 0;
    /// Are the numbers of the depth image planar distances already?
    [[nodiscard]] virtual bool is_depth_planar() const = 0;
    /// Are those of the velocity image previous minus current position, in pixels, y down, without jitter?
    [[nodiscard]] virtual bool is_velocity_plain() const = 0;
    /// The cascades of shadow_light(frame.lights, number), for effects that need shadows: a sampler2DArrayShadow, used
    /// by its name. Where a frame has fewer such lights, one that is lit everywhere.
    [[nodiscard]] virtual PassImage shadow_map(std::uint32_t number) = 0;
    /// An image that several effects need (linear depth, say): `make` declares its passes for the first that asks, with
    /// shaders of effects/shared; they run while any of the effects that asked is on, and its `condition` holds.
    [[nodiscard]] virtual PassImage shared(std::string_view name, PassImage (*make)(PassBuilder&),
                                           ConditionFunction condition = nullptr) = 0;
    [[nodiscard]] virtual PassImage table(const TableDesc& desc) = 0;
    /// Adds a pass; returns the written image's new name.
    virtual PassImage add(const KernelPassDesc& desc) = 0;
    /// The same of a pass with several outputs, `output` first; none after an error.
    virtual std::vector<PassImage> add_all(const KernelPassDesc& desc) { return {add(desc)}; }
    /// The pointwise end samples `image` under `name`. While the effect, or all that writes `image`, is off, a 1x1
    /// image of `neutral` stands in.
    virtual void side(std::string name, PassImage image, PassVector neutral) = 0;
    /// The same for an image that the end mostly loads: where loads are cheap, sample_linear() is four of them, and the
    /// other functions that sample are not there.
    virtual void loaded_side(std::string name, PassImage image, PassVector neutral) {
        side(std::move(name), image, neutral);
    }
    /// Vectors for the pointwise end, worked out on the CPU in every frame: its text reads them by
    /// `vec4 <effect>_custom(int)`. At most 96 together in one kernel.
    virtual void end_constants(std::uint32_t /*vectors*/, ConstantsFunction /*constants*/) {}
    /// The effect's output, for effects without a pointwise end. While it is off, its input stands in.
    virtual void result(PassImage image) = 0;
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
    /// The state after the effect, given that before it and the parameters; null: unchanged.
    ColorState (*makes)(ColorState before, const void* parameters) = nullptr;
    Needs needs{};
    FlatPlace flat;
    std::uint32_t toggle_key = 0;  ///< of a viewer: F1 .. F12 that switches it; 0: none
    OutputScale output_scale;      ///< of effects with a result of their own
    /// An upscaler: its result has the extent of the frame's output, whatever its input's. That is the target's where
    /// CompileDesc::target_extent is given, else the scene's.
    bool makes_output = false;
    bool has_second = false;  ///< reads a second picture, as side image `second`
    /// Its text names no image `second`, but calls `vec4 <name>_second(Pixel pixel)`: a reading is then made in place.
    bool has_second_in_place = false;
    bool parts_channels = false;  ///< of a map: Place::barrel differs from channel to channel
    bool is_ui = false;           ///< of the interface's own chain: see EntryDesc::is_ui
    /// Where the picture is no code values, it gets those of sRGB, too, and back behind it.
    bool works_encoded = false;
    /// Of such an effect: luminance of the 1.0 that it works with; null: the picture's white.
    float (*working_white_nits)(const void* parameters) = nullptr;
    /// What a path tracer or a camera puts into its pictures itself: occlusion, light in the air, motion.
    bool is_in_traced_light = false;
    bool is_last_step = false;  ///< encode, dither: skipped where the target takes linear floats
    std::function<void(PassBuilder&)> build{};
    /// The published equation in double precision; see reference.hpp.
    ReferenceFunction reference = nullptr;
    ReferenceMapFunction reference_map = nullptr;  ///< of a map, in its place
    ReferenceTapFunction reference_tap = nullptr;  ///< of a tap
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
};

/// Every effect of this build, by name.
[[nodiscard]] std::span<const EffectInfo* const> all_effects();
/// The effect of that name; null: none.
[[nodiscard]] const EffectInfo* find_effect(std::string_view name);

}  // namespace darkroom
