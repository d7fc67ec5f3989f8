// SPDX-License-Identifier: MIT
#pragma once
// What an effect's build() makes: passes, the images and buffers between them, and values that outlast the frame.

#include <vulkan/vulkan.h>

#include <array>
#include <cstdint>
#include <darkroom/frame.hpp>
#include <darkroom/resource.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace darkroom {

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

/// Names an image that a pass builder made or was given. A picture that was written has a new name (engine/graph).
struct PassImage {
    std::uint32_t index = ~0u;
};

/// Names a buffer that a pass builder made or found. It is written in place, so it keeps its name.
struct PassBuffer {
    std::uint32_t index = ~0u;
    [[nodiscard]] bool is_given() const { return index != ~0u; }
};

struct PassImageDesc {
    std::string name;
    VkFormat format = VK_FORMAT_R16G16B16A16_SFLOAT;  ///< UNDEFINED: that of pictures between kernels
    /// Mip level 0 is numerator / denominator of the effect's input: floored, at least 1.
    std::uint32_t numerator = 1;
    std::uint32_t denominator = 1;
    std::uint32_t mip_levels = 1;
    VkExtent2D extent{};        ///< where it is not 0: of mip level 0, whatever the frame's
    bool is_of_output = false;  ///< the fraction is one of what the frame is finished at, as ResultScale::is_of_output
};

/// A pass of one kernel.
struct KernelPassDesc {
    std::string name;         ///< label in plans and timings
    std::string_view shader;  ///< file in the effect's folder, and its part: "motion_blur.glsl#tiles"
    struct Input {
        std::string name;  ///< what the shader calls it
        PassImage image;
        std::uint32_t mip_level = 0;
    };
    std::vector<Input> inputs;
    PassImage output;
    std::uint32_t output_mip_level = 0;
    /// Images of the same extent that it writes, too, at most three: add_all() tells their new names. The shader then
    /// defines `void shade(Pixel pixel, out vec4 result[N])`.
    std::vector<PassImage> more_outputs{};
    /// Values that the shader reads, as `float NAME[]`.
    struct Value {
        std::string name;
        PassBuffer value;
    };
    std::vector<Value> values{};
    bool is_additive = false;          ///< adds to what `output` holds
    std::uint32_t custom_vectors = 0;  ///< at most 512
    ConstantsFunction constants = nullptr;
    ConditionFunction condition = nullptr;  ///< beside the entry's own toggle
    std::uint32_t argument = 0;             ///< handed to condition
};

/// A compute pass: its shader defines `void run()`, with shared memory of its own (engine/gpu/kernel/kernel.hpp).
struct ComputePassDesc {
    std::string name;
    std::string_view shader;
    std::vector<KernelPassDesc::Input> inputs;
    /// One mip level; several levels of an image follow each other.
    struct Output {
        std::string name;
        PassImage image;
        std::uint32_t mip_level = 0;
    };
    std::vector<Output> outputs{};
    enum class Access : std::uint8_t { Read, Write, ReadWrite };
    struct Buffer {
        std::string name;  ///< of an array of `type`
        PassBuffer buffer;
        Access access = Access::Read;  ///< Write: all of it, what was there is lost
        std::string type = "uint";
    };
    std::vector<Buffer> buffers{};
    std::array<std::uint32_t, 2> workgroup{8, 8};
    std::uint32_t shared_bytes = 0;
    /// Groups of a dispatch; (0, 0): as many as cover the first output, or the first input where there is none.
    std::array<std::uint32_t, 2> groups{};
    std::array<std::uint32_t, 2> tile{};  ///< texels that a group covers there; (0, 0): as many as invocations
    bool is_additive = false;             ///< of one output: store() adds to what it holds
    std::uint32_t custom_vectors = 0;
    ConstantsFunction constants = nullptr;
    ConditionFunction condition = nullptr;
    std::uint32_t argument = 0;
};
/// What a compute pass may ask for. A pass that asks for more is an error: the effect has another form for such
/// devices.
struct ComputeLimits {
    std::uint32_t workgroup_invocations = 128;
    std::uint32_t shared_bytes = 16384;
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
    /// Can passes write this format here?
    [[nodiscard]] virtual bool is_written(VkFormat) const { return true; }
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
    [[nodiscard]] virtual ComputeLimits compute_limits() const { return {}; }
    /// Are compute passes that write this format, ask for so much, and keep what they make on the way in shared memory
    /// faster here than a kernel for each step? Where not, the plan remarks why.
    [[nodiscard]] virtual bool tiles_pay(VkFormat /*format*/, const ComputeLimits& /*asked*/) { return false; }
    /// A buffer of this frame, for passes of the effect alone.
    [[nodiscard]] virtual PassBuffer create_buffer(std::string_view /*name*/, std::uint32_t /*bytes*/) { return {}; }
    /// A few numbers that outlast the frame and have a name, for all entries behind: what a pass wrote, then or in an
    /// earlier frame of the view; zero after a cut.
    [[nodiscard]] virtual PassBuffer value(std::string_view /*name*/, std::uint32_t /*numbers*/) { return {}; }
    /// The value of this name that an entry before declared; not given: there is none.
    [[nodiscard]] virtual PassBuffer find_value(std::string_view /*name*/) const { return {}; }
    /// Adds a compute pass; returns the new name of each output's image. None after an error.
    virtual std::vector<PassImage> add_compute(const ComputePassDesc& /*desc*/) { return {}; }
    /// The pointwise end reads a value as `float NAME[]`.
    virtual void value_side(std::string /*name*/, PassBuffer /*value*/) {}
    /// The pointwise end samples `image` under `name`. While the effect, or all that writes `image`, is off, a 1x1
    /// image of `neutral` stands in.
    virtual void side(std::string name, PassImage image, PassVector neutral) = 0;
    /// Vectors for the pointwise end, worked out on the CPU in every frame: its text reads them by
    /// `vec4 <effect>_custom(int)`. At most 96 together in one kernel.
    virtual void end_constants(std::uint32_t /*vectors*/, ConstantsFunction /*constants*/) {}
    /// The effect's output, for effects without a pointwise end. While it is off, its input stands in.
    virtual void result(PassImage image) = 0;
};

}  // namespace darkroom
