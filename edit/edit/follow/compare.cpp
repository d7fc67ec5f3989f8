// SPDX-License-Identifier: MIT
#include "edit/follow/compare.hpp"

#include <algorithm>
#include <cstring>
#include <tuple>

#include "looks/apply/look_resources.hpp"
#include "looks/apply/look_stack.hpp"
#include "looks/look_parts.hpp"

namespace darkroom::edit {

namespace {

bool is_same(const std::vector<float>& a, const std::vector<float>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0);
}

bool says_same(const LookEntry& a, const LookEntry& b) {
    if (a.effect->name != b.effect->name || a.effect_file != b.effect_file || a.is_of_ui != b.is_of_ui ||
        a.words.size() != b.words.size() || state_words(a.state) != state_words(b.state))
        return false;
    for (const WireInfo& wire : wires)
        if (a.*wire.member != b.*wire.member) return false;
    return std::ranges::all_of(a.effect->parameters.rows, [&](const ParamInfo& row) { return has_same(a, b, row); });
}

std::vector<const LookEntry*> entries_of(const Look& look, bool is_of_ui) {
    std::vector<const LookEntry*> out;
    for (const LookEntry& entry : look.entries)
        if (entry.is_of_ui == is_of_ui) out.push_back(&entry);
    return out;
}

/// The interface's entries have an order of their own. One that is not there is off.
bool has_same_ui(const Look& a, const Look& b) {
    const std::vector<const LookEntry*> of_a = entries_of(a, true), of_b = entries_of(b, true);
    const auto are_in = [](const auto& these, const auto& others) {
        return std::ranges::all_of(these, [&](const LookEntry* entry) {
            const auto found = std::ranges::find_if(
                others, [&](const LookEntry* other) { return other->effect->name == entry->effect->name; });
            return found == others.end() ? entry->state.enabled.on == 0 : says_same(*entry, **found);
        });
    };
    return are_in(of_a, of_b) && are_in(of_b, of_a);
}

bool says_same(const std::optional<LookUi>& a, const std::optional<LookUi>& b) {
    if (!a || !b) return !a && !b;
    return a->document == b->document && a->controllers == b->controllers && a->game == b->game;
}

/// A table of values has no order.
std::string modulation_of(const Look& look) {
    Look sorted{.is_flat = look.is_flat, .entries = look.entries, .pulses = look.pulses, .layers = look.layers};
    for (LookLayer& layer : sorted.layers)
        std::ranges::sort(layer.values, {},
                          [](const LookLayer::Value& value) { return std::tie(value.entry, value.parameter); });
    std::string out;
    write_modulation(out, sorted);
    return out;
}

bool has_same_files(const LookEntry& a, const LookEntry& b) {
    return a.effect == b.effect &&
           std::ranges::equal(a.resources, b.resources, {}, &LookResource::data, &LookResource::data);
}

}  // namespace

bool has_same(const LookEntry& a, const LookEntry& b, const ParamInfo& row) {
    if (row.kind == Kind::Resource) return value_text(a, row) == value_text(b, row);
    return std::equal(a.words.begin() + row.word, a.words.begin() + row.word + row.words, b.words.begin() + row.word);
}

bool says_same(const Look& a, const Look& b) {
    const auto is_same_entry = [](const LookEntry* x, const LookEntry* y) { return says_same(*x, *y); };
    if (a.is_flat != b.is_flat || a.is_enabled != b.is_enabled || (a.is_flat && a.order != b.order) ||
        !says_same(a.ui, b.ui) || !has_same_ui(a, b) ||
        !std::ranges::equal(entries_of(a, false), entries_of(b, false), is_same_entry))
        return false;
    return modulation_of(a) == modulation_of(b);
}

bool reads_as(const Look& read, Look look) {
    const std::vector<std::string> names = entry_names(look);
    const std::vector<const LookEntry*> others = counterparts(look, read);
    for (std::size_t i = 0; i < names.size(); ++i)
        if (others[i] != nullptr && others[i]->state.enabled.on != 0 && is_moved(look, names[i])) wake(look.entries[i]);
    return says_same(read, look);
}

bool is_same(const Look& a, const Look& b) {
    return says_same(a, b) && std::ranges::equal(a.entries, b.entries, has_same_files);
}

bool is_same(const ResourceData& a, const ResourceData& b) {
    if (a.index() != b.index()) return false;
    if (const auto* const image = std::get_if<ResourceImage>(&a)) {
        const auto& other = std::get<ResourceImage>(b);
        return image->width == other.width && image->height == other.height && is_same(image->rgba, other.rgba);
    }
    const auto &table = std::get<ColorTable>(a), &other = std::get<ColorTable>(b);
    return table.shaper_size == other.shaper_size && table.shaper_min == other.shaper_min &&
           table.shaper_max == other.shaper_max && table.size == other.size && table.min == other.min &&
           table.max == other.max && is_same(table.shaper, other.shaper) && is_same(table.cube, other.cube);
}

bool is_same(const EffectInfo& a, const EffectInfo& b) {
    return &a == &b ||
           (a.name == b.name && std::ranges::equal(a.files, b.files, {}, &EffectFile::text, &EffectFile::text));
}

std::size_t bytes_of(const ResourceData& data) {
    if (const auto* const image = std::get_if<ResourceImage>(&data)) return image->rgba.size() * sizeof(float);
    const auto& table = std::get<ColorTable>(data);
    return (table.shaper.size() + table.cube.size()) * sizeof(float);
}

std::size_t bytes_of(const Look& look) {
    std::size_t bytes = sizeof(Look) + look.pulses.size() * sizeof(LookPulse);
    for (const LookEntry& entry : look.entries)
        bytes += sizeof(LookEntry) + entry.words.size() * 4 + entry.resources.size() * sizeof(LookResource);
    for (const LookLayer& layer : look.layers)
        for (const LookLayer::Value& value : layer.values) bytes += sizeof(value) + value.words.size() * 4;
    return bytes;
}

}  // namespace darkroom::edit
