// SPDX-License-Identifier: MIT
#include "compose/chain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "compose/frame_check.hpp"
#include "core/assert.hpp"
#include "gpu/format_use.hpp"
#include "gpu/formats.hpp"

namespace darkroom::compose {

namespace {

using gpu::most_images;
constexpr std::uint32_t most_custom_vectors = 96;

VkDeviceSize align(VkDeviceSize size, VkDeviceSize alignment) { return (size + alignment - 1) / alignment * alignment; }

}  // namespace

Chain::Chain(gpu::Context& context, Program program, const CompileDesc& desc, std::uint32_t slots)
    : context_(context), program_(std::move(program)), desc_(desc), slots_(slots) {}

Chain::~Chain() = default;

Result<std::unique_ptr<Chain>> Chain::create(gpu::Context& context, Program program, const CompileDesc& desc,
                                             std::uint32_t slots, bool has_timers, std::span<const Entry> stack) {
    std::unique_ptr<Chain> chain(new Chain(context, std::move(program), desc, slots));
    auto compiled = chain->program_.graph.compile(desc.max_extent, graph::measure_on(context));
    if (!compiled) return failure(std::move(compiled));
    chain->compiled_.emplace(std::move(*compiled));
    chain->schedule_.emplace(*chain->compiled_);
    // Depth is never filtered: what lies between two surfaces is no surface.
    for (const graph::Slot& slot : chain->compiled_->slots())
        chain->is_nearest_.push_back(!gpu::can_filter(context, slot.desc.format) || gpu::is_depth(slot.desc.format));
    auto tables = Tables::create(context, chain->program_.constants);
    if (!tables) return failure(std::move(tables));
    chain->tables_ = std::move(*tables);
    if (std::ranges::any_of(chain->program_.imports, [](const auto& i) { return i && shadow_number(*i) >= 0; })) {
        auto lit = LitShadowMap::create(context);
        if (!lit) return failure(std::move(lit));
        chain->lit_ = std::move(*lit);
    }
    if (auto ok = chain->make_kernels(stack); !ok) return failure(std::move(ok));
    if (auto ok = chain->make_resources(has_timers); !ok) return failure(std::move(ok));
    chain->builders_ = std::make_unique<Builders>(context, chain->variants_);
    return chain;
}

Result<> Chain::make_resources(bool has_timers) {
    auto physical = graph::Physical::create(context_, *compiled_, desc_.views);
    if (!physical) return failure(std::move(physical));
    physical_.emplace(std::move(*physical));
    views_.resize(desc_.views);
    for (View& view : views_) view.was_on.resize(program_.history_entries.size());

    std::vector<VkDescriptorSetLayout> layouts;
    set_at_.assign(program_.passes.size(), 0);
    std::size_t pass_block_size = 16;
    for (std::size_t i = 0; i < program_.passes.size(); ++i) {
        if (!variants_[i]) continue;
        const gpu::KernelSpec& spec = program_.passes[i].spec;
        if (spec.images.size() > most_images || spec.custom_vectors > most_custom_vectors)
            return user_error(fmt::format("pass '{}': {} images and {} custom vectors; at most {} and {} are allowed",
                                          spec.name, spec.images.size(), spec.custom_vectors, most_images,
                                          most_custom_vectors));
        set_at_[i] = static_cast<std::uint32_t>(layouts.size());
        layouts.insert(layouts.end(), slots_, variants_[i]->complete().set_layout());
        pass_block_size = std::max(pass_block_size, gpu::pass_block_size(spec));
    }
    auto sets = gpu::DescriptorSets::create(context_, layouts);
    if (!sets) return failure(std::move(sets));
    sets_ = std::move(*sets);
    custom_.resize(most_custom_vectors);

    // What every device binds as one uniform buffer.
    constexpr std::uint32_t most_constants = 16384;
    if (program_.constants_words * 4 > most_constants)
        return user_error(fmt::format("the stack has {} bytes of parameters; at most {} are allowed",
                                      program_.constants_words * 4, most_constants));
    constants_stride_ = align(program_.constants_words * 4, context_.traits.uniform_alignment);
    pass_block_stride_ = align(pass_block_size, context_.traits.uniform_alignment);
    auto constants = gpu::Buffer::create(context_, constants_stride_ * slots_, gpu::constants_usage,
                                         gpu::Memory::Kind::Constants, "constants");
    if (!constants) return failure(std::move(constants));
    constants_ = std::move(*constants);
    auto blocks =
        gpu::Buffer::create(context_, pass_block_stride_ * slots_ * std::max<std::size_t>(1, program_.passes.size()),
                            VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, gpu::Memory::Kind::Constants, "pass blocks");
    if (!blocks) return failure(std::move(blocks));
    pass_blocks_ = std::move(*blocks);

    if (has_timers && context_.traits.timestamp_period_ns > 0) {
        const auto marks = static_cast<std::uint32_t>(program_.passes.size() + 1);
        auto timers = gpu::Timers::create(context_, slots_, marks);
        if (!timers) return failure(std::move(timers));
        timers_ = std::move(*timers);
        timed_passes_.resize(slots_);
        for (auto& passes : timed_passes_) passes.reserve(marks);
        milliseconds_.resize(marks);
        times_.reserve(marks);
    }
    return {};
}

Result<> Chain::record(VkCommandBuffer commands, const Frame& frame, std::span<const Entry> stack) {
    if (auto ok = check_frame(program_, desc_, frame); !ok) return ok;
    const VkExtent2D extent = frame.color.used_region().extent;
    const PassContext context{.frame_extent = extent,
                              .output_extent = extent,
                              .time = frame.time,
                              .delta_time = frame.delta_time,
                              .frame_index = frame.frame_index,
                              .camera = &frame.camera,
                              .lights = frame.lights};
    slot_ = static_cast<std::uint32_t>(recordings_ % slots_);
    tables_.upload(commands);
    lit_.upload(commands);
    evaluate(stack, context);

    auto* const block = reinterpret_cast<std::uint32_t*>(constants_.memory.mapped + constants_stride_ * slot_);
    // Shaders get time in a float, so it wraps after an hour of the 1/60 s steps that effects think in.
    const float time = static_cast<float>(std::fmod(frame.time, 3600.0));
    const float delta = static_cast<float>(frame.delta_time);
    const std::array<std::uint32_t, 4> frame_block{std::bit_cast<std::uint32_t>(time),
                                                   std::bit_cast<std::uint32_t>(delta),
                                                   static_cast<std::uint32_t>(frame.frame_index), frame.view};
    std::copy(frame_block.begin(), frame_block.end(), block);
    const CameraBlock camera = camera_block(frame.camera);
    std::memcpy(block + frame_block.size(), camera.data(), sizeof camera);
    for (std::size_t i = 0; i < stack.size(); ++i) {
        const ParamTable& table = stack[i].info->parameters;
        const std::span<std::uint32_t> words(block + program_.block_words[i], block_words(table));
        words[0] = gates_.is_on(static_cast<std::uint32_t>(i)) ? 1 : 0;
        words[1] = std::bit_cast<std::uint32_t>(stack[i].desc.opacity);
        words[2] = static_cast<std::uint32_t>(stack[i].desc.blend);
        write_block(table, {gates_.words_of(static_cast<std::uint32_t>(i)), table.words()}, words);
    }
    block[program_.finish_word] = static_cast<std::uint32_t>(finish_);

    for (std::size_t i = 0; i < program_.imports.size(); ++i) {
        if (!program_.imports[i]) continue;
        const ImageRef& image = image_of(frame, *program_.imports[i]);
        import_states_[i] = {.layout = image.layout,
                             .stages = image.last_stages,
                             .access = image.last_access,
                             .final_layout = image.final_layout,
                             .final_stages = image.final_stages,
                             .final_access = image.final_access};
        physical_->bind(static_cast<std::uint32_t>(i), {.handle = image.image,
                                                        .view = image.view,
                                                        .base_mip_level = image.mip_level,
                                                        .base_array_layer = image.array_layer,
                                                        .array_layers = image.layer_count});
    }
    reset_histories(frame);
    physical_->begin(commands, context_.vk, extent, frame.view);
    schedule_->derive(gates_.toggles(), import_states_,
                      physical_->histories(frame.view).recordings);

    const bool is_timed = timers_.pool != VK_NULL_HANDLE;
    if (is_timed) {
        timed_passes_[slot_].clear();
        timers_.begin(commands, slot_);
        timers_.mark(commands, slot_, 0);
    }
    const std::span<const graph::Barrier> barriers = schedule_->barriers();
    for (const graph::Schedule::Step& step : schedule_->steps()) {
        physical_->record_barriers(commands, context_.vk, barriers.subspan(step.first_barrier, step.barrier_count),
                                   frame.view);
        record_pass(commands, declared_pass_[step.pass], frame, context, stack);
        if (is_timed) {
            timed_passes_[slot_].push_back(declared_pass_[step.pass]);
            timers_.mark(commands, slot_, static_cast<std::uint32_t>(timed_passes_[slot_].size()));
        }
    }
    physical_->record_barriers(commands, context_.vk, schedule_->final_barriers(), frame.view);
    physical_->end(frame.view);
    ++recordings_;
    return {};
}

const ImageRef& Chain::image_of(const Frame& frame, HostImage which) const {
    if (shadow_number(which) < 0) return host_image(frame, which);
    const Light* const light = shadow_light(frame.lights, static_cast<std::uint32_t>(shadow_number(which)));
    return light != nullptr ? light->cascades : lit_.reference;
}

/// Histories start from zero where nothing of the last frame of the view can be used.
void Chain::reset_histories(const Frame& frame) {
    View& view = views_[frame.view];
    bool is_related = !frame.camera.is_cut && frame.delta_time > 0;
    for (std::size_t i = 0; i < program_.history_entries.size(); ++i) {
        const bool is_on = gates_.is_on(program_.history_entries[i]);
        if (is_on && !view.was_on[i]) is_related = false;
        view.was_on[i] = is_on ? 1 : 0;
    }
    for (std::uint32_t i = 0; i < physical_->history_count() && !is_related; ++i) {
        if (graph::HistoryImages* const history = physical_->history(i, frame.view)) history->state.needs_reset = true;
    }
}

gpu::Binding Chain::bind_slot(std::uint32_t slot, std::uint32_t mip_level, const Frame& frame,
                              VkExtent2D extent) const {
    const graph::Slot& image = compiled_->slots()[slot];
    if (image.kind == graph::Slot::Kind::Import) {
        const HostImage which = *program_.imports[image.import_index];
        const ImageRef& host = image_of(frame, which);
        const VkRect2D region = host.used_region();
        if (shadow_number(which) >= 0)
            return {.view = host.view,
                    .region = {region.offset, region.extent, host.extent},
                    .sampler = context_.shadow_sampler,
                    .layout = schedule_->read_layout(slot)};
        return {.view = host.view,
                .region = {region.offset, region.extent, host.extent},
                .is_nearest = is_nearest_[slot],
                .layout = schedule_->read_layout(slot)};
    }
    if (image.kind == graph::Slot::Kind::Constant) {
        const auto constant = std::find_if(program_.constants.begin(), program_.constants.end(),
                                           [&](const Constant& c) { return c.import_index == image.import_index; });
        return tables_.binding(static_cast<std::size_t>(constant - program_.constants.begin()));
    }
    const std::uint32_t mip = std::min(mip_level, image.desc.mip_levels - 1);
    return {.view = physical_->mip_view(slot, mip, frame.view),
            .region = {{},
                       graph::mip_extent(image.desc.size.of(extent), mip),
                       graph::mip_extent(image.desc.size.of(desc_.max_extent), mip)},
            .is_nearest = is_nearest_[slot]};
}

gpu::Binding Chain::bind(const PassInput& input, const Frame& frame, VkExtent2D extent) const {
    if (input.table != no_table) return tables_.binding(input.table);
    return bind_slot(schedule_->slot_of(input.version), input.mip_level, frame, extent);
}

void Chain::record_pass(VkCommandBuffer commands, std::uint32_t index, const Frame& frame, const PassContext& context,
                        std::span<const Entry> stack) {
    const ProgramPass& pass = program_.passes[index];
    std::array<gpu::Binding, most_images> images;
    for (std::size_t i = 0; i < pass.inputs.size(); ++i) {
        images[i] = bind(pass.inputs[i], frame, context.frame_extent);
        if (!pass.spec.images[i].loads_by.empty()) images[i].layout = VK_IMAGE_LAYOUT_GENERAL;
    }
    const gpu::Binding output =
        bind_slot(schedule_->slot_of(pass.output), pass.output_mip_level, frame, context.frame_extent);

    const std::span<PassVector> custom(custom_.data(), pass.spec.custom_vectors);
    if (pass.constants != nullptr) {
        PassContext own = context;
        own.frame_extent = program_.entry_sizes[pass.entry].of(context.frame_extent);
        own.output_extent = output.region.extent;
        pass.constants(gates_.words_of(pass.entry), own, custom);
    }
    const VkDeviceSize block_offset = pass_block_stride_ * (slot_ * program_.passes.size() + index);
    const std::span<const gpu::Binding> inputs(images.data(), pass.inputs.size());
    gpu::write_pass_block(pass.spec, output.region, inputs, custom,
                          {pass_blocks_.memory.mapped + block_offset, gpu::pass_block_size(pass.spec)});

    last_shapes_[index] = shape_of(pass, stack, output.region, inputs);
    const gpu::Kernel& kernel = variants_[index]->find(last_shapes_[index]);
    if (variants_[index]->has_lean() && &kernel == &variants_[index]->complete()) builders_->wake();
    gpu::begin_label(context_, commands, pass.name.c_str());
    kernel.record(commands, {.set = sets_.sets[set_at_[index] + slot_],
                             .constants = constants_.handle,
                             .constants_offset = constants_stride_ * slot_,
                             .constants_size = program_.constants_words * 4,
                             .pass_block = pass_blocks_.handle,
                             .pass_block_offset = block_offset,
                             .images = inputs,
                             .outputs = {&output, 1}});
    gpu::end_label(context_, commands);
}

std::span<const PassTime> Chain::times() {
    if (timers_.pool == VK_NULL_HANDLE || recordings_ == 0) return {};
    for (std::uint64_t back = 1; back <= std::min<std::uint64_t>(slots_, recordings_); ++back) {
        const auto slot = static_cast<std::uint32_t>((recordings_ - back) % slots_);
        const auto& passes = timed_passes_[slot];
        if (timers_.read(slot, static_cast<std::uint32_t>(passes.size() + 1), milliseconds_) < passes.size()) continue;
        times_.clear();
        for (std::size_t i = 0; i < passes.size(); ++i)
            times_.push_back({program_.passes[passes[i]].name, milliseconds_[i]});
        return times_;
    }
    return {};
}

Plan Chain::describe(std::span<const Entry> stack) const {
    return describe_program(program_, *compiled_, desc_, stack);
}

}  // namespace darkroom::compose
