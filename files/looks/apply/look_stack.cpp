// SPDX-License-Identifier: MIT
#include "looks/apply/look_stack.hpp"
#include <darkroom/describe.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/text/param_text.hpp"
#include "looks/apply/look_resources.hpp"

namespace darkroom {

namespace {

// Of the flat table's effects that are off, the pointwise ones without images that come and go by an amount cost nearly
// nothing. The others would own memory, part a kernel or lengthen it in every frame, for what nobody asked for.
bool is_in_the_way(const Look& look, const LookEntry& entry, const std::string& name, const ApplyOptions& options) {
    const EffectInfo& effect = *entry.effect;
    if (is_moved(look, name) || std::ranges::count(options.keeps, name) > 0) return false;
    if (entry.is_of_ui) return entry.state.enabled.on == 0 && !options.keeps_what_is_off;
    const bool has_amount = std::ranges::any_of(effect.parameters.rows, &ParamInfo::is_amount);
    const bool starts_on = flat_entry(effect, look.order).state.enabled.on != 0;
    if (!look.is_flat || (effect.touch == Touch::Pointwise && !effect.build && (has_amount || starts_on))) return false;
    const bool is_still =
        effect.touch == Touch::Warp && effect.is_identity != nullptr && effect.is_identity(entry.words.data());
    return is_still || (entry.state.enabled.on == 0 && !options.keeps_what_is_off);
}

OutputScale fraction(float scale) {
    OutputScale best{1, 1};
    for (std::uint32_t denominator = 1; denominator <= 64; ++denominator) {
        const auto numerator =
            static_cast<std::uint32_t>(std::clamp(std::lround(scale * static_cast<float>(denominator)), 1L, 64L));
        const auto error = [&](const OutputScale& of) {
            return std::abs(static_cast<float>(of.numerator) / static_cast<float>(of.denominator) - scale);
        };
        if (error({numerator, denominator}) < error(best)) best = {numerator, denominator};
    }
    return best;
}

VkFormat image_format(EntryFormat format) {
    constexpr std::array formats{VK_FORMAT_UNDEFINED,
                                 VK_FORMAT_R8G8B8A8_UNORM,
                                 VK_FORMAT_R16G16B16A16_UNORM,
                                 VK_FORMAT_R16G16B16A16_SFLOAT,
                                 VK_FORMAT_R32G32B32A32_SFLOAT,
                                 VK_FORMAT_A2B10G10R10_UNORM_PACK32,
                                 VK_FORMAT_B10G11R11_UFLOAT_PACK32,
                                 VK_FORMAT_R8_UNORM,
                                 VK_FORMAT_R16_SFLOAT,
                                 VK_FORMAT_R32_SFLOAT};
    static_assert(formats.size() == detail::Enumerators<EntryFormat>::count);
    return formats[static_cast<std::size_t>(format)];
}

/// Reads the wires of an entry. `made`: the outputs before it, all of them for what is read of the frame before.
class WireReader {
  public:
    explicit WireReader(const Look& look) : look_(look) {
        for (const auto& [name, handle] : given_wires) made_.emplace(name);
    }

    Result<> read(PlacedEntry& placed) {
        for (std::size_t i = 0; i < wires.size(); ++i) DARKROOM_TRY(read(placed, wires[i], placed.ends[i]));
        if (!placed.entry->output.empty()) made_.insert(placed.entry->output);
        return {};
    }
    /// What is read of the frame before may be made by a later entry: to be asked when all have been read.
    Result<> check_previous(std::span<const PlacedEntry> all) const {
        for (const PlacedEntry& placed : all)
            for (std::size_t i = 0; i < wires.size(); ++i)
                if (placed.ends[i].is_previous && !made_.contains(placed.ends[i].output))
                    return refuse(placed, wires[i], "no entry has this output");
        return {};
    }

  private:
    Result<> read(const PlacedEntry& placed, const WireInfo& wire, PlacedEntry::Wire& out) const {
        std::string_view name = placed.entry->*wire.member;
        if (!wire.is_reference || name.empty()) return {};
        if (is_file_name(name)) {
            out.picture = resource_of(*placed.entry, wire);
            if (out.picture != nullptr && out.picture->data != nullptr) return {};
            return refuse(placed, wire, "the entry has no such resource");
        }
        out.is_previous = name.ends_with(previous_suffix);
        if (out.is_previous) name.remove_suffix(previous_suffix.size());
        out.output = name;
        if (out.is_previous || made_.contains(name)) return {};
        return refuse(placed, wire, "no entry before it has this output");
    }
    Failure refuse(const PlacedEntry& placed, const WireInfo& wire, std::string_view why) const {
        return user_error(fmt::format("{}: {}: {} = \"{}\": {}", look_.shown_name, placed.name, wire.key,
                                      printable(placed.entry->*wire.member), why));
    }

    const Look& look_;
    std::set<std::string, std::less<>> made_;
};

}  // namespace

bool is_domain_change(const EffectInfo& effect) {
    if (effect.makes == nullptr || !effect.flat.starts_on) return false;
    const void* const defaults = effect.parameters.defaults.data();
    for (const Domain before : {Domain::SceneLinear, Domain::DisplayLinear})
        if (effect.accepts.contains(before) && effect.makes({.domain = before}, defaults).domain != before) return true;
    return false;
}

Result<std::vector<PlacedEntry>> stack_of(const Look& look, const ApplyOptions& options) {
    const std::vector<std::string> names = entry_names(look);
    std::vector<PlacedEntry> out;
    WireReader reader(look);
    for (const LookEntry* const entry : ordered(look)) {
        const std::string& name = names[static_cast<std::size_t>(entry - look.entries.data())];
        // The interface lies outside of post-processing.
        const bool is_own = look.is_enabled || entry->is_of_ui || entry->effect->exposure != nullptr;
        const bool is_kept = is_own || is_domain_change(*entry->effect);
        if ((look.is_flat && !is_kept) || is_in_the_way(look, *entry, name, options)) continue;
        PlacedEntry placed{.entry = entry,
                           .name = name,
                           .desc = {.is_ui = entry->is_of_ui && entry->effect->flat.ui == UiPart::Layer,
                                    .name = name,
                                    .output = entry->output,
                                    .enabled = is_own ? entry->state.enabled.on != 0 : true,
                                    .opacity = entry->state.opacity,
                                    .blend = entry->state.blend,
                                    .scale = fraction(entry->state.scale),
                                    .format = image_format(entry->state.format)},
                           .has_values = is_own};
        // Bloom reads the scene itself in the documented order, and in the other what exposure and air made of it.
        if (look.is_flat && !entry->is_of_ui && look.order == LookOrder::Documented) placed.desc.source = scene_color;
        DARKROOM_TRY(reader.read(placed));
        out.push_back(std::move(placed));
    }
    DARKROOM_TRY(reader.check_previous(out));
    return out;
}

std::vector<const LookEntry*> counterparts(const Look& of, const Look& in) {
    std::vector<const LookEntry*> out;
    const std::vector<std::string> names = entry_names(of), others = entry_names(in);
    for (std::size_t i = 0; i < names.size(); ++i) {
        const LookEntry& entry = of.entries[i];
        const auto is_same = [&](std::size_t k) {
            const LookEntry& other = in.entries[k];
            const bool has_ids = entry.id != 0 && other.id != 0;
            return (has_ids ? entry.id == other.id : names[i] == others[k]) &&
                   entry.effect->name == other.effect->name && entry.is_of_ui == other.is_of_ui;
        };
        const LookEntry* found = nullptr;
        for (std::size_t k = 0; k < others.size() && found == nullptr; ++k)
            if (is_same(k)) found = &in.entries[k];
        out.push_back(found);
    }
    return out;
}

}  // namespace darkroom
