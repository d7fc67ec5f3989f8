// SPDX-License-Identifier: MIT
#pragma once
// A kernel is a function of a pixel, written once in GLSL and run as a compute shader or as a fragment shader on a
// full-screen triangle. The body calls
//     vec4 sample_linear(IMAGE, vec2 uv)     bilinear, clamped to the image's region; uv (0,0)-(1,1) spans the region
//     vec4 load(IMAGE, ivec2 texel)          one texel; the texel must lie inside the region
//     vec4 load_clamped(IMAGE, ivec2 texel)  one texel, clamped to the region
//     vec4 gather_red(IMAGE, vec2 uv)        textureGather of the red channel
//     vec4 gather_green(IMAGE, vec2 uv)      textureGather of the green channel
//     ivec2 size(IMAGE)                      extent of the image's region, in texels
// where IMAGE is a name from KernelSpec::images, and defines
//     vec4 shade(Pixel pixel)                with one output
//     void shade(Pixel pixel, out vec4 result[N])   with N
// It may read KernelSpec::frame and members by their names, custom[i], output_size(), which is pixel.size, and the
// constants, for choices that must not cost a branch,
//     bool loads_outside_are_zero            a load outside any image gives zeros here, and may be made
//     bool rays_meet                         the frame's camera is perspective: all its rays come from one point
// Pixel is { ivec2 texel; vec2 uv; ivec2 size; }: texel (0,0) is the top left of the output's region.
// A compute pass has a body of its own instead (KernelSpec::compute): it defines
//     void run()                             with GLSL's own invocation numbers, `shared` variables and barrier()
// reads its images as above, writes its outputs, which have names and may be mip levels of several extents, by
//     void store(OUTPUT, ivec2 texel, vec4 value)   and asks ivec2 size(OUTPUT), and what packed floats are rounded to:
//     vec4 as_stored(OUTPUT, vec4 value)
// and its buffers are arrays, NAME[i], that any kernel may read and a compute pass may write, by atomics, too.
// output_size() is the extent that its groups are counted from.
// The functions of images exist for 2D images; another sampler type is used by its name and GLSL's own functions. Where
// a region ends inside its image, a gather does not leave it either, but gives the last whole 2x2 block there.
// kernel_source() writes the rest: preamble, bindings, region arithmetic, and main() of the stage.
//
// Set 0: binding 0 the block of the frame, binding 1 the kernel's own block, both uniform buffers, then the images in
// order, then, in compute, the outputs, then the buffers.
//
// The text depends on what the kernel does and on nothing else: names of passes and entries stay out of it, so that
// equal kernels are one kernel (gpu/kernel/kernel_store.hpp).

#include <vulkan/vulkan.h>

#include <array>
#include <cstdint>
#include <darkroom/kernel_statistics.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/digest/sha256.hpp"
#include "core/try.hpp"
#include "gpu/kernel/block.hpp"

namespace darkroom::gpu {

class Context;

/// Buffers of blocks are made with this usage, and bound at multiples of Traits::uniform_alignment. Measured on the
/// software driver, 16 scalars from a storage buffer cost 35 to 90 % more than the same ones from a uniform buffer.
inline constexpr VkBufferUsageFlags block_usage = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT;

/// Limits of one kernel: record() works in arrays of these sizes, on the stack. Vulkan promises 16 samplers a stage and
/// 4 attachments.
inline constexpr std::uint32_t max_images = 16;
inline constexpr std::uint32_t max_outputs = 4;
inline constexpr std::uint32_t max_buffers = 4;

enum class Stage : std::uint8_t { Compute, Raster };

struct KernelImage {
    std::string name;
    /// VK_FORMAT_UNDEFINED: sampled (any format). Else load() is an imageLoad of that format, the cheapest read of an
    /// own pixel, and the image is bound in VK_IMAGE_LAYOUT_GENERAL; sample_linear(), of floats, then mixes four loads,
    /// and there are no gathers.
    VkFormat storage_format = VK_FORMAT_UNDEFINED;
    /// Or "sampler3D", "usampler2D", ... What ends with "Shadow" is compared: Context::shadow_sampler.
    std::string sampler_type = "sampler2D";
    /// The device cannot filter its format: sample_linear() mixes four loads. Of "sampler2D" only.
    bool is_filtered_by_loads = false;
    bool is_single = false;  ///< one texel, which load() gives everywhere
};

/// A storage buffer: an array of elements of a type, as many as are bound.
struct KernelBuffer {
    std::string name;
    std::string type = "uint";
    bool is_written = false;  ///< by compute passes alone
};

/// What a compute pass asks of a device beside images and buffers.
struct ComputeBody {
    std::vector<std::string> outputs;  ///< names, one for each of KernelSpec::outputs
    std::uint32_t shared_bytes = 0;    ///< that its `shared` variables take
};

struct KernelSpec {
    std::string name;  ///< of the pipeline, and in errors; not part of the text
    std::vector<KernelImage> images;
    std::vector<VkFormat> outputs;
    std::vector<KernelBuffer> buffers{};
    std::optional<ComputeBody> compute{};  ///< its body is run(), not shade()
    bool is_whole = false;                 ///< all regions are whole images: no region arithmetic
    bool rays_meet = false;                ///< a constant that the body may ask for, see the top of this file
    bool has_robust_images = false;        ///< robustImageAccess: with whole images, loads outside are zero
    std::uint32_t sub_texel_bits = 4;      ///< VkPhysicalDeviceLimits::subTexelPrecisionBits; 4 is what all promise
    bool is_additive = false;              ///< output 0 += result instead of = result
    /// What all kernels of a frame read: laid out by its owner, who outlives the spec. Empty: no such block.
    std::span<const BlockMember> frame;
    std::vector<BlockMember> members;  ///< of the kernel's own block, behind what kernel_source() puts there
    std::uint32_t custom_vectors = 0;  ///< vec4 custom[n] in the own block
    std::string body;                  ///< GLSL: helpers and shade(); may hold #line directives
    std::array<std::uint32_t, 2> workgroup{16, 8};  ///< 128 invocations are what every device allows
};

/// The whole shader for one stage. Pure text: tested without a device.
[[nodiscard]] std::string kernel_source(const KernelSpec& spec, Stage stage);

/// The same without the names of files in its #line directives: an effect of a user's is the same wherever it lies.
[[nodiscard]] std::string without_file_names(std::string_view source);

/// The shader with what it is known by.
struct KernelText {
    KernelText(const KernelSpec& spec, Stage stage);
    std::string source;
    Digest digest{};  ///< of without_file_names()
};

/// The part of an image that a frame uses. Layouts are the graph's matter.
struct Region {
    VkOffset2D offset{};
    VkExtent2D extent{};
    VkExtent2D image{};  ///< of the whole image (of the mip level the view shows)
};
struct Binding {
    VkImageView view = VK_NULL_HANDLE;  ///< of one mip level where sample_linear() is called
    Region region{};
    bool is_nearest = false;  ///< formats that cannot be filtered
    bool is_lent = false;     ///< the host's: its handle may stand for another view than last time
    VkImageLayout layout =
        VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;  ///< of a sampled image; storage images are GENERAL
};

/// Bytes of the own block of a spec, and its content for one invocation: output region, one region an input, of a
/// compute pass one an output, custom vectors, and the words of the members.
[[nodiscard]] std::size_t own_block_size(const KernelSpec& spec);
void write_own_block(const KernelSpec& spec, const Region& output, std::span<const Binding> images,
                     std::span<const std::array<float, 4>> custom, std::span<const std::uint32_t> words,
                     std::span<std::byte> out, std::span<const Binding> outputs = {});

/// Compiled for one stage: pipeline, layouts. Made when a stack is compiled or on a worker, never while recording.
class Kernel {
  public:
    [[nodiscard]] static Result<std::unique_ptr<Kernel>> create(Context& context, const KernelSpec& spec, Stage stage);
    /// The same from the text of `spec` and `stage`.
    [[nodiscard]] static Result<std::unique_ptr<Kernel>> create(Context& context, const KernelSpec& spec, Stage stage,
                                                                const KernelText& text);
    ~Kernel();
    /// Without its body.
    [[nodiscard]] const KernelSpec& spec() const;
    [[nodiscard]] Stage stage() const;
    /// The same for all kernels with the same images, outputs and stage.
    [[nodiscard]] VkDescriptorSetLayout set_layout() const;
    /// Of its stage's program; on a device that compiles only.
    [[nodiscard]] Result<KernelStatistics> statistics() const;

    struct Block {
        VkBuffer buffer = VK_NULL_HANDLE;
        VkDeviceSize offset = 0, size = 0;
    };
    struct Invocation {
        VkDescriptorSet set = VK_NULL_HANDLE;  ///< of set_layout(), not in use by an unfinished frame
        Block frame, own;                      ///< own: the caller wrote it with write_own_block
        std::span<const Binding> images;
        std::span<const Binding> outputs;  ///< all with the same region, but those of a compute pass
        std::span<const Block> buffers{};
    };
    /// Writes all of the set.
    void write_set(const Invocation& invocation) const;
    /// Binds and dispatches (or begins rendering, draws, ends), with a set that was written. No allocation, no wait.
    void record(VkCommandBuffer commands, VkDescriptorSet set, std::span<const Binding> outputs) const;
    /// Dispatches so many groups of a compute pass.
    void record_groups(VkCommandBuffer commands, VkDescriptorSet set, std::array<std::uint32_t, 2> groups) const;

  private:
    Kernel();
    struct State;
    std::unique_ptr<State> state_;
};

/// Whether `stage` can run `spec` on this device; the error names the output or image and its format.
[[nodiscard]] Result<> usable(const Context& context, const KernelSpec& spec, Stage stage);

/// Rows suit the software driver, squares the GPUs; never more invocations than the device allows.
[[nodiscard]] std::array<std::uint32_t, 2> usual_workgroup(const Context& context);

/// Which stage runs `spec` best on this device, from the measurements in docs/architecture.md: GPUs compute; the
/// software driver rasterises. Formats that the stage cannot write force the other one.
[[nodiscard]] Stage preferred_stage(const Context& context, const KernelSpec& spec);

}  // namespace darkroom::gpu
