// SPDX-License-Identifier: MIT
#pragma once
// For tests only: a stack that no device is needed for, with a parameter of every kind, and the reference's names for
// some of them. Not part of the library.

#include <darkroom/composer.hpp>
#include <darkroom/console.hpp>
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <string>
#include <vector>

namespace darkroom::test {

enum class Shape : std::uint32_t { Round, Square, Star };

struct Warp {
    float strength = 0;
};
struct Echo {
    float strength = 0;
    float scale = 1;
};
struct Tone {
    float contrast = 1;
    float gamma = 1;
};
struct Sample {
    std::int32_t count = 4;
    Toggle is_on = false;
    Shape shape = Shape::Round;
    Vec2 offset;
    Rgb color{1, 1, 1};
    Curve curve;
    Resource table;
};

inline constexpr auto warp_rows =
    describe(field<&Warp::strength>("How much it bends.", {-1, 1}).also_named("r_ui_warp"));
inline constexpr auto echo_rows = describe(field<&Echo::strength>("How much.", {0, 2}).also_named("r_ui_echo"),
                                           field<&Echo::scale>("How large.", {0.5, 2}).also_named("r_ui_echo_scale"));
inline constexpr auto tone_rows = describe(field<&Tone::contrast>("A factor.", {1, 2}).also_named("contrast", true),
                                           field<&Tone::gamma>("An exponent.", {0.25, 4}).also_named("gamma", true));
inline constexpr auto sample_rows = describe(
    field<&Sample::count>("How many.", {1, 64}), field<&Sample::is_on>("Is it on."), field<&Sample::shape>("Its form."),
    field<&Sample::offset>("Where.", {-1, 1}), field<&Sample::color>("Which.", {0, 1}),
    field<&Sample::curve>("Along what.", {0, 1}), field<&Sample::table>("By what."));

inline const EffectInfo warp_effect{.name = "warp", .doc = "Bends.", .parameters = warp_rows.table()};
inline const EffectInfo chroma_effect = [] {
    static constexpr auto rows =
        describe(field<&Warp::strength>("How much it parts.", {0, 1}).also_named("r_ui_chromatic"));
    return EffectInfo{.name = "chroma", .doc = "Parts colours.", .parameters = rows.table()};
}();
inline const EffectInfo echo_effect{.name = "echo", .doc = "Doubles.", .parameters = echo_rows.table()};
inline const EffectInfo tone_effect{.name = "tone", .doc = "Tones.", .parameters = tone_rows.table()};
inline const EffectInfo sample_effect{.name = "sample", .doc = "Has all kinds.", .parameters = sample_rows.table()};

inline const EffectInfo& effect_info(const Warp&) { return warp_effect; }
inline const EffectInfo& effect_info(const Echo&) { return echo_effect; }
inline const EffectInfo& effect_info(const Tone&) { return tone_effect; }
inline const EffectInfo& effect_info(const Sample&) { return sample_effect; }

/// The stack and a console whose output is kept.
struct ConsoleBed {
    explicit ConsoleBed(const std::filesystem::path& folder = {}) {
        composer.add(Warp{.strength = -0.15f});
        const Warp parted{.strength = 0.005f};
        composer.add(chroma_effect, &parted);
        composer.add(Echo{.strength = 0.1f, .scale = 1.01f});
        composer.add(Tone{.contrast = 1.4f, .gamma = 0.9f});
        composer.add(Sample{});
        console.emplace(composer, ConsoleDesc{.print =
                                                  [this](Severity severity, std::string_view line) {
                                                      printed.emplace_back(line);
                                                      severities.push_back(severity);
                                                  },
                                              .folder = folder});
    }
    /// What `commands` print, a line each.
    std::string run(std::string_view commands) {
        printed.clear();
        severities.clear();
        console->execute(commands);
        std::string out;
        for (const std::string& line : printed) out += (out.empty() ? "" : "\n") + line;
        return out;
    }

    Composer composer{Device::assumed()};
    std::optional<Console> console;
    std::vector<std::string> printed;
    std::vector<Severity> severities;
};

}  // namespace darkroom::test
