// SPDX-License-Identifier: MIT
#pragma once
// What the planner makes of a stack: passes with their kernels, images and toggles, and the graph that orders them.
// Pure data: no device objects, no pointers into the stack but to the effects' static descriptions.

#include <darkroom/composer.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gpu/kernel.hpp"
#include "graph/graph.hpp"
#include "plan/glsl.hpp"

namespace darkroom::plan {

/// A stack entry as the Composer keeps it.
struct Entry {
    const EffectInfo* info = nullptr;
    EntryDesc desc;
    std::vector<std::uint32_t> base;  ///< parameter words
    struct Override {
        std::string owner;
        std::uint32_t word = 0, words = 0;
        std::array<std::uint32_t, 1 + 2 * Curve::capacity> value{};
    };
    std::vector<Override> overrides;

    /// Base values under the overrides, in the order they were set. `out` holds info->parameters.words() words.
    void evaluate(std::span<std::uint32_t> out) const;
    /// Whether it changes anything in a frame with these values; what the plan leaves out never does.
    [[nodiscard]] bool is_on(const std::uint32_t* words) const {
        return desc.enabled && desc.opacity > 0 && (info->is_identity == nullptr || !info->is_identity(words));
    }
    /// What the picture is behind it, in a frame with these values.
    [[nodiscard]] Domain domain_after(Domain before, const std::uint32_t* words, bool is_on) const {
        return is_on && info->makes != nullptr ? info->makes(before, words) : before;
    }
    [[nodiscard]] bool is_plain() const {
        return desc.opacity == 1.0f && desc.blend == BlendMode{} && !desc.mask.is_given();
    }
};

/// Whether passes run in a frame: an entry is on, and its condition holds; or, for a fused kernel between others, any
/// of its entries is on.
struct Gate {
    std::vector<std::uint32_t> entries;
    ConditionFunction condition = nullptr;
    std::uint32_t argument = 0;
    std::vector<ConditionFunction> conditions;  ///< of what is shared: one an entry, null: none
};

inline constexpr std::uint32_t no_table = ~0u;
/// An image that a pass reads: a version of the graph, or a table, which never changes and needs no graph.
struct PassInput {
    graph::Version version;
    std::uint32_t mip_level = 0;
    std::uint32_t table = no_table;  ///< index of Program::constants
    bool is_shadow_map = false;
    bool is_loaded = false;  ///< a side image that is read by load() alone
};

struct ProgramPass {
    std::string name;
    gpu::KernelSpec spec;
    gpu::Stage stage = gpu::Stage::Compute;
    std::vector<PassInput> inputs;  ///< one per spec.images
    graph::Version output;          ///< the version that this pass makes
    std::uint32_t output_mip_level = 0;
    std::int32_t toggle = -1;
    std::string boundary;

    // A pass of an effect:
    std::uint32_t entry = ~0u;
    const EffectInfo* info = nullptr;
    ConstantsFunction constants = nullptr;
    std::string text;  ///< the body without the parameter loader
    // A fused kernel:
    std::vector<FusedStep> steps;
    Finish finish = Finish::None;
    Resampling resampling = Resampling::None;
};

/// A table, or a neutral image that stands in for a version: uploaded once, constant after. A neutral image may be
/// sampled and loaded.
struct Constant {
    TableDesc desc;
    std::uint32_t import_index = ~0u;  ///< in the graph; tables have none
};

/// Which import of the graph is which image of the host.
enum class HostImage : std::uint8_t { Color, Depth, Normals, Velocity, Ui, Target, Shadow0, Shadow1, Shadow2, Shadow3 };
/// The number of a shadow map; negative for what is none.
[[nodiscard]] constexpr std::int32_t shadow_number(HostImage image) {
    return static_cast<std::int32_t>(image) - static_cast<std::int32_t>(HostImage::Shadow0);
}

/// In place of an entry: the scene.
inline constexpr std::uint32_t no_entry = ~0u;

struct Program {
    graph::Graph graph;
    std::vector<ProgramPass> passes;  ///< in the order they were added to the graph
    std::vector<Gate> toggles;
    std::vector<Constant> constants;
    std::vector<std::optional<HostImage>> imports;  ///< per import; empty: a constant
    std::vector<std::uint32_t> block_words;         ///< per entry: first word of its block in the constants
    std::uint32_t constants_words = 0;
    std::uint32_t finish_word = 0;            ///< of finish_ in the constants
    std::vector<std::uint32_t> entry_inputs;  ///< per entry: whose output it gets, past what is left out
    std::uint32_t last_entry = no_entry;      ///< whose output the target gets
    std::vector<graph::Size> entry_sizes;     ///< per entry: of the picture that it gets
    graph::Size target_size;
    std::vector<std::uint32_t> history_entries;  ///< entries with histories
    std::vector<bool> is_left_out;               ///< per entry
    std::vector<bool> is_mixable;                ///< per entry: opacity and blending may change while recording
    std::vector<std::string> left_out, remarks;
};

struct PlannerTraits {
    /// Which stage runs a kernel: gpu::preferred_stage, or the one the user asked for where it can.
    std::function<Result<gpu::Stage>(const gpu::KernelSpec&)> stage_of;
    /// Whether the device reads this format by imageLoad; null: every one.
    std::function<bool(VkFormat)> can_load{};
    bool loads_are_cheap = false;  ///< see gpu/kernel.hpp
    std::array<std::uint32_t, 2> workgroup{16, 16};
};

/// Turns a stack into a program. Errors: a handle that names no earlier entry, a shader that is missing.
[[nodiscard]] Result<Program> plan_program(std::span<const Entry> stack, const CompileDesc& desc,
                                           const PlannerTraits& traits);

/// What the target needs of a picture in this domain: it is encoded exactly once, by a kernel or by the format.
[[nodiscard]] Finish finish_of(Domain domain, const CompileDesc& desc);
[[nodiscard]] Domain target_domain(const CompileDesc& desc);

/// The body of an effect's pass, with choices as literals where they are known.
[[nodiscard]] std::string effect_pass_body(const ProgramPass& pass, std::span<const Baked> baked);

/// Made by the planner from entries; else by an effect's build.
[[nodiscard]] inline bool is_fused(const ProgramPass& pass) { return pass.entry == ~0u; }

/// The program as users read it: the passes that run with the stack's present values, in a frame that brings all that
/// `desc` promises and a light to look at.
[[nodiscard]] Plan describe_program(const Program& program, const graph::Compiled& compiled, const CompileDesc& desc,
                                    std::span<const Entry> stack);

}  // namespace darkroom::plan
