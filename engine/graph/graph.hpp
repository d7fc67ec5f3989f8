// SPDX-License-Identifier: MIT
#pragma once
// The frame graph: passes declare what they read and write, `compile` decides what runs, where transient images lie in
// shared memory, and `Schedule` derives every barrier. It knows no effect and no kernel, and needs no device: sizes and
// memory requirements are data, so its tests run on a null device.
//
// 1. Declare: import host images, create transient ones, add passes in the order in which they see each other's work.
// 2. compile(): errors that name both ends, culling, rounds of passes that run side by side, lifetimes, aliasing.
// 3. Per frame, Schedule (graph/schedule.hpp): the barriers of the passes that are on.

#include <vulkan/vulkan.h>
#include <compare>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/try.hpp"

namespace darkroom::graph {

/// How a pass touches an image or a buffer. From it follow the stage, the access mask, the layout and the usage flags.
enum class Use : std::uint8_t {
    SampledCompute,       ///< texture() or texelFetch in a compute shader
    SampledFragment,      ///< the same in a fragment shader
    StorageRead,          ///< imageLoad in a compute shader
    StorageReadFragment,  ///< imageLoad in a fragment shader
    StorageWrite,         ///< imageStore, every texel of the region written: the old content is dropped
    StorageReadWrite,     ///< imageLoad and imageStore: the old content is kept
    ColorWrite,           ///< colour attachment, every texel of the region written: the old content is dropped
    ColorBlend,           ///< colour attachment, blended over the old content
    // Of buffers:
    BufferRead,  ///< storage or uniform buffer in a compute shader
    BufferReadFragment,
    BufferWrite,      ///< storage buffer of a compute shader, all of it written: the old content is dropped
    BufferReadWrite,  ///< the same, or by atomics: the old content is kept
    BufferCopy,       ///< copied out of
};
inline constexpr std::uint8_t use_count = 13;
[[nodiscard]] bool is_of_buffers(Use use);
[[nodiscard]] bool is_write(Use use);
[[nodiscard]] bool keeps_content(Use use);  ///< a write that needs what was there before
[[nodiscard]] VkPipelineStageFlags2 stages_of(Use use);
[[nodiscard]] VkAccessFlags2 access_of(Use use);
[[nodiscard]] VkImageLayout layout_of(Use use);
[[nodiscard]] VkImageUsageFlags usage_of(Use use);

/// What a size is a fraction of: the frame's colour, or what the frame is finished at.
enum class Extent : std::uint8_t { Scene, Output };
/// The named extents of one frame.
struct Extents {
    VkExtent2D scene{}, output{};
    Extents() = default;
    Extents(VkExtent2D all) : scene(all), output(all) {}  // NOLINT(google-explicit-constructor): a frame of one extent
    Extents(VkExtent2D of_scene, VkExtent2D of_output) : scene(of_scene), output(of_output) {}
    [[nodiscard]] VkExtent2D of(Extent name) const { return name == Extent::Scene ? scene : output; }
};

/// Extent in pixels: a reduced fraction of a named extent, floored, at least 1; or absolute where `width` is not 0.
struct Size {
    std::uint32_t numerator = 1;
    std::uint32_t denominator = 1;
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    Extent extent = Extent::Scene;
    [[nodiscard]] VkExtent2D of(const Extents& frame) const;
    /// Of an absolute size floored, else reduced; two ways to the same fraction give the same size.
    [[nodiscard]] Size scaled(std::uint32_t by_numerator, std::uint32_t by_denominator) const;
    [[nodiscard]] static Size fraction(std::uint32_t denominator) { return {.denominator = denominator}; }
    friend auto operator<=>(const Size&, const Size&) = default;
};
/// The extent of a mip level: floored halves, at least 1.
[[nodiscard]] VkExtent2D mip_extent(VkExtent2D extent, std::uint32_t mip_level);

/// Of an image; or of a buffer, which has no more than a name and a size.
struct ImageDesc {
    std::string name;
    VkFormat format = VK_FORMAT_R16G16B16A16_SFLOAT;
    Size size{};
    std::uint32_t mip_levels = 1;
    std::uint32_t array_layers = 1;
    VkDeviceSize buffer_bytes = 0;

    [[nodiscard]] bool is_buffer() const { return buffer_bytes != 0; }
};

/// What the host promises about an image it lends for a frame: where it is before, where it shall be after.
struct ImportDesc {
    ImageDesc image;
    VkImageUsageFlags usage = 0;  ///< what the host created it with: a use outside is an error
    bool is_constant = false;     ///< never written, always in a layout that shaders read it in (neutral images)
};

/// One version of an image. A write makes a new version; the old one must not be read any more.
struct Version {
    std::uint32_t index = ~0u;
    [[nodiscard]] bool is_valid() const { return index != ~0u; }
    friend bool operator==(Version, Version) = default;
};

struct MipRange {
    std::uint32_t first = 0;
    std::uint32_t count = ~0u;  ///< all that follow
};
struct Read {
    Version version;
    Use use = Use::SampledCompute;
    MipRange mips{};
    /// What this reader alone gets instead, see Graph::fall_back. Invalid: what all readers get.
    Version instead{};
};
struct Write {
    Version version;  ///< the version this write replaces
    Use use = Use::StorageWrite;
    MipRange mips{};
};

struct PassDesc {
    std::string name;
    std::vector<Read> reads;
    std::vector<Write> writes;
    bool has_side_effect = false;  ///< never culled
    /// Index of the gate, a switch of passes, that lets this one run; -1: always on.
    std::int32_t gate = -1;
};
struct PassId {
    std::uint32_t index = ~0u;
};

/// Names a history in all plans that hold it: who declared it (0: nobody, then it belongs to one graph alone), and how
/// many histories that owner declared before.
struct HistoryKey {
    std::uint64_t owner = 0;
    std::uint32_t number = 0;
    friend auto operator<=>(const HistoryKey&, const HistoryKey&) = default;
};

/// Requirements of a transient image, asked of the device once at compile (or invented by a test).
struct Requirements {
    VkDeviceSize size = 0;
    VkDeviceSize alignment = 1;
    std::uint32_t memory_type_bits = ~0u;
};
using Measure = std::function<Result<Requirements>(const ImageDesc&, VkImageUsageFlags, const Extents& frame)>;

class Compiled;
struct Declaration;
struct Solution;

class Graph {
  public:
    Graph();
    ~Graph();
    Graph(Graph&&) noexcept;
    Graph& operator=(Graph&&) noexcept;
    [[nodiscard]] Version import(ImportDesc desc);
    [[nodiscard]] Version create(ImageDesc desc);
    /// An image that outlives the frame. `current` starts each frame undefined and must be written; `previous` is what
    /// the last frame wrote, zero if it did not write it. Both are ordinary versions; `previous` is only read.
    struct History {
        Version current, previous;
    };
    [[nodiscard]] History history(ImageDesc desc, HistoryKey key = {});
    /// A buffer of this frame alone. Buffers share no memory: they are small.
    [[nodiscard]] Version create_buffer(std::string name, VkDeviceSize bytes);
    /// A buffer that outlives the frame, one that is written in place: the version is what the last frame left in it
    /// (zero after a reset), and stays where no pass writes it. Counted and keyed as histories are.
    [[nodiscard]] Version lasting_buffer(std::string name, VkDeviceSize bytes, HistoryKey key = {});

    /// Adds a pass. Returns, for each of desc.writes, the version it makes. A write of some mip levels keeps the
    /// others. Mistakes are kept for compile() to report, so declaring code needs no checks.
    std::vector<Version> add(PassDesc desc);

    /// If the producer of `version` is off in a frame, its readers get `instead`: the pass's own input, or a constant.
    /// Mip levels that `instead` lacks become its last one. Without a fall-back, a write that keeps content falls back
    /// to the version it replaces. A reader with a Read::instead gets that one in place of any of these that would lead
    /// to another image, or to none.
    void fall_back(Version version, Version instead);
    /// A promise of the caller: whenever `gate` is on, `implied` is on, too. No cycles.
    void imply(std::int32_t gate, std::int32_t implied);
    /// `version` is wanted after the frame: passes that lead to it are kept.
    void keep(Version version);

    /// Checks, culls, computes lifetimes and packs. Errors: use after overwrite, a version nobody writes, a cycle of
    /// fall-backs, a gated pass whose output is read without a fall-back, a use the host's image was not made for.
    [[nodiscard]] Result<Compiled> compile(const Extents& largest, const Measure& measure) const;

  private:
    std::unique_ptr<Declaration> declaration_;
};

/// How a plan uses an image, whichever gates are on: stages and access of all passes, the layout of the first use and
/// of the last. An image that is only read is in one layout from the first to the last.
struct ImageUses {
    VkPipelineStageFlags2 stages = 0;
    VkAccessFlags2 access = 0;
    VkImageLayout first_layout = VK_IMAGE_LAYOUT_UNDEFINED, last_layout = VK_IMAGE_LAYOUT_UNDEFINED;
};

/// A physical image: an import, a transient, or one of the two images of a history; or a buffer, transient or lasting.
struct Slot {
    enum class Kind : std::uint8_t { Import, Constant, Transient, History, Lasting };
    Kind kind = Kind::Transient;
    ImageDesc desc;
    VkImageUsageFlags usage = 0;  ///< union over all passes that were kept
    std::uint32_t import_index = ~0u;
    std::uint32_t history_index = ~0u;
    HistoryKey history_key{};
    std::uint32_t history_parity = 0;  ///< 0: written in even frames, 1: in odd ones
    VkDeviceSize offset = 0;           ///< in the shared allocation of images, or in that of buffers, transients only
    VkDeviceSize size = 0;
    std::uint32_t first_pass = 0, last_pass = 0;  ///< lifetime, in pass order, whole rounds
    VkExtent2D extent{};                          ///< at the largest frame
    /// Histories: the layout between frames. A reset leaves both images in it.
    VkImageLayout rest_layout = VK_IMAGE_LAYOUT_UNDEFINED;
    ImageUses uses{};
};

/// What compile() made. Moving it leaves the schedules made from it valid; destroying it does not.
class Compiled {
  public:
    explicit Compiled(std::unique_ptr<const Solution> solution);
    ~Compiled();
    Compiled(Compiled&&) noexcept;
    Compiled& operator=(Compiled&&) noexcept;
    [[nodiscard]] std::span<const PassDesc> passes() const;        ///< kept ones, round by round
    [[nodiscard]] std::span<const std::uint32_t> rounds() const;   ///< of each, ascending
    [[nodiscard]] std::span<const std::string> culled() const;     ///< names of those left out
    [[nodiscard]] std::span<const Slot> slots() const;             ///< the first ones are the imports, in their order
    [[nodiscard]] VkDeviceSize transient_bytes() const;            ///< after aliasing
    [[nodiscard]] VkDeviceSize transient_bytes_unaliased() const;  ///< the sum of the transient images
    [[nodiscard]] VkDeviceSize buffer_bytes() const;               ///< of all transient buffers
    [[nodiscard]] std::uint32_t memory_type_bits() const;          ///< what all transients accept
    [[nodiscard]] VkDeviceSize memory_alignment() const;           ///< what suits all of them
    [[nodiscard]] std::uint32_t kept_pass_of(PassId declared) const;  ///< ~0u if culled
    /// The versions that a kept pass makes, one for each of its writes.
    [[nodiscard]] std::span<const Version> made(std::uint32_t pass) const;
    [[nodiscard]] const Solution& solution() const { return *solution_; }  ///< for schedule, checker and trace

  private:
    std::unique_ptr<const Solution> solution_;
};

}  // namespace darkroom::graph
