// SPDX-License-Identifier: MIT
#pragma once
// For tests only: stacks of random effects, values and wires. The same generator gives the same stack everywhere, and a
// stack describes itself where a test fails. Not part of the library.

#include <fmt/format.h>

#include <bit>
#include <random>
#include <string>

#include "compose/test_stacks/host.hpp"

namespace darkroom::test {

inline std::uint32_t below(std::mt19937& random, std::uint32_t limit) {
    return static_cast<std::uint32_t>(random() % limit);
}
inline bool one_in(std::mt19937& random, std::uint32_t count) { return below(random, count) == 0; }
inline double between(std::mt19937& random, double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
}

enum class Values : std::uint8_t {
    Sane,  ///< the widest ranges would make numbers that no chain of float pictures can hold
    Any,   ///< of the whole range, its ends among them
};

inline double random_value(std::mt19937& random, const ParamInfo& row, Values values) {
    const Range& range = row.range;
    if (values == Values::Sane) {
        const double most = std::max(range.min * 4, row.kind == Kind::Int ? 6.0 : 2.0);
        return between(random, range.min, std::min(range.max, most));
    }
    switch (below(random, 5)) {
        case 0:
            return range.min;
        case 1:
            return range.max;
        case 2:  // the sizes between are many
            return std::clamp(std::exp2(between(random, -20, 20)), range.min, range.max);
        default:
            return between(random, range.min, range.max);
    }
}

inline void set_random(std::mt19937& random, Composer& composer, Handle handle, Values values) {
    for (const ParamInfo& row : composer.info(handle)->parameters.rows) {
        if (row.kind == Kind::Resource) continue;
        std::array<std::uint32_t, 4> words{};
        for (std::uint32_t i = 0; i < std::min(row.words, 4u); ++i) {
            switch (row.kind) {
                case Kind::Toggle:
                    words[i] = below(random, 2);
                    break;
                case Kind::Choice:
                    words[i] = below(random, static_cast<std::uint32_t>(row.choices.size()));
                    break;
                case Kind::Int:
                    words[i] = static_cast<std::uint32_t>(std::lround(random_value(random, row, values)));
                    break;
                default:
                    words[i] = std::bit_cast<std::uint32_t>(static_cast<float>(random_value(random, row, values)));
            }
        }
        if (row.words <= 4) must(composer.set(handle, row.name, std::span(words).first(row.words)));
    }
    // Values that contradict each other are refused: take the defaults then.
    const EffectInfo& info = *composer.info(handle);
    if (info.conflict == nullptr || info.conflict(composer.words(handle).data()).empty()) return;
    for (const ParamInfo& row : info.parameters.rows)
        must(composer.set(handle, row.name, info.parameters.defaults.subspan(row.word, row.words)));
}

/// Any of the entries before, perhaps as it was a frame before; the scene or its alpha; or (default) the entry before.
inline Handle random_handle(std::mt19937& random, const Composer& composer, std::uint32_t entry) {
    const std::uint32_t pick = below(random, entry + 3);
    if (pick < 3) return std::array{Handle{}, scene_color, scene_alpha}[pick];
    const Handle of_entry = composer.entry(pick - 3);
    return one_in(random, 12) ? of_entry.previous() : of_entry;
}

struct StackDesc {
    Values values = Values::Sane;
    const EffectInfo* always = nullptr;  ///< an effect that the stack holds at some place
    std::span<const EffectInfo* const> effects = all_effects();
    std::uint32_t one_input_in = 6;  ///< how many entries name their input
    bool has_sizes = false;          ///< entries may work at half the size, the last one, too
};

inline void fill_random(std::mt19937& random, Composer& composer, const StackDesc& desc) {
    const std::uint32_t entries = 2 + below(random, 5);
    const std::uint32_t place = desc.always == nullptr ? entries : below(random, entries);
    for (std::uint32_t i = 0; i < entries; ++i) {
        const EffectInfo* info = desc.effects[below(random, static_cast<std::uint32_t>(desc.effects.size()))];
        if (i == place) info = desc.always;
        EntryDesc inputs;
        if (one_in(random, desc.one_input_in)) inputs.input = random_handle(random, composer, i);
        if (one_in(random, 3)) inputs.source = random_handle(random, composer, i);
        if (one_in(random, 5)) inputs.mask = random_handle(random, composer, i);
        if (info->has_second()) inputs.second = i == 0 ? scene_color : composer.entry(below(random, i));
        if (one_in(random, 3)) inputs.opacity = static_cast<float>(between(random, 0, 1));
        if (one_in(random, 3)) inputs.blend = static_cast<BlendMode>(below(random, 9));
        inputs.enabled = !one_in(random, 8);
        if (desc.has_sizes && one_in(random, 12)) inputs.scale = {1, 2};
        if (one_in(random, 12)) inputs.format = VK_FORMAT_R32G32B32A32_SFLOAT;
        set_random(random, composer, composer.add(*info, nullptr, inputs), desc.values);
    }
}

/// What a user may do while the picture runs: other values, choices and toggles; entries on, off, or half seen. The
/// same edits for every composer that holds the same stack and is compiled for the same frames.
inline void edit_random(std::mt19937& random, Composer& composer, Values values) {
    for (std::size_t i = 0; i < composer.size(); ++i) {
        const Handle entry = composer.entry(i);
        if (one_in(random, 2)) set_random(random, composer, entry, values);
        if (one_in(random, 3)) must(composer.set_enabled(entry, !composer.desc(entry)->enabled));
        constexpr std::array opacities{0.0F, 0.25F, 1.0F};
        // An entry with passes of its own may have been planned without a mix: it refuses.
        if (one_in(random, 3)) (void)composer.set_opacity(entry, opacities[below(random, 3)]);
    }
}

/// Entries, wires and values as a look's stack, for effects of the library: all that it takes to build it again.
inline std::string described(const Composer& composer) {
    std::string out;
    const auto wire = [&](std::string_view key, Handle handle) {
        if (!handle.is_given()) return;
        const std::string name = handle == scene_color   ? "scene"
                                 : handle == scene_alpha ? "alpha"
                                                         : composer.desc({handle.id})->name;
        out += fmt::format("{} = \"{}{}\"\n", key, name, handle.is_previous ? ".previous" : "");
    };
    for (std::size_t i = 0; i < composer.size(); ++i) {
        const Handle entry = composer.entry(i);
        const EntryDesc& inputs = *composer.desc(entry);
        out +=
            fmt::format("\n[[stack]]\neffect = \"{0}\"\noutput = \"{1}\"\n", composer.info(entry)->name, inputs.name);
        if (!inputs.enabled) out += "enabled = false\n";
        wire("input", inputs.input);
        wire("source", inputs.source);
        wire("second", inputs.second);
        wire("mask", inputs.mask);
        if (inputs.opacity != 1) out += fmt::format("opacity = {}\n", inputs.opacity);
        if (inputs.scale.denominator != 1)
            out += fmt::format("scale = {}\n", 1.0 * inputs.scale.numerator / inputs.scale.denominator);
        if (inputs.format != VK_FORMAT_UNDEFINED) out += fmt::format("format = {}\n", static_cast<int>(inputs.format));
        if (inputs.blend != BlendMode::Mix) out += fmt::format("blend = {}\n", static_cast<int>(inputs.blend));
        const auto words = composer.words(entry);
        for (const ParamInfo& row : composer.info(entry)->parameters.rows) {
            std::string value;
            for (const std::uint32_t word : words.subspan(row.word, row.words)) {
                if (!value.empty()) value += ", ";
                if (row.kind == Kind::Choice)
                    value += fmt::format("\"{}\"", row.choices[word]);
                else if (row.kind == Kind::Toggle)
                    value += word != 0 ? "true" : "false";
                else if (row.kind == Kind::Int)
                    value += fmt::format("{}", static_cast<std::int32_t>(word));
                else
                    value += fmt::format("{}", std::bit_cast<float>(word));
            }
            out += fmt::format("{} = {}\n", row.name, row.words == 1 ? value : "[" + value + "]");
        }
    }
    return out;
}

}  // namespace darkroom::test
