// SPDX-License-Identifier: MIT
// Compiling a stack, now or later, and recording it.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>

#include "compose/chain/frame_check.hpp"
#include "compose/composer_state.hpp"
#include "core/caught.hpp"
#include "gpu/device/assumed_device.hpp"

namespace darkroom {

namespace {

/// Errors, plans and looks call an entry by its name.
Result<> check_names(std::span<const plan::Entry> stack) {
    for (std::size_t i = 0; i < stack.size(); ++i) {
        const std::string& name = stack[i].desc.name;
        if (name.empty()) return user_error(fmt::format("stack entry {}: its name is empty", i + 1));
        const auto control = std::ranges::find_if(
            name, [](char c) { return static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) == 0x7f; });
        if (control != name.end())
            return user_error(
                fmt::format("stack entry {}: its name holds the control character {:#04x} at place {}; "
                            "allowed is text",
                            i + 1, static_cast<unsigned>(*control), control - name.begin()));
        for (std::size_t other = 0; other < i; ++other)
            if (stack[other].desc.name == name)
                return user_error(
                    fmt::format("stack entries {} and {}: both are named '{}'; allowed is a name of "
                                "their own for each",
                                other + 1, i + 1, name));
    }
    return {};
}

Result<> check_resources(const plan::Entry& entry) {
    for (const ParamInfo& row : entry.info->parameters.rows) {
        const Resource resource{entry.base[row.word]};
        if (row.kind == Kind::Resource && resource.id != 0 && !entry.resources->contains(resource.id))
            return user_error(
                fmt::format("{}.{} = resource {}: the composer has none of this number; it may have been "
                            "forgotten",
                            entry.desc.name, row.name, resource.id));
    }
    return {};
}

Result<> check_target_extent(VkExtent2D extent, std::uint32_t limit) {
    if (extent.width <= limit && extent.height <= limit && (extent.width == 0) == (extent.height == 0)) return {};
    return user_error(fmt::format("target_extent {}x{}: this device allows 1x1 to {}x{}, and 0x0 for the picture's",
                                  extent.width, extent.height, limit, limit));
}

/// For parallel_for(): as many as processors by default, and at least the one that asks.
std::uint32_t threads_of(const ComposerDesc& desc) {
    return desc.max_threads == ComposerDesc{}.max_threads ? 0 : desc.max_threads + 1;
}

}  // namespace

Composer::State::State(std::shared_ptr<gpu::Context> device_context, const ComposerDesc& composer_desc)
    : context(std::move(device_context)), desc(composer_desc) {
    desc.frames_in_flight = std::max(1u, desc.frames_in_flight);
    worker = std::make_unique<compose::Worker>(*context,
                                               desc.max_threads > 0 && !context->is_assumed && !context->compiles_only);
}

Result<> Composer::State::check_device() const {
    if (context->compiles_only)
        return user_error(
            "compile: the composer is on a device that compiles kernels only, for statistics; allowed is a device that "
            "was created without compiles_only, or adopted");
    if (!context->is_assumed) return {};
    return user_error(
        "compile: the composer is on an assumed device, for which stacks are planned; allowed is a device that was "
        "created or adopted");
}

Result<Composer::State::Snapshot> Composer::State::snapshot(const CompileDesc& compile_desc) const {
    const std::uint32_t limit = context->traits.max_image_dimension;
    const auto [width, height] = compile_desc.max_extent;
    if (width == 0 || height == 0 || width > limit || height > limit)
        return user_error(fmt::format("size {}x{}: this device allows 1x1 to {}x{}", width, height, limit, limit));
    DARKROOM_TRY(check_target_extent(compile_desc.target_extent, limit));
    DARKROOM_TRY(compose::check_images(*context, compile_desc));
    if (compile_desc.views == 0) return user_error("views = 0: allowed is 1 and more");
    Snapshot out{.desc = compile_desc};
    for (const auto& entry : stack) {
        DARKROOM_TRY(check_values(*entry, entry->base));
        out.values.push_back(*entry);
        out.values.back().resources = resources;
        DARKROOM_TRY(check_resources(out.values.back()));
        DARKROOM_TRY(check_mixing(entry->desc));
        const OutputScale& scale = entry->desc.scale;
        if (scale.numerator == 0 || scale.denominator == 0)
            return user_error(fmt::format("stack entry '{}': scale {}/{}: allowed are numbers above 0",
                                          entry->desc.name, scale.numerator, scale.denominator));
        out.entries.push_back(entry);
    }
    DARKROOM_TRY(check_names(out.values));
    return out;
}

Result<std::unique_ptr<compose::Chain>> Composer::State::make_chain(Snapshot snapshot) {
    // One that cannot be made leaves what the next is to share.
    std::shared_ptr<compose::StackProgram> own = program;
    if (!own || !own->serves(snapshot.values, snapshot.desc)) {
        DARKROOM_TRY_VALUE(own, compose::plan_stack(*context, snapshot.values, snapshot.desc));
    }
    auto made = compose::Chain::create(*context, *worker, histories,
                                       {.program = own,
                                        .older = program,
                                        .clock = &clock,
                                        .compile = snapshot.desc,
                                        .slots = desc.frames_in_flight * snapshot.desc.views,
                                        .max_threads = threads_of(desc),
                                        .has_timers = desc.has_timers,
                                        .entries = std::move(snapshot.entries)},
                                       snapshot.values);
    if (made) program = std::move(own);
    context->save_pipeline_cache_if_grown();
    return made;
}

void Composer::State::take_ready(const Frame& frame) {
    std::unique_ptr<compose::Chain> newer;
    // Formats and extents change on both sides, and the host's images may come later than the plan.
    const auto suits = [&](const std::unique_ptr<compose::Chain>& made) {
        return made &&
               (!chain || made->fits(frame, chain->compiled_for()) || !chain->fits(frame, chain->compiled_for()));
    };
    if (asks_first) {
        if (suits(told)) newer = std::move(told);
    } else if (const std::unique_lock lock(pending_mutex, std::try_to_lock); lock && suits(ready)) {
        newer = std::move(ready);
    }
    if (newer) take(std::move(newer));
}

void Composer::State::take(std::unique_ptr<compose::Chain> newer) {
    // With more views than before, more recordings may be made before the oldest one has finished. Until that many are
    // made, one of another view may go on from what an older plan left, and then has as long to finish.
    const std::uint32_t recordings = 2 * std::max(chain ? chain->slots() : 0u, newer->slots());
    for (Retired& old : retired) old.recordings_left = std::max(old.recordings_left, recordings);
    if (chain) retired.push_back({std::move(chain), recordings});
    chain = std::move(newer);
}

void Composer::State::put_away_retired() {
    for (Retired& old : retired)
        if (old.recordings_left == 0) worker->discard(old.chain);  // or the next recording does
    std::erase_if(retired, [](const Retired& old) { return old.chain == nullptr; });
}

void Composer::State::make_room_for_retired() {
    constexpr std::size_t live = 4;  // what runs, what the host was told of, what is ready, what is being made
    retired.reserve(retired.size() + live);
}

std::unique_lock<std::mutex> Composer::State::stop_compiling() {
    worker->cancel();
    {
        const std::scoped_lock lock(pending_mutex);
        ++requests;
        later.reset();
        pending_error.reset();
    }
    std::unique_lock lock(compile_mutex);
    {
        const std::scoped_lock guard(pending_mutex);
        ready.reset();
    }
    told.reset();
    worker->clean_up();
    return lock;
}

Result<Plan> Composer::plan(const CompileDesc& desc) const try {
    DARKROOM_TRY_VALUE(auto snapshot, state_->snapshot(desc));
    DARKROOM_TRY_VALUE(auto program, plan::plan_program(snapshot.values, desc,
                                                        compose::planner_traits(*state_->context, desc.kernels)));
    DARKROOM_TRY_VALUE(auto compiled,
                       program.graph.compile(plan::largest_extents(desc), graph::measure_on(*state_->context)));
    std::vector<const plan::Entry*> entries;
    for (const plan::Entry& entry : snapshot.values) entries.push_back(&entry);
    Plan plan = plan::describe_program(program, compiled, desc, entries);
    if (state_->context->is_assumed) plan.remarks.emplace_back(gpu::assumed_device_remark(*state_->context->profile));
    return plan;
} catch (...) {
    return caught("plan");
}

Result<Plan> Composer::State::compile(const CompileDesc& wanted) {
    DARKROOM_TRY(check_device());
    DARKROOM_TRY_VALUE(auto made, snapshot(wanted));
    make_room_for_retired();
    const auto lock = stop_compiling();
    DARKROOM_TRY_VALUE(auto newer, make_chain(std::move(made)));
    Plan plan = newer->plan();
    take(std::move(newer));
    return plan;
}

Result<Plan> Composer::compile(const CompileDesc& desc) try { return state_->compile(desc); } catch (...) {
    return caught("compile");
}

std::optional<CompileDesc> Composer::State::last_desc() const {
    const std::scoped_lock lock(pending_mutex);
    if (later) return later->desc;
    for (const auto* const plan : {&ready, &told, &chain})
        if (*plan) return (*plan)->compiled_for();
    return std::nullopt;
}

bool Composer::State::is_mixable(const plan::Entry& entry) const {
    const std::scoped_lock lock(pending_mutex);
    const std::array plans{&ready, &told, &chain};
    return !(later && std::ranges::count(later->unmixed, entry.id) > 0) &&
           std::ranges::all_of(plans, [&](const auto* plan) {
               const auto place = *plan ? (*plan)->index_of(entry.id) : std::nullopt;
               return !place || (*plan)->program()->program.is_mixable[*place];
           });
}

void Composer::State::compile_now(Snapshot wanted, std::uint64_t number) {
    const std::scoped_lock lock(compile_mutex);
    const auto is_outdated = [&] {
        const std::scoped_lock guard(pending_mutex);
        return number != requests;
    };
    if (is_outdated()) return;
    // On the worker nobody else would catch it.
    auto made = [&]() -> Result<std::unique_ptr<compose::Chain>> {
        try {
            return make_chain(std::move(wanted));
        } catch (...) {
            return caught("compile");
        }
    }();
    std::unique_ptr<compose::Chain> older;
    const std::scoped_lock guard(pending_mutex);
    if (number != requests) return;
    later.reset();
    if (!made) {
        pending_error = std::move(made).error();
        return;
    }
    older = std::exchange(ready, std::move(*made));
}

Result<> Composer::compile_later(const CompileDesc& desc) try {
    DARKROOM_TRY(state_->check_device());
    auto snapshot = state_->snapshot(desc);
    if (!snapshot) return failure(std::move(snapshot));
    State& state = *state_;
    state.make_room_for_retired();
    State::Later later{.desc = desc};
    for (const plan::Entry& entry : snapshot->values)
        if (!plan::is_merged(entry)) later.unmixed.push_back(entry.id);
    // Whatever may fail for lack of memory comes before the promise.
    struct Request {
        State::Snapshot snapshot;
        std::uint64_t number = 0;
    };
    auto request = std::make_shared<Request>(Request{std::move(*snapshot)});
    std::function<void()> task = [&state, request] {
        state.compile_now(std::move(request->snapshot), request->number);
    };
    {
        const std::scoped_lock lock(state.pending_mutex);
        request->number = ++state.requests;
        state.later = std::move(later);
        state.pending_error.reset();
    }
    if (state.worker->is_running()) {
        state.worker->run(std::move(task));
        return {};
    }
    state.worker->clean_up();
    task();
    return {};
} catch (...) {
    return caught("compile_later");
}

PendingCompile Composer::pending() const try {
    const std::scoped_lock lock(state_->pending_mutex);
    return {.is_pending = state_->later || state_->ready || state_->told,
            .is_ready = state_->ready || state_->told,
            .error = state_->pending_error};
} catch (...) {
    return {.is_pending = false, .error = caught("pending").value()};
}

const Plan* Composer::current_plan() const try {
    return state_->chain ? &state_->chain->plan() : nullptr;
} catch (...) {
    // There is no memory to tell it in.
    return nullptr;
}

const Plan* Composer::coming_plan() {
    State& state = *state_;
    state.asks_first = true;
    std::unique_ptr<compose::Chain> newer;
    {
        const std::scoped_lock lock(state.pending_mutex);
        newer = std::move(state.ready);
    }
    if (newer) {
        // The host may still read what it was told before.
        if (state.told) state.retired.push_back({std::move(state.told)});
        state.told = std::move(newer);
    }
    return state.told ? &state.told->plan() : nullptr;
}

Result<> Composer::record(VkCommandBuffer commands, const Frame& frame) try {
    const auto start = std::chrono::steady_clock::now();
    State& state = *state_;
    state.take_ready(frame);
    if (!state.chain) return user_error("record: the composer has no plan; compile it first");
    state.put_away_retired();
    state.last = plan::moment_of(frame.time, frame.camera);
    if (state.is_any_waiting) state.start_pulses(frame.time);
    auto ok = state.chain->record(commands, frame);
    // One that the worker had no room for has none left already.
    for (State::Retired& old : state.retired)
        if (ok && old.recordings_left > 0) --old.recordings_left;
    state.record_microseconds =
        std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count();
    return ok;
} catch (...) {
    return caught("record");
}

Result<> Composer::abandon() try {
    if (!state_->chain || !state_->chain->abandon())
        return user_error("abandon: the composer has no last recording that could be taken back");
    for (State::Retired& old : state_->retired) ++old.recordings_left;
    return {};
} catch (...) {
    return caught("abandon");
}

void Composer::wait_for_kernels() try {
    if (!state_->chain) return;
    if (const auto ok = state_->chain->build_lean(); !ok) state_->context->say(Severity::Warning, ok.error().text);
} catch (...) {
    state_->context->say(Severity::Warning, caught("wait_for_kernels").value().text);
}

RecordingTimes Composer::times() { return state_->chain ? state_->chain->times() : RecordingTimes{}; }
ValueReading Composer::value(std::string_view name, std::uint32_t view) const {
    return state_->chain ? state_->chain->value(name, view) : ValueReading{};
}
WatchState Composer::watch_state(std::uint32_t id) const {
    return state_->chain ? state_->chain->watch_state(id) : WatchState::NotInPlan;
}
double Composer::record_microseconds() const { return state_->record_microseconds; }

Result<Plan> Composer::rebind(const Device& device) try {
    const std::optional<CompileDesc> desc = state_->last_desc();
    if (!desc) return user_error("rebind: the composer was never compiled");
    // Beside the old state, which stays as it is unless all of this works.
    auto newer = std::make_unique<State>(device.shared_context(), state_->desc);
    newer->stack = state_->stack;
    newer->resources = state_->resources;
    newer->last = state_->last;
    newer->is_any_waiting = state_->is_any_waiting;
    newer->asks_first = state_->asks_first;
    auto plan = newer->compile(*desc);
    if (plan) state_ = std::move(newer);
    return plan;
} catch (...) {
    return caught("rebind");
}

namespace {

/// docs/embedding.md quotes how it is used.
[[maybe_unused]] void usage_composer(Composer& composer, VkCommandBuffer commands, const Frame& frame,
                                     void (*report)(const Error&)) {
    const darkroom::ImageRef& target = frame.target;
    auto plan = composer.compile({.max_extent = {3840, 2160},
                                  .color = {VK_FORMAT_R16G16B16A16_SFLOAT},
                                  .depth = {VK_FORMAT_D32_SFLOAT},
                                  .target = {target.format, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT}});
    if (!plan) return report(plan.error());
    std::puts(plan->text().c_str());

    if (auto recorded = composer.record(commands, frame); !recorded) return report(recorded.error());
    // And where the recording is not submitted:
    if (auto taken_back = composer.abandon(); !taken_back) return report(taken_back.error());
}

}  // namespace

}  // namespace darkroom
