// SPDX-License-Identifier: MIT
// Recording a chain. What it is made of is in chain_make.cpp.
#include "compose/chain/chain.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "compose/chain/camera_jump.hpp"
#include "compose/chain/frame_check.hpp"
#include "core/assert.hpp"
#include "gpu/resource/barriers.hpp"
#include "gpu/resource/formats.hpp"
#include "plan/frame_inputs.hpp"

namespace darkroom::compose {

using plan::FixedImage;
using plan::HostImage;
using plan::PassInput;
using plan::ProgramPass;
using plan::Shape;

namespace {

graph::ImportState state_of(const ImageRef& image) {
    return {.layout = image.layout,
            .stages = image.last_stages,
            .access = image.last_access,
            .final_layout = image.final_layout != VK_IMAGE_LAYOUT_UNDEFINED ? image.final_layout : image.layout,
            .final_stages = image.final_stages,
            .final_access = image.final_access};
}

}  // namespace

Result<> Chain::record(VkCommandBuffer commands, const Frame& frame) {
    DARKROOM_TRY(check_frame(program_of(), desc_.compile, frame));
    find_watched(frame);
    const VkExtent2D extent = frame.color.used_region().extent;
    Camera camera = frame.camera;
    camera.is_cut |= is_jump(frame);
    const PassContext context{.scene_extent = extent,
                              .frame_extent = extent,
                              .output_extent = extent,
                              .time = frame.time,
                              .delta_time = seconds_between_frames(frame.delta_time),
                              .frame_index = frame.frame_index,
                              .camera = &camera,
                              .lights = frame.lights};
    StackProgram& program = *desc_.program;
    Clock& clock = *desc_.clock;
    clock.max_unfinished = std::max(clock.max_unfinished, desc_.slots);
    slot_ = static_cast<std::uint32_t>(recordings_ % desc_.slots);
    view_index_ = frame.view;
    is_abandonable_ = false;
    values_.evaluate(program_of(), desc_.compile, entries_, context, frame.target.used_region().extent, watched_);
    note_watch_states();
    write_frame_block(frame);
    lend_images(frame);
    // Older plans, which have made no recording for so long, may be gone.
    if (recordings_ == desc_.slots) physical_->forget_older();
    physical_->prepare(values_.extents(), !camera.is_cut && context.delta_time > 0, frame.view);
    physical_->histories(frame.view).staged.camera = frame.camera.view;
    schedule_->derive(values_.gates(), import_states_, physical_->frame(frame.view));
    find_histories(frame);
    for (const graph::Schedule::Step& step : schedule_->steps())
        if (declared_pass_[step.pass] != program_of().passes.size())
            prepare_pass(declared_pass_[step.pass], frame, context);

    // Effects have had their say: nothing of what follows fails.
    program.tables->upload(commands, clock.recordings);
    program.lit.upload(commands, clock.recordings);
    if (auto* const staging = program.tables->spent_staging(clock.recordings, clock.max_unfinished))
        worker_.discard(*staging);
    value_copies_.begin(slot_);
    physical_->begin(commands, context_.vk, *schedule_, frame.view);
    const bool is_timed = !timers_.pools.empty();
    if (is_timed) {
        // Which queries are a finished recording's, a device that resets none at once tells when the slot comes round.
        if (!timers_.is_reset && recordings_ >= desc_.slots) static_cast<void>(read_times(slot_));
        timed_[slot_].frame_index = frame.frame_index;
        timed_[slot_].passes.clear();
        timers_.begin(commands, slot_);
        timers_.mark(commands, slot_, 0);
    }
    const std::span<const graph::Barrier> barriers = schedule_->barriers();
    for (const graph::Schedule::Step& step : schedule_->steps()) {
        physical_->record_barriers(commands, context_.vk, barriers.subspan(step.first_barrier, step.barrier_count),
                                   frame.view);
        if (declared_pass_[step.pass] == program_of().passes.size()) {
            record_value_copies(commands, frame);
            continue;
        }
        record_pass(commands, declared_pass_[step.pass]);
        if (is_timed) {
            timed_[slot_].passes.push_back(declared_pass_[step.pass]);
            timers_.mark(commands, slot_, static_cast<std::uint32_t>(timed_[slot_].passes.size()));
        }
    }
    physical_->record_barriers(commands, context_.vk, schedule_->final_barriers(), frame.view);
    leave_unused(commands, frame);
    physical_->end(*schedule_, frame.view);
    ++recordings_;
    ++clock.recordings;
    is_abandonable_ = true;
    return {};
}

bool Chain::abandon() {
    if (!is_abandonable_) return false;
    is_abandonable_ = false;
    --recordings_;
    --desc_.clock->recordings;
    desc_.program->tables->take_back(desc_.clock->recordings);
    desc_.program->lit.take_back(desc_.clock->recordings);
    value_copies_.take_back(slot_);
    if (!timed_.empty()) timed_[slot_].passes.clear();
    physical_->abandon(view_index_);
    return true;
}

const ImageRef& Chain::image_of(const Frame& frame, HostImage which) const {
    static const ImageRef none;
    if (which.kind == HostImage::Kind::Watched) {
        const Watched* const watched = watched_[which.number];
        return watched != nullptr ? watched->target : none;
    }
    if (which.kind != HostImage::Kind::Shadow) return host_image(frame, which);
    const Light* const light = shadow_light(frame.lights, which.number);
    return light != nullptr ? light->cascades : desc_.program->lit.reference;
}

void Chain::write_frame_block(const Frame& frame) {
    std::array<std::uint32_t, plan::frame_words> words;
    // Shaders get time in a float, so it wraps after an hour of the 1/60 s steps that effects think in.
    words[0] = std::bit_cast<std::uint32_t>(static_cast<float>(std::fmod(frame.time, 3600.0)));
    words[1] = std::bit_cast<std::uint32_t>(static_cast<float>(seconds_between_frames(frame.delta_time)));
    words[2] = static_cast<std::uint32_t>(frame.frame_index);
    words[3] = frame.view;
    const plan::CameraBlock camera = plan::camera_block(frame.camera);
    std::memcpy(words.data() + 4, camera.data(), sizeof camera);
    std::memcpy(blocks_.memory.mapped + slot_stride_ * slot_, words.data(), sizeof words);
}

void Chain::lend_images(const Frame& frame) {
    for (std::size_t i = 0; i < program_of().imports.size(); ++i) {
        if (!program_of().imports[i]) continue;
        const ImageRef& image = image_of(frame, *program_of().imports[i]);
        import_states_[i] = state_of(image);
        physical_->bind(static_cast<std::uint32_t>(i), {.handle = image.image,
                                                        .view = image.view,
                                                        .base_mip_level = image.mip_level,
                                                        .base_array_layer = image.array_layer,
                                                        .array_layers = image.layer_count});
    }
}

/// Images that the frame brings and the plan does not know: left as the host asks for, too.
void Chain::leave_unused(VkCommandBuffer commands, const Frame& frame) const {
    const auto is_used = [&](const ImageRef& image) {
        return std::ranges::any_of(program_of().imports,
                                   [&](const auto& which) { return which && overlap(image_of(frame, *which), image); });
    };
    const auto for_all = [&](const auto& visit) {
        for (const plan::FrameInput& input : plan::frame_inputs)
            if (input.given != nullptr) visit(frame.*input.given);
        for (const Light& light : frame.lights) visit(light.cascades);
        for (const Watched& watched : frame.watched) visit(watched.target);
    };
    for_all([&](const ImageRef& image) {
        if (image.image == VK_NULL_HANDLE || is_used(image)) return;
        // Of several that are one image, the first is left for all.
        graph::ImportState state = state_of(image);
        bool is_later = false, is_behind = false;
        for_all([&](const ImageRef& other) {
            is_behind |= &other == &image;
            if (!overlap(other, image)) return;
            is_later |= !is_behind;
            state.stages |= other.last_stages;
            state.access |= other.last_access;
            state.final_stages |= other.final_stages;
            state.final_access |= other.final_access;
        });
        const auto barrier = graph::barrier_of_unused(state);
        if (is_later || !barrier) return;
        const VkImageAspectFlags aspects = barrier->is_depth_alone ? VkImageAspectFlags{VK_IMAGE_ASPECT_DEPTH_BIT}
                                                                   : gpu::format_traits(image.format).aspects;
        const VkImageMemoryBarrier2 one =
            gpu::image_barrier(image.image, {aspects, image.mip_level, 1, image.array_layer, image.layer_count},
                               {barrier->source_stages, barrier->source_access, barrier->old_layout},
                               {barrier->target_stages, barrier->target_access, barrier->new_layout});
        gpu::record_barriers(context_.vk, commands, {&one, 1});
    });
}

void Chain::find_watched(const Frame& frame) {
    std::ranges::fill(watched_, nullptr);
    for (const Watched& watched : frame.watched)
        if (const auto number = watch_with(desc_.compile, watched.id); number && watched.target.is_given())
            watched_[*number] = &watched;
}

void Chain::note_watch_states() {
    for (std::size_t i = 0; i < watched_.size(); ++i) {
        const std::int32_t gate = program_of().watch_gates[i];
        const auto entry = index_of(desc_.compile.watches[i].entry.id);
        watch_states_[i] = gate < 0                                           ? WatchState::NotInPlan
                           : watched_[i] == nullptr                           ? WatchState::NotGiven
                           : !values_.gates()[static_cast<std::size_t>(gate)] ? WatchState::NotWritten
                           : entry && !values_.is_on(*entry)                  ? WatchState::InputShown
                                                                              : WatchState::Shown;
    }
}

WatchState Chain::watch_state(std::uint32_t id) const {
    const auto number = watch_with(desc_.compile, id);
    return number ? watch_states_[*number] : WatchState::NotInPlan;
}

/// Of an image's region, the texels that lie where the part of the frame is that is wanted.
gpu::Region Chain::watched_region(const gpu::Region& whole, const Watched& watched, VkExtent2D extent) const {
    if (watched.region.extent.width == 0) return whole;
    gpu::Region out = whole;
    const auto cut = [](std::int32_t from, std::uint32_t length, std::uint32_t frame, std::uint32_t size,
                        std::int32_t& offset, std::uint32_t& texels) {
        const std::uint64_t first = std::uint64_t{static_cast<std::uint32_t>(from)} * size / frame;
        const std::uint64_t last =
            ((std::uint64_t{static_cast<std::uint32_t>(from)} + length) * size + frame - 1) / frame;
        offset += static_cast<std::int32_t>(first);
        texels = static_cast<std::uint32_t>(last - first);
    };
    const VkRect2D& region = watched.region;
    cut(region.offset.x, region.extent.width, extent.width, whole.extent.width, out.offset.x, out.extent.width);
    cut(region.offset.y, region.extent.height, extent.height, whole.extent.height, out.offset.y, out.extent.height);
    return out;
}

bool Chain::is_jump(const Frame& frame) {
    const graph::HistoryView::State& last = physical_->histories(frame.view).now;
    return last.recordings > 0 && is_camera_jump(last.camera, frame.camera);
}

/// Which entries find something in each history that they read.
void Chain::find_histories(const Frame& frame) {
    std::ranges::fill(has_history_, std::uint8_t{1});
    for (std::uint32_t i = 0; i < program_of().history_entries.size(); ++i) {
        const std::uint32_t entry = program_of().history_entries[i];
        const graph::HistoryImages* const history = physical_->history(i, frame.view);
        if (entry != plan::no_entry && history != nullptr && schedule_->reads_history(i) && !history->is_valid)
            has_history_[entry] = 0;
    }
}

gpu::Binding Chain::bind_slot(std::uint32_t slot, std::uint32_t mip_level, const Frame& frame) const {
    const graph::Slot& image = compiled_->slots()[slot];
    if (image.kind == graph::Slot::Kind::Import) {
        const HostImage which = *program_of().imports[image.import_index];
        const ImageRef& host = image_of(frame, which);
        const VkRect2D region = host.used_region();
        return {.view = host.view,
                .region = {region.offset, region.extent, host.extent},
                .is_nearest = is_nearest_[slot] != 0,
                .is_lent = true,
                .layout = schedule_->read_layout(slot)};
    }
    if (image.kind == graph::Slot::Kind::Constant) {
        const auto& fixed = program_of().fixed_images;
        const auto found = std::ranges::find(fixed, image.import_index, &FixedImage::import_index);
        return desc_.program->tables->binding(static_cast<std::size_t>(found - fixed.begin()));
    }
    const std::uint32_t mip = std::min(mip_level, image.desc.mip_levels - 1);
    return {.view = physical_->mip_view(slot, mip, frame.view),
            .region = {{},
                       graph::mip_extent(image.desc.size.of(values_.extents()), mip),
                       graph::mip_extent(image.extent, mip)},
            .is_nearest = is_nearest_[slot] != 0};
}

gpu::Binding Chain::bind(const PassInput& input, const Frame& frame) const {
    if (input.table != plan::no_table) return desc_.program->tables->binding(input.table);
    return bind_slot(schedule_->slot_of(input.version, input.instead), input.mip_level, frame);
}

/// The values of the members of the pass's own block.
std::span<const std::uint32_t> Chain::write_words(const ProgramPass& pass) {
    std::size_t count = 0;
    const bool is_fused = pass.as<plan::FusedPass>() != nullptr;
    if (pass.finishes_by_frame()) {
        const plan::Conversion& finish = values_.finish();
        words_[count++] = finish.word();
        if (pass.as<plan::FusedPass>()->finish == plan::Finish::OfFrameOrConvert)
            for (const float value : {finish.scale, finish.limit, finish.ootf, finish.target_ootf})
                words_[count++] = std::bit_cast<std::uint32_t>(value);
    }
    for (const plan::FusedStep& step : pass.steps()) {
        const plan::Entry& entry = *entries_[step.entry];
        if (is_fused) {
            words_[count++] = values_.is_on(step.entry) ? 1 : 0;
            words_[count++] = std::bit_cast<std::uint32_t>(values_.opacity(step.entry));
            words_[count++] = static_cast<std::uint32_t>(entry.desc.blend);
            if (step.is_wrapped) {
                const plan::Work& work = values_.work(step.entry);
                words_[count++] = work.word;
                for (const float value : {work.scale, work.limit, work.ootf})
                    words_[count++] = std::bit_cast<std::uint32_t>(value);
            }
        } else if (!step.text->asks_parameters) {
            continue;
        }
        const ParamTable& table = entry.info->parameters;
        const std::uint32_t words = plan::parameter_words(table);
        plan::write_parameters(table, {values_.words(step.entry), table.words()},
                               std::span(words_).subspan(count, words));
        count += words;
    }
    return std::span(words_).first(count);
}

const gpu::Kernel& Chain::kernel_of(std::uint32_t pass, const gpu::Region& output,
                                    std::span<const gpu::Binding> inputs) {
    PassKernels& kernels = *desc_.program->kernels[pass];
    last_shapes_[pass] = plan::shape_of(program_of().passes[pass], entries_, values_, output, inputs);
    if (const gpu::Kernel* const kernel =
            kernels.find(last_shapes_[pass], desc_.clock->recordings, desc_.clock->max_unfinished))
        return *kernel;
    worker_.want(kernels, last_shapes_[pass]);
    return kernels.complete();
}

/// The pass's set of this slot, written anew where a view changed. A host's view is always written: handles are given
/// again, and one that is known may be another image now.
VkDescriptorSet Chain::updated_set(std::uint32_t pass, const gpu::Kernel& kernel, std::span<const gpu::Binding> inputs,
                                   std::span<const gpu::Binding> outputs, std::span<const gpu::Kernel::Block> buffers) {
    const Sets& sets = pass_sets_[pass];
    const VkDescriptorSet set = sets_.sets[sets.first + slot_];
    Written* const written = written_.data() + sets.first_written + std::size_t{slot_} * sets.images;
    bool is_changed = !buffers.empty();  // each view has its own
    const auto note = [&](std::size_t at, const gpu::Binding& binding) {
        const Written now{binding.view, binding.layout, binding.is_nearest};
        is_changed |= binding.is_lent || written[at] != now;
        written[at] = now;
    };
    for (std::size_t i = 0; i < inputs.size(); ++i) note(i, inputs[i]);
    for (std::size_t i = 0; i < outputs.size(); ++i) note(inputs.size() + i, outputs[i]);
    if (!is_changed) return set;
    const VkDeviceSize start = slot_stride_ * slot_;
    kernel.write_set({.set = set,
                      .frame = {blocks_.handle, start, plan::frame_words * 4},
                      .own = {blocks_.handle, start + block_at_[pass], gpu::own_block_size(kernel.spec())},
                      .images = inputs,
                      .outputs = outputs,
                      .buffers = buffers});
    return set;
}

void Chain::fill_custom(const ProgramPass& pass, const PassContext& context, VkExtent2D output) {
    const std::span<PassVector> custom(custom_.data(), pass.spec.custom_vectors);
    PassContext own = context;
    own.output_extent = output;
    const auto fill = [&](ConstantsFunction constants, std::uint32_t entry, std::span<PassVector> out) {
        if (constants == nullptr) return;
        own.frame_extent = program_of().entry_sizes[entry].of(values_.extents());
        own.has_history = has_history_[entry] != 0;
        constants(values_.words(entry), own, out);
    };
    if (const auto* const kernel = pass.of_effect()) fill(kernel->constants, kernel->step.entry, custom);
    if (const auto* const copy = pass.as<plan::CopyPass>(); copy != nullptr && copy->constants != nullptr)
        copy->constants(nullptr, own, custom);
    for (const plan::FusedStep& step : pass.steps())
        fill(step.constants, step.entry, custom.subspan(step.first_vector, step.custom_vectors));
}

void Chain::prepare_pass(std::uint32_t index, const Frame& frame, const PassContext& context) {
    const ProgramPass& pass = program_of().passes[index];
    std::array<gpu::Binding, gpu::max_images> images;
    for (std::size_t i = 0; i < pass.inputs.size(); ++i) images[i] = bind(pass.inputs[i], frame);
    if (const auto watch = pass.watch())
        images[0].region = watched_region(images[0].region, *watched_[*watch], context.frame_extent);
    const std::span<const gpu::Binding> inputs(images.data(), pass.inputs.size());
    Prepared& prepared = prepared_[index];
    prepared.output_count = 0;
    pass.for_each_output([&](graph::Version version, std::uint32_t mip_level) {
        prepared.outputs[prepared.output_count++] = bind_slot(schedule_->slot_of(version), mip_level, frame);
    });
    const std::span<const gpu::Binding> outputs(prepared.outputs.data(), prepared.output_count);
    std::array<gpu::Kernel::Block, gpu::max_buffers> blocks;
    for (std::size_t i = 0; i < pass.buffers.size(); ++i) {
        const auto range = physical_->buffer(schedule_->slot_of(pass.buffers[i].version), frame.view);
        blocks[i] = {range.handle, range.offset, range.size};
    }
    const gpu::Region region = !outputs.empty()  ? outputs[0].region
                               : !inputs.empty() ? inputs[0].region
                                                 : gpu::Region{};
    fill_custom(pass, context, region.extent);
    const std::span<const PassVector> custom(custom_.data(), pass.spec.custom_vectors);
    gpu::write_own_block(
        pass.spec, region, inputs, custom, write_words(pass),
        {blocks_.memory.mapped + slot_stride_ * slot_ + block_at_[index], gpu::own_block_size(pass.spec)}, outputs);
    prepared.extent = region.extent;
    prepared.kernel = &kernel_of(index, region, inputs);
    prepared.set = updated_set(index, *prepared.kernel, inputs, outputs, {blocks.data(), pass.buffers.size()});
}

void Chain::record_pass(VkCommandBuffer commands, std::uint32_t index) {
    const ProgramPass& pass = program_of().passes[index];
    const Prepared& prepared = prepared_[index];
    gpu::begin_label(context_, commands, pass.name.c_str());
    if (const auto* const compute = pass.as<plan::ComputePass>())
        prepared.kernel->record_groups(commands, prepared.set, compute->groups_of(prepared.extent));
    else
        prepared.kernel->record(commands, prepared.set, {prepared.outputs.data(), prepared.output_count});
    gpu::end_label(context_, commands);
}

void Chain::record_value_copies(VkCommandBuffer commands, const Frame& frame) {
    const auto& values = program_of().values;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const auto range = physical_->buffer(schedule_->slot_of(values[i].version), frame.view);
        value_copies_.record(commands, slot_, i, range.handle, range.offset);
    }
    value_copies_.end(commands, slot_, {recordings_ + 1, frame.frame_index, frame.view});
}

ValueReading Chain::value(std::string_view name, std::uint32_t view) const {
    const auto& values = program_of().values;
    const auto found = std::ranges::find(values, name, &plan::Program::NamedValue::name);
    if (found == values.end()) return {};
    return value_copies_.find(static_cast<std::size_t>(found - values.begin()), view);
}

bool Chain::read_times(std::uint32_t slot) {
    const Timed& timed = timed_[slot];
    if (timed.passes.empty() ||
        timers_.read(slot, static_cast<std::uint32_t>(timed.passes.size() + 1), milliseconds_) < timed.passes.size())
        return false;
    times_.clear();
    for (std::size_t i = 0; i < timed.passes.size(); ++i)
        times_.push_back({program_of().passes[timed.passes[i]].name, milliseconds_[i]});
    times_frame_ = timed.frame_index;
    return true;
}

RecordingTimes Chain::times() {
    for (std::uint64_t back = 1; timers_.is_reset && back <= std::min<std::uint64_t>(desc_.slots, recordings_); ++back)
        if (read_times(static_cast<std::uint32_t>((recordings_ - back) % desc_.slots))) break;
    return {times_frame_, times_};
}

}  // namespace darkroom::compose
