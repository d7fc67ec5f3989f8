// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <darkroom/composer.hpp>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstring>

#include "compose/chain.hpp"
#include "compose/frame_check.hpp"
#include "core/assert.hpp"
#include "core/param_text.hpp"
#include "gpu/context.hpp"
#include "gpu/format_use.hpp"

namespace darkroom {

namespace {

/// The stage the user asked for where it can run the kernel, else the other one.
Result<gpu::Stage> stage_of(const gpu::Context& context, const gpu::KernelSpec& spec, KernelStage wanted) {
    if (wanted == KernelStage::Auto) return gpu::preferred_stage(context, spec);
    const gpu::Stage first = wanted == KernelStage::Compute ? gpu::Stage::Compute : gpu::Stage::Raster;
    const gpu::Stage second = wanted == KernelStage::Compute ? gpu::Stage::Raster : gpu::Stage::Compute;
    auto ok = gpu::usable(context, spec, first);
    if (ok) return first;
    if (gpu::usable(context, spec, second)) return second;
    return failure(std::move(ok));
}

std::string shown(const plan::Entry& entry, const ParamInfo& row) {
    return fmt::format("{}.{}", entry.desc.name, row.name);
}

/// Whether a value is surely allowed, found out without memory: values change inside frame loops. What is not goes the
/// long way through core, which knows every kind and makes the error's text.
template <class T>
bool is_inside(const ParamInfo& row, std::span<const std::uint32_t> words) {
    std::array<std::uint32_t, sizeof(T) / 4> copy{};
    std::copy_n(words.begin(), copy.size(), copy.begin());
    return detail::is_inside(std::bit_cast<T>(copy), row.range);
}
bool is_surely_allowed(const ParamInfo& row, std::span<const std::uint32_t> words) {
    if (words.size() != row.words) return false;
    switch (row.kind) {
        case Kind::Float:
            return is_inside<float>(row, words);
        case Kind::Int:
            return is_inside<std::int32_t>(row, words);
        case Kind::Toggle:
            return words[0] <= 1;
        case Kind::Choice:
            return words[0] < row.choices.size();
        case Kind::Vec2:
            return is_inside<Vec2>(row, words);
        case Kind::Vec3:
            return is_inside<Vec3>(row, words);
        case Kind::Vec4:
            return is_inside<Vec4>(row, words);
        case Kind::Rgb:
            return is_inside<Rgb>(row, words);
        case Kind::Curve:
        case Kind::Resource:
            break;
    }
    return false;
}

/// Allocates nothing where the value is allowed, but for curves.
Result<> check_value(const plan::Entry& entry, const ParamInfo& row, std::span<const std::uint32_t> words) {
    return is_surely_allowed(row, words) ? Result<>{} : check_words(row, words, shown(entry, row));
}

Result<> check_together(const plan::Entry& entry, std::span<const std::uint32_t> words) {
    if (entry.info->conflict == nullptr) return {};
    const std::string conflict = entry.info->conflict(words.data());
    return conflict.empty() ? Result<>{} : user_error(fmt::format("{}: {}", entry.desc.name, conflict));
}

/// All values of an entry: a struct that a host filled may hold anything.
Result<> check_values(const plan::Entry& entry, std::span<const std::uint32_t> words) {
    for (const ParamInfo& row : entry.info->parameters.rows)
        if (auto ok = check_value(entry, row, words.subspan(row.word, row.words)); !ok) return ok;
    return check_together(entry, words);
}

/// Errors, plans and looks call an entry by its name.
Result<> check_names(std::span<const plan::Entry> stack) {
    for (std::size_t i = 0; i < stack.size(); ++i) {
        const std::string& name = stack[i].inputs.name;
        if (name.empty()) return user_error(fmt::format("stack entry {}: its name is empty", i + 1));
        const auto control = std::ranges::find_if(
            name, [](char c) { return static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) == 0x7f; });
        if (control != name.end())
            return user_error(
                fmt::format("stack entry {}: its name holds the control character {:#04x} at place {}; "
                            "allowed is text",
                            i + 1, static_cast<unsigned>(*control), control - name.begin()));
        for (std::size_t other = 0; other < i; ++other)
            if (stack[other].inputs.name == name)
                return user_error(
                    fmt::format("stack entries {} and {}: both are named '{}'; allowed is a name of "
                                "their own for each",
                                other + 1, i + 1, name));
    }
    return {};
}

Failure unknown_handle() { return user_error("a handle that names no entry of this composer"); }

}  // namespace

namespace plan {

void Entry::evaluate(std::span<std::uint32_t> out) const {
    std::copy(base.begin(), base.end(), out.begin());
    for (const Override& o : overrides) std::copy_n(o.value.begin(), o.words, out.begin() + o.word);
}

}  // namespace plan

struct Composer::State {
    Device* device = nullptr;
    ComposerDesc desc;
    std::vector<plan::Entry> stack;
    std::optional<CompileDesc> compiled_for;
    std::unique_ptr<compose::Chain> chain;
    /// Chains that unfinished recordings may still use, and how many recordings each has to outlive.
    struct Retired {
        std::unique_ptr<compose::Chain> chain;
        std::uint32_t recordings_left = 0;
    };
    std::vector<Retired> retired;
    bool is_stale = false;  ///< the stack is not the one that was compiled
    double record_microseconds = 0;

    [[nodiscard]] std::uint32_t slots() const {
        return desc.frames_in_flight * (compiled_for ? compiled_for->views : 1);
    }
    [[nodiscard]] bool has(Handle handle) const { return handle.id >= 1 && handle.id <= stack.size(); }
    plan::Entry& at(Handle handle) {
        DARKROOM_ASSERT(has(handle));
        return stack[handle.id - 1];
    }
    [[nodiscard]] Result<plan::Program> program(const CompileDesc& compile_desc) const {
        if (auto ok = check_names(stack); !ok) return failure(std::move(ok));
        const gpu::Context& context = device->context();
        const bool is_software = context.traits.is_software;
        const plan::PlannerTraits traits{
            .stage_of = [&](const gpu::KernelSpec& spec) { return stage_of(context, spec, compile_desc.kernels); },
            .can_load = [&](VkFormat format) { return gpu::can_load(context, format); },
            .loads_are_cheap = is_software,
            .workgroup = is_software ? std::array{64u, 4u} : std::array{16u, 16u}};
        return plan::plan_program(stack, compile_desc, traits);
    }
    Result<const ParamInfo*> row(Handle handle, std::string_view parameter) {
        if (!has(handle)) return unknown_handle();
        const plan::Entry& entry = at(handle);
        if (const ParamInfo* const found = entry.info->parameters.find(parameter)) return found;
        std::vector<std::string> names;
        for (const ParamInfo& info : entry.info->parameters.rows) names.emplace_back(info.name);
        return user_error(
            fmt::format("{} has no parameter '{}'{}", entry.desc.name, parameter, suggestion(parameter, names)));
    }
};

Composer::Composer(Device& device, const ComposerDesc& desc) : state_(std::make_unique<State>()) {
    state_->device = &device;
    state_->desc = desc;
    state_->desc.frames_in_flight = std::max(1u, desc.frames_in_flight);
}
Composer::Composer(Composer&&) noexcept = default;
Composer& Composer::operator=(Composer&&) noexcept = default;
Composer::~Composer() = default;

Handle Composer::add(const EffectInfo& info, const void* parameters, const EntryDesc& desc) {
    plan::Entry entry{.info = &info, .desc = desc};
    entry.base.assign(info.parameters.defaults.begin(), info.parameters.defaults.end());
    if (parameters != nullptr) std::memcpy(entry.base.data(), parameters, entry.base.size() * 4);
    if (entry.desc.name.empty()) {
        const auto same = std::count_if(state_->stack.begin(), state_->stack.end(),
                                        [&](const plan::Entry& other) { return other.info->name == info.name; });
        entry.desc.name = same == 0 ? std::string(info.name) : fmt::format("{}#{}", info.name, same + 1);
    }
    state_->stack.push_back(std::move(entry));
    state_->is_stale = true;
    return {static_cast<std::uint32_t>(state_->stack.size())};
}

void Composer::clear() {
    state_->stack.clear();
    state_->is_stale = true;
}

std::optional<Handle> Composer::find(std::string_view entry_name) const {
    for (std::uint32_t i = 0; i < state_->stack.size(); ++i)
        if (state_->stack[i].desc.name == entry_name) return Handle{i + 1};
    return std::nullopt;
}
std::size_t Composer::size() const { return state_->stack.size(); }
Handle Composer::entry(std::size_t index) const { return {static_cast<std::uint32_t>(index + 1)}; }
const EffectInfo& Composer::info(Handle handle) const { return *state_->at(handle).info; }
const EntryDesc& Composer::desc(Handle handle) const { return state_->at(handle).desc; }
std::span<const std::uint32_t> Composer::words(Handle handle) const { return state_->at(handle).base; }

Result<> Composer::set_enabled(Handle handle, bool enabled) {
    if (!state_->has(handle)) return unknown_handle();
    state_->at(handle).desc.enabled = enabled;
    return {};
}

Result<> Composer::set_opacity(Handle handle, float opacity) {
    if (!state_->has(handle)) return unknown_handle();
    plan::Entry& entry = state_->at(handle);
    if (!(opacity >= 0 && opacity <= 1))
        return user_error(fmt::format("{}: opacity = {}: allowed is [0, 1]", entry.desc.name, opacity));
    // An entry with passes of its own is laid over its input by the next kernel, if that was planned so.
    const bool is_mixable = !state_->chain || state_->is_stale ||
                            state_->chain->program().is_mixable.size() < handle.id ||
                            state_->chain->program().is_mixable[handle.id - 1];
    if (!is_mixable && opacity > 0 && opacity < 1)
        return user_error(fmt::format(
            "{}: opacity = {}: it has passes of its own and was compiled with opacity 1; allowed are 0 and 1, "
            "or add it with an opacity below 1 and compile",
            entry.desc.name, opacity));
    entry.desc.opacity = opacity;
    return {};
}

Result<> Composer::set(Handle handle, std::string_view parameter, std::span<const std::uint32_t> words) {
    const auto row = state_->row(handle, parameter);
    if (!row) return failure(row.error());
    plan::Entry& entry = state_->at(handle);
    if (auto ok = check_value(entry, **row, words); !ok) return ok;
    std::copy(words.begin(), words.end(), entry.base.begin() + (*row)->word);
    return {};
}

Result<> Composer::set(Handle handle, std::string_view parameter, double value) {
    const auto row = state_->row(handle, parameter);
    if (!row) return failure(row.error());
    plan::Entry& entry = state_->at(handle);
    const ParamInfo& info = **row;
    const bool is_allowed = value >= info.range.min && value <= info.range.max;
    if (is_allowed && info.kind == Kind::Float) {
        entry.base[info.word] = std::bit_cast<std::uint32_t>(static_cast<float>(value));
        return {};
    }
    if (is_allowed && info.kind == Kind::Int && value == std::trunc(value)) {
        entry.base[info.word] = static_cast<std::uint32_t>(static_cast<std::int32_t>(value));
        return {};
    }
    return assign(info, entry.base, value, shown(entry, info));
}

Result<> Composer::set_all(Handle handle, const EffectInfo& info, const void* parameters) {
    if (!state_->has(handle)) return unknown_handle();
    plan::Entry& entry = state_->at(handle);
    if (entry.info != &info) return user_error(fmt::format("{} is no {}", entry.desc.name, info.name));
    const std::span words(static_cast<const std::uint32_t*>(parameters), entry.base.size());
    if (auto ok = check_values(entry, words); !ok) return ok;
    std::copy(words.begin(), words.end(), entry.base.begin());
    return {};
}

Result<> Composer::set_override(Handle handle, std::string_view parameter, std::string_view owner,
                                std::span<const std::uint32_t> words) {
    const auto row = state_->row(handle, parameter);
    if (!row) return failure(row.error());
    plan::Entry& entry = state_->at(handle);
    if (auto ok = check_value(entry, **row, words); !ok) return ok;
    const auto found = std::find_if(entry.overrides.begin(), entry.overrides.end(),
                                    [&](const auto& o) { return o.owner == owner && o.word == (*row)->word; });
    if (found == entry.overrides.end()) {
        entry.overrides.push_back({.owner = std::string(owner), .word = (*row)->word, .words = (*row)->words});
    } else {
        std::rotate(found, found + 1, entry.overrides.end());  // the last to set wins
    }
    std::copy(words.begin(), words.end(), entry.overrides.back().value.begin());
    return {};
}

void Composer::drop_overrides(std::string_view owner) {
    for (plan::Entry& entry : state_->stack)
        std::erase_if(entry.overrides, [&](const auto& o) { return o.owner == owner; });
}

std::vector<std::uint32_t> Composer::current(Handle handle) const {
    const plan::Entry& entry = state_->at(handle);
    std::vector<std::uint32_t> out(entry.base.size());
    entry.evaluate(out);
    return out;
}

Result<Plan> Composer::plan(const CompileDesc& desc) const {
    auto program = state_->program(desc);
    if (!program) return failure(std::move(program));
    auto compiled = program->graph.compile(desc.max_extent, graph::measure_on(state_->device->context()));
    if (!compiled) return failure(std::move(compiled));
    return plan::describe_program(*program, *compiled, desc, state_->stack);
}

Result<Plan> Composer::compile(const CompileDesc& desc) {
    const std::uint32_t limit = state_->device->context().traits.max_image_dimension;
    if (desc.max_extent.width == 0 || desc.max_extent.height == 0 || desc.max_extent.width > limit ||
        desc.max_extent.height > limit)
        return user_error(fmt::format("size {}x{}: this device allows 1x1 to {}x{}", desc.max_extent.width,
                                      desc.max_extent.height, limit, limit));
    if (desc.target_extent.width > limit || desc.target_extent.height > limit ||
        (desc.target_extent.width == 0) != (desc.target_extent.height == 0))
        return user_error(fmt::format("target_extent {}x{}: this device allows 1x1 to {}x{}, and 0x0 for the picture's",
                                      desc.target_extent.width, desc.target_extent.height, limit, limit));
    if (auto ok = compose::check_images(state_->device->context(), desc); !ok) return failure(std::move(ok));
    if (desc.views == 0) return user_error("views = 0: allowed is 1 and more");
    for (const plan::Entry& entry : state_->stack)
        if (auto ok = check_values(entry, entry.base); !ok) return failure(std::move(ok));
    auto program = state_->program(desc);
    if (!program) return failure(std::move(program));
    auto chain =
        compose::Chain::create(state_->device->context(), std::move(*program), desc,
                               state_->desc.frames_in_flight * desc.views, state_->desc.has_timers, state_->stack);
    if (!chain) return failure(std::move(chain));
    // With more views than before, more recordings may be made before the oldest one has finished.
    const std::uint32_t newer = std::max(state_->slots(), state_->desc.frames_in_flight * desc.views);
    for (State::Retired& retired : state_->retired) retired.recordings_left = std::max(retired.recordings_left, newer);
    if (state_->chain) state_->chain->retire();
    if (state_->chain) state_->retired.push_back({std::move(state_->chain), newer});
    state_->chain = std::move(*chain);
    state_->compiled_for = desc;
    state_->is_stale = false;
    return state_->chain->describe(state_->stack);
}

Result<> Composer::record(VkCommandBuffer commands, const Frame& frame) {
    const auto start = std::chrono::steady_clock::now();
    if (!state_->chain) return user_error("record: the composer has no plan; compile it first");
    if (state_->is_stale) return user_error("record: the stack changed since it was compiled; compile it again");
    // By the contract the recordings that used a retired chain have finished once as many newer ones are made.
    std::erase_if(state_->retired, [](const State::Retired& retired) { return retired.recordings_left == 0; });
    auto ok = state_->chain->record(commands, frame, state_->stack);
    if (ok)
        for (State::Retired& retired : state_->retired) --retired.recordings_left;
    state_->record_microseconds =
        std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count();
    return ok;
}

void Composer::wait_for_kernels() {
    if (!state_->chain || state_->is_stale) return;
    if (const auto ok = state_->chain->build_lean(state_->stack); !ok)
        state_->device->context().say(Severity::Warning, ok.error().text);
}

std::span<const PassTime> Composer::times() {
    return state_->chain ? state_->chain->times() : std::span<const PassTime>{};
}
double Composer::record_microseconds() const { return state_->record_microseconds; }

Result<Plan> Composer::rebind(Device& device) {
    if (!state_->compiled_for) return user_error("rebind: the composer was never compiled");
    state_->retired.clear();
    state_->chain.reset();
    state_->device = &device;
    return compile(*state_->compiled_for);
}

}  // namespace darkroom
