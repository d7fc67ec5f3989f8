// SPDX-License-Identifier: MIT
// Properties that hold for every graph, tried on random ones: the checker agrees with the derived barriers over several
// frames, and disagrees when one of them is missing or weaker.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/test_support_allocations.hpp"
#include "graph/test_graphs.hpp"

namespace darkroom::graph::test {
namespace {

constexpr std::uint32_t graph_count = 400;

struct Case {
    std::uint32_t seed = 0;
    Compiled compiled;
    std::vector<ImportState> imports;
};

/// The first `count` random graphs that compile.
void for_each_case(std::uint32_t count, const std::function<void(Case&)>& body) {
    std::uint32_t found = 0, seed = 1;
    for (; found < count && seed < 40 * count; ++seed) {
        std::uint32_t import_count = 0;
        const Graph graph = random_graph(seed, import_count);
        auto compiled = graph.compile(full_hd, measure);
        if (!compiled) continue;
        ++found;
        constexpr std::array layouts{VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                     VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                     VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL};
        Case item{seed, std::move(*compiled), {}};
        for (std::uint32_t i = 0; i < import_count; ++i)
            item.imports.push_back(host_state(layouts[(seed + i) % layouts.size()]));
        // Some hosts place a barrier in front of a recording, and none behind it.
        for (std::uint32_t i = 0; i < import_count; ++i)
            if ((seed / 4 + i) % 3 == 0) item.imports[i].stages = item.imports[i].access = 0;
        body(item);
    }
    ASSERT_EQ(found, count) << "of " << seed << " graphs too few compile";
}

std::array<bool, gate_count> random_gates(std::mt19937& random) {
    std::array<bool, gate_count> gates{};
    for (bool& gate : gates) gate = random() % 2 == 0;
    return gates;
}

/// A recording that can be changed.
struct Copy {
    std::vector<Step> steps;
    std::vector<Barrier> barriers, final_barriers;
    std::vector<std::uint8_t> gates;
    std::vector<VkImageLayout> read_layouts;
    std::uint64_t frame = 0;

    explicit Copy(const Recording& from)
        : steps(from.steps.begin(), from.steps.end()),
          barriers(from.barriers.begin(), from.barriers.end()),
          final_barriers(from.final_barriers.begin(), from.final_barriers.end()),
          gates(from.gates.begin(), from.gates.end()),
          read_layouts(from.read_layouts.begin(), from.read_layouts.end()),
          frame(from.frame) {}
    Recording recording() const { return {steps, barriers, final_barriers, gates, read_layouts, frame}; }
    Barrier& barrier(std::size_t index) {
        return index < barriers.size() ? barriers[index] : final_barriers[index - barriers.size()];
    }
    void remove(std::size_t index) {
        if (index >= barriers.size()) {
            final_barriers.erase(final_barriers.begin() + static_cast<std::ptrdiff_t>(index - barriers.size()));
            return;
        }
        barriers.erase(barriers.begin() + static_cast<std::ptrdiff_t>(index));
        for (Step& step : steps) {
            if (step.first_barrier > index) {
                --step.first_barrier;
            } else if (index < step.first_barrier + step.barrier_count) {
                --step.barrier_count;
            }
        }
    }
};

}  // namespace

TEST(GraphRandom, CheckerAcceptsWhatScheduleDerives) {
    std::size_t barrier_count = 0, culled_in_frame = 0;
    for_each_case(graph_count, [&](Case& item) {
        std::mt19937 random(item.seed);
        Schedule schedule(item.compiled);
        std::vector<Copy> copies;
        for (std::uint64_t frame = 0; frame < 6; ++frame) {
            schedule.derive(random_gates(random), item.imports, frame);
            copies.emplace_back(schedule.recording());
            barrier_count += schedule.barriers().size();
            culled_in_frame += item.compiled.passes().size() - schedule.steps().size();
            const auto alone = check(item.compiled, schedule, item.imports);
            ASSERT_TRUE(alone) << "seed " << item.seed << ": " << alone.error().text << "\n"
                               << trace(item.compiled, schedule);
        }
        std::vector<Recording> frames;
        for (const Copy& copy : copies) frames.push_back(copy.recording());
        const auto together = check_frames(item.compiled, frames, item.imports);
        ASSERT_TRUE(together) << "seed " << item.seed << ": " << together.error().text;
    });
    EXPECT_GT(barrier_count, 1000u);
    EXPECT_GT(culled_in_frame, 100u);
}

TEST(GraphRandom, CheckerMissesNoMissingBarrier) {
    for_each_case(graph_count, [&](Case& item) {
        std::mt19937 random(item.seed + 77);
        const auto gates = random_gates(random);
        Schedule schedule(item.compiled);
        std::vector<Copy> copies;
        for (std::uint64_t frame = 0; frame < 5; ++frame) {
            schedule.derive(gates, item.imports, frame);
            copies.emplace_back(schedule.recording());
        }
        Copy& last = copies[2];
        const std::size_t count = last.barriers.size() + last.final_barriers.size();
        for (std::size_t index = 0; index < count; ++index) {
            for (int mutation = 0; mutation < 3; ++mutation) {
                const Copy saved = last;
                const std::string where = fmt::format("seed {}, barrier {} of {}", item.seed, index,
                                                      item.compiled.slots()[last.barrier(index).slot].desc.name);
                if (mutation == 0) last.remove(index);
                if (mutation == 1) last.barrier(index).source_stages = 0;
                if (mutation == 2) last.barrier(index).target_stages = 0;
                std::vector<Recording> frames;
                for (const Copy& copy : copies) frames.push_back(copy.recording());
                EXPECT_FALSE(check_frames(item.compiled, frames, item.imports)) << where << ", mutation " << mutation;
                last = saved;
            }
        }
    });
}

TEST(GraphRandom, CheckerMissesNoWrongLayoutOfADescriptor) {
    std::size_t changed = 0;
    for_each_case(100, [&](Case& item) {
        Schedule schedule(item.compiled);
        schedule.derive({}, item.imports, 0);
        Copy copy(schedule.recording());
        for (const Step& step : copy.steps) {
            for (const Read& read : item.compiled.passes()[step.pass].reads) {
                const std::uint32_t slot = schedule.slot_of(read.version, read.instead);
                const bool is_sampled = read.use == Use::SampledCompute || read.use == Use::SampledFragment;
                if (!is_sampled || item.compiled.slots()[slot].kind != Slot::Kind::Import) continue;
                const VkImageLayout right = copy.read_layouts[slot];
                copy.read_layouts[slot] = VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL;
                const Recording recording = copy.recording();
                EXPECT_FALSE(check_frames(item.compiled, {&recording, 1}, item.imports)) << "seed " << item.seed;
                copy.read_layouts[slot] = right;
                ++changed;
            }
        }
    });
    EXPECT_GT(changed, 50u);
}

TEST(GraphRandom, LiveImagesShareNoBytes) {
    bool is_anything_aliased = false;
    for_each_case(graph_count, [&](Case& item) {
        const std::span<const Slot> slots = item.compiled.slots();
        for (std::size_t i = 0; i < slots.size(); ++i) {
            const Slot& a = slots[i];
            if (a.kind != Slot::Kind::Transient || a.desc.is_buffer()) continue;
            EXPECT_EQ(a.offset % 65536, 0u);
            EXPECT_LE(a.offset + a.size, item.compiled.transient_bytes());
            for (std::size_t j = i + 1; j < slots.size(); ++j) {
                const Slot& b = slots[j];
                if (b.kind != Slot::Kind::Transient || b.desc.is_buffer()) continue;
                const bool are_both_alive = a.first_pass <= b.last_pass && b.first_pass <= a.last_pass;
                const bool share_bytes = a.offset < b.offset + b.size && b.offset < a.offset + a.size;
                EXPECT_FALSE(are_both_alive && share_bytes)
                    << "seed " << item.seed << ": " << a.desc.name << ", " << b.desc.name;
            }
        }
        EXPECT_LE(item.compiled.transient_bytes(), item.compiled.transient_bytes_unaliased());
        is_anything_aliased |= item.compiled.transient_bytes() < item.compiled.transient_bytes_unaliased();
    });
    EXPECT_TRUE(is_anything_aliased);
}

TEST(GraphRandom, DeriveAllocatesNothing) {
    for_each_case(100, [&](Case& item) {
        std::mt19937 random(item.seed);
        Schedule schedule(item.compiled);
        for (std::uint64_t frame = 0; frame < 8; ++frame) {
            const auto gates = random_gates(random);
            const std::uint64_t before = darkroom::test::allocation_count();
            schedule.derive(gates, item.imports, frame);
            ASSERT_EQ(darkroom::test::allocation_count(), before) << "seed " << item.seed;
        }
    });
}

TEST(GraphRandom, MovedGraphKeepsItsSchedules) {
    for_each_case(10, [&](Case& item) {
        Schedule schedule(item.compiled);
        schedule.derive({}, item.imports, 0);
        const std::string before = trace(item.compiled, schedule);
        const Compiled moved = std::move(item.compiled);
        Schedule other = std::move(schedule);
        other.derive({}, item.imports, 0);
        EXPECT_EQ(trace(moved, other), before);
    });
}

}  // namespace darkroom::graph::test
