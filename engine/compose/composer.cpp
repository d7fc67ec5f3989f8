// SPDX-License-Identifier: MIT
// The stack of a Composer: entries, their order and their values. Compiling and recording are in composer_run.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include <darkroom/describe.hpp>
#include "compose/composer_state.hpp"
#include "core/caught.hpp"
#include "core/text/param_text.hpp"

namespace darkroom {

namespace {

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

/// Of all Composers of the process, so that the handle of one names nothing in another.
std::uint32_t next_id() {
    static std::atomic<std::uint32_t> last{0};
    std::uint32_t id = ++last;
    while (id == 0 || id >= ui_layer.id) id = ++last;
    return id;
}

Result<> check_part(std::string_view name, std::uint64_t size, std::uint64_t most, std::uint64_t values,
                    std::uint64_t wanted) {
    if (size > most) return user_error(fmt::format("{} of {} entries: allowed is at most {}", name, size, most));
    if (values == wanted) return {};
    return user_error(fmt::format("{} of {} entries: {} numbers are given; allowed is {}", name, size, values, wanted));
}

Result<> check_domain(std::string_view name, const std::array<float, 3>& min, const std::array<float, 3>& max) {
    for (std::size_t i = 0; i < min.size(); ++i)
        if (!(std::isfinite(min[i]) && std::isfinite(max[i]) && min[i] < max[i]))
            return user_error(fmt::format(
                "{} from {} to {}: allowed is a finite domain that ends above where it begins", name, min[i], max[i]));
    return {};
}

Result<> check_resource(const ResourceData& data, std::uint64_t largest) {
    constexpr std::uint64_t longest = 65536, widest = 256;
    if (const auto* const image = std::get_if<ResourceImage>(&data)) {
        if (image->width == 0 || image->height == 0 || image->width > largest || image->height > largest)
            return user_error(fmt::format("a picture of {}x{}: allowed is 1x1 to {}x{}", image->width, image->height,
                                          largest, largest));
        const std::uint64_t pixels = std::uint64_t{image->width} * image->height;
        return check_part("a picture", pixels, pixels, image->rgba.size(), 4 * pixels);
    }
    const auto& table = std::get<ColorTable>(data);
    if (auto ok = check_domain("a shaper", table.shaper_min, table.shaper_max); table.shaper_size > 0 && !ok) return ok;
    if (auto ok = check_domain("a cube", table.min, table.max); table.size > 0 && !ok) return ok;
    DARKROOM_TRY(
        check_part("a shaper", table.shaper_size, longest, table.shaper.size(), std::uint64_t{3} * table.shaper_size));
    return check_part("the edge of a cube", table.size, widest, table.cube.size(),
                      table.size > widest ? 0 : std::uint64_t{3} * table.size * table.size * table.size);
}

}  // namespace

Result<> check_mixing(const EntryDesc& desc) {
    if (!(desc.opacity >= 0 && desc.opacity <= 1))
        return user_error(fmt::format("{}: opacity = {}: allowed is [0, 1]", desc.name, desc.opacity));
    if (desc.blend > BlendMode::SoftLight)
        return user_error(fmt::format("{}: blend = {}: allowed is 0 to {}", desc.name,
                                      static_cast<std::uint32_t>(desc.blend),
                                      static_cast<std::uint32_t>(BlendMode::SoftLight)));
    return {};
}

Result<> check_values(const plan::Entry& entry, std::span<const std::uint32_t> words) {
    for (const ParamInfo& row : entry.info->parameters.rows)
        DARKROOM_TRY(check_value(entry, row, words.subspan(row.word, row.words)));
    return check_together(entry, words);
}

std::size_t Composer::State::index_of(Handle handle) const {
    const auto found = std::ranges::find_if(stack, [&](const auto& entry) { return entry->id == handle.id; });
    return static_cast<std::size_t>(found - stack.begin());
}

plan::Entry* Composer::State::entry(Handle handle) const {
    const std::size_t index = index_of(handle);
    return index < stack.size() ? stack[index].get() : nullptr;
}

Result<plan::Entry*> Composer::State::checked(Handle handle) const {
    if (plan::Entry* const found = entry(handle)) return found;
    return user_error(
        fmt::format("handle {}: it names no entry of this composer; the entry may have been removed", handle.id));
}

std::shared_ptr<plan::Entry> Composer::State::make_entry(const EffectInfo& info, const void* parameters,
                                                         const EntryDesc& entry_desc) const {
    auto entry = std::make_shared<plan::Entry>();
    entry->id = next_id();
    entry->history_owner = entry->id;
    entry->info = &info;
    entry->effect_owner = info.owner.lock();
    entry->desc = entry_desc;
    entry->base.assign(info.parameters.defaults.begin(), info.parameters.defaults.end());
    if (parameters != nullptr) std::memcpy(entry->base.data(), parameters, entry->base.size() * 4);
    const auto is_taken = [&](const std::string& name) {
        return std::ranges::any_of(stack, [&](const auto& other) { return other->desc.name == name; });
    };
    if (entry->desc.name.empty()) {
        entry->desc.name = info.name;
        for (std::uint32_t number = 2; is_taken(entry->desc.name); ++number)
            entry->desc.name = fmt::format("{}#{}", info.name, number);
    }
    return entry;
}

Result<const ParamInfo*> Composer::State::row(const plan::Entry& entry, std::string_view parameter) {
    if (const ParamInfo* const found = entry.info->parameters.find(parameter)) return found;
    std::vector<std::string> names;
    for (const ParamInfo& info : entry.info->parameters.rows) names.emplace_back(info.name);
    return user_error(
        fmt::format("{} has no parameter '{}'{}", entry.desc.name, parameter, suggestion(parameter, names)));
}

Composer::Composer(const Device& device, const ComposerDesc& desc)
    : state_(std::make_unique<State>(device.shared_context(), desc)) {}
Composer::Composer(Composer&&) noexcept = default;
Composer& Composer::operator=(Composer&&) noexcept = default;
Composer::~Composer() = default;

Handle Composer::add(const EffectInfo& info, const void* parameters, const EntryDesc& desc) try {
    return {state_->stack.emplace_back(state_->make_entry(info, parameters, desc))->id};
} catch (...) {
    state_->context->say(Severity::Error, caught("add").value().text);
    return {};
}

Result<Handle> Composer::insert(Handle before, const EffectInfo& info, const void* parameters,
                                const EntryDesc& desc) try {
    DARKROOM_TRY(check(before));
    const auto place = state_->stack.begin() + static_cast<std::ptrdiff_t>(state_->index_of(before));
    return Handle{(*state_->stack.insert(place, state_->make_entry(info, parameters, desc)))->id};
} catch (...) {
    return caught("insert");
}

Result<> Composer::remove(Handle handle) try {
    DARKROOM_TRY(check(handle));
    state_->stack.erase(state_->stack.begin() + static_cast<std::ptrdiff_t>(state_->index_of(handle)));
    return {};
} catch (...) {
    return caught("remove");
}

Result<> Composer::move(Handle handle, Handle before) try {
    DARKROOM_TRY(check(handle));
    if (before.is_given()) DARKROOM_TRY(check(before));
    if (handle == before) return {};
    const auto at = [&](Handle which) {
        return state_->stack.begin() + static_cast<std::ptrdiff_t>(state_->index_of(which));
    };
    const auto from = at(handle), to = before.is_given() ? at(before) : state_->stack.end();
    if (from < to)
        std::rotate(from, from + 1, to);
    else
        std::rotate(to, from, from + 1);
    return {};
} catch (...) {
    return caught("move");
}

Result<> Composer::replace(Handle handle, const EffectInfo& info, const void* parameters) try {
    DARKROOM_TRY_VALUE(auto entry, state_->checked(handle));
    plan::Entry& old = *entry;
    if (old.info == &info) {
        const void* const from = parameters != nullptr ? parameters : info.parameters.defaults.data();
        std::memcpy(old.base.data(), from, old.base.size() * 4);
        return {};
    }
    // The present plan goes on with the values of the other effect, switched and faded by the same handle.
    auto made = state_->make_entry(info, parameters, old.desc);
    made->id = old.id;
    std::shared_ptr<plan::Entry>& place = state_->stack[state_->index_of(handle)];
    // One that no plan holds goes; the one before it may still be in a picture.
    made->replaced = place.use_count() == 1 ? place->replaced : place;
    place = std::move(made);
    return {};
} catch (...) {
    return caught("replace");
}

Result<> Composer::rewire(Handle handle, const EntryDesc& desc) try {
    DARKROOM_TRY_VALUE(auto entry, state_->checked(handle));
    EntryDesc own = desc;
    own.is_ui = entry->desc.is_ui;
    own.enabled = entry->desc.enabled;
    if (own.name.empty()) own.name = entry->desc.name;
    DARKROOM_TRY(check_mixing(own));
    std::swap(entry->desc, own);
    return {};
} catch (...) {
    return caught("rewire");
}

void Composer::clear() { state_->stack.clear(); }

Result<Resource> Composer::define(ResourceData data) try {
    DARKROOM_TRY(check_resource(data, std::min(16384u, state_->context->traits.max_image_dimension)));
    const Resource out{next_id()};
    // Plans under way keep the map they began with.
    Resources all = *state_->resources;
    all.emplace(out.id, std::make_shared<const ResourceData>(std::move(data)));
    state_->resources = std::make_shared<const Resources>(std::move(all));
    return out;
} catch (...) {
    return caught("define");
}

void Composer::forget(Resource resource) try {
    Resources all = *state_->resources;
    all.erase(resource.id);
    state_->resources = std::make_shared<const Resources>(std::move(all));
} catch (...) {
    // It stays until it can be forgotten: a later call, or the Composer's end.
    state_->context->say(Severity::Warning, caught("forget").value().text);
}

const Resources& Composer::resources() const { return *state_->resources; }

std::optional<Handle> Composer::find(std::string_view entry_name) const {
    for (const auto& entry : state_->stack)
        if (entry->desc.name == entry_name) return Handle{entry->id};
    return std::nullopt;
}
std::size_t Composer::size() const { return state_->stack.size(); }
Handle Composer::entry(std::size_t index) const {
    return index < state_->stack.size() ? Handle{state_->stack[index]->id} : Handle{};
}
Result<> Composer::check(Handle handle) const try {
    auto entry = state_->checked(handle);
    return entry ? Result<>{} : failure(std::move(entry));
} catch (...) {
    return caught("check");
}
const EffectInfo* Composer::info(Handle handle) const {
    const plan::Entry* const entry = state_->entry(handle);
    return entry == nullptr ? nullptr : entry->info;
}
const EntryDesc* Composer::desc(Handle handle) const {
    const plan::Entry* const entry = state_->entry(handle);
    return entry == nullptr ? nullptr : &entry->desc;
}
std::span<const std::uint32_t> Composer::words(Handle handle) const {
    const plan::Entry* const entry = state_->entry(handle);
    return entry == nullptr ? std::span<const std::uint32_t>{} : entry->base;
}

Result<> Composer::set_enabled(Handle handle, bool enabled) try {
    DARKROOM_TRY_VALUE(auto entry, state_->checked(handle));
    State::for_all_of(*entry, [&](plan::Entry& one) { one.desc.enabled = enabled; });
    return {};
} catch (...) {
    return caught("set_enabled");
}

Result<> Composer::set_opacity(Handle handle, float opacity) try {
    DARKROOM_TRY_VALUE(auto found, state_->checked(handle));
    plan::Entry& entry = *found;
    if (!(opacity >= 0 && opacity <= 1))
        return user_error(fmt::format("{}: opacity = {}: allowed is [0, 1]", entry.desc.name, opacity));
    // An entry with passes of its own is laid over its input by the next kernel, if that was planned so.
    if (opacity > 0 && opacity < 1 && !state_->is_mixable(entry))
        return user_error(fmt::format(
            "{}: opacity = {}: it has passes of its own and was compiled with opacity 1; allowed are 0 and 1, "
            "or add it with an opacity below 1 and compile",
            entry.desc.name, opacity));
    State::for_all_of(entry, [&](plan::Entry& one) { one.desc.opacity = opacity; });
    return {};
} catch (...) {
    return caught("set_opacity");
}

Result<> Composer::set(Handle handle, std::string_view parameter, std::span<const std::uint32_t> words) try {
    DARKROOM_TRY_VALUE(auto found_entry, state_->checked(handle));
    plan::Entry& entry = *found_entry;
    DARKROOM_TRY_VALUE(const auto row, State::row(entry, parameter));
    DARKROOM_TRY(check_value(entry, *row, words));
    std::copy(words.begin(), words.end(), entry.base.begin() + row->word);
    return {};
} catch (...) {
    return caught("set");
}

Result<> Composer::set(Handle handle, std::string_view parameter, double value) try {
    DARKROOM_TRY_VALUE(auto found_entry, state_->checked(handle));
    plan::Entry& entry = *found_entry;
    DARKROOM_TRY_VALUE(const auto row, State::row(entry, parameter));
    const ParamInfo& info = *row;
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
} catch (...) {
    return caught("set");
}

Result<ParameterId> Composer::parameter(Handle handle, std::string_view name) const try {
    DARKROOM_TRY_VALUE(auto found_entry, state_->checked(handle));
    const plan::Entry& entry = *found_entry;
    DARKROOM_TRY_VALUE(const auto row, State::row(entry, name));
    const std::size_t place = std::min<std::size_t>(state_->index_of(handle), 0xffff);
    return ParameterId{static_cast<std::uint32_t>(entry.history_owner),
                       static_cast<std::uint16_t>(row - entry.info->parameters.rows.data()),
                       static_cast<std::uint16_t>(place)};
} catch (...) {
    return caught("parameter");
}

Result<> Composer::set(ParameterId parameter, std::span<const std::uint32_t> words) try {
    const auto& stack = state_->stack;
    const auto is_it = [&](const auto& entry) { return entry->history_owner == parameter.owner; };
    auto found = stack.begin() + std::min<std::ptrdiff_t>(parameter.place, std::ssize(stack));
    if (found == stack.end() || !is_it(*found)) found = std::ranges::find_if(stack, is_it);
    if (found == stack.end() || parameter.row >= (*found)->info->parameters.rows.size())
        return user_error(
            fmt::format("parameter {}: it does not belong to this composer; its entry may have been removed, or have "
                        "another effect",
                        parameter.owner));
    plan::Entry& entry = **found;
    const ParamInfo& row = entry.info->parameters.rows[parameter.row];
    DARKROOM_TRY(check_value(entry, row, words));
    std::copy(words.begin(), words.end(), entry.base.begin() + row.word);
    return {};
} catch (...) {
    return caught("set");
}

Result<> Composer::set(Handle handle, const EffectInfo& info, const void* parameters) try {
    DARKROOM_TRY_VALUE(auto found_entry, state_->checked(handle));
    plan::Entry& entry = *found_entry;
    if (entry.info != &info)
        return user_error(fmt::format("{}: is not an entry of the effect {}", entry.desc.name, info.name));
    const std::span words(static_cast<const std::uint32_t*>(parameters), entry.base.size());
    DARKROOM_TRY(check_values(entry, words));
    std::copy(words.begin(), words.end(), entry.base.begin());
    return {};
} catch (...) {
    return caught("set");
}

Result<> Composer::set_override(Handle handle, std::string_view parameter, std::string_view owner,
                                std::span<const std::uint32_t> words) try {
    DARKROOM_TRY_VALUE(auto found_entry, state_->checked(handle));
    plan::Entry& entry = *found_entry;
    DARKROOM_TRY_VALUE(const auto row, State::row(entry, parameter));
    DARKROOM_TRY(check_value(entry, *row, words));
    const auto found = std::find_if(entry.overrides.begin(), entry.overrides.end(),
                                    [&](const auto& o) { return o.owner == owner && o.word == row->word; });
    if (found == entry.overrides.end()) {
        entry.overrides.push_back({.owner = std::string(owner), .word = row->word, .words = row->words});
    } else {
        std::rotate(found, found + 1, entry.overrides.end());  // the last to set wins
    }
    std::copy(words.begin(), words.end(), entry.overrides.back().value.begin());
    return {};
} catch (...) {
    return caught("set_override");
}

void Composer::drop_overrides(std::string_view owner) {
    for (const auto& entry : state_->stack)
        State::for_all_of(*entry, [&](plan::Entry& one) {
            std::erase_if(one.overrides, [&](const auto& o) { return o.owner == owner; });
        });
}

std::uint32_t Composer::pre_roll(double delta_time) const try {
    const double seconds = seconds_between_frames(delta_time);
    if (!(seconds > 0)) return 0;
    std::uint64_t frames = 0;
    for (const auto& entry : state_->stack) {
        const EntryDesc& desc = entry->desc;
        for (const Handle wire : {desc.input, desc.source, desc.second, desc.mask})
            if (wire.is_previous) frames += previous_pre_roll;
        if (entry->info->pre_roll == nullptr) continue;
        std::vector<std::uint32_t> words(entry->base.size());
        if (entry->is_on(entry->evaluate(words, state_->last), words.data()))
            frames += entry->info->pre_roll(words.data(), seconds);
    }
    return static_cast<std::uint32_t>(std::min<std::uint64_t>(frames, std::numeric_limits<std::uint32_t>::max()));
} catch (...) {
    state_->context->say(Severity::Warning, caught("pre_roll").value().text);
    return 0;
}

}  // namespace darkroom
