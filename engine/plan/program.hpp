// SPDX-License-Identifier: MIT
#pragma once
// What the planner makes of a stack: passes with their kernels, images and toggles, and the graph that orders them.
// Pure data: no device objects, no pointers into the stack but to the effects' static descriptions.

#include <algorithm>
#include <darkroom/composer.hpp>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "gpu/kernel/kernel.hpp"
#include "graph/graph.hpp"
#include "plan/frame/modulation.hpp"
#include "plan/frame/shape.hpp"
#include "plan/text/glsl.hpp"

namespace darkroom::plan {

/// Vectors from the CPU in one pass of an effect, and in one fused kernel beside the parameters of its entries. With
/// them a block stays within the 16 KiB that every device allows.
inline constexpr std::uint32_t max_custom_vectors = 512;
inline constexpr std::uint32_t max_fused_vectors = 96;
/// Entries in one fused kernel, and entries of a plan that join a kernel begun by another. A compiler's time grows
/// faster than its kernel, and a kernel of one entry serves all entries of that effect.
inline constexpr std::size_t max_fused_entries = 16, max_joined_entries = 96;
/// Kernels of a plan that do not run where their entries are off. A picture behind such a kernel may be any of those
/// before it, so all of them keep their memory; behind the kernels that always run two pictures are enough.
inline constexpr std::size_t max_gated_kernels = 32;

/// A stack entry as the Composer keeps it.
struct Entry {
    std::uint32_t id = 0;             ///< of its Handle: never given twice
    std::uint64_t history_owner = 0;  ///< whose histories it goes on with; 0: nobody's
    const EffectInfo* info = nullptr;
    std::shared_ptr<const void> effect_owner{};  ///< keeps `info` alive where it is not static
    EntryDesc desc;
    std::shared_ptr<const Resources> resources{};  ///< of the Composer
    std::vector<std::uint32_t> base;               ///< parameter words
    struct Override {
        std::string owner;
        std::uint32_t word = 0, words = 0;
        std::array<std::uint32_t, 1 + 2 * Curve::capacity> value{};
    };
    std::vector<Override> overrides;

    std::vector<Layer> layers;
    std::vector<Pulse> pulses;
    std::weak_ptr<Entry> replaced{};  ///< of another effect under the same number, while a plan has it

    /// Base values, the layers over them, pulses added, then overrides in the order they were set. `out` holds
    /// info->parameters.words() words. Allocates nothing.
    Presence evaluate(std::span<std::uint32_t> out, const Moment& moment) const;
    /// What passes may depend on: base values of the rows that are read at compile, defaults of all others.
    [[nodiscard]] std::vector<std::uint32_t> values_at_compile() const;
    /// Whether it changes anything in a frame with these values; what the plan leaves out never does.
    [[nodiscard]] bool is_on(const Presence& presence, const std::uint32_t* words) const {
        return presence.is_enabled && presence.opacity > 0 &&
               (info->is_identity == nullptr || !info->is_identity(words));
    }
    /// What the picture is behind it, in a frame with these values.
    [[nodiscard]] ColorState state_after(const ColorState& before, const std::uint32_t* words, bool is_on) const {
        if (!is_on || info->makes == nullptr) return before;
        ColorState out = info->makes(before, words);
        out.is_associated = before.is_associated;
        return out;
    }
    /// At this opacity: is its result the output as it is? `has_mask`: by the plan, whose wires a rewire leaves alone.
    [[nodiscard]] bool is_plain(float opacity, bool has_mask) const {
        return opacity == 1.0f && desc.blend == BlendMode{} && !has_mask;
    }
    /// In every frame: layers may move the opacity.
    [[nodiscard]] bool is_plain() const {
        return is_plain(desc.opacity, desc.mask.is_given()) &&
               std::ranges::none_of(layers, [](const Layer& l) { return l.opacity.has_value(); });
    }
};

/// Whether passes run in a frame: an entry is on, and its condition holds; or, for a fused kernel between others, any
/// of its entries is on.
struct Gate {
    std::vector<std::uint32_t> entries;
    ConditionFunction condition = nullptr;
    std::uint32_t argument = 0;
    std::vector<ConditionFunction> conditions;  ///< of what is shared: one an entry, null: none
    // Of a watch, which has no entries:
    std::optional<std::uint32_t> watch;  ///< of CompileDesc::watches: the frame must have a target for it
    std::int32_t writer = -1;            ///< the gate, before this one, of what writes the image; -1: always open
};

inline constexpr std::uint32_t no_table = ~0u;
/// An image that a pass reads: a version of the graph, or a table, which never changes and needs no graph.
struct PassInput {
    graph::Version version;
    graph::Version instead{};  ///< what this pass alone gets while nobody makes the version: a neutral image
    std::uint32_t mip_level = 0;
    std::uint32_t table = no_table;  ///< index of Program::fixed_images
    bool is_shadow_map = false;
};

/// A kernel that the planner makes of entries that follow each other; it may have no step.
struct FusedPass {
    std::vector<FusedStep> steps;
    Finish finish = Finish::None;
    Resampling resampling = Resampling::None;
    bool is_alpha = false;  ///< makes a grey picture of the alpha before its steps
    FinishAlpha alpha{};
};
/// A kernel of an effect's build.
struct KernelPass {
    FusedStep step;
    ConstantsFunction constants = nullptr;
};
/// The same with a body of its own, which writes what it likes of its outputs and buffers.
struct ComputePass {
    KernelPass own;
    struct Output {
        graph::Version version;
        std::uint32_t mip_level = 0;
    };
    std::vector<Output> outputs;
    std::array<std::uint32_t, 2> groups{};  ///< (0, 0): as many tiles as cover the first output or input
    std::array<std::uint32_t, 2> tile{};
    [[nodiscard]] std::array<std::uint32_t, 2> groups_of(VkExtent2D extent) const {
        if (groups[0] != 0) return groups;
        return {(extent.width + tile[0] - 1) / tile[0], (extent.height + tile[1] - 1) / tile[1]};
    }
};
/// An image as it is, or brought to another size.
struct CopyPass {
    Resampling resampling = Resampling::None;
    std::optional<std::uint32_t> watch{};   ///< of CompileDesc::watches: copies part of its input for it
    ConstantsFunction constants = nullptr;  ///< of the resampling
};

struct PassBufferUse {
    graph::Version version;  ///< of a buffer that is written, the one that the pass makes
    ComputePassDesc::Access access = ComputePassDesc::Access::Read;
    std::uint32_t number = 0;  ///< of Planner's buffers
};

struct ProgramPass {
    std::string name;
    std::variant<FusedPass, KernelPass, CopyPass, ComputePass> kind;
    gpu::KernelSpec spec;  ///< without its body: see plan/frame/shape.hpp
    gpu::Stage stage = gpu::Stage::Compute;
    std::vector<PassInput> inputs;         ///< one per spec.images
    std::vector<PassBufferUse> buffers{};  ///< one per spec.buffers
    graph::Version output;                 ///< the version that this pass makes; none of one that writes buffers alone
    std::vector<graph::Version> more_outputs{};  ///< of the same extent
    std::uint32_t output_mip_level = 0;
    std::int32_t toggle = -1;
    std::string boundary;
    std::vector<Literal> literals;
    bool asks_rays_meet = false;

    template <class Kind>
    [[nodiscard]] const Kind* as() const {
        return std::get_if<Kind>(&kind);
    }
    /// Of a pass of an effect's build; else null.
    [[nodiscard]] const KernelPass* of_effect() const {
        const ComputePass* const compute = as<ComputePass>();
        return compute != nullptr ? &compute->own : as<KernelPass>();
    }
    /// Calls visit(version, mip level) for each image that it writes.
    template <class Visit>
    void for_each_output(const Visit& visit) const {
        if (const ComputePass* const compute = as<ComputePass>()) {
            for (const ComputePass::Output& out : compute->outputs) visit(out.version, out.mip_level);
            return;
        }
        visit(output, output_mip_level);
        for (const graph::Version more : more_outputs) visit(more, output_mip_level);
    }
    /// The steps of entries that it holds: one for an effect's pass, none for a copy.
    [[nodiscard]] std::span<const FusedStep> steps() const;
    [[nodiscard]] std::optional<std::uint32_t> watch() const {
        const CopyPass* const copy = as<CopyPass>();
        return copy == nullptr ? std::nullopt : copy->watch;
    }
    /// The frame's values say what the target needs.
    [[nodiscard]] bool finishes_by_frame() const {
        const FusedPass* const fused = as<FusedPass>();
        return fused != nullptr && is_by_frame(fused->finish);
    }
};

/// A table, a picture of the host, or a neutral image that stands in for a version: uploaded once, constant after. A
/// neutral image may be sampled and loaded.
struct FixedImage {
    TableDesc desc;
    std::shared_ptr<const ResourceData> picture{};  ///< of the host, which holds the texels in place of `desc`
    std::uint32_t import_index = ~0u;               ///< in the graph; tables have none
};
[[nodiscard]] inline std::span<const std::byte> texels_of(const FixedImage& fixed) {
    if (!fixed.picture) return fixed.desc.data;
    return std::as_bytes(std::span(std::get<ResourceImage>(*fixed.picture).rgba));
}

/// Which import of the graph is which image of the host.
struct HostImage {
    enum class Kind : std::uint8_t { Color, Input, Shadow, Target, Watched };
    Kind kind = Kind::Color;
    std::uint32_t number = 0;  ///< a FrameImage; of lights with cascades; of CompileDesc::watches
    friend auto operator<=>(const HostImage&, const HostImage&) = default;
};
[[nodiscard]] constexpr HostImage host_input(FrameImage image) {
    return {HostImage::Kind::Input, static_cast<std::uint32_t>(image)};
}

/// In place of an entry: the scene.
inline constexpr std::uint32_t no_entry = ~0u;
/// In place of an entry: the interface's image.
inline constexpr std::uint32_t ui_entry = ~0u - 1;

struct Program {
    graph::Graph graph;
    std::vector<ProgramPass> passes;  ///< in the order they were added to the graph
    std::vector<Gate> gates;
    std::vector<FixedImage> fixed_images;
    std::vector<std::optional<HostImage>> imports;  ///< per import; empty: a fixed image
    std::vector<std::uint32_t> entry_inputs;        ///< per entry: whose output it gets, past what is left out
    std::vector<std::uint32_t> entry_states;  ///< per entry: as what its picture comes; of an earlier frame's, too
    std::uint32_t last_entry = no_entry;      ///< whose output the target gets
    std::vector<graph::Size> entry_sizes;     ///< per entry: of the picture that it gets
    graph::Size target_size;
    std::vector<std::uint32_t>
        history_entries;  ///< per history of the graph: the entry that is told what it holds; no_entry: none
    /// Per watch: the gate of the pass that copies; -1: the plan has nothing that it names.
    std::vector<std::int32_t> watch_gates;
    std::vector<bool> is_left_out;  ///< per entry
    /// What entries make under a name, the last of each, for the host to read. A pass of the graph behind all of
    /// `passes` copies them, if there are any.
    struct NamedValue {
        std::string name;
        graph::Version version;
        std::uint32_t numbers = 0;
    };
    std::vector<NamedValue> values;
    std::vector<bool> is_mixable;  ///< per entry: opacity and blending may change while recording
    std::vector<std::string> left_out, remarks;
    /// What effects asked of the largest extent: the program serves every extent with the same answers.
    struct ExtentAnswer {
        std::uint32_t (*question)(VkExtent2D) = nullptr;
        graph::Size size;  ///< of the picture that the effect gets
        std::uint32_t answer = 0;
    };
    std::vector<ExtentAnswer> extent_answers;
};

/// Those of the largest frame, and of one whose colour and target are of these extents.
[[nodiscard]] inline graph::Extents extents_of(const CompileDesc& desc, VkExtent2D scene, VkExtent2D target) {
    return {scene, desc.target_extent.width != 0 ? target : scene};
}
[[nodiscard]] inline graph::Extents largest_extents(const CompileDesc& desc) {
    return extents_of(desc, desc.max_extent, desc.target_extent);
}

struct PlannerTraits {
    /// Which stage runs a kernel: gpu::preferred_stage, or the one the user asked for where it can.
    std::function<Result<gpu::Stage>(const gpu::KernelSpec&)> stage_of;
    /// Whether the device reads this format by imageLoad; null: every one.
    std::function<bool(VkFormat)> can_load{};
    /// Whether a linear sampler reads this format; null: every one. Else the kernels filter by loads.
    std::function<bool(VkFormat)> can_filter{};
    bool has_robust_images = false;    ///< see gpu/kernel/kernel.hpp
    std::uint32_t sub_texel_bits = 4;  ///< likewise
    bool packing_pays = true;          ///< smaller pixels and shared memory save time, as on no software driver
    std::uint32_t max_image_side = 16384;
    std::uint32_t max_storage_images = 4;  ///< of a kernel, its output among them
    std::array<std::uint32_t, 2> workgroup{16, 8};
    ComputeLimits compute{};
};

/// Turns a stack into a program. Errors: a handle that names no earlier entry, a shader that is missing.
[[nodiscard]] Result<Program> plan_program(std::span<const Entry> stack, const CompileDesc& desc,
                                           const PlannerTraits& traits);

/// Will a plan lay the entry's result over its input, so that its opacity may change while recording? One without
/// passes, and no part of a reading, always mixes.
[[nodiscard]] inline bool is_merged(const Entry& entry) {
    const Touch touch = entry.info->touch;
    return touch == Touch::Pointwise || touch == Touch::Warp || !entry.is_plain();
}

/// Numbers in the graph and in the program of the passes that the graph kept, in the order in which they are recorded:
/// those of one round lie beside each other.
[[nodiscard]] std::map<std::uint32_t, std::uint32_t> passes_in_order(const Program& program,
                                                                     const graph::Compiled& compiled);

/// The program as users read it: the passes that run with the entries' present values, in a frame of
/// example_values().
[[nodiscard]] Plan describe_program(const Program& program, const graph::Compiled& compiled, const CompileDesc& desc,
                                    std::span<const Entry* const> entries);

}  // namespace darkroom::plan
