// SPDX-License-Identifier: MIT
#pragma once
// For tests only: stacks of random effects, values and wires. The same generator gives the same stack everywhere, and a
// stack describes itself where a test fails. Not part of the library.

#include <fmt/format.h>

#include <bit>
#include <random>
#include <string>

#include "compose/test_host.hpp"

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
        const double most = row.kind == Kind::Int ? 6.0 : std::max(range.min * 4, 2.0);
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
    for (const ParamInfo& row : composer.info(handle).parameters.rows) {
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
    const EffectInfo& info = composer.info(handle);
    if (info.conflict == nullptr || info.conflict(composer.words(handle).data()).empty()) return;
    for (const ParamInfo& row : info.parameters.rows)
        must(composer.set(handle, row.name, info.parameters.defaults.subspan(row.word, row.words)));
}

/// Any of the entries before, the scene, or (default) the entry before.
inline Handle random_handle(std::mt19937& random, std::uint32_t entry) {
    const std::uint32_t pick = below(random, entry + 2);
    return pick == 0 ? Handle{} : pick == 1 ? scene_color : Handle{pick - 1};
}

/// `always`: an effect that the stack holds at some place.
inline void fill_random(std::mt19937& random, Composer& composer, Values values, const EffectInfo* always = nullptr) {
    const std::uint32_t entries = 2 + below(random, 5);
    const std::uint32_t place = always == nullptr ? entries : below(random, entries);
    const auto effects = all_effects();
    for (std::uint32_t i = 0; i < entries; ++i) {
        const EffectInfo* info = effects[below(random, static_cast<std::uint32_t>(effects.size()))];
        if (i == place) info = always;
        EntryDesc desc;
        if (one_in(random, 6)) desc.input = random_handle(random, i);
        if (one_in(random, 3)) desc.source = random_handle(random, i);
        if (one_in(random, 5)) desc.mask = random_handle(random, i);
        if (info->has_second) desc.second = i == 0 ? scene_color : Handle{1 + below(random, i)};
        if (one_in(random, 3)) desc.opacity = static_cast<float>(between(random, 0, 1));
        if (one_in(random, 3)) desc.blend = static_cast<BlendMode>(below(random, 9));
        desc.enabled = !one_in(random, 8);
        set_random(random, composer, composer.add(*info, nullptr, desc), values);
    }
}

/// Entries, wires and values: all that it takes to build the stack again.
inline std::string described(const Composer& composer) {
    std::string out;
    const auto shown = [](Handle handle) {
        return handle == scene_color ? std::string("scene") : std::to_string(handle.id);
    };
    for (std::size_t i = 0; i < composer.size(); ++i) {
        const Handle entry = composer.entry(i);
        const EntryDesc& desc = composer.desc(entry);
        out += "\n  " + desc.name + (desc.enabled ? "" : ", off") + ": in " + shown(desc.input) + ", source " +
               shown(desc.source) + ", second " + shown(desc.second) + ", mask " + shown(desc.mask) + ", opacity " +
               std::to_string(desc.opacity) + ", blend " + std::to_string(static_cast<int>(desc.blend));
        const auto words = composer.words(entry);
        for (const ParamInfo& row : composer.info(entry).parameters.rows) {
            out += ", " + std::string(row.name);
            const bool is_whole = row.kind == Kind::Int || row.kind == Kind::Choice || row.kind == Kind::Toggle;
            for (const std::uint32_t word : words.subspan(row.word, row.words))
                out += is_whole ? fmt::format(" {}", static_cast<std::int32_t>(word))
                                : fmt::format(" {}", std::bit_cast<float>(word));
        }
    }
    return out;
}

}  // namespace darkroom::test
