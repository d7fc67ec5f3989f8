// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <darkroom/look.hpp>
#include <map>

#include "core/param_text.hpp"
#include "looks/look_parts.hpp"
#include "looks/look_resources.hpp"

namespace darkroom {

namespace {

// Of the flat table's effects that are off, the pointwise ones without images cost nothing. The others would own memory
// or part a kernel in every frame, for what nobody asked for.
bool is_in_the_way(const Look& look, const LookEntry& entry, const std::string& name, const ApplyOptions& options) {
    const EffectInfo& effect = *entry.effect;
    if (is_moved(look, name) || std::ranges::count(options.keeps, name) > 0) return false;
    if (entry.is_of_ui) return entry.state.enabled.on == 0 && !options.keeps_what_is_off;
    if (!look.is_flat || (effect.touch == Touch::Pointwise && !effect.build)) return false;
    const bool is_still =
        effect.touch == Touch::Warp && effect.is_identity != nullptr && effect.is_identity(entry.words.data());
    return is_still || (entry.state.enabled.on == 0 && !options.keeps_what_is_off);
}

/// The look's tables and pictures in a Composer, each defined once.
class Definitions {
  public:
    explicit Definitions(Composer& composer) : composer_(composer) {}

    Result<Resource> number_of(const LookResource* resource, std::string_view key) {
        if (resource == nullptr || resource->data == nullptr)
            return user_error(fmt::format("{}: the entry has no such resource", key));
        const auto [found, is_new] = defined_.try_emplace(resource->data.get());
        if (!is_new) return found->second;
        const auto number = composer_.define(*resource->data);
        if (!number)
            return failure(Error{number.error().fault,
                                 fmt::format("{} = \"{}\": {}", key, printable(resource->file), number.error().text)});
        return found->second = *number;
    }

    /// The entry's values with the Composer's numbers of its resources.
    Result<std::vector<std::uint32_t>> words_of(const LookEntry& entry) {
        std::vector<std::uint32_t> words = entry.words;
        for (const ParamInfo& row : entry.effect->parameters.rows) {
            if (row.kind != Kind::Resource || words[row.word] == 0) continue;
            const auto number = number_of(resource_of(entry, row), row.name);
            if (!number) return failure(number.error());
            words[row.word] = number->id;
        }
        return words;
    }

  private:
    Composer& composer_;
    std::map<const ResourceData*, Resource> defined_;
};

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

}  // namespace

bool is_domain_change(const EffectInfo& effect) {
    if (effect.makes == nullptr || !effect.flat.starts_on) return false;
    const void* const defaults = effect.parameters.defaults.data();
    for (const Domain before : {Domain::SceneLinear, Domain::DisplayLinear})
        if (effect.accepts.contains(before) && effect.makes(before, defaults) != before) return true;
    return false;
}

Result<> apply(const Look& look, Composer& composer, const ApplyOptions& options) {
    const std::vector<std::string> names = entry_names(look);
    Definitions definitions(composer);
    std::map<std::string, Handle, std::less<>> outputs(given_wires.begin(), given_wires.end());
    // What an entry reads of the frame before may be made by a later one: those are wired when all are there.
    std::vector<std::pair<Handle, std::size_t>> unwired;
    const auto blame = [&](std::size_t index, const Error& error) {
        return failure(Error{error.fault, fmt::format("{}: {}: {}", look.shown_name, names[index], error.text)});
    };
    const auto wired = [&](std::size_t index, bool is_complete) -> Result<EntryDesc> {
        const LookEntry& entry = look.entries[index];
        EntryDesc desc{.is_ui = entry.is_of_ui && entry.effect->is_ui,
                       .name = names[index],
                       .output = entry.output,
                       .enabled = look.is_enabled ? entry.state.enabled.on != 0 : true,
                       .opacity = entry.state.opacity,
                       .blend = entry.state.blend,
                       .scale = fraction(entry.state.scale),
                       .format = image_format(entry.state.format)};
        for (const WireInfo& end : wires) {
            std::string_view name = entry.*end.member;
            if (!end.is_reference || name.empty()) continue;
            if (is_file_name(name)) {
                const auto number = definitions.number_of(resource_of(entry, end), end.key);
                if (!number) return blame(index, number.error());
                desc.*end.handle = Composer::picture_of(*number);
                continue;
            }
            const bool is_previous = name.ends_with(previous_suffix);
            if (is_previous) name.remove_suffix(previous_suffix.size());
            const auto found = outputs.find(name);
            if (is_previous && !is_complete) continue;
            if (found == outputs.end())
                return user_error(fmt::format("{}: {}: {} = \"{}\": no entry{} has this output", look.shown_name,
                                              names[index], end.key, printable(entry.*end.member),
                                              is_previous ? "" : " before it"));
            desc.*end.handle = is_previous ? found->second.previous() : found->second;
        }
        if (look.is_flat && !entry.is_of_ui) desc.source = scene_color;
        return desc;
    };
    for (const LookEntry* const entry : ordered(look)) {
        const std::size_t index = static_cast<std::size_t>(entry - look.entries.data());
        const bool is_kept = look.is_enabled || is_domain_change(*entry->effect);
        if ((look.is_flat && !is_kept) || is_in_the_way(look, *entry, names[index], options)) continue;
        const auto desc = wired(index, false);
        if (!desc) return failure(desc.error());
        const auto words = definitions.words_of(*entry);
        if (!words) return blame(index, words.error());
        const Handle handle = composer.add(*entry->effect, look.is_enabled ? words->data() : nullptr, *desc);
        if (!entry->output.empty()) outputs[entry->output] = handle;
        const bool reads_previous = std::ranges::any_of(wires, [&](const WireInfo& end) {
            return end.is_reference && (entry->*end.member).ends_with(previous_suffix) &&
                   !is_file_name(entry->*end.member);
        });
        if (reads_previous) unwired.emplace_back(handle, index);
    }
    for (const auto& [handle, index] : unwired) {
        const auto desc = wired(index, true);
        if (!desc) return failure(desc.error());
        if (auto ok = composer.rewire(handle, *desc); !ok) return ok;
    }
    return apply_modulation(look, composer);
}

}  // namespace darkroom
