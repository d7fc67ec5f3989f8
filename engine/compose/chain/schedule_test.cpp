// SPDX-License-Identifier: MIT
// The graphs that the planner makes, without a device: whatever is toggled from frame to frame, the checker finds every
// read ordered after its write.

#include <random>

#include "compose/test_stacks/host.hpp"
#include "graph_check/check.hpp"
#include "plan/program.hpp"

namespace darkroom::plan {
namespace {

class ComposeSchedule : public test::StackTest {};

Entry entry_of(std::string_view effect, std::vector<Entry>& stack, EntryDesc desc = {}) {
    const EffectInfo& info = *find_effect(effect);
    desc.name = std::string(effect) + std::to_string(stack.size());
    Entry entry{.id = static_cast<std::uint32_t>(stack.size() + 1), .info = &info, .desc = std::move(desc)};
    entry.base.assign(info.parameters.defaults.begin(), info.parameters.defaults.end());
    return entry;
}

std::vector<Entry> random_stack(std::mt19937& random) {
    const auto below = [&](std::uint32_t limit) { return static_cast<std::uint32_t>(random() % limit); };
    std::vector<Entry> stack;
    const std::uint32_t entries = 1 + below(7);
    for (std::uint32_t i = 0; i < entries; ++i) {
        const auto handle = [&] {
            const std::uint32_t pick = below(i + 2);
            return pick == 0 ? Handle{} : pick == 1 ? scene_color : Handle{pick - 1};
        };
        const EffectInfo& info = *all_effects()[below(static_cast<std::uint32_t>(all_effects().size()))];
        EntryDesc desc;
        if (below(3) == 0) desc.input = handle();
        if (below(2) == 0) desc.source = handle();
        if (below(3) == 0) desc.mask = handle();
        if (info.has_second()) desc.second = i == 0 ? scene_color : Handle{1 + below(i)};
        if (below(3) == 0) desc.opacity = 0.5f;
        stack.push_back(entry_of(info.name, stack, desc));
    }
    return stack;
}

/// Bytes and alignment of an invented device.
Result<graph::Requirements> measure(const graph::ImageDesc& desc, VkImageUsageFlags, const graph::Extents& frame) {
    VkDeviceSize size = 0;
    for (std::uint32_t level = 0; level < desc.mip_levels; ++level) {
        const VkExtent2D extent = graph::mip_extent(desc.size.of(frame), level);
        size += VkDeviceSize{extent.width} * extent.height * gpu::format_traits(desc.format).bits / 8;
    }
    return graph::Requirements{.size = size, .alignment = 64};
}

/// The commands of one frame, kept.
struct Copy {
    explicit Copy(const graph::Recording& of, std::vector<std::uint8_t> on)
        : steps(of.steps.begin(), of.steps.end()),
          barriers(of.barriers.begin(), of.barriers.end()),
          final_barriers(of.final_barriers.begin(), of.final_barriers.end()),
          toggles(std::move(on)),
          read_layouts(of.read_layouts.begin(), of.read_layouts.end()),
          frame(of.frame) {}
    [[nodiscard]] graph::Recording recording() const {
        return {.steps = steps,
                .barriers = barriers,
                .final_barriers = final_barriers,
                .gates = toggles,
                .read_layouts = read_layouts,
                .frame = frame};
    }
    std::vector<graph::Step> steps;
    std::vector<graph::Barrier> barriers, final_barriers;
    std::vector<std::uint8_t> toggles;
    std::vector<VkImageLayout> read_layouts;
    std::uint64_t frame = 0;
};

std::vector<graph::ImportState> states_of(const Program& program) {
    std::vector<graph::ImportState> states(program.imports.size());
    for (std::size_t i = 0; i < states.size(); ++i) {
        if (program.imports[i] == HostImage{HostImage::Kind::Color})
            states[i] = {.layout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                         .stages = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                         .access = VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                         .final_layout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
        if (program.imports[i] == HostImage{HostImage::Kind::Target})
            states[i].final_layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    }
    return states;
}

/// Which toggles are on: entries at random, and the levels of pyramids up to a limit.
std::vector<std::uint8_t> random_toggles(std::mt19937& random, const Program& program, std::size_t entries) {
    std::vector<bool> is_on(entries);
    for (std::size_t i = 0; i < entries; ++i) is_on[i] = random() % 4 != 0;
    const auto limit = static_cast<std::uint32_t>(random() % 7);
    std::vector<std::uint8_t> out;
    for (const Gate& toggle : program.gates) {
        bool on = false;
        for (const std::uint32_t entry : toggle.entries) on = on || is_on[entry];
        out.push_back(on && (toggle.condition == nullptr || toggle.argument < limit) ? 1 : 0);
    }
    return out;
}

TEST_F(ComposeSchedule, TheCheckerAcceptsEveryFrameOfEveryStack) {
    std::size_t passes = 0, skipped = 0, toggled = 0;
    for (std::uint32_t seed = 0; seed < 150; ++seed) {
        SCOPED_TRACE(seed);
        std::mt19937 random(seed * 7919 + 1);
        const std::vector<Entry> stack = random_stack(random);
        CompileDesc desc{.max_extent = {640, 360}};
        desc.fuse = seed % 3 != 0;
        if (seed % 2 == 0) desc.color.usage |= VK_IMAGE_USAGE_STORAGE_BIT;
        // The stages mixed as a device with few formats would have them.
        const auto program =
            plan_program(stack, desc, {.stage_of = [&](const gpu::KernelSpec& spec) -> Result<gpu::Stage> {
                             const std::size_t length = spec.name.size() + seed;
                             return length % 2 == 0 ? gpu::Stage::Compute : gpu::Stage::Raster;
                         }});
        ASSERT_TRUE(program) << program.error().text;
        const auto compiled = program->graph.compile(desc.max_extent, measure);
        ASSERT_TRUE(compiled) << compiled.error().text;
        const std::vector<graph::ImportState> states = states_of(*program);

        graph::Schedule schedule(*compiled);
        std::vector<Copy> frames;
        for (std::uint64_t frame = 0; frame < 6; ++frame) {
            const std::vector<std::uint8_t> on = frame == 0 ? std::vector<std::uint8_t>(program->gates.size(), 1)
                                                            : random_toggles(random, *program, stack.size());
            const auto toggles = std::make_unique<bool[]>(on.size() + 1);
            std::ranges::copy(on, toggles.get());
            schedule.derive({toggles.get(), on.size()}, states, frame);
            frames.emplace_back(schedule.recording(), on);
            passes += schedule.steps().size();
            skipped += compiled->passes().size() - schedule.steps().size();
            toggled += on.size();
        }
        std::vector<graph::Recording> recordings;
        for (const Copy& copy : frames) recordings.push_back(copy.recording());
        const auto checked = graph::check_frames(*compiled, recordings, states);
        ASSERT_TRUE(checked) << checked.error().text;
    }
    EXPECT_GT(passes, 2000u);
    EXPECT_GT(skipped, 300u);
    EXPECT_GT(toggled, 1000u);
}

TEST_F(ComposeSchedule, KernelsKeepToTheStorageImagesOfTheDevice) {
    std::size_t most = 0;
    for (std::uint32_t seed = 0; seed < 60; ++seed) {
        std::mt19937 random(seed * 31 + 7);
        const std::vector<Entry> stack = random_stack(random);
        CompileDesc desc{.max_extent = {640, 360}};
        desc.color.usage |= VK_IMAGE_USAGE_STORAGE_BIT;
        const auto count = [&](std::uint32_t limit) {
            const auto program = plan_program(
                stack, desc,
                {.stage_of = [](const gpu::KernelSpec&) -> Result<gpu::Stage> { return gpu::Stage::Compute; },
                 .can_load = [](VkFormat) { return true; },
                 .max_storage_images = limit});
            EXPECT_TRUE(program);
            std::size_t worst = 0;
            for (const ProgramPass& pass : program->passes) {
                EXPECT_EQ(pass.inputs.size(), pass.spec.images.size());
                std::size_t storage = pass.spec.outputs.empty() ? 0 : 1;
                for (const gpu::KernelImage& image : pass.spec.images)
                    if (image.storage_format != VK_FORMAT_UNDEFINED) ++storage;
                worst = std::max(worst, storage);
            }
            return worst;
        };
        most = std::max(most, count(64));
        EXPECT_EQ(count(1), 1u) << "seed " << seed;
    }
    EXPECT_GT(most, 1u) << "nothing had to be limited";
}

TEST_F(ComposeSchedule, TheDefaultStackHasNoTransientImagesButBlooms) {
    std::vector<Entry> stack;
    stack.push_back(entry_of("bloom", stack, {.source = scene_color}));
    for (const char* const effect : {"exposure", "tonemap", "encode", "dither", "vignette"})
        stack.push_back(entry_of(effect, stack));
    for (const bool is_fused : {true, false}) {
        CompileDesc desc{.max_extent = {1920, 1080}};
        desc.fuse = is_fused;
        const auto program =
            plan_program(stack, desc,
                         {.stage_of = [](const gpu::KernelSpec&) -> Result<gpu::Stage> { return gpu::Stage::Compute; },
                          .compute = {.workgroup_invocations = 256}});
        ASSERT_TRUE(program) << program.error().text;
        const auto compiled = program->graph.compile(desc.max_extent, measure);
        ASSERT_TRUE(compiled) << compiled.error().text;
        std::vector<std::string> transients;
        for (const graph::Slot& slot : compiled->slots())
            if (slot.kind == graph::Slot::Kind::Transient) transients.push_back(slot.desc.name);
        const auto together = static_cast<double>(compiled->transient_bytes());
        const auto alone = static_cast<double>(compiled->transient_bytes_unaliased());
        if (is_fused) {
            ASSERT_EQ(transients.size(), 2u);
            EXPECT_NE(transients[0].find("pyramid"), std::string::npos);
            EXPECT_NE(transients[1].find("wide levels"), std::string::npos);
        } else {
            EXPECT_EQ(transients.size(), 7u);
            EXPECT_LE(together, 0.45 * alone);
        }
    }
}

}  // namespace
}  // namespace darkroom::plan
