// SPDX-License-Identifier: MIT
// Pulses and layers of looks: into a file, and into a Composer.
#include <fmt/format.h>

#include <algorithm>

#include "core/text/param_text.hpp"
#include "looks/apply/look_resources.hpp"
#include "looks/look_modulation.hpp"
#include "looks/look_parts.hpp"

namespace darkroom {

namespace {

template <class State>
auto words_of(const State& state) {
    return std::bit_cast<std::array<std::uint32_t, sizeof(State) / 4>>(state);
}

void write_rows(std::string& out, const ParamTable& table, std::span<const std::uint32_t> words,
                std::string_view separator) {
    for (const ParamInfo& row : table.rows)
        out += fmt::format("{}{} = {}", &row == table.rows.data() ? "" : separator, row.name, format(row, words));
}

/// What a value of a layer is, as TOML.
std::string text_of(const Look& look, const LookLayer::Value& value) {
    Look copy{.is_flat = look.is_flat, .entries = look.entries};
    const auto target = find_target(copy, fmt::format("{}.{}", value.entry, value.parameter), "");
    if (!target || target->row == nullptr) return "0";
    std::vector<std::uint32_t> words(target->row->word);
    words.insert(words.end(), value.words.begin(), value.words.end());
    return format(*target->row, words);
}

std::string amount_text(const Look& look, const LookPulse& pulse) {
    const std::vector<std::string> names = entry_names(look);
    const auto at = static_cast<std::size_t>(std::ranges::find(names, pulse.entry) - names.begin());
    const ParamInfo* const row =
        at < names.size() ? look.entries[at].effect->parameters.find(pulse.parameter) : nullptr;
    const std::uint32_t count = row == nullptr ? 1 : row->words;
    std::string out;
    for (std::uint32_t i = 0; i < std::min(count, 4u); ++i)
        out += fmt::format("{}{}", i == 0 ? "" : ", ", format({.name = "amount"}, words_of(pulse.amount[i])));
    return count == 1 ? out : "[" + out + "]";
}

}  // namespace

bool is_moved(const Look& look, std::string_view entry) {
    const auto is_of_entry = [&](const auto& one) { return one.entry == entry; };
    return std::ranges::any_of(look.pulses, is_of_entry) ||
           std::ranges::any_of(look.layers,
                               [&](const LookLayer& layer) { return std::ranges::any_of(layer.values, is_of_entry); });
}

void write_modulation(std::string& out, const Look& look) {
    for (const LookPulse& pulse : look.pulses) {
        out += fmt::format("\n[[pulse]]\nevent = {}\nparameter = {}\namount = {}\n", toml_string(pulse.event),
                           toml_string(fmt::format("{}.{}", pulse.entry, pulse.parameter)), amount_text(look, pulse));
        write_rows(out, pulse_rows, words_of(pulse.state), "\n");
        out += '\n';
    }
    for (const LookLayer& layer : look.layers) {
        out += fmt::format("\n[[layer]]\nname = {}\n", toml_string(layer.name));
        if (!layer.file.empty()) out += fmt::format("look = {}\n", toml_string(layer.file));
        write_rows(out, layer_rows, words_of(layer.state), "\n");
        out += '\n';
        if (layer.distance) {
            out += "distance = { ";
            write_rows(out, distance_rows, words_of(*layer.distance), ", ");
            out += " }\n";
        }
        if (!layer.file.empty()) continue;
        out += "[layer.values]\n";
        for (const LookLayer::Value& value : layer.values)
            out += fmt::format("{} = {}\n", toml_string(fmt::format("{}.{}", value.entry, value.parameter)),
                               text_of(look, value));
    }
}

namespace {

auto parts(const PulseDesc& of) {
    return std::tie(of.event, of.entry.id, of.parameter, of.amount, of.envelope, of.duration);
}

bool is_same(const LayerDesc& a, const LayerDesc& b) {
    const auto is_same_place = [](const LayerDistance& one, const LayerDistance& other) {
        return words_of(one) == words_of(other);
    };
    const auto is_same_value = [](const LayerValue& one, const LayerValue& other) {
        return one.entry == other.entry && one.parameter == other.parameter && one.words == other.words;
    };
    return a.name == b.name && a.weight == b.weight && a.distance.has_value() == b.distance.has_value() &&
           (!a.distance || is_same_place(*a.distance, *b.distance)) &&
           std::ranges::equal(a.values, b.values, is_same_value);
}

}  // namespace

ModulationFollower::ModulationFollower(const Look& was, Composer& composer)
    : composer_(composer), was_(descs_of(was)) {}

// What a look that is off leaves out, and what its order has no place for, is not there to be moved.
ModulationFollower::Descs ModulationFollower::descs_of(const Look& look) const {
    Descs out;
    const auto find = [&](std::string_view name) {
        const auto entry = composer_.find(name);
        if (entry) out.effects.push_back(composer_.info(*entry));
        return entry;
    };
    for (const LookPulse& pulse : look.pulses)
        if (const auto entry = find(pulse.entry))
            out.pulses.push_back({.event = pulse.event,
                                  .entry = *entry,
                                  .parameter = pulse.parameter,
                                  .amount = pulse.amount,
                                  .envelope = pulse.state.envelope,
                                  .duration = double{pulse.state.duration}});
    for (const LookLayer& layer : look.layers) {
        LayerDesc desc{.name = layer.name, .weight = layer.state.weight, .distance = layer.distance, .values = {}};
        for (const LookLayer::Value& value : layer.values)
            if (const auto entry = find(value.entry)) desc.values.push_back({*entry, value.parameter, value.words});
        if (!desc.values.empty()) out.layers.push_back(std::move(desc));
    }
    return out;
}

Result<bool> ModulationFollower::follow(const Look& is) {
    const Descs now = descs_of(is);
    const bool are_rows_same = was_.effects == now.effects;
    const auto blame = [&](const Error& error) {
        return failure(Error{error.fault, fmt::format("{}: {}", is.shown_name, error.text)});
    };
    const bool has_pulses = are_rows_same && std::ranges::equal(was_.pulses, now.pulses, {}, parts, parts);
    if (!has_pulses) {
        composer_.remove_pulses();
        for (const PulseDesc& pulse : now.pulses)
            if (const auto ok = composer_.add_pulse(pulse); !ok) return blame(ok.error());
    }
    // Layers are blended in their order: those from the first change on are added anew.
    std::size_t kept = 0;
    while (are_rows_same && kept < std::min(was_.layers.size(), now.layers.size()) &&
           is_same(was_.layers[kept], now.layers[kept]))
        ++kept;
    for (std::size_t i = kept; i < was_.layers.size(); ++i) composer_.remove_layer(was_.layers[i].name);
    for (std::size_t i = kept; i < now.layers.size(); ++i)
        if (const auto ok = composer_.add_layer(now.layers[i]); !ok) return blame(ok.error());
    return !has_pulses || kept < std::max(was_.layers.size(), now.layers.size());
}

}  // namespace darkroom
