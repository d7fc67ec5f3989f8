// SPDX-License-Identifier: MIT
// What is on in a frame, the shape of each pass that follows from it, and the kernels made for shapes before frames
// ask.

#include <algorithm>
#include <atomic>
#include <mutex>
#include <thread>

#include "compose/chain.hpp"

namespace darkroom::compose {

namespace {

/// Runs `work(i)` for i in [0, count) on a few threads; the first error wins.
template <class Work>
Result<> for_all(std::size_t count, const Work& work) {
    std::atomic<std::size_t> next{0};
    std::mutex lock;
    Result<> first{};
    const auto run = [&] {
        for (std::size_t i = next++; i < count; i = next++) {
            if (auto ok = work(i); !ok) {
                const std::scoped_lock guard(lock);
                if (first) first = failure(std::move(ok));
            }
        }
    };
    std::vector<std::thread> threads;
    const std::size_t helpers = std::min<std::size_t>(count, std::max(1u, std::thread::hardware_concurrency()));
    for (std::size_t i = 1; i < helpers; ++i) threads.emplace_back(run);
    run();
    for (std::thread& thread : threads) thread.join();
    return first;
}

bool is_whole(const gpu::Region& region) {
    return region.offset.x == 0 && region.offset.y == 0 && region.extent.width == region.image.width &&
           region.extent.height == region.image.height;
}

}  // namespace

Result<> Chain::make_kernels(std::span<const Entry> stack) {
    declared_pass_.assign(compiled_->passes().size(), 0);
    std::vector<std::uint32_t> kept;
    for (std::uint32_t i = 0; i < program_.passes.size(); ++i) {
        variants_.push_back(nullptr);
        const std::uint32_t pass = compiled_->kept_pass_of({i});
        if (pass == ~0u) continue;
        declared_pass_[pass] = i;
        kept.push_back(i);
        variants_[i] = std::make_unique<Variants>(program_.passes[i]);
    }

    gates_ = Gates(program_, stack);
    evaluate(stack, {.frame_extent = desc_.max_extent, .output_extent = desc_.max_extent});
    import_states_.resize(program_.imports.size());
    schedule_->derive(gates_.toggles(), import_states_, 0);
    last_shapes_.resize(program_.passes.size());
    for (const std::uint32_t i : kept) last_shapes_[i] = expected_shape(program_.passes[i], stack);

    // The complete kernel and the one of the expected shape, for every pass.
    return for_all(kept.size() * 2, [&](std::size_t i) -> Result<> {
        Variants& variants = *variants_[kept[i / 2]];
        if (i % 2 == 0) return variants.build_complete(context_);
        return variants.build(context_, last_shapes_[kept[i / 2]]);
    });
}

void Chain::evaluate(std::span<const Entry> stack, const PassContext& context) {
    gates_.evaluate(program_, stack, context);
    finish_ = finish_of(gates_.domain_behind(program_.last_entry), desc_);
}

Shape Chain::shape_of(const ProgramPass& pass, std::span<const Entry> stack, const gpu::Region& output,
                      std::span<const gpu::Binding> inputs) const {
    Shape shape;
    if (pass.steps.size() > max_lean_steps) return shape;
    if (is_whole(output) && std::ranges::all_of(inputs, [](const gpu::Binding& b) { return is_whole(b.region); }))
        shape.steps |= Shape::is_whole;
    if (!inputs.empty() && inputs[0].region.extent.width == 2 * output.extent.width &&
        inputs[0].region.extent.height == 2 * output.extent.height)
        shape.steps |= Shape::input_is_twice;
    if (pass.finish == Finish::OfFrame) shape.steps |= static_cast<std::uint64_t>(finish_) << Shape::finish_bit;
    for (std::size_t i = 0; i < pass.steps.size(); ++i) {
        const std::uint32_t entry = pass.steps[i].entry;
        if (gates_.is_on(entry))
            shape.steps |= (stack[entry].is_plain() ? std::uint64_t{1} : std::uint64_t{3}) << (2 * i);
    }
    for_each_choice(pass, [&](std::size_t step, const ParamInfo& row, std::uint32_t bit, std::uint32_t bits) {
        const std::uint32_t entry = is_fused(pass) ? pass.steps[step].entry : pass.entry;
        if (gates_.is_on(entry))
            shape.choices |= std::uint64_t{gates_.words_of(entry)[row.word] & ((1u << bits) - 1)} << bit;
    });
    return shape;
}

/// The shape that a frame of the largest extent will have, in whole images: what most frames are.
Shape Chain::expected_shape(const ProgramPass& pass, std::span<const Entry> stack) const {
    const auto region = [&](std::uint32_t slot, std::uint32_t mip_level) {
        // A pass that is off has no slot: any region does.
        if (slot >= compiled_->slots().size()) return gpu::Region{{}, desc_.max_extent, desc_.max_extent};
        const graph::ImageDesc& desc = compiled_->slots()[slot].desc;
        const VkExtent2D extent =
            graph::mip_extent(desc.size.of(desc_.max_extent), std::min(mip_level, desc.mip_levels - 1));
        return gpu::Region{{}, extent, extent};
    };
    std::array<gpu::Binding, gpu::most_images> inputs;
    for (std::size_t i = 0; i < pass.inputs.size(); ++i) {
        const PassInput& input = pass.inputs[i];
        inputs[i] = input.table != no_table
                        ? tables_.binding(input.table)
                        : gpu::Binding{.region = region(schedule_->slot_of(input.version), input.mip_level)};
    }
    return shape_of(pass, stack, region(schedule_->slot_of(pass.output), pass.output_mip_level),
                    {inputs.data(), pass.inputs.size()});
}

Result<> Chain::build_lean(std::span<const Entry> stack) {
    evaluate(stack, {.frame_extent = desc_.max_extent, .output_extent = desc_.max_extent});
    schedule_->derive(gates_.toggles(), import_states_, 0);
    for (std::size_t i = 0; i < program_.passes.size(); ++i) {
        if (!variants_[i]) continue;
        if (auto ok = variants_[i]->build(context_, expected_shape(program_.passes[i], stack)); !ok) return ok;
        if (auto ok = variants_[i]->build(context_, last_shapes_[i]); !ok) return ok;
    }
    return {};
}

}  // namespace darkroom::compose
