// SPDX-License-Identifier: MIT
// Layers and pulses of a Composer: they lie in the entries that they move, as overrides do.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "compose/composer_state.hpp"
#include "core/caught.hpp"
#include "core/text/param_text.hpp"

namespace darkroom {

namespace {

constexpr double longest_pulse = 3600;

bool is_made_of_numbers(const ParamInfo& row) {
    return row.kind == Kind::Float || row.kind == Kind::Int || row.kind == Kind::Vec2 || row.kind == Kind::Vec3 ||
           row.kind == Kind::Vec4 || row.kind == Kind::Rgb;
}

Result<> check_pulse(const plan::Entry& entry, const ParamInfo& row, const PulseDesc& desc) {
    const std::string shown = fmt::format("pulse '{}' of {}.{}", printable(desc.event), entry.desc.name, row.name);
    if (!is_made_of_numbers(row))
        return user_error(fmt::format("{}: the parameter takes {}; allowed is a parameter of numbers", shown,
                                      expected_kind(row.kind)));
    if (!(desc.duration > 0 && desc.duration <= longest_pulse))
        return user_error(fmt::format("{}: duration = {}: allowed is (0, {}] s", shown, desc.duration, longest_pulse));
    for (const float amount : desc.amount)
        if (!std::isfinite(amount))
            return user_error(fmt::format("{}: amount = {}: allowed are finite numbers", shown, amount));
    return {};
}

Result<> check_distance(const std::string& shown, const LayerDistance& distance) {
    const auto& [x, y, z] = distance.point;
    const bool is_place = std::isfinite(x) && std::isfinite(y) && std::isfinite(z);
    if (is_place && distance.near >= 0 && distance.far > distance.near && std::isfinite(distance.far)) return {};
    return user_error(
        fmt::format("{}: distance from {} to {} m of ({}, {}, {}): allowed is 0 <= near < far of a finite place", shown,
                    distance.near, distance.far, x, y, z));
}

Result<> check_weight(const std::string& shown, float weight) {
    if (weight >= 0 && weight <= 1) return {};
    return user_error(fmt::format("{}: weight = {}: allowed is [0, 1]", shown, weight));
}

std::string shown_layer(std::string_view name) { return fmt::format("layer '{}'", printable(name)); }

/// Puts one value of a layer where it belongs.
Result<> add_value(const plan::Entry& entry, const LayerValue& value, plan::Layer& out) {
    const std::string shown =
        fmt::format("{}: {}.{}", shown_layer(out.name), entry.desc.name, printable(value.parameter));
    if (value.parameter == "enabled" || value.parameter == "opacity") {
        const bool is_toggle = value.parameter == "enabled";
        const float opacity = value.words.size() == 1 ? std::bit_cast<float>(value.words[0]) : -1;
        if (value.words.size() != 1 || (is_toggle ? value.words[0] > 1 : !(opacity >= 0 && opacity <= 1)))
            return user_error(fmt::format("{}: allowed is {}", shown, is_toggle ? "true or false" : "[0, 1]"));
        if (is_toggle)
            out.is_enabled = value.words[0] != 0;
        else
            out.opacity = opacity;
        return {};
    }
    const ParamInfo* const row = entry.info->parameters.find(value.parameter);
    if (row == nullptr) return user_error(fmt::format("{}: there is no such parameter", shown));
    DARKROOM_TRY(check_words(*row, value.words, shown));
    out.values.push_back({row, value.words});
    return {};
}

}  // namespace

Result<> Composer::add_pulse(const PulseDesc& desc) try {
    DARKROOM_TRY_VALUE(auto entry, state_->checked(desc.entry));
    DARKROOM_TRY_VALUE(const auto row, State::row(*entry, desc.parameter));
    DARKROOM_TRY(check_pulse(*entry, *row, desc));
    entry->pulses.push_back(
        {.event = desc.event, .row = row, .amount = desc.amount, .shape = desc.envelope, .duration = desc.duration});
    return {};
} catch (...) {
    return caught("add_pulse");
}

std::size_t Composer::fire(std::string_view event, std::optional<double> time) {
    std::size_t count = 0;
    for (const auto& entry : state_->stack)
        for (plan::Pulse& pulse : entry->pulses) {
            if (pulse.event != event) continue;
            ++count;
            pulse.is_waiting = !time;
            if (time) pulse.start = *time;
        }
    state_->is_any_waiting |= count > 0 && !time;
    return count;
}

void Composer::State::start_pulses(double time) {
    is_any_waiting = false;
    for (const auto& entry : stack)
        for (plan::Pulse& pulse : entry->pulses)
            if (std::exchange(pulse.is_waiting, false)) pulse.start = time;
}

Result<> Composer::add_layer(const LayerDesc& desc) try {
    const std::string shown = shown_layer(desc.name);
    if (std::ranges::count(layer_names(), desc.name) > 0)
        return user_error(fmt::format("{}: there is one of this name", shown));
    if (desc.values.empty()) return user_error(fmt::format("{}: it has no values", shown));
    DARKROOM_TRY(check_weight(shown, desc.weight));
    if (desc.distance) DARKROOM_TRY(check_distance(shown, *desc.distance));
    // All of it, or nothing.
    std::vector<std::pair<plan::Entry*, plan::Layer>> made;
    for (const LayerValue& value : desc.values) {
        DARKROOM_TRY_VALUE(auto entry, state_->checked(value.entry));
        auto found = std::ranges::find(made, entry, &std::pair<plan::Entry*, plan::Layer>::first);
        if (found == made.end())
            found = made.insert(
                found, {entry, {.name = desc.name, .weight = desc.weight, .distance = desc.distance, .values = {}}});
        DARKROOM_TRY(add_value(*entry, value, found->second));
    }
    for (auto& [entry, layer] : made) {
        if (layer.opacity && !state_->is_mixable(*entry))
            state_->context->say(
                Severity::Info, fmt::format("{}: {}.opacity: it has passes of its own and was compiled with opacity 1: "
                                            "between 0 and 1 it moves once the stack is compiled again",
                                            shown, entry->desc.name));
        entry->layers.reserve(entry->layers.size() + 1);
    }
    for (auto& [entry, layer] : made) entry->layers.push_back(std::move(layer));
    return {};
} catch (...) {
    return caught("add_layer");
}

Result<> Composer::set_layer_weight(std::string_view name, float weight) try {
    if (!(weight >= 0 && weight <= 1)) return check_weight(shown_layer(name), weight);
    bool is_any = false;
    for (const auto& entry : state_->stack)
        for (plan::Layer& layer : entry->layers) {
            if (layer.name != name) continue;
            layer.weight = weight;
            is_any = true;
        }
    if (is_any) return {};
    return user_error(
        fmt::format("{}: there is no layer of this name{}", shown_layer(name), suggestion(name, layer_names())));
} catch (...) {
    return caught("set_layer_weight");
}

std::vector<std::string> Composer::layer_names() const try {
    std::vector<std::string> out;
    for (const auto& entry : state_->stack)
        for (const plan::Layer& layer : entry->layers)
            if (std::ranges::count(out, layer.name) == 0) out.push_back(layer.name);
    return out;
} catch (...) {
    return {};
}

void Composer::remove_pulses() {
    for (const auto& entry : state_->stack) State::for_all_of(*entry, [](plan::Entry& one) { one.pulses.clear(); });
}
void Composer::remove_layer(std::string_view name) {
    for (const auto& entry : state_->stack)
        State::for_all_of(*entry, [&](plan::Entry& one) {
            std::erase_if(one.layers, [&](const plan::Layer& layer) { return layer.name == name; });
        });
}

std::vector<std::uint32_t> Composer::current(Handle handle) const try {
    const plan::Entry* const entry = state_->entry(handle);
    if (entry == nullptr) return {};
    std::vector<std::uint32_t> out(entry->base.size());
    entry->evaluate(out, state_->last);
    return out;
} catch (...) {
    return {};
}

Composer::EntryValues Composer::values_at(Handle handle, double time, const Camera& camera) const try {
    const plan::Entry* const entry = state_->entry(handle);
    if (entry == nullptr) return {};
    EntryValues out{.words = std::vector<std::uint32_t>(entry->base.size())};
    const plan::Presence presence = entry->evaluate(out.words, plan::moment_of(time, camera));
    out.is_enabled = presence.is_enabled;
    const bool is_shown = presence.opacity <= 0 || presence.opacity >= 1 || state_->is_mixable(*entry);
    out.opacity = is_shown ? presence.opacity : 1;
    return out;
} catch (...) {
    return {};
}

}  // namespace darkroom
