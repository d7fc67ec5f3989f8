// SPDX-License-Identifier: MIT
// What a chain is made of, and the kernels made before frames ask for them.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <mutex>
#include <utility>

#include "compose/chain/chain.hpp"
#include "core/thread/parallel.hpp"
#include "gpu/resource/format_use.hpp"
#include "gpu/resource/formats.hpp"

namespace darkroom::compose {

namespace {

VkDeviceSize align(VkDeviceSize size, VkDeviceSize alignment) { return (size + alignment - 1) / alignment * alignment; }

/// Calls `work(i)` for i in [0, count) on several threads; the first error wins.
template <class Work>
Result<> for_all(std::size_t count, std::size_t max_threads, const Work& work) {
    std::mutex lock;
    Result<> first{};
    parallel_for(count, max_threads, [&](std::size_t i) {
        auto ok = work(i);
        const std::scoped_lock guard(lock);
        if (!ok && first) first = failure(std::move(ok));
    });
    return first;
}

std::vector<const plan::Entry*> pointers_to(std::span<const plan::Entry> entries) {
    std::vector<const plan::Entry*> out;
    for (const plan::Entry& entry : entries) out.push_back(&entry);
    return out;
}

}  // namespace

Chain::Chain(gpu::Context& context, Worker& worker, ChainDesc desc)
    : context_(context), worker_(worker), desc_(std::move(desc)) {
    for (const auto& entry : desc_.entries) entries_.push_back(entry.get());
}

Result<std::unique_ptr<Chain>> Chain::create(gpu::Context& context, Worker& worker, graph::HistoryPool& histories,
                                             ChainDesc desc, std::span<const plan::Entry> values) {
    std::unique_ptr<Chain> chain(new Chain(context, worker, std::move(desc)));
    const plan::Program& program = chain->program_of();
    DARKROOM_TRY_VALUE(auto compiled,
                       program.graph.compile(plan::largest_extents(chain->desc_.compile), graph::measure_on(context)));
    chain->compiled_.emplace(std::move(compiled));
    chain->schedule_.emplace(*chain->compiled_);
    DARKROOM_TRY(chain->desc_.program->make_tables(context, chain->desc_.older.get()));
    DARKROOM_TRY(chain->make_kernels(values));
    DARKROOM_TRY(chain->make_resources(histories));
    chain->desc_.older.reset();
    chain->plan_ = plan::describe_program(program, *chain->compiled_, chain->desc_.compile, pointers_to(values));
    return chain;
}

const Plan& Chain::plan() {
    if (recordings_ == 0) return plan_;
    const plan::Program& program = program_of();
    std::vector<std::uint32_t> now(values_.gates().begin(), values_.gates().end());
    for (std::uint32_t i = 0; i < entries_.size(); ++i) {
        now.push_back(values_.is_on(i) ? 1 : 0);
        now.push_back(values_.lacks_perspective(*entries_[i]->info) ? 1 : 0);
        now.push_back(std::bit_cast<std::uint32_t>(values_.opacity(i)));
        now.insert(now.end(), values_.words(i), values_.words(i) + entries_[i]->base.size());
    }
    if (now != described_) {
        plan_ = plan::describe_frame(program, *compiled_, desc_.compile, entries_, values_);
        described_ = std::move(now);
    }
    return plan_;
}

Result<> Chain::make_kernels(std::span<const plan::Entry> values) {
    const plan::Program& program = program_of();
    const std::vector<const plan::Entry*> entries = pointers_to(values);
    declared_pass_.assign(compiled_->passes().size(), static_cast<std::uint32_t>(program.passes.size()));
    std::vector<std::uint32_t> kept;
    for (std::uint32_t i = 0; i < program.passes.size(); ++i) {
        const std::uint32_t pass = compiled_->kept_pass_of({i});
        if (pass == ~0u) continue;
        declared_pass_[pass] = i;
        kept.push_back(i);
    }
    values_ = plan::FrameValues(program, entries);
    import_states_.resize(program.imports.size());
    last_shapes_ = expected_shapes(entries);

    // The complete kernel and the one of the expected shape, for every pass, unless this program has them.
    std::vector<std::pair<std::uint32_t, bool>> missing;
    for (const std::uint32_t i : kept) {
        const PassKernels& kernels = *desc_.program->kernels[i];
        if (!kernels.has_complete()) missing.emplace_back(i, true);
        if (!kernels.was_built(last_shapes_[i])) missing.emplace_back(i, false);
    }
    return for_all(missing.size(), desc_.max_threads, [&](std::size_t i) -> Result<> {
        const auto [pass, is_complete] = missing[i];
        PassKernels& kernels = *desc_.program->kernels[pass];
        return is_complete ? kernels.build_complete(*context_.kernels) : kernels.build(context_, last_shapes_[pass]);
    });
}

std::vector<plan::Shape> Chain::expected_shapes(std::span<const plan::Entry* const> entries) const {
    const plan::Program& program = program_of();
    const VkExtent2D extent = desc_.compile.max_extent;
    const Camera camera = plan::example_camera();
    plan::FrameValues values(program, entries);
    // Twice, for entries that read what a later one made in the frame before.
    for (int frame = 0; frame < 2; ++frame)
        values.evaluate(program, desc_.compile, entries,
                        {.scene_extent = extent, .frame_extent = extent, .output_extent = extent, .camera = &camera},
                        desc_.compile.target_extent);
    graph::Schedule schedule(*compiled_);
    schedule.derive(values.gates(), import_states_, 0);
    std::vector<plan::Shape> out(program.passes.size());
    for (std::uint32_t i = 0; i < out.size(); ++i)
        if (compiled_->kept_pass_of({i}) != ~0u)
            out[i] = plan::expected_shape(program, *compiled_, schedule, values, entries, program.passes[i],
                                          plan::largest_extents(desc_.compile));
    return out;
}

Result<> Chain::build_lean() {
    const std::vector<plan::Shape> expected = expected_shapes(entries_);
    for (std::size_t i = 0; i < program_of().passes.size(); ++i) {
        if (pass_sets_[i].first == ~0u) continue;
        PassKernels& kernels = *desc_.program->kernels[i];
        for (const plan::Shape& shape : {expected[i], last_shapes_[i]}) {
            const auto is_there = [&] {
                return kernels.find(shape, desc_.clock->recordings, desc_.clock->max_unfinished) != nullptr;
            };
            if (is_there()) continue;
            DARKROOM_TRY(kernels.build(context_, shape));
            static_cast<void>(is_there());
        }
    }
    return {};
}

Result<> Chain::make_resources(graph::HistoryPool& histories) {
    DARKROOM_TRY_VALUE(auto physical, graph::Physical::create(context_, *compiled_, desc_.compile.views, histories));
    physical_.emplace(std::move(physical));
    prepared_.resize(program_of().passes.size());
    has_history_.resize(entries_.size());
    watched_.resize(desc_.compile.watches.size());
    watch_states_.resize(watched_.size());
    // Depth is never filtered: between two surfaces there is none.
    for (const graph::Slot& slot : compiled_->slots())
        is_nearest_.push_back(!gpu::can_filter(context_, slot.desc.format) || gpu::is_depth(slot.desc.format) ? 1 : 0);

    const std::size_t max_bytes = context_.traits.max_uniform_range;
    std::size_t max_words = 0;
    VkDeviceSize at = align(plan::frame_words * 4, context_.traits.uniform_alignment);
    for (const plan::ProgramPass& pass : program_of().passes) {
        const std::size_t size = gpu::own_block_size(pass.spec);
        if (size > max_bytes)
            return user_error(
                fmt::format("pass '{}': {} bytes of parameters; at most {} are allowed", pass.name, size, max_bytes));
        block_at_.push_back(at);
        at += align(size, context_.traits.uniform_alignment);
        max_words = std::max<std::size_t>(max_words, gpu::word_count(pass.spec.members));
    }
    slot_stride_ = at;
    words_.resize(max_words + 1);
    custom_.resize(plan::max_custom_vectors);
    DARKROOM_TRY_VALUE(blocks_, gpu::Buffer::create(context_, slot_stride_ * desc_.slots, gpu::block_usage,
                                                    gpu::Memory::Kind::Constants, "blocks"));
    DARKROOM_TRY_VALUE(value_copies_, ValueCopies::create(context_, program_of().values, desc_.slots));
    DARKROOM_TRY(make_sets());
    return make_timers();
}

Result<> Chain::make_sets() {
    std::vector<VkDescriptorSetLayout> layouts;
    pass_sets_.resize(program_of().passes.size());
    std::uint32_t written = 0;
    for (const std::uint32_t i : declared_pass_) {
        if (i == program_of().passes.size()) continue;
        const plan::ProgramPass& pass = program_of().passes[i];
        Sets& sets = pass_sets_[i];
        sets = {.first = static_cast<std::uint32_t>(layouts.size()),
                .first_written = written,
                .images = static_cast<std::uint32_t>(pass.inputs.size() + pass.spec.outputs.size())};
        written += sets.images * desc_.slots;
        layouts.insert(layouts.end(), desc_.slots, desc_.program->kernels[i]->complete().set_layout());
    }
    written_.resize(written);
    DARKROOM_TRY_VALUE(sets_, gpu::DescriptorSets::create(context_, layouts));
    return {};
}

Result<> Chain::make_timers() {
    if (!desc_.has_timers || context_.traits.timestamp_period_ns <= 0) return {};
    const auto marks = static_cast<std::uint32_t>(program_of().passes.size() + 1);
    DARKROOM_TRY_VALUE(timers_, gpu::Timers::create(context_, desc_.slots, marks));
    timed_.resize(desc_.slots);
    for (Timed& timed : timed_) timed.passes.reserve(marks);
    milliseconds_.resize(marks);
    times_.reserve(marks);
    return {};
}

std::optional<std::uint32_t> Chain::index_of(std::uint32_t entry_id) const {
    const auto found = std::ranges::find(entries_, entry_id, &plan::Entry::id);
    if (found == entries_.end()) return std::nullopt;
    return static_cast<std::uint32_t>(found - entries_.begin());
}

}  // namespace darkroom::compose
